//! How a gear sits on its body: its place there, and what holds its bore.

use gearmesh_geometry::input::{Bounded, End};
use gearmesh_geometry::number_range;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

number_range!(
    /// Tilts of a gear on its body in milliradians, as of misaligned axes.
    pub SmallTilt: End::At(-10.0), End::At(10.0), "the misalignment is treated as small"
);

/// `eccentricity_1` and `eccentricity_2`.
#[derive(Debug, Clone, Copy, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct EccentricityTable {
    /// Distance of the gear's axis from the body's z axis.
    pub offset_um: f64,
    /// Its direction from the body's x axis.
    pub direction_deg: f64,
    /// Tilt of the gear's axis.
    pub tilt_mrad: Bounded<SmallTilt>,
    /// Direction of the tilt's axis from the body's x axis.
    pub tilt_direction_deg: f64,
}

/// How the bore of a gear is held.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum BoreHold {
    /// Glued to a rigid pin.
    Bonded,
    /// It slides along a rigid pin, which holds it radially all round.
    Sliding,
    /// Rollers press on it where they touch.
    Rollers,
}

impl BoreHold {
    /// Name in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Bonded => "bonded",
            Self::Sliding => "sliding",
            Self::Rollers => "rollers",
        }
    }
}
