//! The columns that a run will have, and the size of its result, before it runs.

use std::fmt;

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::InputDocument;
use gearmesh_model::Column;
use gearmesh_specification::system::run::Run;

use super::job::{RunJob, RunKind};
use super::recorder::{Course, Recorder, time};
use super::{in_time, static_series};
use crate::megabytes::megabytes;
use crate::system::SystemScene;

/// The columns of a job's rows; of natural frequencies none.
#[must_use]
pub fn recorded_columns(job: &RunJob) -> Vec<Column> {
    let (abscissas, course) = match &job.kind {
        RunKind::Transient(_) | RunKind::SpeedSweep(_) => (vec![time()], Course::InTime),
        RunKind::Static(series) => (static_series::abscissas_of(&series.points), Course::Static),
        RunKind::Eigen(_) => return Vec::new(),
    };
    let system = &job.system;
    let recorder = Recorder::new(system, system.start(), &job.selection, abscissas, course);
    recorder.columns().to_vec()
}

/// Rows and columns of a result: nearly all of its bytes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ResultSize {
    /// Rows.
    pub rows: f64,
    /// Columns.
    pub columns: usize,
}

impl ResultSize {
    /// Of a job's rows; none where it keeps none: sweeps and natural frequencies.
    #[must_use]
    pub fn of(job: &RunJob) -> Option<Self> {
        let rows = match &job.kind {
            RunKind::Transient(run) => in_time::rows(run),
            RunKind::Static(series) => series.points.len() as f64,
            RunKind::SpeedSweep(_) | RunKind::Eigen(_) => return None,
        };
        let columns = recorded_columns(job).len();
        Some(Self { rows, columns })
    }

    /// The same columns, and the rows of a scene that runs in time.
    #[must_use]
    pub fn with_rows_of(self, scene: &SystemScene) -> Self {
        let Run::Transient { end_s } = scene.run else {
            return self;
        };
        let interval_s = scene.output.interval_s.unwrap_or(end_s);
        Self {
            rows: in_time::rows_until(end_s, interval_s),
            ..self
        }
    }

    /// Bytes of the rows, eight a number.
    #[must_use]
    pub fn bytes(&self) -> f64 {
        self.rows * (8 * self.columns) as f64
    }
}

impl fmt::Display for ResultSize {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (rows, columns) = (self.rows, self.columns);
        write!(f, "{rows} rows of {columns} columns, ")?;
        write!(f, "{}", megabytes(self.bytes()))
    }
}

/// Refuses results that are larger than they may be, before anything of them is computed. `what` they are, in the
/// complaint.
///
/// # Errors
/// [`InputError`] at the key, with the size and how more is allowed.
pub fn demand_result_size(
    (document, key): (&InputDocument, &str),
    (what, bytes): (&str, f64),
    most_bytes: f64,
) -> Result<(), InputError> {
    if bytes <= most_bytes {
        return Ok(());
    }
    let enough = (1e-9 * bytes).ceil();
    let allowed = (1e-3 * most_bytes).round() / 1e6;
    Err(document.error(
        key,
        format!(
            "{what} will have {}, allowed are {allowed} GB; give --most-result-GB {enough:.0} (in Python most_result_GB={enough:.0}) to allow it",
            megabytes(bytes)
        ),
    ))
}
