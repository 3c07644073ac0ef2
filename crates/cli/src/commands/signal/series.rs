//! A column of a result over time, or over the angle of a shaft.

use crate::arguments::{AbscissaArguments, SeriesArguments, WindowKind};
use crate::commands::signal::outcome::Curve;
use crate::console;
use gearmesh_operations::Failure;
use gearmesh_scene::system_run::{ResultKind, SystemResult};
use gearmesh_signal::{AngleSamples, Resampler, Window};
use std::f64::consts::TAU;
use std::ops::Range;
use std::path::Path;

/// Columns named in a message at most.
const NAMED: usize = 12;

/// What is read of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// Its values at the instants of the rows.
    Instants,
    /// What its rows can tell of its vibration.
    LowPass,
}

/// Uniform samples.
pub struct Series {
    pub title: String,
    pub column: String,
    /// Unit of the values.
    pub unit: String,
    /// Samples in a second, or in a turn.
    pub rate: f64,
    /// Time of the first sample \[s\], or angle \[turns\].
    pub start: f64,
    /// Time of the first sample that was read \[s\].
    pub start_s: f64,
    /// `frequency` or `order`, and its unit.
    pub place: &'static str,
    pub place_unit: &'static str,
    pub values: Vec<f64>,
    /// Share of half the rate of the rows up to which they are right.
    pub band: f64,
    /// Angle of the shaft at each sample, rising \[rad\].
    shaft_rad: Option<Vec<f64>>,
}

/// Opens the result of a run in time.
pub fn open(path: &Path) -> Result<SystemResult, Failure> {
    let result = SystemResult::open(path).map_err(Failure::input)?;
    if result.kind != ResultKind::Transient {
        return Err(Failure::input(format!(
            "{}: found a result of kind `{}`; signals are those of a `transient` run",
            path.display(),
            result.kind
        )));
    }
    Ok(result)
}

impl Series {
    /// Reads a column and, if asked for, the turns of a body, of which so many are needed: where no begin is stated,
    /// the series begins early enough for them.
    pub fn read(
        a: &SeriesArguments,
        shaft: Option<(&str, usize)>,
        form: Form,
    ) -> Result<Self, Failure> {
        let result = open(&a.result)?;
        let names: Vec<&str> = result.rows.columns().iter().map(|c| &*c.name).collect();
        if !names.contains(&&*a.column) {
            let is_like = |name: &&&str| name.to_lowercase().contains(&a.column.to_lowercase());
            let (like, all) = (names.iter().filter(is_like).count(), names.len());
            let mut shown: Vec<&str> = names.iter().filter(is_like).copied().collect();
            if shown.is_empty() {
                shown.clone_from(&names);
            }
            shown.truncate(NAMED);
            return Err(Failure::input(format!(
                "{}: found no column `{}`; {like} of {all} columns contain that text, for instance {}; `gearmesh signal columns` lists them all",
                a.result.display(),
                a.column,
                shown.join(", ")
            )));
        }
        let read = |name: &str| result.rows.read(name).map_err(Failure::work);
        let rate = 1.0 / result.interval_s().map_err(Failure::work)?;
        let mut values = match form {
            Form::Instants => read(&a.column)?,
            Form::LowPass => result.read_for_spectrum(&a.column).map_err(Failure::work)?,
        };
        if form == Form::LowPass
            && let Some(warning) = result.folded_in_words(&a.column)
        {
            console::warning(warning);
        }
        let mut range = range(a, values.len(), rate)?;
        let shaft_rad = match shaft {
            None => None,
            Some((body, needed)) => {
                let all = turns_of(&result, body)?;
                if a.from_s.is_none() {
                    let first = Resampler::default().first_row_for(needed, &all, &range);
                    if first < range.start {
                        range.start = first;
                        console::note(format!(
                            "begins at {} s: from the middle of the run on there are not {needed} turns of `{body}`",
                            first as f64 / rate
                        ));
                    }
                }
                Some(rising(&all, &range, (body, rate))?)
            }
        };
        let start_s = range.start as f64 / rate;
        let mut columns = result.rows.columns().iter();
        let column = columns.find(|column| column.name == a.column);
        let unit = column.map_or("", |column| match &column.unit[..] {
            "1" => "",
            unit => unit,
        });
        let unit = unit.to_owned();
        values = values[range].to_vec();
        Ok(Self {
            title: result.head.title.clone(),
            column: a.column.clone(),
            unit,
            rate,
            start: start_s,
            start_s,
            place: "frequency",
            place_unit: "Hz",
            values,
            band: match form {
                Form::LowPass if result.has_low_pass(&a.column) => result.spectrum_band(),
                _ => 1.0,
            },
            shaft_rad,
        })
    }

