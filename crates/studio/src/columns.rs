//! Columns of a multibody result as curves. A chart has some thousand points: of each stretch of rows its least and its
//! largest value, so that no peak is lost and a long result is never in the page as a whole.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard};

use gearmesh_operations::{Watch, moving_system};
use gearmesh_report::min_max;
use gearmesh_report::words_and_unit;
use gearmesh_scene::system_run::{SystemResult, rank};
use gearmesh_signal::{Window, amplitude_spectrum};
use serde::Deserialize;
use serde_json::{Value, json};

use crate::problem::Problem;

/// Columns of one request: more curves than a chart shows.
const MOST_COLUMNS: usize = 16;

/// Share of a step by which steps in time may differ.
const EVEN: f64 = 1e-6;

/// Rows of two columns against each other.
const MOST_TOGETHER: usize = 20_000;

/// Moments of a picture that moves.
const MOST_MOMENTS: usize = 150;

/// A stretch of a result whose gears are drawn.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MomentsAsked {
    from: Option<f64>,
    to: Option<f64>,
}

/// A result in time, opened.
#[derive(Debug)]
pub struct ColumnsSession {
    file: PathBuf,
    // Files of this format are read by one thread at a time.
    result: Mutex<SystemResult>,
    description: Value,
    names: Vec<String>,
    axis: Vec<f64>,
    axis_name: String,
}

/// Which curves.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CurvesAsked {
    columns: Vec<String>,
    from: Option<f64>,
    to: Option<f64>,
    /// Amplitudes over frequency in the place of values over time.
    #[serde(default)]
    spectrum: bool,
    /// Whole rows, evenly chosen, in the place of least and largest values: those of two columns are none of one row.
    #[serde(default)]
    together: bool,
}

impl ColumnsSession {
    /// Lists the columns.
    ///
    /// # Errors
    /// [`Problem::Input`] for a result without rows.
    pub fn new(file: &Path, result: SystemResult) -> Result<Self, Problem> {
        let columns = result.rows.columns();
        let Some(first) = columns.first().filter(|_| result.rows.rows() > 1) else {
            let problem = format!(
                "{}: a {} result has no rows to draw; `gearmesh report` shows it",
                result.head.title, result.kind
            );
            return Err(Problem::Input(problem));
        };
        let axis_name = first.name.clone();
        let axis = result.rows.read(&axis_name)?;
        let mut shown: Vec<_> = columns.iter().skip(1).collect();
        shown.sort_by_key(|column| rank(&column.name));
        let listed = shown.iter().map(|column| {
            let (label, _) = words_and_unit(&column.name);
            json!({"name": column.name, "label": label, "unit": column.unit, "help": column.description})
        });
        let (label, unit) = words_and_unit(&axis_name);
        let description = json!({
            "title": result.head.title,
            "kind": result.kind.to_string(),
            "rows": result.rows.rows(),
            "axis": {"name": axis_name, "label": label, "unit": unit},
            "columns": listed.collect::<Vec<_>>(),
        });
        Ok(Self {
            file: file.to_owned(),
            names: columns.iter().map(|column| column.name.clone()).collect(),
            result: Mutex::new(result),
            description,
            axis,
            axis_name,
        })
    }

    /// The columns, those first that a reader asks for first.
    pub fn description(&self) -> Value {
        self.description.clone()
    }

    /// The gears at moments of a stretch, and the forces on their teeth.
    ///
    /// # Errors
    /// [`Problem`] for a result without gears that move, and once `watch` stops it.
    pub fn moments(&self, asked: &MomentsAsked, watch: &Watch<'_>) -> Result<Value, Problem> {
        let result = self.locked()?;
        let stretch = [asked.from, asked.to];
        Ok(moving_system(
            (&self.file, &result),
            stretch,
            MOST_MOMENTS,
            watch,
        )?)
    }

