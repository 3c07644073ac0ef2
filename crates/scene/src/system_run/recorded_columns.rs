//! The columns that a run will have, and the size of its result, before it runs.

use std::fmt;

use gearmesh_model::Column;

use super::job::{RunJob, RunKind};
use super::recorder::{Course, Recorder};
use super::{in_time, static_series};

/// The columns of a job's rows; of natural frequencies none.
#[must_use]
pub fn recorded_columns(job: &RunJob) -> Vec<Column> {
    let (abscissas, course) = match &job.kind {
        RunKind::Transient(_) | RunKind::SpeedSweep(_) => (vec![in_time::time()], Course::InTime),
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

/// A size as people read it: `0.3 MB`, `1.4 GB`.
#[must_use]
pub fn megabytes(bytes: f64) -> String {
    if bytes < 1e9 {
        format!("{:.1} MB", 1e-6 * bytes)
    } else {
        format!("{:.1} GB", 1e-9 * bytes)
    }
}
