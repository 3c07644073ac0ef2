//! The cases of a multibody study: a result file each, and its figures.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use gearmesh_model::FileError;

use super::cases::{Selected, SelectedValue, StudyError};
use super::elsewhere::SentCase;
use super::study_file::Study;
use crate::system::SystemScene;
use crate::system_run::{
    Figures, Outcome, RunHead, RunJob, RunOptions, SystemResult, SystemRunError, inputs,
    recorded_columns, run,
};

/// Wall time between checkpoints of a case.
const CHECKPOINTS: Duration = Duration::from_secs(60);

/// Wall time between two looks at a case that another study has in hand.
const WAITING: Duration = Duration::from_millis(200);

/// Digits of the digest in a file's name.
const NAME_DIGITS: usize = 16;

/// The columns that a run of the scene will have.
///
/// # Errors
/// [`StudyError`] for a scene that cannot be built.
pub(super) fn column_names(scene: &SystemScene) -> Result<Vec<String>, StudyError> {
    let job = RunJob::from_scene(scene.clone().load()?)?;
    let columns = recorded_columns(&job).into_iter();
    Ok(columns.map(|column| column.name).collect())
}

/// Runs a case, or waits for the other study in the same folder that is at it; none if it was stopped.
pub(super) fn run_case(
    scene: SystemScene,
    folder: &Path,
    stop: &AtomicBool,
) -> Result<Option<PathBuf>, StudyError> {
    loop {
        match run_unless_there(scene.clone(), folder, stop) {
            Err(StudyError::Run(SystemRunError::File(FileError::InUse { .. }))) => {
                std::thread::sleep(WAITING);
            }
            outcome => return outcome,
        }
    }
}

/// Runs a case unless its result is there already; none if it was stopped.
fn run_unless_there(
    scene: SystemScene,
    folder: &Path,
    stop: &AtomicBool,
) -> Result<Option<PathBuf>, StudyError> {
    if stop.load(Ordering::Relaxed) {
        return Ok(None);
    }
    let job = RunJob::from_scene(scene.load()?)?;
    let identity = job.head.identity();
    let file = folder.join(file_name(&identity));
    if is_there(&file, &identity) {
        return Ok(Some(file));
    }
    Ok(run_into(job, &file, stop)?.then_some(file))
}

/// Name of a case's file.
pub(super) fn file_name(identity: &str) -> String {
    let digits: String = identity.chars().take(NAME_DIGITS).collect();
    format!("{digits}.h5")
}

/// Whether a file is the whole result of a case.
pub(super) fn is_there(file: &Path, identity: &str) -> bool {
    SystemResult::open(file).is_ok_and(|result| result.head.identity() == identity)
}

/// The study's columns of a case; none where its file is not there.
pub(super) fn stored(
    study: &Study,
    file: &Path,
    identity: &str,
) -> Option<Result<Vec<Selected>, String>> {
    let result = SystemResult::open(file).ok()?;
    (result.head.identity() == identity).then(|| selected_of(study, &result))
}

/// What tells the result of a scene from others.
pub(super) fn head(scene: &SystemScene) -> RunHead {
    RunHead {
        scene_toml: scene.document.text.clone(),
        inputs: inputs(scene),
        ..RunHead::default()
    }
}

/// Runs a case that was sent, unless it is there or another process is at it: whether it was computed, none if it was
/// stopped. Its result says what it would have said where the case comes from.
pub(super) fn run_sent(
    scene: SystemScene,
    case: &SentCase,
    folder: &Path,
    stop: &AtomicBool,
) -> Result<Option<bool>, StudyError> {
    let file = folder.join(&case.file);
    loop {
        if is_there(&file, &case.identity) {
            return Ok(Some(false));
        }
        if stop.load(Ordering::Relaxed) {
            return Ok(None);
        }
        let mut job = RunJob::from_scene(scene.clone().load()?)?;
        job.head.scene_toml.clone_from(&case.text);
        job.head.inputs.clone_from(&case.inputs);
        match run_into(job, &file, stop) {
            Err(StudyError::Run(SystemRunError::File(FileError::InUse { .. }))) => {
                std::thread::sleep(WAITING);
            }
            outcome => return Ok(outcome?.then_some(true)),
        }
    }
}

/// False where it was stopped.
fn run_into(job: RunJob, file: &Path, stop: &AtomicBool) -> Result<bool, StudyError> {
    let options = RunOptions {
        output: file,
        restart: false,
        checkpoint_interval: CHECKPOINTS,
        stop,
        progress: &|_| (),
    };
    Ok(run(job, &options)? == Outcome::Finished)
}

/// Figures of the study's columns over its time, or what keeps them from being read.
pub(super) fn selected(study: &Study, file: &Path) -> Result<Vec<Selected>, String> {
    let result = SystemResult::open(file).map_err(|error| error.to_string())?;
    selected_of(study, &result)
}

fn selected_of(study: &Study, result: &SystemResult) -> Result<Vec<Selected>, String> {
    let say = |error: FileError| error.to_string();
    if let Some(problem) = result.problem() {
        return Err(problem);
    }
    let mut first = 0;
    // Equilibria have no time.
    if study.tables.from_s > 0.0 {
        let times = result.rows.read("time_s").map_err(say)?;
        // Half a step of the clock's rounding belongs to the first row.
        first = times.partition_point(|time| *time < study.tables.from_s * (1.0 - 1e-12));
        if first == times.len() {
            return Err(format!(
                "from_s = {} is after the end of the run at {} s",
                study.tables.from_s,
                times.last().copied().unwrap_or_default()
            ));
        }
    }
    let figures = |name: &String| {
        let mut columns = result.rows.columns().iter();
        let Some(column) = columns.find(|column| column.name == *name) else {
            let known: Vec<&str> = result.rows.columns().iter().map(|c| &c.name[..]).collect();
            return Err(format!(
                "the result has no column `{name}`; it has {}",
                known.join(", ")
            ));
        };
        let values = result.rows.read(name).map_err(say)?;
        Ok(Selected {
            column: name.clone(),
            unit: column.unit.clone(),
            torque_nm: None,
            value: SelectedValue::Series(Figures::of(&values[first..])),
        })
    };
    study.tables.columns.iter().map(figures).collect()
}
