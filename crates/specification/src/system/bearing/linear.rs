//! `kind = "linear"`: a bearing of constant stiffness and damping.

use gearmesh_bearings::Control;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Keys of `kind = "linear"`: the stiffness is stated by its diagonal (`radial_stiffness_N_per_mm` …), by a matrix, or
/// taken from a bearing file (`tangent_of`).
#[derive(Debug, Clone, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[allow(non_snake_case)]
pub struct LinearBearingTable {
    /// Stiffness across the axis.
    pub radial_stiffness_N_per_mm: Option<f64>,
    /// Stiffness along the axis; none where not given.
    pub axial_stiffness_N_per_mm: Option<f64>,
    /// Stiffness against tilting; none where not given.
    pub tilt_stiffness_Nm_per_rad: Option<f64>,
    /// Which way the axial stiffness carries: "both" (the default), "positive" (forces on the shaft along the axis) or
    /// "negative" (against it). The axial damping acts both ways.
    pub axial_support: Option<AxialSupportWord>,
    /// Whole stiffness matrix in N/m, N/rad and N·m/rad instead of the diagonal: 5×5 (x, y, z, tilt about x, about y),
    /// or 6×6 with zeros for the rotation about the axis, which is free.
    pub stiffness_matrix_SI: Option<Vec<Vec<f64>>>,
    /// Damping matrix in N·s/m, N·s/rad and N·m·s/rad, with the stiffness matrix and of its size.
    pub damping_matrix_SI: Option<Vec<Vec<f64>>>,
    /// Bearing file (docs/bearings.md), from the scene's folder: stiffness and load are those of its balls or rollers
    /// in equilibrium under the loads and speeds of the start.
    pub tangent_of: Option<String>,
    /// With `tangent_of`: how balls roll at speed, "outer-race" (the default) or "least-spin".
    pub control: Option<Control>,
    /// Damping across the axis; none where not given. Not with a matrix.
    pub radial_damping_N_s_per_mm: Option<f64>,
    /// Damping along the axis; none where not given. Not with a matrix.
    pub axial_damping_N_s_per_mm: Option<f64>,
    /// Damping of tilting; none where not given. Not with a matrix.
    pub tilt_damping_Nm_s_per_rad: Option<f64>,
}

/// `axial_support`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum AxialSupportWord {
    /// Both ways.
    #[default]
    Both,
    /// Forces on the shaft along the axis.
    Positive,
    /// Forces on the shaft against the axis.
    Negative,
}
