//! `kind = "quasi-static"`: every ball or roller in equilibrium at every moment.

use gearmesh_bearings::Control;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Keys of `kind = "quasi-static"`.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct QuasiStaticBearingTable {
    /// Bearing file (docs/bearings.md), from the scene's folder.
    pub file: String,
    /// How balls roll at speed: "outer-race" (the default) or "least-spin".
    #[serde(default)]
    pub control: Control,
    /// Damping across the axis beside the elastic bearing; none where not given.
    #[serde(default)]
    pub radial_damping_N_s_per_mm: f64,
    /// Damping along the axis; none where not given.
    #[serde(default)]
    pub axial_damping_N_s_per_mm: f64,
    /// Damping of tilting; none where not given.
    #[serde(default)]
    pub tilt_damping_Nm_s_per_rad: f64,
    /// Whether the load of every ball or roller is a channel.
    #[serde(default)]
    pub element_loads: bool,
}
