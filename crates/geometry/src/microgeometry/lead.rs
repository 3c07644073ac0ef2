//! Laws along the face: end relief.

use super::profile::ReliefShape;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Faces of a gear.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, Serialize, JsonSchema)]
pub enum FaceEnds {
    /// Both.
    #[default]
    #[serde(rename = "both")]
    Both,
    /// The one towards +z.
    #[serde(rename = "+z")]
    Positive,
    /// The one towards −z.
    #[serde(rename = "-z")]
    Negative,
}

/// End relief: zero up to `length_m` before a face, `amount_m` at the face.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct EndRelief {
    /// Material removed at the face \[m\].
    pub amount_m: f64,
    /// Length along the axis over which it grows \[m\].
    pub length_m: f64,
    /// How it grows along the axis.
    pub shape: ReliefShape,
    /// The faces that have it.
    pub ends: FaceEnds,
}

impl EndRelief {
    /// Material removed \[m\] at `z_m` from mid-face, and its derivative along the axis.
    #[must_use]
    pub fn removed_m(&self, z_m: f64, face_width_m: f64) -> (f64, f64) {
        let (towards_face, sense) = match self.ends {
            FaceEnds::Both => (z_m.abs(), z_m.signum()),
            FaceEnds::Positive => (z_m, 1.0),
            FaceEnds::Negative => (-z_m, -1.0),
        };
        let s = (towards_face - 0.5 * face_width_m) / self.length_m + 1.0;
        let (removed, by_s) = self.shape.removed_m(self.amount_m, s);
        (removed, by_s * sense / self.length_m)
    }
}
