//! What a mesh asks of the kinematics of two gears' flanks, whatever the family of the gears.
//!
//! | family | file |
//! | --- | --- |
//! | involute teeth, spur and helical, external or inside a ring, on parallel axes | `involute_mesh.rs`, with [`crate::MeshKinematics`] |
//! | bevel gears, on axes that meet | `bevel/` |
//! | crowned cylinders on crossed axes, the example of docs/extending.md | `tests/verification/conformance/crowned_cylinders.rs` |
//!
//! At rest, [`crate::PosedFlanks`] makes of any family what a static contact asks for. A family finds the patches that
//! face each other at a pose, with their gaps and derivatives ([`FlankContacts`]). Models, friction, modes and the
//! assembly of the load ask for no more.

use gearmesh_contact::SliceLayout;
use gearmesh_geometry::Flank;
use nalgebra::Vector3;

use crate::error::DrivetrainError;
use crate::flank_contacts::FlankContacts;
use crate::pose::{Pose, Vector6};
use crate::slice_plane::Matrix6;

/// Half axes of a contact ellipse as shares of a flank: along the face, up the flank.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PatchAxes {
    /// The long one.
    pub long: [f64; 2],
    /// The short one.
    pub short: [f64; 2],
}

/// Where two flanks touch, and over which ellipse.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ContactPatch {
    /// On gear 1 and gear 2: share of the face from the toe, share of the flank from its lower line.
    pub places: [[f64; 2]; 2],
    /// After Hertz \[Pa\].
    pub peak_pressure_pa: f64,
    /// On gear 1 and gear 2.
    pub axes: [PatchAxes; 2],
}

/// A unit tangent along which flanks slide on each other at a contact.
#[derive(Debug, Clone, Copy)]
pub struct Tangent {
    /// k: load on gear 2 of a unit friction force on it; sliding of gear 2 over gear 1 is k·(u̇, ω).
    pub direction: Vector6,
    /// ∂k by the increments of the pose; none where no derivatives are asked for.
    pub change: Option<Matrix6>,
}

/// Kinematics of the flanks of two gears at any pose.
pub trait FlankKinematics: Send {
    /// Slices along the teeth.
    fn layout(&self) -> &SliceLayout;

    /// Side of the flanks of gear 0 or 1 that touch on a side, which is named by gear 1's: a ring and the gear inside
    /// it touch with opposite ones.
    fn side_of(&self, _gear: usize, side: Flank) -> Flank {
        side
    }

    /// σ = ±1 of a side: the tangent of [`Self::sliding`] points to the tip of gear 1 and from that of gear 2 where it
    /// is +1.
    fn hand(&self, side: Flank) -> f64 {
        side.mirror()
    }

    /// Largest number of patches that can face each other at once, for sizing.
    fn capacity(&self) -> usize;

    /// Distance of one tooth from the next along the line of action \[m\]: the measure of motions in which teeth pass
    /// through each other.
    fn pitch_m(&self) -> f64;

    /// Whether the flanks of any gear deviate from the ideal.
    fn has_errors(&self) -> bool {
        false
    }

    /// Bound of what deviations add to both flanks together \[m\].
    fn most_added_m(&self) -> f64 {
        0.0
    }

    /// Gives all pairs of teeth one gap, for a spring that stands for the whole mesh.
    ///
    /// # Errors
    /// [`DrivetrainError::NoCommonGap`] where the family has none.
    fn share_one_gap(&mut self) -> Result<(), DrivetrainError> {
        Err(DrivetrainError::NoCommonGap)
    }

    /// Goes to a pose: what follows is asked at the last one.
    ///
    /// # Errors
    /// What keeps the gears from meshing at this pose at all.
    fn locate(&mut self, pose: &Pose) -> Result<(), DrivetrainError>;

    /// Gap \[m\] of ideal flanks of one side if none of that side can touch, for a short cut; none if some might.
    fn open_gap_m(&self, _side: Flank) -> Option<f64> {
        None
    }

