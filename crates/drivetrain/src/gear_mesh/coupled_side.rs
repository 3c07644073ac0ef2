//! What a mesh is asked when its forces are found with those of other meshes.

use gearmesh_geometry::Flank;

use super::GearMesh;
use crate::error::DrivetrainError;
use crate::flank_contacts::ToothContact;
use crate::flank_modes::ModalMotion;
use crate::models::hybrid::{OUT_OF_REACH, ReducedTeeth};
use crate::models::teeth_model::TeethModel;
use crate::pose::{Pose, Vector6};

/// A side whose forces are found with those of other meshes.
pub(crate) struct CoupledSide<'a> {
    pub contacts: &'a [ToothContact],
    /// Load on gear 2 per unit force of each contact that carries, where tangents were asked for.
    pub directions: &'a [Vector6],
    /// Says how gaps are felt ([`TeethModel::felt`]).
    pub felt: &'a dyn TeethModel,
    pub model: &'a ReducedTeeth,
}

impl GearMesh {
    /// The deepest overlap of all sides that were found \[m\].
    pub(crate) fn deepest_overlap_m(&self) -> f64 {
        let each = self.sides.iter().map(|side| side.found.deepest_overlap_m());
        each.fold(0.0, f64::max)
    }

    /// Finds flanks that are not out of reach of the deepest overlap of all meshes, too, and prepares the models for
    /// forces that are found with those of other meshes.
    ///
    /// # Errors
    /// As [`TeethModel::prepare`].
    pub(crate) fn prepare(&mut self, pose: &Pose, deepest_m: f64) -> Result<(), DrivetrainError> {
        let reach_m = OUT_OF_REACH * deepest_m;
        for number in 0..self.sides.len() {
            if reach_m > 0.0 && self.sides[number].found.open_gap_m.is_some() {
                self.find_side(number, pose, &ModalMotion::default(), reach_m);
            }
            let side = &mut self.sides[number];
            side.model.prepare(&side.found, deepest_m)?;
        }
        Ok(())
    }

    /// Number of its sides.
    pub(crate) fn side_count(&self) -> usize {
        self.sides.len()
    }

    /// The flank of gear 0 or 1 that touches on the side with this number.
    pub(crate) fn flank_of(&self, gear: usize, side: usize) -> Flank {
        self.kinematics.side_of(gear, self.sides[side].flank)
    }

    /// Whether the forces of all sides can be found with those of other meshes.
    pub(crate) fn couples(&self) -> bool {
        let mut sides = self.sides.iter();
        sides.all(|side| side.model.coupled().is_some()) && self.modal.count() == 0
    }

    /// A side whose forces are found with those of other meshes.
    pub(crate) fn coupled_side(&self, number: usize) -> Option<CoupledSide<'_>> {
        let side = &self.sides[number];
        Some(CoupledSide {
            contacts: &side.found.contacts,
            directions: &side.directions,
            felt: &*side.model,
            model: side.model.coupled()?,
        })
    }

    /// Its model.
    pub(crate) fn coupled_model(&mut self, number: usize) -> Option<&mut ReducedTeeth> {
        self.sides[number].model.coupled_mut()
    }
}