    /// Reads a column over time, or over a shaft's angle for whole turns if one is asked for.
    pub fn over(a: &SeriesArguments, abscissa: &AbscissaArguments) -> Result<Self, Failure> {
        let series = Self::read(
            a,
            abscissa.shaft.as_deref().map(|shaft| (shaft, 1)),
            Form::LowPass,
        )?;
        if abscissa.shaft.is_none() {
            return Ok(series);
        }
        let per_turn = series.samples_per_turn(abscissa.samples_per_turn)?;
        let resampled = series.to_angle(per_turn)?;
        let mut values = resampled.values;
        let turns = values.len() / per_turn;
        if turns == 0 {
            return Err(Failure::input(format!(
                "--shaft: found {:.2} turns between the ends of the series, needed is 1 or more",
                values.len() as f64 / per_turn as f64
            )));
        }
        values.truncate(turns * per_turn);
        Ok(Self {
            rate: per_turn as f64,
            start: resampled.start_rad / TAU,
            place: "order",
            place_unit: "",
            values,
            ..series
        })
    }

    /// Angles of the shaft.
    pub fn angles(&self) -> Result<&[f64], Failure> {
        let angles = self.shaft_rad.as_deref();
        angles.ok_or_else(|| Failure::input("--shaft: found none, needed for orders and averages"))
    }

    /// Resampled to the shaft's angle.
    pub fn to_angle(&self, per_turn: usize) -> Result<AngleSamples, Failure> {
        let resampler = Resampler::default();
        let resampled = resampler.to_angle(&self.values, self.angles()?, per_turn);
        resampled.map_err(Failure::input)
    }

    /// What was asked for, or an even number of samples at the highest speed.
    pub fn samples_per_turn(&self, asked: Option<usize>) -> Result<usize, Failure> {
        if let Some(samples) = asked {
            return Ok(samples);
        }
        let steps = self.angles()?.windows(2).map(|pair| pair[1] - pair[0]);
        let fastest = steps.fold(0.0_f64, f64::max);
        let samples = 2.0 * (0.5 * TAU / fastest).floor();
        if !(4.0..=1e7).contains(&samples) {
            return Err(Failure::input(format!(
                "--shaft: the result has {samples} samples in a turn, allowed are 4 to 1e7; give --samples-per-turn or another interval_s in the scene"
            )));
        }
        Ok(samples as usize)
    }

    /// Times or turns of the samples.
    pub fn abscissa(&self) -> Curve {
        let (name, unit) = match self.place {
            "order" => ("turns", ""),
            _ => ("time", "s"),
        };
        let at = |i: usize| self.start + i as f64 / self.rate;
        Curve::new(name, unit, (0..self.values.len()).map(at).collect())
    }
}

/// Angle of a body's shaft at each row \[rad\].
fn turns_of(result: &SystemResult, body: &str) -> Result<Vec<f64>, Failure> {
    let column = format!("bodies/{body}/turn_rad");
    let names = || result.rows.columns().iter().map(|c| &*c.name);
    if names().any(|name| name == column) {
        return result.rows.read(&column).map_err(Failure::work);
    }
    let bodies = names().filter_map(|name| name.strip_prefix("bodies/")?.strip_suffix("/turn_rad"));
    Err(Failure::input(format!(
        "--shaft: found `{body}`, allowed are {}",
        bodies.collect::<Vec<_>>().join(", ")
    )))
}

/// The angles of some rows, as those of a shaft that turns forward.
fn rising(
    all: &[f64],
    rows: &Range<usize>,
    (body, rate): (&str, f64),
) -> Result<Vec<f64>, Failure> {
    let mut turns = all[rows.clone()].to_vec();
    // Orders do not depend on the sense of turning.
    if turns.last() < turns.first() {
        turns.iter_mut().for_each(|angle| *angle = -*angle);
    }
    match turns.windows(2).position(|pair| pair[1] <= pair[0]) {
        None => Ok(turns),
        Some(row) => Err(Failure::input(format!(
            "--shaft: found that `{body}` stands still or turns back at {} s; orders need a shaft that turns one way: choose another, or --from-s and --to-s",
            (rows.start + row) as f64 / rate
        ))),
    }
}

/// The window that was asked for, or the usual one.
pub fn window(a: &AbscissaArguments) -> Window {
    match a.window {
        Some(WindowKind::None) => Window::None,
        Some(WindowKind::Hann) => Window::Hann,
        Some(WindowKind::FlatTop) => Window::FlatTop,
        None if a.shaft.is_some() => Window::None,
        None => Window::Hann,
    }
}

/// Rows between the times that are asked for.
fn range(a: &SeriesArguments, rows: usize, rate: f64) -> Result<Range<usize>, Failure> {
    let end_s = (rows - 1) as f64 / rate;
    let (from_s, to_s) = (a.from_s.unwrap_or(0.5 * end_s), a.to_s.unwrap_or(end_s));
    // Half a step, so that the end of the run may be given as it was in the scene.
    let slack = 0.5 / rate;
    if !(from_s >= 0.0 && from_s < to_s && to_s <= end_s + slack) {
        return Err(Failure::input(format!(
            "--from-s, --to-s: found {from_s} to {to_s}; allowed are times that rise within 0 to {end_s}"
        )));
    }
    let first = (from_s * rate).round() as usize;
    Ok(first..((to_s * rate).round() as usize + 1).min(rows))
}
