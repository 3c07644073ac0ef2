//! Reduced teeth whose forces are found with those of other meshes.

use gearmesh_contact::slice_contact::SliceContact;

use super::{NOWHERE, ReducedTeeth};
use crate::flank_contacts::FlankContacts;
use crate::models::teeth_model::TeethLoads;

/// What the solution of several meshes together says of one side.
#[derive(Debug, Clone, Default)]
pub(crate) struct JointShare {
    /// −∂F/∂gap of its own patches \[N/m\], `[force][gap]`.
    pub stiffness_n_per_m: Vec<f64>,
    /// What the gaps that are felt ahead make of the forces, K a \[N\] of all meshes' a.
    pub drag_n: Vec<f64>,
    /// Half of the energy that it shares with others \[J\].
    pub stored_j: f64,
    /// ∂E*/∂u of the energy that it shares with others, `[patch][gear]` \[J per u\].
    pub energy_by_u: Vec<[f64; 2]>,
}

impl ReducedTeeth {
    /// Lets the forces be found with those of other meshes.
    pub(crate) fn join(&mut self) {
        let most = self.slices.capacity();
        self.joint = Some(JointShare {
            stiffness_n_per_m: Vec::with_capacity(most * most),
            drag_n: Vec::with_capacity(most),
            energy_by_u: Vec::with_capacity(most),
            stored_j: 0.0,
        });
    }

    /// The patches within reach.
    pub(crate) fn slices(&self) -> &SliceContact {
        &self.slices
    }

    /// Number of patches within reach.
    pub(crate) fn patch_count(&self) -> usize {
        self.patches.len()
    }

    /// The patch of a contact; none where it is out of reach.
    pub(crate) fn patch_of(&self, contact: usize) -> Option<usize> {
        self.row.get(contact).copied().filter(|row| *row != NOWHERE)
    }

    /// Forces of the patches to start from, after [`Self::lay_known`] \[N\].
    pub(crate) fn known_n(&self) -> &[f64] {
        &self.change
    }

    /// Takes forces that were found with those of other meshes.
    pub(crate) fn accept(&mut self, forces_n: &[f64]) -> &mut JointShare {
        self.slices.accept(forces_n);
        self.joint.get_or_insert_default()
    }

    /// Writes the forces that were found with those of other meshes.
    pub(super) fn fill_joint(
        &mut self,
        flanks: &FlankContacts,
        tangents: bool,
        loads: &mut TeethLoads,
    ) {
        if self.patches.is_empty() {
            return;
        }
        self.fill(flanks, tangents, loads);
        loads.stored_j += self.joint.as_ref().map_or(0.0, |joint| joint.stored_j);
    }
}
