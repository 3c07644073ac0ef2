//! `kind = "dynamic"`: every ball a body of its own. What a scene does not name is not computed.

use gearmesh_bearings::dynamic::{LandSide, PocketShape};
use gearmesh_geometry::input::{Bounded, Positive};
use gearmesh_geometry::kinds;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Keys of `kind = "dynamic"`.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DynamicBearingTable {
    /// Bearing file of a ball bearing (docs/bearings.md), from the scene's folder.
    pub file: String,
    /// Stated law of the contacts at the races; Hertz where not given.
    pub contact: Option<ContactTable>,
    /// With Hertz: energy that is lost when a ball meets a race; none where not given.
    pub rebound: Option<ReboundTable>,
    /// Friction or film between balls and races; none where not given, and balls do not turn then.
    pub traction: Option<TractionTable>,
    /// Races as meshes of triangles; tori where not given. Not with faults.
    pub surface: Option<SurfaceTable>,
    /// Whether balls have weight, by the scene's `gravity_m_per_s2`.
    #[serde(default)]
    pub ball_weight: bool,
    /// A cage for each row; none where not given.
    pub cage: Option<CageTable>,
    /// Whether the load of every ball is a channel.
    #[serde(default)]
    pub ball_loads: bool,
    /// Whether the acceleration of every ball's centre is a channel, world axes.
    #[serde(default)]
    pub ball_accelerations: bool,
}

/// `contact`: F = max(0, K (δ/mm)^e + c STEP(δ; 0, 0, d, 1) δ̇), the impact function of multibody programs.
#[derive(Debug, Clone, Copy, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct ContactTable {
    /// K; its unit is N/mm^e with the exponent below.
    pub stiffness_N_per_mm_e: f64,
    /// e, at least 1.
    pub exponent: f64,
    /// c; none where not given.
    #[serde(default)]
    pub damping_N_s_per_mm: f64,
    /// d, from which the damping acts in full; needed with damping.
    pub full_damping_depth_um: Option<f64>,
}

/// `rebound`: damping that fades in with the load and never pulls, stated by a free blow.
#[derive(Debug, Clone, Copy, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct ReboundTable {
    /// Speed after a free blow over that before it, above 0 to 1.
    pub restitution: f64,
    /// Speed of that blow; slower ones lose less of their speed.
    pub at_speed_mm_per_s: f64,
}

/// `traction`: what acts against the slip of a ball.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(remote = "Self", rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(tag = "kind", rename = "TractionTable")]
#[allow(non_snake_case)]
pub enum TractionTable {
    /// One coefficient, smooth at zero.
    Coulomb {
        /// Coefficient of friction.
        coefficient: f64,
        /// Slip at which 71 % of it act.
        transition_speed_mm_per_s: f64,
    },
    /// Coefficients by slip, from 0 without slip on; the last one goes on.
    Table {
        /// Slips, rising, the first above 0.
        slip_mm_per_s: Vec<f64>,
        /// Coefficient at each.
        coefficient: Vec<f64>,
    },
    /// A film of lubricant that shears by Eyring's law. Not for pockets.
    Fluid {
        /// Viscosity at ambient pressure.
        viscosity_mPa_s: f64,
        /// Growth of its logarithm with the pressure.
        pressure_viscosity_per_GPa: f64,
        /// Eyring's stress.
        eyring_stress_MPa: f64,
        /// Thickness of the film.
        film_thickness_um: f64,
    },
}

kinds!(TractionTable, "kind");

/// `surface`: what the races are made of.
#[derive(Debug, Clone, Copy, Deserialize, Serialize, JsonSchema)]
#[serde(remote = "Self", rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(tag = "kind", rename = "SurfaceTable")]
pub enum SurfaceTable {
    /// Triangles. Their edges should be a fifth of the contact ellipse or less; two million on a race at most.
    Triangles {
        /// Longest edge across the groove.
        across_um: f64,
        /// Longest edge along the way of the balls.
        along_um: f64,
    },
}

kinds!(SurfaceTable, "kind");

/// `cage`: a body with six degrees of freedom, called `BEARING/cage`, of two rows `BEARING/cage_1` and
/// `BEARING/cage_2`.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct CageTable {
    /// Mass.
    pub mass_kg: Bounded<Positive>,
    /// Moments of inertia across, across and along the axis; those of a thin ring on the pitch circle where not given.
    pub inertia_kg_m2: Option<[f64; 3]>,
    /// The pockets.
    pub pockets: PocketTable,
    /// The land that guides it; without one its balls do.
    pub land: Option<LandTable>,
}

/// `cage.pockets`.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct PocketTable {
    /// "cylindrical" (a bore along the radius, the default) or "spherical" (holds the ball every way).
    #[serde(default)]
    pub shape: PocketShape,
    /// Play to each side.
    pub clearance_um: f64,
    /// Stiffness of the film within the play; none where not given.
    #[serde(default)]
    pub film_stiffness_N_per_mm: f64,
    /// K of K (z/mm)^1.5 beyond the play.
    pub stiffness_N_per_mm_e: f64,
    /// Energy lost in blows; none where not given.
    pub rebound: Option<ReboundTable>,
    /// Friction of the balls, "coulomb" or "table"; none where not given.
    pub traction: Option<TractionTable>,
}

/// `cage.land`.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct LandTable {
    /// Ring that has the land: "outer" or "inner".
    pub ring: LandSide,
    /// Diameter of the land.
    pub diameter_mm: f64,
    /// Gap between land and cage when the cage is in the middle.
    pub clearance_um: f64,
    /// Film of lubricant in the gap; dry where not given.
    pub film: Option<LandFilmTable>,
    /// K of K (depth/mm)^1.5 where the solids touch.
    pub stiffness_N_per_mm_e: f64,
    /// Gap below which the solids touch; 0 where not given, which a film does not allow.
    #[serde(default)]
    pub roughness_um: f64,
    /// Energy lost in blows; none where not given.
    pub rebound: Option<ReboundTable>,
    /// Friction of the solids; none where not given.
    pub friction: Option<LandFrictionTable>,
}

/// `cage.land.film`.
#[derive(Debug, Clone, Copy, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct LandFilmTable {
    /// Viscosity.
    pub viscosity_mPa_s: f64,
    /// Width of the land.
    pub width_mm: f64,
}

/// `cage.land.friction`.
#[derive(Debug, Clone, Copy, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LandFrictionTable {
    /// Coefficient of friction.
    pub coefficient: f64,
    /// Slip at which 71 % of it act.
    pub transition_speed_mm_per_s: f64,
}
