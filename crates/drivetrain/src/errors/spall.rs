//! A spall: material lost from a patch of one flank.

use gearmesh_geometry::{Flank, ToothGeometry, involute};

use super::check_tooth;
use crate::error::{DrivetrainError, positive};
use crate::flank_error::{FlankError, FlankPoint, Removed};
use crate::step::step;

/// A patch between two radii and two axial positions from which a depth is removed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpallPatch {
    /// Tooth.
    pub tooth: usize,
    /// Flank.
    pub side: Flank,
    /// Lower and upper radius \[m\].
    pub radii_m: [f64; 2],
    /// Lower and upper axial position from mid-face \[m\].
    pub z_m: [f64; 2],
    /// Depth \[m\].
    pub depth_m: f64,
    /// Length along the profile over which the edges fall to the depth, in roll angle \[rad\]: with it the contact goes
    /// in and out without a step.
    pub edge_rad: f64,
}

/// The patch on its flank.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spall {
    patch: SpallPatch,
    roll_rad: [f64; 2],
}

impl Spall {
    /// Puts the patch on a gear.
    ///
    /// # Errors
    /// [`DrivetrainError::Tooth`], or [`DrivetrainError::Value`] for a depth or edge that is not positive, or limits
    /// out of order.
    pub fn new(gear: &ToothGeometry, patch: SpallPatch) -> Result<Self, DrivetrainError> {
        let owner = "spall";
        check_tooth(owner, patch.tooth, gear.teeth)?;
        positive(owner, "the depth in m", patch.depth_m)?;
        positive(owner, "the edge in rad", patch.edge_rad)?;
        for (what, [low, high]) in [
            ("the upper radius in m", patch.radii_m),
            ("the upper axial position in m", patch.z_m),
        ] {
            DrivetrainError::require(owner, (what, high), high > low, "above the lower one")?;
        }
        Ok(Self {
            patch,
            roll_rad: patch
                .radii_m
                .map(|r| involute::roll_angle_rad(r, gear.base_radius_m)),
        })
    }
}

impl FlankError for Spall {
    fn removed(&self, at: FlankPoint) -> Removed {
        let p = &self.patch;
        let inside = (p.z_m[0]..=p.z_m[1]).contains(&at.z_m);
        if at.tooth != p.tooth || at.side != p.side || !inside {
            return Removed::default();
        }
        let [low, high] = self.roll_rad;
        let (rise, rise_slope) = step(at.roll_rad, [low, 0.0], [low + p.edge_rad, 1.0]);
        let (fall, fall_slope) = step(at.roll_rad, [high - p.edge_rad, 1.0], [high, 0.0]);
        Removed {
            depth_m: p.depth_m * rise * fall,
            slope_m_per_rad: p.depth_m * (rise_slope * fall + rise * fall_slope),
            slope_along_axis: 0.0,
        }
    }

    fn most_added_m(&self) -> f64 {
        0.0
    }
}
