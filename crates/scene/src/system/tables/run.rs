//! `[run]`: what is done with the system.
//!
//! | kind | what | keys |
//! | --- | --- | --- |
//! | `transient` | motion from the start to `end_s` | `end_s` |
//! | `static` | equilibria | `load_factors`; `motion` with `angles_deg` |
//! | `eigen` | natural frequencies about an operating point | `settle_s`, `most_frequency_Hz`, `load_factors`; `motion` with `speeds_rpm` |
//! | `speed-sweep` | motion at a driver's speed that goes up and down | `motion`, `from_rpm`, `to_rpm`, `direction`; `speeds`, `settle_s`, `measure_s` or `ramp_s` |

use std::f64::consts::TAU;

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{InputDocument, TableKeys};
use schemars::JsonSchema;
use serde::Deserialize;

/// `[run]` as it stands in the file.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct RunTable {
    /// What is done.
    pub kind: RunKind,
    /// `transient`: end of the run.
    pub end_s: Option<f64>,
    /// `static`, `eigen`: shares of all `[[load]]` at which an equilibrium is sought, one after the other; 1 alone
    /// where not given.
    pub load_factors: Option<Vec<f64>>,
    /// `static`, `eigen`, `speed-sweep`: name of the `[[motion]]` that is varied.
    pub motion: Option<String>,
    /// `static`: angles of the motion.
    pub angles_deg: Option<Vec<f64>>,
    /// `eigen`: speeds of the motion.
    pub speeds_rpm: Option<Vec<f64>>,
    /// `eigen`: the operating point is where the motion stands after this time; the static equilibrium where not given.
    /// `speed-sweep`: time at each speed before it is measured.
    pub settle_s: Option<f64>,
    /// `eigen`: highest frequency that is listed.
    pub most_frequency_Hz: Option<f64>,
    /// `speed-sweep`: first speed.
    pub from_rpm: Option<f64>,
    /// `speed-sweep`: last speed.
    pub to_rpm: Option<f64>,
    /// `speed-sweep`: "up" from the first to the last speed, "down" back, or "up-down"; "up-down" where not given.
    pub direction: Option<Direction>,
    /// `speed-sweep`, stepped: number of speeds.
    pub speeds: Option<usize>,
    /// `speed-sweep`, stepped: time over which each speed is measured.
    pub measure_s: Option<f64>,
    /// `speed-sweep`, ramped: time of each ramp.
    pub ramp_s: Option<f64>,
}

