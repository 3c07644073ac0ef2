//! A tooth broken off above a radius, over its whole width.

use gearmesh_geometry::{ToothGeometry, involute};

use super::check_tooth;
use crate::error::DrivetrainError;
use crate::flank_error::{FlankError, FlankPoint, Removed};

/// No flank above a roll angle on one tooth, both sides. The force of a pair that reaches the edge ends abruptly, as it
/// does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BrokenTooth {
    tooth: usize,
    from_roll_rad: f64,
    /// Sense in which the roll angle runs towards the tip.
    towards_tip: f64,
}

impl BrokenTooth {
    /// The tooth, and the radius from which on towards the tip it is gone \[m\]; a radius below the flank takes the
    /// whole tooth.
    ///
    /// # Errors
    /// [`DrivetrainError::Tooth`], or [`DrivetrainError::Value`] for a radius not between 0 and the tip, of a ring not
    /// outside the tip.
    pub fn new(
        gear: &ToothGeometry,
        tooth: usize,
        above_radius_m: f64,
    ) -> Result<Self, DrivetrainError> {
        let owner = "broken tooth";
        check_tooth(owner, tooth, gear.teeth)?;
        DrivetrainError::require(
            owner,
            ("the radius where it ends in m", above_radius_m),
            above_radius_m > 0.0 && gear.is_towards_tip(gear.tip_radius_m, above_radius_m),
            "positive and below the tip radius, of a ring above it",
        )?;
        Ok(Self {
            tooth,
            from_roll_rad: involute::roll_angle_rad(above_radius_m, gear.base_radius_m),
            towards_tip: gear.tip_direction(),
        })
    }
}

impl FlankError for BrokenTooth {
    fn removed(&self, at: FlankPoint) -> Removed {
        let beyond_rad = self.towards_tip * (at.roll_rad - self.from_roll_rad);
        if at.tooth == self.tooth && beyond_rad > 0.0 {
            Removed::EVERYTHING
        } else {
            Removed::default()
        }
    }

    fn most_added_m(&self) -> f64 {
        0.0
    }
}
