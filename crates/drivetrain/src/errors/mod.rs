//! Gear errors and faults, each one file; what they have in common is in `flank_error.rs`.

pub mod broken_tooth;
pub mod deviation_table;
pub mod eccentricity;
pub mod pitch;
pub mod spall;
pub mod tip_chip;

use crate::error::DrivetrainError;

/// Refuses a tooth that does not exist.
pub(crate) fn check_tooth(
    owner: &'static str,
    found: usize,
    teeth: usize,
) -> Result<usize, DrivetrainError> {
    if found < teeth {
        return Ok(found);
    }
    Err(DrivetrainError::Tooth {
        owner,
        found,
        last: teeth.saturating_sub(1),
    })
}
