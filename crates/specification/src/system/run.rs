//! `[run]`: what is done with the system.
//!
//! | kind | what | keys |
//! | --- | --- | --- |
//! | `transient` | motion from the start to `end_s` | `end_s` |
//! | `static` | equilibria | `load_factors`; `motion` with `angles_deg` |
//! | `eigen` | natural frequencies about an operating point | `settle_s`, `most_frequency_Hz`, `load_factors`; `motion` with `speeds_rpm` |
//! | `speed-sweep` | motion at a driver's speed that goes up and down | `motion`, `from_rpm`, `to_rpm`, `direction`; `speeds`, `settle_s`, `measure_s` or `ramp_s` |

use gearmesh_geometry::given;
use std::f64::consts::TAU;

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{Bounded, Count, InputDocument, Positive, TableKeys};
use gearmesh_geometry::kinds;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// `[run]` as written in the file.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(remote = "Self", rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(tag = "kind", rename = "RunTable")]
pub enum RunTable {
    /// Motion in time.
    Transient {
        /// End of the run.
        end_s: Bounded<Positive>,
    },
    /// Static equilibria.
    Static(StaticTable),
    /// Natural frequencies.
    Eigen(EigenTable),
    /// Up and down through a range of speeds.
    SpeedSweep(SpeedSweepTable),
}

kinds!(RunTable, "kind");

impl Default for RunTable {
    /// One equilibrium.
    fn default() -> Self {
        Self::Static(StaticTable::default())
    }
}

/// Keys of `kind = "static"`.
#[derive(Debug, Clone, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StaticTable {
    /// Shares of all `[[load]]` at which an equilibrium is sought, one after the other; 1 alone where not given.
    pub load_factors: Option<Vec<f64>>,
    /// Name of the `[[motion]]` that is varied.
    pub motion: Option<String>,
    /// Angles of the motion.
    pub angles_deg: Option<Vec<f64>>,
}

/// Keys of `kind = "eigen"`.
#[derive(Debug, Clone, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct EigenTable {
    /// Shares of all `[[load]]` at which an equilibrium is sought, one after the other; 1 alone where not given.
    pub load_factors: Option<Vec<f64>>,
    /// Name of the `[[motion]]` that is varied.
    pub motion: Option<String>,
    /// Speeds of the motion.
    pub speeds_rpm: Option<Vec<f64>>,
    /// The operating point is where the motion stands after this time; the static equilibrium where not given.
    pub settle_s: Option<Bounded<Positive>>,
    /// Highest frequency that is listed.
    pub most_frequency_Hz: Option<Bounded<Positive>>,
}

/// Keys of `kind = "speed-sweep"`: stepped with `speeds`, `settle_s` and `measure_s`, ramped with `ramp_s`.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpeedSweepTable {
    /// Name of the `[[motion]]` that is varied.
    pub motion: String,
    /// First speed.
    pub from_rpm: f64,
    /// Last speed.
    pub to_rpm: f64,
    /// "up" from the first to the last speed, "down" back, or "up-down"; "up-down" where not given.
    #[serde(default)]
    pub direction: Direction,
    /// Stepped: number of speeds.
    pub speeds: Option<Count<2, 100_000>>,
    /// Stepped: time at each speed before it is measured.
    pub settle_s: Option<Bounded<Positive>>,
    /// Stepped: time over which each speed is measured.
    pub measure_s: Option<Bounded<Positive>>,
    /// Ramped: time of each ramp.
    pub ramp_s: Option<Bounded<Positive>>,
}

/// `run.kind`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RunKind {
    /// Motion in time.
    Transient,
    /// Static equilibria.
    Static,
    /// Natural frequencies.
    Eigen,
    /// Up and down through a range of speeds.
    SpeedSweep,
}

impl RunKind {
    /// Name in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Transient => "transient",
            Self::Static => "static",
            Self::Eigen => "eigen",
            Self::SpeedSweep => "speed-sweep",
        }
    }
}

/// Which way a sweep goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Direction {
    /// From the first to the last speed.
    Up,
    /// From the last to the first.
    Down,
    /// There and back, going on from the state reached: jumps show where they are.
    #[default]
    UpDown,
}