    /// Curves, or their spectra.
    ///
    /// # Errors
    /// [`Problem::Input`] for a column that is not there and for rows without a spectrum.
    pub fn curves(&self, asked: &CurvesAsked) -> Result<Value, Problem> {
        if asked.columns.len() > MOST_COLUMNS {
            let found = asked.columns.len();
            return Err(Problem::Input(format!(
                "found {found} columns, allowed are {MOST_COLUMNS} at once"
            )));
        }
        asked
            .columns
            .iter()
            .try_for_each(|name| self.demand(name))?;
        let rows = self.stretch([asked.from, asked.to]);
        let result = self.locked()?;
        let x = &self.axis[rows.clone()];
        if asked.spectrum {
            let rate = self.rate(x)?;
            let spectrum_of = |name: &String| -> Result<(f64, Vec<f64>), Problem> {
                let values = result.read_for_spectrum(name)?;
                let found = amplitude_spectrum(&values[rows.clone()], rate, Window::Hann);
                let found = found.map_err(|error| Problem::Input(format!("{name}: {error}")))?;
                let lines =
                    ((found.highest() * result.spectrum_band()) / found.line_spacing) as usize;
                Ok((
                    found.line_spacing,
                    found.values.into_iter().take(lines + 1).collect(),
                ))
            };
            let spectra = asked
                .columns
                .iter()
                .map(spectrum_of)
                .collect::<Result<Vec<_>, Problem>>()?;
            let lines = spectra.first().map_or(0, |(_, values)| values.len());
            let spacing = spectra.first().map_or(0.0, |(spacing, _)| *spacing);
            let x: Vec<f64> = (0..lines).map(|line| spacing * line as f64).collect();
            let curves: Vec<Vec<f64>> = spectra
                .iter()
                .map(|(_, values)| min_max::values(values))
                .collect();
            return Ok(json!({"x": min_max::abscissas(&x), "curves": curves, "rows": rows.len()}));
        }
        let every = rows.len().div_ceil(MOST_TOGETHER).max(1);
        if asked.together {
            let read = |name: &String| -> Result<Vec<f64>, Problem> {
                let values = result.rows.read_rows(name, rows.clone())?;
                Ok(values.into_iter().step_by(every).collect())
            };
            let curves = asked.columns.iter().map(read);
            let curves = curves.collect::<Result<Vec<_>, Problem>>()?;
            let x: Vec<f64> = x.iter().copied().step_by(every).collect();
            return Ok(json!({"x": x, "curves": curves, "rows": rows.len(), "every": every}));
        }
        let read = |name: &String| Ok(min_max::values(&result.rows.read_rows(name, rows.clone())?));
        let curves = asked
            .columns
            .iter()
            .map(read)
            .collect::<Result<Vec<_>, Problem>>()?;
        Ok(json!({"x": min_max::abscissas(x), "curves": curves, "rows": rows.len()}))
    }

    pub(crate) fn locked(&self) -> Result<MutexGuard<'_, SystemResult>, Problem> {
        let result = self.result.lock();
        result.map_err(|error| Problem::Work(error.to_string()))
    }

    /// What the rows run over.
    pub(crate) fn axis(&self) -> &[f64] {
        &self.axis
    }

    /// Demands a column.
    pub(crate) fn demand(&self, name: &String) -> Result<(), Problem> {
        match self.names.contains(name) {
            true => Ok(()),
            false => Err(Problem::Input(format!("the result has no column {name}"))),
        }
    }

    /// Rows from one value of the axis to another.
    pub(crate) fn stretch(&self, [from, to]: [Option<f64>; 2]) -> Range<usize> {
        let first = from.map_or(0, |from| self.axis.partition_point(|x| *x < from));
        let all = self.axis.len();
        let last = to.map_or(all, |to| self.axis.partition_point(|x| *x <= to));
        first.min(last)..last
    }

    /// Rows a second.
    pub(crate) fn rate(&self, x: &[f64]) -> Result<f64, Problem> {
        let refused = |problem: &str| Problem::Input(format!("{}: {problem}", self.axis_name));
        let (Some(first), Some(last)) = (x.first(), x.last()) else {
            return Err(refused("no rows in this range"));
        };
        let step = (last - first) / (x.len().saturating_sub(1)).max(1) as f64;
        let is_even = x
            .windows(2)
            .all(|w| (w[1] - w[0] - step).abs() <= EVEN * step.abs() + 1e-12);
        match is_even && step > 0.0 && self.axis_name == "time_s" {
            true => Ok(1.0 / step),
            false => Err(refused("spectra need even steps in time")),
        }
    }
}
