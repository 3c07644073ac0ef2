//! `bearing.housing`: what lies between the outer ring and the housing or the ground.

use gearmesh_geometry::input::Beside;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::system::connection::StiffnessTable;

/// `bearing.housing`: the outer ring as a body, and the stiffness that it stands on.
pub type HousingTable = Beside<StiffnessTable, RingKeys>;

/// Keys of `bearing.housing` alone.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RingKeys {
    /// Mass of the outer ring, with what moves with it.
    pub ring_mass_kg: f64,
    /// Its moments of inertia across, across and along the axis.
    pub ring_inertia_kg_m2: [f64; 3],
}
