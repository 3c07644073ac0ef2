//! A function of time: a number, or a table with one of `linear`, `step`, `sine`, `table`, `sum`, `product`, `python`.

use std::fmt;
use std::path::{Path, PathBuf};

use gearmesh_dynamics::{Interpolation, Table, TimeFunction};
use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{NumberTable, TableKeys};
use schemars::JsonSchema;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Deserializer, Error, MapAccess, Visitor};
use serde::{Deserialize, Serialize};

use crate::host_functions::HostFunctions;

/// A function of time; its unit is that of its key.
#[derive(Debug, Clone, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum FunctionTable {
    /// The same at all times.
    Constant(f64),
    /// A form.
    Form(Box<FunctionForm>),
}

/// Forms of functions.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum FunctionForm {
    /// at_zero + slope_per_s · t
    Linear {
        /// Value at t = 0.
        #[serde(default)]
        at_zero: f64,
        /// Change per second.
        slope_per_s: f64,
    },
    /// From one value to another by a smooth cubic.
    Step {
        /// Where the step begins.
        start_s: f64,
        /// Value before.
        from: f64,
        /// Where it ends.
        end_s: f64,
        /// Value after.
        to: f64,
    },
    /// offset + amplitude · sin(2π frequency t + phase)
    Sine {
        /// Mean value; 0 where not given.
        #[serde(default)]
        offset: f64,
        /// Amplitude.
        amplitude: f64,
        /// Frequency.
        #[serde(rename = "frequency_Hz")]
        frequency_hz: f64,
        /// Phase; 0 where not given.
        #[serde(default)]
        phase_deg: f64,
    },
    /// From a file, held beyond its ends.
    Table {
        /// Comma separated file with a line of heads, relative to the scene.
        file: PathBuf,
        /// Head of the values' column.
        column: String,
        /// Head of the times' column; "time_s" where not given.
        time_column: Option<String>,
        /// Between the rows; "monotone-cubic" where not given.
        #[serde(default)]
        interpolation: InterpolationWord,
    },
    /// Sum of functions.
    Sum(Vec<FunctionTable>),
    /// Product of two functions; the second has no unit.
    Product([FunctionTable; 2]),
    /// Name of a Python function, for runs from Python only (docs/python.md). A load's returns the value, a motion's
    /// the value, its rate and its acceleration.
    Python(String),
}

/// Where functions come from that the table only names.
#[derive(Debug, Clone, Copy)]
pub struct Sources<'a> {
    /// Files are relative to it.
    pub folder: &'a Path,
    /// Functions of the calling program.
    pub host: &'a HostFunctions,
}

/// Between the rows of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum InterpolationWord {
    /// Straight lines; the rate jumps.
    Linear,
    /// A cubic without overshoot.
    #[default]
    MonotoneCubic,
}

impl<'de> Deserialize<'de> for FunctionTable {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NumberOrForm)
    }
}

struct NumberOrForm;

impl<'de> Visitor<'de> for NumberOrForm {
    type Value = FunctionTable;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(
            "a number, or a table with one of linear, step, sine, table, sum, product, python",
        )
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<FunctionTable, E> {
        Ok(FunctionTable::Constant(value))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<FunctionTable, E> {
        Ok(FunctionTable::Constant(value as f64))
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<FunctionTable, E> {
        Ok(FunctionTable::Constant(value as f64))
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<FunctionTable, A::Error> {
        let form = FunctionForm::deserialize(MapAccessDeserializer::new(map))?;
        Ok(FunctionTable::Form(Box::new(form)))
    }
}

impl FunctionTable {
    /// A value that shows its sign: a constant, the end of a step, a slope; none of other forms.
    pub fn first_value(&self) -> Option<f64> {
        match self {
            Self::Constant(value) => Some(*value),
            Self::Form(form) => match form.as_ref() {
                FunctionForm::Linear { at_zero, .. } if *at_zero != 0.0 => Some(*at_zero),
                FunctionForm::Linear { slope_per_s, .. } => Some(*slope_per_s),
                FunctionForm::Step { from, to, .. } => Some(if *from != 0.0 { *from } else { *to }),
                _ => None,
            },
        }
    }

    /// The function in SI units: values times `unit`.
    ///
    /// # Errors
    /// [`InputError`] at `key`, or in the file of a table.
    pub fn function(
        &self,
        keys: &TableKeys<'_>,
        key: &str,
        unit: f64,
        sources: Sources<'_>,
    ) -> Result<TimeFunction, InputError> {
        let form = match self {
            Self::Constant(value) => return Ok(TimeFunction::Constant(unit * value)),
            Self::Form(form) => form,
        };
        let below = |part: &str| format!("{key}.{part}");
        Ok(match form.as_ref() {
            FunctionForm::Linear {
                at_zero,
                slope_per_s,
            } => TimeFunction::Linear {
                at_zero: unit * at_zero,
                slope_per_s: unit * slope_per_s,
            },
            FunctionForm::Step {
                start_s,
                from,
                end_s,
                to,
            } => TimeFunction::step(*start_s, unit * from, *end_s, unit * to)
                .map_err(|e| keys.error(&below("step"), e))?,
            FunctionForm::Sine {
                offset,
                amplitude,
                frequency_hz,
                phase_deg,
            } => TimeFunction::Sine {
                offset: unit * offset,
                amplitude: unit * amplitude,
                frequency_hz: *frequency_hz,
                phase_rad: phase_deg.to_radians(),
            },
            FunctionForm::Table {
                file,
                column,
                time_column,
                interpolation,
            } => {
                let heads = [time_column.as_deref().unwrap_or("time_s"), column];
                let numbers = NumberTable::read(&sources.folder.join(file), &heads)?;
                numbers.require_increasing(0)?;
                let times = numbers.column(0).to_vec();
                let values = numbers.column(1).iter().map(|value| unit * value).collect();
                let between = match interpolation {
                    InterpolationWord::Linear => Interpolation::Linear,
                    InterpolationWord::MonotoneCubic => Interpolation::MonotoneCubic,
                };
                let table = Table::new(&file.display().to_string(), times, values, between);
                TimeFunction::Table(table.map_err(|e| keys.error(&below("table"), e))?)
            }
            FunctionForm::Sum(terms) => {
                if terms.is_empty() {
                    let problem = "is empty; name at least one function";
                    return Err(keys.error(&below("sum"), problem));
                }
                let terms = terms.iter().enumerate();
                let terms = terms.map(|(i, term)| {
                    term.function(keys, &below(&format!("sum.{i}")), unit, sources)
                });
                TimeFunction::Sum(terms.collect::<Result<_, _>>()?)
            }
            FunctionForm::Product([first, second]) => product(
                first.function(keys, &below("product.0"), unit, sources)?,
                second.function(keys, &below("product.1"), 1.0, sources)?,
            ),
            FunctionForm::Python(name) => {
                let function = sources.host.of_time(name);
                let function = function.map_err(|e| keys.error(&below("python"), e))?;
                product(TimeFunction::Constant(unit), TimeFunction::Host(function))
            }
        })
    }
}

/// The product of two functions.
pub fn product(first: TimeFunction, second: TimeFunction) -> TimeFunction {
    TimeFunction::Product(Box::new(first), Box::new(second))
}
