//! Columns of a multibody result as curves. A chart has some thousand points: of each stretch of rows its least and its
//! largest value, so that no peak is lost and a long result is never in the page as a whole.

use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard};

use gearmesh_operations::{Watch, moving_system};
use gearmesh_report::min_max;
use gearmesh_report::words_and_unit;
use gearmesh_scene::system_run::{SystemResult, rank};
use gearmesh_signal::{Band, SeriesError, Spectrum, Window, amplitude_spectrum, envelope};
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

/// Edges of an envelope's band, as a share of its width; as in `gearmesh signal envelope`.
const EDGE: f64 = 0.1;

/// A stretch of a result.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StretchAsked {
    pub(crate) from: Option<f64>,
    pub(crate) to: Option<f64>,
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
    beside: Option<Box<ColumnsSession>>,
}

/// Which curves.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CurvesAsked {
    columns: Vec<String>,
    from: Option<f64>,
    to: Option<f64>,
    #[serde(default)]
    shown: Shown,
    /// Band of an envelope \[Hz\].
    #[serde(rename = "band_Hz")]
    band_hz: Option<[f64; 2]>,
    /// Those of the result beside this one.
    #[serde(default)]
    beside: bool,
}

/// What is drawn of a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Shown {
    /// Values over time, by least and largest ones.
    #[default]
    Curves,
    /// Amplitudes over frequency.
    Spectrum,
    /// Amplitudes of the envelope of a band over frequency.
    Envelope,
    /// Whole rows, evenly chosen: least and largest values of two columns are none of one row.
    Together,
}

/// The spectrum of values, or of the envelope of a band of them.
fn lines(values: &[f64], rate: f64, band: Option<Band>) -> Result<Spectrum, SeriesError> {
    match band {
        None => amplitude_spectrum(values, rate, Window::Hann),
        Some(band) => {
            let found = envelope(values, rate, band)?;
            amplitude_spectrum(&found.envelope, rate, Window::Hann)
        }
    }
}

