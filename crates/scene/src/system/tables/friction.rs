//! `friction` of gear meshes and of pairs: one vocabulary. A gear mesh knows how fast the flanks slide, a pair at rest
//! only where they would turn round.

use gearmesh_contact::Friction as PathFriction;
use gearmesh_drivetrain::Friction as SpeedFriction;
use gearmesh_geometry::InputError;
use gearmesh_geometry::input::TableKeys;
use schemars::JsonSchema;
use serde::Deserialize;

use super::{MM, UM};

/// Sliding speed of the static coefficient where a scene states none \[mm/s\]: small against the sliding of gears that
/// run at some rpm, large enough for steps of some microseconds.
const DEFAULT_STATIC_SPEED_MM_PER_S: f64 = 10.0;
/// Distance from the pitch point within which friction turns round in a pair where the scene states none \[µm\].
const DEFAULT_REVERSAL_UM: f64 = 20.0;

/// `friction`.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(tag = "model", rename_all = "kebab-case", deny_unknown_fields)]
pub enum FrictionTable {
    /// Coulomb, regularised.
    Coulomb {
        /// Coefficient of sliding. In gear meshes from `dynamic_speed_mm_per_s` on.
        dynamic_coefficient: Option<f64>,
        /// Gear meshes: coefficient at `static_speed_mm_per_s`; that of sliding where not given.
        static_coefficient: Option<f64>,
        /// Gear meshes: sliding speed of the static coefficient; 10 where not given.
        static_speed_mm_per_s: Option<f64>,
        /// Gear meshes: sliding speed from which the dynamic coefficient holds; ten times the static one where not
        /// given.
        dynamic_speed_mm_per_s: Option<f64>,
        /// Pairs: distance from the pitch point within which friction turns round; 20 where not given.
        reversal_um: Option<f64>,
        /// Pairs: the former name of `dynamic_coefficient`.
        coefficient: Option<f64>,
    },
}

impl FrictionTable {
    /// The friction of a gear mesh; `keys` are those of its table.
    ///
    /// # Errors
    /// [`InputError`] for a number out of its range, or a key of pairs.
    pub(crate) fn of_gear_mesh(&self, keys: &TableKeys<'_>) -> Result<SpeedFriction, InputError> {
        let Self::Coulomb {
            dynamic_coefficient,
            static_coefficient,
            static_speed_mm_per_s,
            dynamic_speed_mm_per_s,
            reversal_um,
            coefficient,
        } = self;
        if coefficient.is_some() {
            return Err(keys.error("friction.coefficient", "is called dynamic_coefficient"));
        }
        if reversal_um.is_some() {
            return Err(keys.error(
                "friction.reversal_um",
                "is for scenes of a [pair], which stand; a gear mesh has static_speed_mm_per_s in its place",
            ));
        }
        let sliding = keys.needed(
            "friction.dynamic_coefficient",
            *dynamic_coefficient,
            "friction",
        )?;
        let resting = static_coefficient.unwrap_or(sliding);
        let slow = static_speed_mm_per_s.unwrap_or(DEFAULT_STATIC_SPEED_MM_PER_S);
        let fast = dynamic_speed_mm_per_s.unwrap_or(10.0 * slow);
        let require = |key: &str, value: f64, ok: bool, allowed: &str| {
            keys.require(&format!("friction.{key}"), value, ok, allowed)
        };
        require(
            "dynamic_coefficient",
            sliding,
            (0.0..=5.0).contains(&sliding),
            "0 to 5",
        )?;
        require(
            "static_coefficient",
            resting,
            (sliding..=5.0).contains(&resting),
            &format!("at least dynamic_coefficient, {sliding}, and at most 5"),
        )?;
        require("static_speed_mm_per_s", slow, slow > 0.0, "more than 0")?;
        require(
            "dynamic_speed_mm_per_s",
            fast,
            fast > slow,
            &format!("more than static_speed_mm_per_s, {slow}"),
        )?;
        SpeedFriction::new([resting, sliding], [MM * slow, MM * fast])
            .map_err(|e| keys.error("friction", e))
    }

    /// The friction of a pair at rest, and a note where a key has its former name; `keys` are those of its table.
    ///
    /// # Errors
    /// [`InputError`] for a number out of its range, or a key of gear meshes.
    pub(crate) fn of_pair(
        &self,
        keys: &TableKeys<'_>,
    ) -> Result<(PathFriction, Option<String>), InputError> {
        let Self::Coulomb {
            dynamic_coefficient,
            static_coefficient,
            static_speed_mm_per_s,
            dynamic_speed_mm_per_s,
            reversal_um,
            coefficient,
        } = self;
        for (key, given) in [
            ("static_coefficient", static_coefficient.is_some()),
            ("static_speed_mm_per_s", static_speed_mm_per_s.is_some()),
            ("dynamic_speed_mm_per_s", dynamic_speed_mm_per_s.is_some()),
        ] {
            if given {
                return Err(keys.error(
                    &format!("friction.{key}"),
                    "is for gear meshes, which have speeds; a [pair] stands and has reversal_um in its place",
                ));
            }
        }
        let (key, sliding, note) = match (dynamic_coefficient, coefficient) {
            (Some(value), None) => ("friction.dynamic_coefficient", *value, None),
            (None, Some(value)) => {
                let key = "friction.coefficient";
                let note = keys
                    .error(key, "is now called dynamic_coefficient")
                    .to_string();
                (key, *value, Some(note))
            }
            (Some(_), Some(_)) => {
                return Err(keys.error(
                    "friction.coefficient",
                    "is the former name of dynamic_coefficient; remove it",
                ));
            }
            (None, None) => {
                return Err(
                    keys.error("friction.dynamic_coefficient", "missing; friction needs it")
                );
            }
        };
        keys.require(key, sliding, (0.0..=1.0).contains(&sliding), "0 to 1")?;
        let reversal = reversal_um.unwrap_or(DEFAULT_REVERSAL_UM);
        keys.require(
            "friction.reversal_um",
            reversal,
            reversal > 0.0,
            "more than 0",
        )?;
        let friction = PathFriction {
            coefficient: sliding,
            reversal_m: UM * reversal,
        };
        Ok((friction, note))
    }
}
