//! `[[spring]]`, `[[torsion_spring]]` and `[[bushing]]`: forces between two bodies. Places and axes are those of the
//! world at the start.

use gearmesh_geometry::input::Beside;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// `[[spring]]`: along the line between two points.
#[derive(Debug, Clone, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct SpringTable {
    /// Name.
    pub name: String,
    /// First body; "ground" where not given.
    pub body_1: Option<String>,
    /// Second body.
    pub body_2: String,
    /// Point of the first body.
    pub at_1_mm: [f64; 3],
    /// Point of the second body; its origin where not given.
    pub at_2_mm: Option<[f64; 3]>,
    /// Stiffness.
    pub stiffness_N_per_mm: f64,
    /// Damping; none where not given.
    #[serde(default)]
    pub damping_N_s_per_mm: f64,
    /// Length without force; the length at the start where not given.
    pub free_length_mm: Option<f64>,
}

/// `[[torsion_spring]]`: about an axis, over any number of turns.
#[derive(Debug, Clone, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct TorsionSpringTable {
    /// Name.
    pub name: String,
    /// First body; "ground" where not given.
    pub body_1: Option<String>,
    /// Second body.
    pub body_2: String,
    /// Axis; the z axis of `body_2` where not given.
    pub axis: Option<[f64; 3]>,
    /// Stiffness.
    pub stiffness_Nm_per_rad: f64,
    /// Damping; none where not given.
    #[serde(default)]
    pub damping_Nm_s_per_rad: f64,
    /// Angle without torque, counted from the start; 0 where not given.
    #[serde(default)]
    pub free_angle_deg: f64,
}

/// `[[bushing]]`.
pub type BushingTable = Beside<StiffnessTable, BushingKeys>;

/// `[[bushing]]`: six components, for small relative rotations. Either the diagonals or the 6×6 matrices; order x, y,
/// z, rotations about x, y, z, with z along `axis`.
#[derive(Debug, Clone, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BushingKeys {
    /// Name.
    pub name: String,
    /// First body; "ground" where not given.
    pub body_1: Option<String>,
    /// Second body.
    pub body_2: String,
    /// Where; the origin of `body_2` where not given.
    pub at_mm: Option<[f64; 3]>,
    /// Axis, the bushing's z; the axes of `body_2` where not given.
    pub axis: Option<[f64; 3]>,
}

/// Stiffness and damping of bushings and housings.
#[derive(Debug, Clone, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct StiffnessTable {
    /// Stiffness along x, y, z.
    pub stiffness_N_per_mm: Option<[f64; 3]>,
    /// Stiffness about x, y, z.
    pub stiffness_Nm_per_rad: Option<[f64; 3]>,
    /// Damping along x, y, z; none where not given.
    pub damping_N_s_per_mm: Option<[f64; 3]>,
    /// Damping about x, y, z; none where not given.
    pub damping_Nm_s_per_rad: Option<[f64; 3]>,
    /// Symmetric stiffness matrix in N/m, N/rad and N·m/rad, instead of the diagonals.
    pub stiffness_matrix_SI: Option<[[f64; 6]; 6]>,
    /// Symmetric damping matrix in N·s/m, N·s/rad and N·m·s/rad, with the stiffness matrix.
    pub damping_matrix_SI: Option<[[f64; 6]; 6]>,
}
