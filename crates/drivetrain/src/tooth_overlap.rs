//! Teeth that overlap deeper than any teeth deflect: no motion of gears, although the equations would go on with it.
//!
//! Which tooth faces which follows from the angles alone (mesh_kinematics.rs). So teeth whose only modelled flanks are
//! torn apart would pass through those of the mate until the next tooth is nearer, half a base pitch deep in it, and
//! the mesh would push with a force that no work has been done against. A run ends before that.

use gearmesh_geometry::Flank;

use crate::error::DrivetrainError;
use crate::gear_mesh::GearMesh;
use crate::pose::Pose;

/// How deep flanks that the mesh leaves out may overlap, as a share of the base pitch: 0.06 modules, the upper end of
/// the usual backlash, since gears without thickness allowance have none and still may lift off their working flanks by
/// as much.
pub const BEHIND: f64 = 0.02;

/// How deep flanks of the mesh may be pressed into each other, as a share of the base pitch: 0.3 modules, a fifth of
/// the way to the next tooth and far more than teeth can be bent.
pub const THROUGH: f64 = 0.1;

impl GearMesh {
    /// Refuses a motion in which teeth overlap, at the pose of the last evaluation.
    ///
    /// # Errors
    /// [`DrivetrainError::TeethPressed`] for flanks of the mesh deeper than [`THROUGH`],
    /// [`DrivetrainError::TeethBehind`] for flanks that it leaves out deeper than [`BEHIND`].
    pub fn refuse_overlap(&self, pose: &Pose) -> Result<(), DrivetrainError> {
        let pitch_m = self.kinematics().pitch_m();
        for flank in self.flanks() {
            let depth_m = self
                .side(flank)
                .map_or(0.0, |(found, _)| found.deepest_overlap_m());
            if depth_m > THROUGH * pitch_m {
                return Err(DrivetrainError::TeethPressed {
                    flank,
                    depth_mm: 1e3 * depth_m,
                    allowed_mm: 1e3 * THROUGH * pitch_m,
                });
            }
        }
        let Some(behind) = self.left_out() else {
            return Ok(());
        };
        let allowed_m = BEHIND * pitch_m;
        // Material that is removed makes the gap wider than that of ideal flanks.
        let most_added_m = self.kinematics().most_added_m();
        let ideal = self.kinematics().nearest_gap_m(behind);
        if ideal.is_none_or(|gap_m| gap_m - most_added_m > -allowed_m) {
            return Ok(());
        }
        let depth_m = self.kinematics().overlap_m(pose, behind);
        if depth_m <= allowed_m {
            return Ok(());
        }
        Err(DrivetrainError::TeethBehind {
            behind,
            depth_mm: 1e3 * depth_m,
            allowed_mm: 1e3 * allowed_m,
        })
    }

    /// The side that the mesh leaves out, where it has only one.
    fn left_out(&self) -> Option<Flank> {
        let has = |side: Flank| self.flanks().any(|flank| flank == side);
        match (has(Flank::Right), has(Flank::Left)) {
            (true, false) => Some(Flank::Left),
            (false, true) => Some(Flank::Right),
            _ => None,
        }
    }
}
