//! `planets.pin`: pins that bend between the side plates of a carrier.

use gearmesh_geometry::gear_file::PoissonRatio;
use gearmesh_geometry::input::{Bounded, NotNegative, Positive};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// `planets.pin`: each pin a Timoshenko beam that is fixed in the side plates of the carrier, which are rigid.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct PinTable {
    /// Outer diameter.
    pub diameter_mm: Bounded<Positive>,
    /// Inner diameter; solid where not given.
    pub inner_diameter_mm: Option<Bounded<NotNegative>>,
    /// Where side plates hold it along its axis, from the middle of the set: one place, or two.
    pub plates_mm: Vec<f64>,
    /// Young's modulus; 206 where not given.
    pub young_GPa: Option<Bounded<Positive>>,
    /// Poisson's ratio; 0.3 where not given.
    pub poisson: Option<Bounded<PoissonRatio>>,
    /// Density; 7850 where not given.
    pub density_kg_per_m3: Option<Bounded<Positive>>,
    /// Damping over stiffness; none where not given.
    pub damping_s: Option<Bounded<NotNegative>>,
}
