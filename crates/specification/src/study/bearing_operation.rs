//! `operation`: what a bearing that is studied by itself carries, and how it turns.

use gearmesh_bearings::life::Lubrication;
use gearmesh_bearings::{AppliedBearingLoad, Control, Operation, TiltCondition};
use gearmesh_geometry::InputError;
use gearmesh_geometry::input::InputDocument;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;

/// `[operation]`: with a bearing file; the same as the options of `gearmesh bearing`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct OperationTable {
    /// Force on the inner ring along x, y, z.
    pub load_N: [f64; 3],
    /// Moment on the inner ring about x and y; none where neither this nor `tilt_mrad` is given.
    pub moment_Nm: Option<[f64; 2]>,
    /// Tilt of the inner ring about x and y, instead of a moment.
    pub tilt_mrad: Option<[f64; 2]>,
    /// Speed of the inner ring; 0 where not given.
    #[serde(default)]
    pub speed_rpm: f64,
    /// Speed of the outer ring; 0 where not given.
    #[serde(default)]
    pub outer_speed_rpm: f64,
    /// Kinematic viscosity of the oil at the bearing's temperature, for the modified life; with `contamination`.
    pub viscosity_mm2_per_s: Option<f64>,
    /// e_C of ISO 281, 0 (dirty) to 1 (clean).
    pub contamination: Option<f64>,
}

/// Loads and speeds in SI units.
#[derive(Debug, Clone, Copy)]
pub struct BearingOperation {
    /// On the inner ring.
    pub load: AppliedBearingLoad,
    /// Speeds.
    pub operation: Operation,
    /// Lubricant, for the modified life.
    pub lubrication: Option<Lubrication>,
}

impl Default for BearingOperation {
    /// No load, at rest.
    fn default() -> Self {
        let load = AppliedBearingLoad {
            force_n: [0.0; 3],
            tilt: TiltCondition::Moments([0.0; 2]),
        };
        Self {
            load,
            operation: operation([0.0; 2]),
            lubrication: None,
        }
    }
}

fn operation([inner_rpm, outer_rpm]: [f64; 2]) -> Operation {
    Operation {
        inner_rad_per_s: inner_rpm * PI / 30.0,
        outer_rad_per_s: outer_rpm * PI / 30.0,
        cage_angle_rad: 0.0,
        inner_angle_rad: 0.0,
        control: Control::OuterRace,
    }
}

/// Largest amounts of loads \[N, N·m\], tilts \[mrad\], speeds \[1/min\], viscosities \[mm²/s\].
const MOST: [f64; 4] = [1e9, 100.0, 1e7, 1e9];

impl BearingOperation {
    /// From the table; complaints name `document`.
    ///
    /// # Errors
    /// [`InputError`] for unknown keys and numbers out of their range.
    pub fn from_value(value: &toml::Value, document: &InputDocument) -> Result<Self, InputError> {
        let error = |key: &str, problem: String| {
            let key = if key.is_empty() {
                "operation".to_owned()
            } else {
                format!("operation.{key}")
            };
            InputError {
                file: document.file.clone(),
                line: None,
                key,
                problem,
            }
        };
        let table: OperationTable = (value.clone().try_into())
            .map_err(|e: toml::de::Error| error("", e.message().to_owned()))?;
        let within = |key: &str, values: &[f64], most: f64| {
            let sound = values.iter().all(|v| v.is_finite() && v.abs() <= most);
            let told = || format!("found {values:?}, allowed is {} to {most}", -most);
            sound.then_some(()).ok_or_else(|| error(key, told()))
        };
        within("load_N", &table.load_N, MOST[0])?;
        within("speed_rpm", &[table.speed_rpm], MOST[2])?;
        within("outer_speed_rpm", &[table.outer_speed_rpm], MOST[2])?;
        let tilt = match (table.moment_Nm, table.tilt_mrad) {
            (Some(_), Some(_)) => {
                let told = "there is `moment_Nm` already; remove one of the two";
                return Err(error("tilt_mrad", told.to_owned()));
            }
            (_, Some(tilt)) => {
                within("tilt_mrad", &tilt, MOST[1])?;
                TiltCondition::Held(tilt.map(|t| 1e-3 * t))
            }
            (moment, None) => {
                let moment = moment.unwrap_or_default();
                within("moment_Nm", &moment, MOST[0])?;
                TiltCondition::Moments(moment)
            }
        };
        let lubrication = match (table.viscosity_mm2_per_s, table.contamination) {
            (None, None) => None,
            (Some(viscosity), Some(contamination)) => {
                within("viscosity_mm2_per_s", &[viscosity], MOST[3])?;
                if viscosity <= 0.0 {
                    let told = format!("found {viscosity}, allowed is more than 0");
                    return Err(error("viscosity_mm2_per_s", told));
                }
                if !(0.0..=1.0).contains(&contamination) {
                    let told = format!("found {contamination}, allowed is 0 (dirty) to 1 (clean)");
                    return Err(error("contamination", told));
                }
                if table.speed_rpm == table.outer_speed_rpm {
                    let told = "the modified life needs a speed; give `speed_rpm`";
                    return Err(error("viscosity_mm2_per_s", told.to_owned()));
                }
                Some(Lubrication {
                    viscosity_mm2_per_s: viscosity,
                    contamination,
                })
            }
            _ => {
                let told =
                    "needs both `viscosity_mm2_per_s` and `contamination`, for the modified life";
                return Err(error("", told.to_owned()));
            }
        };
        Ok(Self {
            load: AppliedBearingLoad {
                force_n: table.load_N,
                tilt,
            },
            operation: operation([table.speed_rpm, table.outer_speed_rpm]),
            lubrication,
        })
    }
}