/// What is done, checked, in SI units.
#[derive(Debug, Clone, PartialEq)]
pub enum Run {
    /// Motion in time.
    Transient {
        /// End \[s\].
        end_s: f64,
    },
    /// Static equilibria: every load factor at every angle.
    Static {
        /// Shares of all applied loads.
        load_factors: Vec<f64>,
        /// Angles of a motion \[rad\].
        angles_rad: Option<MotionValues>,
    },
    /// Natural frequencies about an operating point: every load factor at every speed.
    Eigen {
        /// The operating point is the motion after this time \[s\]; the static equilibrium where not given.
        settle_s: Option<f64>,
        /// Shares of all applied loads.
        load_factors: Vec<f64>,
        /// Speeds of a motion \[rad/s\].
        speeds_rad_per_s: Option<MotionValues>,
        /// Highest frequency that is listed \[Hz\].
        most_frequency_hz: Option<f64>,
    },
    /// Motion at a driver's speed that goes up and down.
    SpeedSweep(SpeedSweep),
}

/// Values that one motion takes in turn.
#[derive(Debug, Clone, PartialEq)]
pub struct MotionValues {
    /// Name of the motion.
    pub motion: String,
    /// Values, rad or rad/s.
    pub values: Vec<f64>,
}

/// A speed sweep.
#[derive(Debug, Clone, PartialEq)]
pub struct SpeedSweep {
    /// Name of the motion that is varied; it prescribes a speed.
    pub motion: String,
    /// First speed \[rad/s\].
    pub from_rad_per_s: f64,
    /// Last speed \[rad/s\].
    pub to_rad_per_s: f64,
    /// Up, down or both.
    pub direction: Direction,
    /// In steps or on a ramp.
    pub schedule: Schedule,
}

/// How the speed changes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Schedule {
    /// Speeds at equal distances; at each the motion settles and is then measured.
    Stepped {
        /// Number of speeds, at least 2.
        speeds: usize,
        /// Settling time \[s\].
        settle_s: f64,
        /// Measuring time \[s\].
        measure_s: f64,
    },
    /// At a constant rate, each way in this time \[s\].
    Ramped {
        /// Time of one ramp \[s\].
        ramp_s: f64,
    },
}

impl Schedule {
    /// Windows that one way of a ramped sweep is cut into.
    pub const RAMP_WINDOWS: usize = 100;

    /// Refuses windows without samples: the mean and the spread of a window need two of them, at this output interval.
    ///
    /// # Errors
    /// [`InputError`] at the key that makes the windows.
    pub fn refuse_empty_windows(
        self,
        document: &InputDocument,
        interval_s: f64,
    ) -> Result<(), InputError> {
        let keys = TableKeys::new(document, "run");
        let least_s = 2.0 * interval_s;
        let samples = format!("two samples of output.interval_s = {interval_s}");
        // Intervals that fit but for rounding do.
        let holds = |window_s: f64| window_s >= least_s * (1.0 - 1e-9);
        match self {
            Self::Stepped {
                speeds,
                settle_s,
                measure_s,
            } => {
                let allowed = format!("at least {least_s}, {samples}");
                keys.require("measure_s", measure_s, holds(measure_s), &allowed)?;
                // A change of speed must not be lost in the rounding of the time.
                let least_s = 1e-9 * (2 * speeds) as f64 * measure_s;
                let allowed = format!("at least {least_s:.3e}, 1e-9 of the run");
                keys.require("settle_s", settle_s, settle_s >= least_s, &allowed)
            }
            Self::Ramped { ramp_s } => {
                let windows = Self::RAMP_WINDOWS;
                let allowed = format!(
                    "at least {}: each of its {windows} windows needs {samples}",
                    least_s * windows as f64
                );
                keys.require("ramp_s", ramp_s, holds(ramp_s / windows as f64), &allowed)
            }
        }
    }
}

impl Run {
    /// Name of the kind in files.
    #[must_use]
    pub fn kind(&self) -> RunKind {
        match self {
            Self::Transient { .. } => RunKind::Transient,
            Self::Static { .. } => RunKind::Static,
            Self::Eigen { .. } => RunKind::Eigen,
            Self::SpeedSweep(_) => RunKind::SpeedSweep,
        }
    }

    /// Name of the motion that is varied.
    #[must_use]
    pub fn varied_motion(&self) -> Option<&str> {
        match self {
            Self::Transient { .. } => None,
            Self::Static {
                angles_rad: values, ..
            }
            | Self::Eigen {
                speeds_rad_per_s: values,
                ..
            } => values.as_ref().map(|values| values.motion.as_str()),
            Self::SpeedSweep(sweep) => Some(&sweep.motion),
        }
    }