impl ColumnsSession {
    /// Lists the columns.
    ///
    /// # Errors
    /// [`Problem::Input`] for a result without rows.
    pub fn new(file: &Path, result: SystemResult) -> Result<Self, Problem> {
        let columns = result.rows.columns();
        let Some(first) = columns.first().filter(|_| result.rows.rows() > 0) else {
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
            // A pure number has none to show.
            let unit = if column.unit == "1" { "" } else { &column.unit };
            json!({"name": column.name, "label": label, "unit": unit, "help": column.description})
        });
        let (label, unit) = words_and_unit(&axis_name);
        let description = json!({
            "title": result.head.title,
            "kind": result.kind.to_string(),
            "rows": result.rows.rows(),
            "axis": {"name": axis_name, "label": label, "unit": unit},
            "columns": listed.collect::<Vec<_>>(),
            "sets": result.head.sets.iter().map(|set| &set.name).collect::<Vec<_>>(),
        });
        let band = result.spectrum_band();
        let mut session = Self {
            file: file.to_owned(),
            names: columns.iter().map(|column| column.name.clone()).collect(),
            result: Mutex::new(result),
            description,
            axis,
            axis_name,
            beside: None,
        };
        let highest = session.rate(&session.axis).map(|rate| 0.5 * rate * band);
        session.description["highest_Hz"] = json!(highest.ok());
        Ok(session)
    }

    /// The session with another result beside it, which must run over the same quantity.
    ///
    /// # Errors
    /// [`Problem::Input`] where it runs over something else.
    pub fn with_beside(mut self, other: Self) -> Result<Self, Problem> {
        if other.axis_name != self.axis_name {
            return Err(Problem::Input(format!(
                "--beside {}: runs over `{}`, the result over `{}`; allowed are two of one kind",
                other.file.display(),
                other.axis_name,
                self.axis_name
            )));
        }
        let name = |path: &Path| {
            let name = path.file_name().unwrap_or(path.as_os_str());
            name.to_string_lossy().into_owned()
        };
        self.description["file"] = json!(name(&self.file));
        self.description["beside"] = json!({
            "title": other.description["title"],
            "file": name(&other.file),
            "rows": other.description["rows"],
            "columns": other.names,
        });
        self.beside = Some(Box::new(other));
        Ok(self)
    }

    /// The columns, those first that a reader asks for first.
    pub fn description(&self) -> Value {
        self.description.clone()
    }

    /// The gears at moments of a stretch, and the forces on their teeth.
    ///
    /// # Errors
    /// [`Problem`] for a result without anything that could be drawn, and once `watch` stops it.
    pub fn moments(&self, asked: &StretchAsked, watch: &Watch<'_>) -> Result<Value, Problem> {
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
    /// [`Problem::Input`] for a column that is not there and for rows without a spectrum, [`Problem::Absent`] where no
    /// result stands beside.
    pub fn curves(&self, asked: &CurvesAsked) -> Result<Value, Problem> {
        if asked.beside {
            let other = self.beside.as_ref().ok_or(Problem::Absent)?;
            let own = CurvesAsked {
                beside: false,
                ..asked.clone()
            };
            return other.curves(&own);
        }
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
        let every = rows.len().div_ceil(MOST_TOGETHER).max(1);
        let read = |name: &String| -> Result<Vec<f64>, Problem> {
            let values = result.rows.read_rows(name, rows.clone())?;
            Ok(match asked.shown {
                Shown::Together => values.into_iter().step_by(every).collect(),
                _ => min_max::values(&values),
            })
        };
        let (x, curves) = match asked.shown {
            Shown::Spectrum | Shown::Envelope => {
                let band = match (asked.shown, asked.band_hz) {
                    (Shown::Envelope, Some([low, high])) => Some(Band {
                        low,
                        high,
                        edge: EDGE * (high - low).max(0.0),
                    }),
                    (Shown::Envelope, None) => {
                        return Err(Problem::Input("an envelope needs band_Hz".to_owned()));
                    }
                    _ => None,
                };
                let rate = self.rate(x)?;
                let mut found = Vec::new();
                for name in &asked.columns {
                    let values = &result.read_for_spectrum(name)?[rows.clone()];
                    let of = lines(values, rate, band);
                    let of = of.map_err(|error| Problem::Input(format!("{name}: {error}")))?;
                    let highest = of.highest() * result.spectrum_band();
                    let count = (highest / of.line_spacing) as usize + 1;
                    found.push((of.line_spacing, of.values, count));
                }
                let (spacing, count) =
                    found.first().map_or((0.0, 0), |(spacing, values, count)| {
                        (*spacing, (*count).min(values.len()))
                    });
                let x: Vec<f64> = (0..count).map(|line| spacing * line as f64).collect();
                let curves = found
                    .iter()
                    .map(|(_, values, _)| min_max::values(&values[..count]));
                (min_max::abscissas(&x), curves.collect())
            }
            Shown::Together => {
                let x = x.iter().copied().step_by(every).collect();
                let curves: Result<Vec<_>, Problem> = asked.columns.iter().map(read).collect();
                (x, curves?)
            }
            Shown::Curves => {
                let curves: Result<Vec<_>, Problem> = asked.columns.iter().map(read).collect();
                (min_max::abscissas(x), curves?)
            }
        };
        let every = match asked.shown {
            Shown::Together => every,
            _ => 1,
        };
        Ok(json!({"x": x, "curves": curves, "rows": rows.len(), "every": every}))
    }

    pub(crate) fn locked(&self) -> Result<MutexGuard<'_, SystemResult>, Problem> {
        let result = self.result.lock();
        result.map_err(|error| Problem::Work(error.to_string()))
    }

    /// What the rows run over.
    pub(crate) fn axis(&self) -> &[f64] {
        &self.axis
    }

    /// Its name and unit, as a chart has them.
    pub(crate) fn axis_words(&self) -> String {
        let (label, unit) = words_and_unit(&self.axis_name);
        format!("{label} {unit}")
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
