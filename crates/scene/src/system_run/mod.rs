//! Runs of multibody systems and their results.
//!
//! | question | answer | file |
//! | --- | --- | --- |
//! | what is to be run | [`RunJob`], made from a scene by [`RunJob::from_scene`] | `job.rs`, `from_scene.rs` |
//! | motion in time, in rows or measured speed by speed | [`run`] | `in_time.rs`, `low_pass.rs`, `speed_plan.rs`, `column_statistics.rs`, `mesh_pace.rs` |
//! | equilibria, natural frequencies | [`run`] | `static_series.rs`, `eigen_run.rs` |
//! | what it will cost | [`RunCost`] | `cost.rs` |
//! | what a row holds | [`Recorder`] | `recorder.rs`, `counted_angles.rs` |
//! | how an unfinished run is kept and resumed | [`PartFolder`] | `part_folder.rs`, `stored_checkpoint.rs` |
//! | the result file | [`SystemResult`] | `result.rs`, `run_record.rs` |
//! | what is judged after the run | [`RatingResult`](crate::rating::RatingResult) | `rating.rs` |
//! | the stages, their loads beside what follows from their teeth | [`StageTable`] | `stages.rs` |
//! | how planets share the load of a set, what kind its modes are | [`SetFigures`], [`SetMode`] | `set_figures.rs`, `set_modes.rs` |
//! | what friction takes, part by part | [`PowerLosses`] | `losses.rs` |
//! | its figures at a glance, what of each period it saw | [`ColumnSummary`], [`MeshPassing`] | `summary.rs`, `column_names.rs`, `mesh_passing.rs` |

mod column_names;
mod column_statistics;
mod cost;
mod counted_angles;
mod eigen_run;
mod error;
mod from_scene;
mod in_time;
mod job;
mod losses;
mod low_pass;
mod mesh_misalignment;
mod mesh_pace;
mod mesh_passing;
mod mode_shares;
mod part_folder;
mod rating;
mod recorded_columns;
mod recorder;
mod result;
mod result_kind;
mod result_record;
mod run_record;
mod set_figures;
mod set_modes;
mod speed_plan;
mod stages;
mod static_series;
mod stored_checkpoint;
mod summary;

pub use column_names::{is_of_pair, is_prominent, rank, rounding, stem, unit_in_name, varying};
pub use column_statistics::{ColumnStatistics, Figures};
pub use cost::RunCost;
pub use eigen_run::participation;
pub use error::SystemRunError;
pub use from_scene::digests_of_named_files;
pub(crate) use from_scene::inputs;
pub use job::{
    Advance, EigenJob, EigenPoint, InTime, MeshRecord, Outcome, RunHead, RunJob, RunKind,
    RunOptions, Settling, StaticJob, StaticPoint, SystemAt,
};
pub use losses::{PowerLoss, PowerLosses};
pub use low_pass::LOW_PASS_BAND;
pub use mesh_misalignment::MeshAxes;
pub use mesh_passing::MeshPassing;
pub use mode_shares::{is_overdamped, largest_shares, shares_in_words};
pub use part_folder::PartFolder;
pub use recorded_columns::{ResultSize, demand_result_size, recorded_columns};
pub use recorder::{Course, Moment, Recorder, Selection};
pub use result::{EigenResult, FOLDED_SHARE, SYSTEM_RESULT_FORMAT, SweepResult, SystemResult};
pub use result_kind::ResultKind;
pub use run_record::RunRecord;
pub use set_figures::{MeshShares, PlanetShares, SetFigures};
pub use set_modes::{SetMode, SetModeKind};
pub use speed_plan::{SpeedPlan, Window};
pub use stages::{StageLine, StageLoad, StageRow, StageTable};
pub use summary::{ColumnSummary, foremost};

pub use crate::megabytes::megabytes;

/// Runs a job and writes its result.
///
/// # Errors
/// [`SystemRunError`].
pub fn run(job: RunJob, options: &RunOptions<'_>) -> Result<Outcome, SystemRunError> {
    let RunJob {
        head,
        system,
        selection,
        ratings,
        kind,
    } = job;
    let name = kind.of_result();
    match &kind {
        RunKind::Transient(run) | RunKind::SpeedSweep(run) => {
            let recorded = (&selection, &ratings[..]);
            in_time::run_in_time(head, system, recorded, (name, run), options)
        }
        RunKind::Static(job) => {
            let recorded = (&selection, &ratings[..]);
            static_series::run_static(head, &system, recorded, job, options)
        }
        RunKind::Eigen(job) => eigen_run::run_eigen(head, job, options),
    }
}