/// `run.kind`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
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
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
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
    /// Checks the keys of the chosen kind and refuses those of others.
    ///
    /// # Errors
    /// [`InputError`] naming the key.
    pub fn check(&self, document: &InputDocument) -> Result<Run, InputError> {
        let keys = TableKeys::new(document, "run");
        self.refuse_unused(&keys)?;
        let kind = format!("kind = \"{}\"", self.kind.name());
        let positive = |key: &str, value: f64| {
            keys.require(key, value, value > 0.0, "more than 0")?;
            Ok::<f64, InputError>(value)
        };
        let needed = |key: &str, value: Option<f64>| positive(key, keys.needed(key, value, &kind)?);
        let optional =
            |key: &str, value: Option<f64>| value.map(|value| positive(key, value)).transpose();
        Ok(match self.kind {
            RunKind::Transient => Run::Transient {
                end_s: needed("end_s", self.end_s)?,
            },
            RunKind::Static => Run::Static {
                load_factors: self.load_factors(&keys)?,
                angles_rad: self.values(&keys, "angles_deg", &self.angles_deg, TAU / 360.0)?,
            },
            RunKind::Eigen => Run::Eigen {
                settle_s: optional("settle_s", self.settle_s)?,
                load_factors: self.load_factors(&keys)?,
                speeds_rad_per_s: self.values(&keys, "speeds_rpm", &self.speeds_rpm, TAU / 60.0)?,
                most_frequency_hz: optional("most_frequency_Hz", self.most_frequency_Hz)?,
            },
            RunKind::SpeedSweep => {
                let speed = |key: &str, value: Option<f64>| {
                    let rpm = keys.needed(key, value, &kind)?;
                    keys.require(key, rpm, true, "a finite number")?;
                    Ok::<f64, InputError>(rpm * TAU / 60.0)
                };
                let schedule = match self.ramp_s {
                    Some(ramp) => {
                        for (key, given) in [
                            ("speeds", self.speeds.is_some()),
                            ("settle_s", self.settle_s.is_some()),
                            ("measure_s", self.measure_s.is_some()),
                        ] {
                            if given {
                                return Err(keys.error(key, "belongs to a stepped sweep, ramp_s to a ramped one; remove one of the two"));
                            }
                        }
                        Schedule::Ramped {
                            ramp_s: positive("ramp_s", ramp)?,
                        }
                    }
                    None => {
                        let speeds =
                            keys.needed("speeds", self.speeds, "a stepped sweep (or give ramp_s)")?;
                        keys.require(
                            "speeds",
                            speeds as f64,
                            (2..=100_000).contains(&speeds),
                            "2 to 100000",
                        )?;
                        Schedule::Stepped {
                            speeds,
                            settle_s: needed("settle_s", self.settle_s)?,
                            measure_s: needed("measure_s", self.measure_s)?,
                        }
                    }
                };
                Run::SpeedSweep(SpeedSweep {
                    motion: keys.needed("motion", self.motion.clone(), &kind)?,
                    from_rad_per_s: speed("from_rpm", self.from_rpm)?,
                    to_rad_per_s: speed("to_rpm", self.to_rpm)?,
                    direction: self.direction.unwrap_or_default(),
                    schedule,
                })
            }
        })
    }

    fn refuse_unused(&self, keys: &TableKeys<'_>) -> Result<(), InputError> {
        keys.refuse_unused(
            ("kind", self.kind.name()),
            &[
                ("end_s", self.end_s.is_some(), &["transient"]),
                (
                    "load_factors",
                    self.load_factors.is_some(),
                    &["static", "eigen"],
                ),
                (
                    "motion",
                    self.motion.is_some(),
                    &["static", "eigen", "speed-sweep"],
                ),
                ("angles_deg", self.angles_deg.is_some(), &["static"]),
                ("speeds_rpm", self.speeds_rpm.is_some(), &["eigen"]),
                (
                    "settle_s",
                    self.settle_s.is_some(),
                    &["eigen", "speed-sweep"],
                ),
                (
                    "most_frequency_Hz",
                    self.most_frequency_Hz.is_some(),
                    &["eigen"],
                ),
                ("from_rpm", self.from_rpm.is_some(), &["speed-sweep"]),
                ("to_rpm", self.to_rpm.is_some(), &["speed-sweep"]),
                ("direction", self.direction.is_some(), &["speed-sweep"]),
                ("speeds", self.speeds.is_some(), &["speed-sweep"]),
                ("measure_s", self.measure_s.is_some(), &["speed-sweep"]),
                ("ramp_s", self.ramp_s.is_some(), &["speed-sweep"]),
            ],
        )
    }

    fn load_factors(&self, keys: &TableKeys<'_>) -> Result<Vec<f64>, InputError> {
        let factors = self.load_factors.clone().unwrap_or_else(|| vec![1.0]);
        if factors.is_empty() {
            return Err(keys.error(
                "load_factors",
                "is empty; give at least one, or leave the key out for full load",
            ));
        }
        for (i, &factor) in factors.iter().enumerate() {
            keys.require(
                &format!("load_factors.{i}"),
                factor,
                true,
                "a finite number",
            )?;
        }
        Ok(factors)
    }

    /// A list of values of the varied motion: list and motion are given together or not at all.
    fn values(
        &self,
        keys: &TableKeys<'_>,
        key: &str,
        values: &Option<Vec<f64>>,
        unit: f64,
    ) -> Result<Option<MotionValues>, InputError> {
        let (motion, values) = match (&self.motion, values) {
            (None, None) => return Ok(None),
            (Some(motion), Some(values)) => (motion.clone(), values),
            (Some(_), None) => {
                return Err(keys.error(key, "missing; `motion` is varied over these values"));
            }
            (None, Some(_)) => {
                return Err(keys.error(
                    "motion",
                    format!("missing; {key} are values of a [[motion]], name it"),
                ));
            }
        };
        if values.is_empty() {
            return Err(keys.error(key, "is empty; give at least one value"));
        }
        for (i, &value) in values.iter().enumerate() {
            keys.require(&format!("{key}.{i}"), value, true, "a finite number")?;
        }
        Ok(Some(MotionValues {
            motion,
            values: values.iter().map(|value| value * unit).collect(),
        }))
    }
}