    /// Simulated time \[s\]; none for kinds that do not step through time.
    #[must_use]
    pub fn simulated_s(&self) -> Option<f64> {
        match self {
            Self::Transient { end_s } => Some(*end_s),
            Self::Static { .. } => None,
            Self::Eigen {
                settle_s,
                load_factors,
                speeds_rad_per_s,
                ..
            } => settle_s.map(|settle| {
                let speeds = speeds_rad_per_s
                    .as_ref()
                    .map_or(1, |speeds| speeds.values.len());
                settle * (speeds * load_factors.len()) as f64
            }),
            Self::SpeedSweep(sweep) => {
                let ways = if sweep.direction == Direction::UpDown {
                    2.0
                } else {
                    1.0
                };
                Some(
                    ways * match sweep.schedule {
                        Schedule::Stepped {
                            speeds,
                            settle_s,
                            measure_s,
                        } => speeds as f64 * (settle_s + measure_s),
                        Schedule::Ramped { ramp_s } => ramp_s,
                    },
                )
            }
        }
    }
}

impl RunTable {
    /// Checks the numbers.
    ///
    /// # Errors
    /// [`InputError`] naming the key.
    pub fn check(&self, document: &InputDocument) -> Result<Run, InputError> {
        let keys = TableKeys::new(document, "run");
        Ok(match self {
            Self::Transient { end_s } => Run::Transient { end_s: **end_s },
            Self::Static(table) => {
                let angles = ("angles_deg", table.angles_deg.as_deref(), TAU / 360.0);
                Run::Static {
                    load_factors: load_factors(table.load_factors.as_deref(), &keys)?,
                    angles_rad: motion_values(&keys, table.motion.as_deref(), angles)?,
                }
            }
            Self::Eigen(table) => {
                let speeds = ("speeds_rpm", table.speeds_rpm.as_deref(), TAU / 60.0);
                Run::Eigen {
                    settle_s: table.settle_s.map(f64::from),
                    load_factors: load_factors(table.load_factors.as_deref(), &keys)?,
                    speeds_rad_per_s: motion_values(&keys, table.motion.as_deref(), speeds)?,
                    most_frequency_hz: table.most_frequency_Hz.map(f64::from),
                }
            }
            Self::SpeedSweep(table) => Run::SpeedSweep(SpeedSweep {
                motion: table.motion.clone(),
                from_rad_per_s: table.from_rpm * TAU / 60.0,
                to_rad_per_s: table.to_rpm * TAU / 60.0,
                direction: table.direction,
                schedule: table.schedule(&keys)?,
            }),
        })
    }
}

impl SpeedSweepTable {
    fn schedule(&self, keys: &TableKeys<'_>) -> Result<Schedule, InputError> {
        if let Some(ramp_s) = self.ramp_s {
            let problem =
                "belongs to a stepped sweep, ramp_s to a ramped one; remove one of the two";
            keys.refuse(&given!(self; speeds, settle_s, measure_s), problem)?;
            return Ok(Schedule::Ramped { ramp_s: *ramp_s });
        }
        let stepped = "a stepped sweep (or give ramp_s)";
        Ok(Schedule::Stepped {
            speeds: keys.needed("speeds", self.speeds, stepped)?.get(),
            settle_s: *keys.needed("settle_s", self.settle_s, stepped)?,
            measure_s: *keys.needed("measure_s", self.measure_s, stepped)?,
        })
    }
}

fn load_factors(factors: Option<&[f64]>, keys: &TableKeys<'_>) -> Result<Vec<f64>, InputError> {
    match factors {
        Some([]) => Err(keys.error(
            "load_factors",
            "is empty; give at least one, or leave the key out for full load",
        )),
        stated => Ok(stated.unwrap_or(&[1.0]).to_vec()),
    }
}

/// A list of values of the varied motion, with its key and unit: list and motion are given together or not at all.
fn motion_values(
    keys: &TableKeys<'_>,
    motion: Option<&str>,
    (key, values, unit): (&str, Option<&[f64]>, f64),
) -> Result<Option<MotionValues>, InputError> {
    match (motion, values) {
        (None, None) => Ok(None),
        (Some(_), Some([])) => Err(keys.error(key, "is empty; give at least one value")),
        (Some(motion), Some(values)) => Ok(Some(MotionValues {
            motion: motion.to_owned(),
            values: values.iter().map(|value| value * unit).collect(),
        })),
        (Some(_), None) => Err(keys.error(key, "missing; `motion` is varied over these values")),
        (None, Some(_)) => {
            let problem = format!("missing; {key} are values of a [[motion]], name it");
            Err(keys.error("motion", problem))
        }
    }
}
