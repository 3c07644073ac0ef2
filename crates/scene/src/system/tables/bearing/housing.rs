//! `bearing.housing`: what lies between the outer ring and the housing or the ground.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// `bearing.housing`: the outer ring becomes a body, called `BEARING/ring`, on a stiffness, called `BEARING/housing`. Either the diagonals or the 6×6
/// matrices; order x, y, z, rotations about x, y, z, with z along the bearing's axis.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct HousingTable {
    /// Mass of the outer ring, with what moves with it.
    pub ring_mass_kg: f64,
    /// Its moments of inertia across, across and along the axis.
    pub ring_inertia_kg_m2: [f64; 3],
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
