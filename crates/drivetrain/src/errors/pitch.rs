//! Pitch errors: each flank of one side shifted along its normal.

use gearmesh_geometry::Flank;

use crate::error::DrivetrainError;
use crate::flank_error::{FlankError, FlankPoint, Removed, most_added_m};

/// Cumulative pitch deviations of the flanks of one side, given as material removed: a flank that stands back by f
/// has +f.
#[derive(Debug, Clone, PartialEq)]
pub struct PitchErrors {
    side: Flank,
    removed_m: Vec<f64>,
}

impl PitchErrors {
    /// One value a tooth \[m\], along the flank normal, tooth 0 first.
    ///
    /// # Errors
    /// [`DrivetrainError::Length`] unless there is one for each tooth, [`DrivetrainError::Value`] if one is not finite.
    pub fn new(side: Flank, removed_m: Vec<f64>, teeth: usize) -> Result<Self, DrivetrainError> {
        let owner = "pitch errors";
        DrivetrainError::check_length(owner, "the list", removed_m.len(), teeth)?;
        for found in &removed_m {
            let number = ("a deviation in m", *found);
            DrivetrainError::require(owner, number, found.is_finite(), "finite")?;
        }
        Ok(Self { side, removed_m })
    }
}

impl FlankError for PitchErrors {
    fn removed(&self, at: FlankPoint) -> Removed {
        let depth_m = if at.side == self.side {
            self.removed_m[at.tooth]
        } else {
            0.0
        };
        Removed {
            depth_m,
            ..Removed::default()
        }
    }

    fn most_added_m(&self) -> f64 {
        most_added_m(&self.removed_m)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn each_tooth_and_side_has_its_own() {
        let errors = PitchErrors::new(Flank::Left, vec![1e-6, -2e-6], 2).unwrap();
        let at = |tooth, side| {
            let (roll_rad, z_m) = (0.3, 0.0);
            errors
                .removed(FlankPoint {
                    tooth,
                    side,
                    roll_rad,
                    z_m,
                })
                .depth_m
        };
        assert_eq!(at(1, Flank::Left), -2e-6);
        assert_eq!(at(1, Flank::Right), 0.0);
        assert!(PitchErrors::new(Flank::Left, vec![0.0], 2).is_err());
        assert!(PitchErrors::new(Flank::Left, vec![0.0, f64::NAN], 2).is_err());
    }
}