    /// Finds all patches that face each other on one side; `pose`: the one that was located. Families that leave
    /// patches out which stand too far open count with flanks bent by [`FlankContacts::bent_m`].
    fn contacts(&mut self, pose: &Pose, side: Flank, found: &mut FlankContacts);

    /// The same where `found` holds what was found last on this side, at a pose next to this one: families whose search
    /// takes long begin at it.
    fn contacts_nearby(&mut self, pose: &Pose, side: Flank, found: &mut FlankContacts) {
        self.contacts(pose, side, found);
    }

    /// The same at any pose, whichever was located.
    ///
    /// # Errors
    /// As [`Self::locate`].
    fn contacts_at(
        &self,
        pose: &Pose,
        side: Flank,
        found: &mut FlankContacts,
    ) -> Result<(), DrivetrainError>;

    /// Whether [`Self::contacts`] finds all patches that close where the gears approach each other by this from the
    /// pose \[m\]; where it does not, its next call looks farther. In motion the pose is that under load.
    ///
    /// # Errors
    /// [`DrivetrainError::Value`] for an approach that no search reaches.
    fn reaches(&mut self, _approach_m: f64) -> Result<bool, DrivetrainError> {
        Ok(true)
    }

    /// Second derivative of the gap of a contact that [`Self::contacts`] found last on this side by the increments of
    /// the pose.
    fn gap_curvature(&self, found: &FlankContacts, contact: usize, side: Flank) -> Matrix6;

    /// Σ F ∂²gap over all contacts with their forces \[N\].
    fn load_curvature(&self, found: &FlankContacts, forces_n: &[f64], side: Flank) -> Matrix6 {
        let loaded = forces_n.iter().enumerate().filter(|(_, f)| **f > 0.0);
        loaded.fold(Matrix6::zeros(), |sum, (i, force)| {
            sum + *force * self.gap_curvature(found, i, side)
        })
    }

    /// Tangents along which the flanks slide in a contact: along the profile, and at right angles to it for families
    /// whose flanks slide along the teeth as well; friction then acts against the sliding in the tangent plane. With
    /// derivatives where they are asked for. The contacts are those that [`Self::contacts`] found last on this side,
    /// as in all that follows.
    fn sliding(
        &self,
        found: &FlankContacts,
        contact: usize,
        side: Flank,
        derivatives: bool,
    ) -> [Option<Tangent>; 2];

    /// The tangents of [`Self::sliding`] as the flanks of gear 1 and gear 2 see them, `[gear][tangent]`: along the
    /// profile towards the tip, and along the tooth as the loads of a reduced gear count it. None of families that
    /// slide along the profile only, whose tangent is that of [`Self::hand`].
    fn tangents_on_flanks(&self, _contact: usize, _side: Flank) -> Option<[[[f64; 2]; 2]; 2]> {
        None
    }

    /// Place of a contact on both flanks, and its ellipse after Hertz under a force \[N\] with E* \[Pa\]; of families
    /// whose flanks touch in points.
    fn contact_patch(
        &self,
        _contact: usize,
        _side: Flank,
        _force_and_modulus: (f64, f64),
    ) -> Option<ContactPatch> {
        None
    }

    /// A vector in gear 1's axes from gear 1's axis to where gear 2 is, for the directions in which the force on gear 1
    /// is told.
    fn towards_gear_2(&self, pose: &Pose) -> Vector3<f64> {
        pose.displacement_m
    }

    /// Gap \[m\] of the nearest ideal flanks of one side, continued beyond their ends, as the transmission error counts
    /// it.
    fn nearest_gap_m(&self, side: Flank) -> Option<f64>;

    /// Whether no tooth reaches the mate.
    fn is_apart(&self) -> bool;

    /// How deep flanks of one side overlap \[m\]; zero where none do.
    fn overlap_m(&self, pose: &Pose, side: Flank) -> f64 {
        let mut found = FlankContacts::default();
        let looked = self.contacts_at(pose, side, &mut found);
        looked.map_or(0.0, |()| found.deepest_overlap_m())
    }
}
