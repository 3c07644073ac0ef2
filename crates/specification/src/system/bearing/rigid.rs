//! `kind = "rigid"`: a joint.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Keys of `kind = "rigid"`. The shaft turns freely and is held across the axis.
#[derive(Debug, Clone, Copy, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct RigidBearingTable {
    /// Whether the shaft is held along the axis: "held" (the default) or "free".
    pub axial: HeldWord,
    /// Whether it is held against tilting: "held" (the default) or "free".
    pub tilt: HeldWord,
}

/// `axial`, `tilt`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum HeldWord {
    /// It does not move.
    #[default]
    Held,
    /// Nothing holds it.
    Free,
}
