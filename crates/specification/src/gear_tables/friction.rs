//! `friction` of gear meshes and of pairs: a gear mesh knows how fast the flanks slide, a pair at rest only where they
//! would turn round.

use gearmesh_contact::Friction as PathFriction;
use gearmesh_drivetrain::Friction as SpeedFriction;
use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{Bounded, Positive, TableKeys, Within};
use gearmesh_geometry::kinds;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{MM, UM};

/// Sliding speed of the static coefficient where a scene states none \[mm/s\]: small against the sliding of gears that
/// run at some rpm, large enough for steps of some microseconds.
const DEFAULT_STATIC_SPEED_MM_PER_S: f64 = 10.0;
/// Distance from the pitch point within which friction turns round in a pair where the scene states none \[µm\].
const DEFAULT_REVERSAL_UM: f64 = 20.0;

/// `friction` of gear meshes.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(remote = "Self", rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(tag = "model", rename = "FrictionTable")]
pub enum FrictionTable {
    /// Coulomb, regularised.
    Coulomb {
        /// Coefficient from `dynamic_speed_mm_per_s` on.
        dynamic_coefficient: Bounded<Within<0, 5>>,
        /// Coefficient at `static_speed_mm_per_s`; the dynamic one where not given.
        static_coefficient: Option<Bounded<Within<0, 5>>>,
        /// Sliding speed of the static coefficient; 10 where not given.
        static_speed_mm_per_s: Option<Bounded<Positive>>,
        /// Sliding speed from which the dynamic coefficient holds; ten times the static one where not given.
        dynamic_speed_mm_per_s: Option<Bounded<Positive>>,
    },
}

kinds!(FrictionTable, "model");

/// `friction` of pairs at rest.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(remote = "Self", rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(tag = "model", rename = "PairFrictionTable")]
pub enum PairFrictionTable {
    /// Coulomb, regularised.
    Coulomb {
        /// Coefficient of sliding.
        dynamic_coefficient: Bounded<Within<0, 1>>,
        /// Distance from the pitch point within which friction turns round; 20 where not given.
        reversal_um: Option<Bounded<Positive>>,
    },
}

kinds!(PairFrictionTable, "model");

impl FrictionTable {
    /// The friction in SI units; `keys` are those of the table around it.
    ///
    /// # Errors
    /// [`InputError`] for a number out of its range.
    pub fn check(&self, keys: &TableKeys<'_>) -> Result<SpeedFriction, InputError> {
        let Self::Coulomb {
            dynamic_coefficient: sliding,
            static_coefficient,
            static_speed_mm_per_s,
            dynamic_speed_mm_per_s,
        } = *self;
        let resting = *static_coefficient.unwrap_or(sliding);
        let sliding = *sliding;
        let slow = static_speed_mm_per_s.map_or(DEFAULT_STATIC_SPEED_MM_PER_S, f64::from);
        let fast = dynamic_speed_mm_per_s.map_or(10.0 * slow, f64::from);
        let require = |key: &str, value: f64, ok: bool, allowed: &str| {
            keys.require(&format!("friction.{key}"), value, ok, allowed)
        };
        require(
            "static_coefficient",
            resting,
            resting >= sliding,
            &format!("at least dynamic_coefficient, {sliding}, and at most 5"),
        )?;
        require(
            "dynamic_speed_mm_per_s",
            fast,
            fast > slow,
            &format!("more than static_speed_mm_per_s, {slow}"),
        )?;
        SpeedFriction::new([resting, sliding], [MM * slow, MM * fast])
            .map_err(|e| keys.error("friction", e))
    }
}

impl PairFrictionTable {
    /// The friction in SI units.
    pub fn friction(&self) -> PathFriction {
        let Self::Coulomb {
            dynamic_coefficient,
            reversal_um,
        } = *self;
        PathFriction {
            coefficient: *dynamic_coefficient,
            reversal_m: UM * reversal_um.map_or(DEFAULT_REVERSAL_UM, f64::from),
        }
    }
}
