//! The columns that a run will have, before it runs.

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
