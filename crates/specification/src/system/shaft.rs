//! `[[shaft]]`: stations along an axis, round sections between them, lumped parts and bodies that sit on it.

use gearmesh_geometry::gear_file::PoissonRatio;
use gearmesh_geometry::input::{Bounded, NotNegative, Positive};
use gearmesh_geometry::kinds;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// `[[shaft]]` as written in the file.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct ShaftTable {
    /// Name. The stations' bodies are called NAME/0, NAME/1, …, that of a rigid shaft NAME.
    pub name: String,
    /// Model.
    pub model: ShaftModel,
    /// Where the shaft's z = 0 is, in the world at the start.
    pub origin_mm: [f64; 3],
    /// Axis in the world at the start; [0, 0, 1] where not given.
    pub axis: Option<[f64; 3]>,
    /// Stations along the axis, increasing, at least two.
    pub stations_mm: Vec<f64>,
    /// Outer diameter between each station and the next.
    pub outer_diameters_mm: Vec<f64>,
    /// Inner diameters likewise; solid where not given.
    pub inner_diameters_mm: Option<Vec<Bounded<NotNegative>>>,
    /// Density.
    pub density_kg_per_m3: Bounded<Positive>,
    /// Speed about the axis at the start, also of the bodies on the shaft that state none; 0 where not given.
    pub speed_rpm: Option<f64>,
    /// Lumped parts.
    #[serde(default)]
    pub part: Vec<PartTable>,
    /// Bodies on the shaft.
    #[serde(default)]
    pub seat: Vec<SeatTable>,
}

/// `shaft.model`.
#[derive(Debug, Clone, Copy, Deserialize, Serialize, JsonSchema)]
#[serde(remote = "Self", rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(tag = "kind", rename = "ShaftModel")]
#[allow(non_snake_case)]
pub enum ShaftModel {
    /// One body, which does not deflect.
    Rigid {},
    /// A body at each station, Timoshenko beams between them.
    Beam {
        /// Young's modulus.
        young_GPa: Bounded<Positive>,
        /// Poisson's ratio.
        poisson: Bounded<PoissonRatio>,
        /// Damping over stiffness; none where not given.
        damping_s: Option<Bounded<NotNegative>>,
    },
}

kinds!(ShaftModel, "kind");

/// `[[shaft.part]]`: mass and inertia at a station.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PartTable {
    /// Number of the station, from 0.
    pub station: usize,
    /// Mass.
    pub mass_kg: Bounded<Positive>,
    /// Inertia about the station: [Jxx, Jyy, Jzz], z along the shaft.
    pub inertia_kg_m2: [Bounded<NotNegative>; 3],
}

/// `[[shaft.seat]]`: a body on the shaft. On a beam it takes the place of the station's own body, and the shaft's mass
/// there is added to it; on a rigid shaft it is fixed.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SeatTable {
    /// Number of the station, from 0.
    pub station: usize,
    /// The body. Without a position it is put on the station, z along the shaft.
    pub body: String,
}
