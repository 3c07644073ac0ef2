//! A chip off the tip at one end of a tooth: a plane cut through the corner of tip and face, both flanks.

use gearmesh_geometry::{ToothGeometry, involute};

use super::check_tooth;
use crate::error::{DrivetrainError, positive};
use crate::flank_error::{FlankError, FlankPoint, Removed};

/// Which end of the face width.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FaceEnd {
    /// Towards +z.
    Positive,
    /// Towards −z.
    Negative,
}

/// No flank above a line that runs from the tip, `length` inside the face, to a depth `height` below the tip on the
/// face itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TipChip {
    tooth: usize,
    end: FaceEnd,
    tip_radius_m: f64,
    base_radius_m: f64,
    /// +1 where radii grow towards the tip, −1 inside a ring.
    towards_tip: f64,
    height_m: f64,
    length_m: f64,
    half_width_m: f64,
}

impl TipChip {
    /// The tooth, the end, how far the chip reaches below the tip on the face, and how far inwards along the tip \[m\].
    ///
    /// # Errors
    /// [`DrivetrainError::Tooth`], or [`DrivetrainError::Value`] for a length that is not positive.
    pub fn new(
        (gear, face_width_m): (&ToothGeometry, f64),
        tooth: usize,
        end: FaceEnd,
        [height_m, length_m]: [f64; 2],
    ) -> Result<Self, DrivetrainError> {
        let owner = "tip chip";
        Ok(Self {
            tooth: check_tooth(owner, tooth, gear.teeth)?,
            end,
            tip_radius_m: gear.tip_radius_m,
            base_radius_m: gear.base_radius_m,
            towards_tip: gear.tip_direction(),
            height_m: positive(owner, "the height in m", height_m)?,
            length_m: positive(owner, "the length in m", length_m)?,
            half_width_m: 0.5 * positive(owner, "the face width in m", face_width_m)?,
        })
    }
}

impl FlankError for TipChip {
    fn removed(&self, at: FlankPoint) -> Removed {
        if at.tooth != self.tooth {
            return Removed::default();
        }
        let from_face = match self.end {
            FaceEnd::Positive => self.half_width_m - at.z_m,
            FaceEnd::Negative => self.half_width_m + at.z_m,
        };
        let depth_here = self.height_m * (1.0 - from_face / self.length_m);
        let radius_m = involute::radius_m(at.roll_rad, self.base_radius_m);
        let below_tip = self.towards_tip * (self.tip_radius_m - radius_m);
        if below_tip < depth_here {
            Removed::EVERYTHING
        } else {
            Removed::default()
        }
    }

    fn most_added_m(&self) -> f64 {
        0.0
    }
}
