//! `kind = "linear"`: a bearing of constant stiffness and damping.

use schemars::JsonSchema;
use serde::Deserialize;

/// Keys of `kind = "linear"`.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct LinearBearingTable {
    /// Stiffness across the axis.
    pub radial_stiffness_N_per_mm: f64,
    /// Stiffness along the axis; none where not given.
    #[serde(default)]
    pub axial_stiffness_N_per_mm: f64,
    /// Stiffness against tilting; none where not given.
    #[serde(default)]
    pub tilt_stiffness_Nm_per_rad: f64,
    /// Damping across the axis; none where not given.
    #[serde(default)]
    pub radial_damping_N_s_per_mm: f64,
    /// Damping along the axis; none where not given.
    #[serde(default)]
    pub axial_damping_N_s_per_mm: f64,
    /// Damping of tilting; none where not given.
    #[serde(default)]
    pub tilt_damping_Nm_s_per_rad: f64,
}
