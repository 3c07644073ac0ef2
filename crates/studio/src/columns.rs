//! Columns of a multibody result as curves. A chart has some thousand points: of each stretch of rows its least and its
//! largest value, so that no peak is lost and a long result is never in the page as a whole.

use std::sync::Mutex;

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

/// A result in time, opened.
#[derive(Debug)]
pub struct ColumnsSession {
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
}

impl ColumnsSession {
    /// Lists the columns.
    ///
    /// # Errors
    /// [`Problem::Input`] for a result without rows.
    pub fn new(result: SystemResult) -> Result<Self, Problem> {
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
        if let Some(name) = asked.columns.iter().find(|name| !self.names.contains(name)) {
            return Err(Problem::Input(format!("the result has no column {name}")));
        }
        let first = asked
            .from
            .map_or(0, |from| self.axis.partition_point(|x| *x < from));
        let last = asked.to.map_or(self.axis.len(), |to| {
            self.axis.partition_point(|x| *x <= to)
        });
        let rows = first.min(last)..last;
        let result = self
            .result
            .lock()
            .map_err(|error| Problem::Work(error.to_string()))?;
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
        let read = |name: &String| Ok(min_max::values(&result.rows.read_rows(name, rows.clone())?));
        let curves = asked
            .columns
            .iter()
            .map(read)
            .collect::<Result<Vec<_>, Problem>>()?;
        Ok(json!({"x": min_max::abscissas(x), "curves": curves, "rows": rows.len()}))
    }

    /// Rows a second.
    fn rate(&self, x: &[f64]) -> Result<f64, Problem> {
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
