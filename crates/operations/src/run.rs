//! A scene becomes a result.

use crate::failure::{Failure, Result};
use crate::watch::Watch;
use crate::{pair_table, system_figures, system_table};
use gearmesh_geometry::input::InputDocument;
use gearmesh_model::Named;
use gearmesh_report::run_figures::pair_figures;
use gearmesh_scene::ModelShelf;
use gearmesh_scene::pair::BevelScene;
use gearmesh_scene::pair::run::run_until;
use gearmesh_scene::rating::RatingResult;
use gearmesh_scene::system::LoadedSystem;
use gearmesh_scene::system_run::{
    Advance, Outcome, ResultSize, RunJob, RunOptions, SystemResult, demand_result_size, megabytes,
    run as run_job,
};
use gearmesh_scene::{LoadedScene, SceneFile, SceneResult, load};
use serde_json::Value;
use std::path::Path;
use std::time::Duration;

/// Results from this size on are announced \[bytes\].
const WORTH_A_WORD: f64 = 50e6;

/// How a scene is run.
#[derive(Debug, Clone, Copy)]
pub struct RunHow<'a> {
    /// Result file; that of a pair may be left out, its result stays in memory.
    pub output: Option<&'a Path>,
    /// Begin anew where an unfinished run lies beside the output.
    pub restart: bool,
    /// Larger results are refused before they are computed \[GB\].
    pub most_result_gb: f64,
    /// Wall time between checkpoints of a multibody run.
    pub checkpoint_interval: Duration,
}

impl Default for RunHow<'_> {
    /// In memory, of any size, without checkpoints.
    fn default() -> Self {
        Self {
            output: None,
            restart: false,
            most_result_gb: f64::INFINITY,
            checkpoint_interval: Duration::MAX,
        }
    }
}

/// The result of a scene of either kind.
pub enum Ran {
    /// A gear pair at rest.
    Pair(Box<SceneResult>),
    /// A multibody system.
    System(Box<SystemResult>),
}

impl Ran {
    /// For people.
    ///
    /// # Errors
    /// [`Failure`] where the result's file cannot be read.
    pub fn lines(&self) -> Result<Vec<String>> {
        match self {
            Self::Pair(result) => Ok(pair_table::table(result)),
            Self::System(result) => system_table::table(result),
        }
    }

    /// For other programs.
    ///
    /// # Errors
    /// As [`Ran::lines`].
    pub fn figures(&self) -> Result<Value> {
        match self {
            Self::Pair(result) => Ok(pair_figures(result)),
            Self::System(result) => system_figures::figures(result),
        }
    }

    /// What is wrong with a result that was written all the same: it shows where things go wrong.
    #[must_use]
    pub fn problem(&self) -> Option<String> {
        match self {
            Self::Pair(_) => None,
            Self::System(result) => result.problem(),
        }
    }
}

/// Runs a scene.
///
/// # Errors
/// [`Failure`] for a scene that is wrong or has no solution, and a result that is too large or cannot be written.
pub fn run(scene: SceneFile, how: &RunHow<'_>, watch: &Watch<'_>) -> Result<Ran> {
    match scene {
        SceneFile::Pair(scene) => {
            refuse_restart(how)?;
            let result = run_pair(&load(*scene)?, how, watch)?;
            Ok(Ran::Pair(Box::new(result)))
        }
        SceneFile::Bevel(scene) => {
            let result = run_bevel(&scene, how, watch)?;
            Ok(Ran::Pair(Box::new(result)))
        }
        SceneFile::System(scene) => {
            let result = run_system(scene.load()?, how, watch)?;
            Ok(Ran::System(Box::new(result)))
        }
    }
}

fn refuse_restart(how: &RunHow<'_>) -> Result<()> {
    match how.restart {
        true => Err(Failure::input(
            "--restart: scenes of a gear pair are not resumed; leave it out",
        )),
        false => Ok(()),
    }
}

/// Runs a pair with its models; stopped, nothing is written.
///
/// # Errors
/// As [`run`].
pub fn run_pair(loaded: &LoadedScene, how: &RunHow<'_>, watch: &Watch<'_>) -> Result<SceneResult> {
    refuse_restart(how)?;
    loaded.scene.notes.iter().for_each(|note| watch.note(note));
    demand_size(
        loaded.result_bytes(),
        (&loaded.scene.document, "run.pitches"),
        how,
        watch,
    )?;
    // Slips of units are among the warnings of the result; what is refused may follow from them.
    let result = with_torques(watch, |progress| run_until(loaded, progress, watch.stop))
        .inspect_err(|_| watch.unit_slips(loaded.unit_slips()))?;
    written(result, how, watch)
}

/// Runs a bevel pair under the torques of its `[load]`; stopped, nothing is written.
///
/// # Errors
/// As [`run`].
pub fn run_bevel(scene: &BevelScene, how: &RunHow<'_>, watch: &Watch<'_>) -> Result<SceneResult> {
    refuse_restart(how)?;
    let loaded = scene.load(&ModelShelf::default())?;
    let assembled = scene.assembled().map_err(Failure::work)?;
    assembled.jam.iter().for_each(|words| watch.warning(words));
    let result = with_torques(watch, |progress| loaded.run(progress, watch.stop))
        .inspect_err(|_| watch.unit_slips(scene.document.unit_slips()))?;
    written(result, how, watch)
}

/// Tells how many torques are solved.
fn with_torques<T>(watch: &Watch<'_>, run: impl FnOnce(&(dyn Fn(usize, usize) + Sync)) -> T) -> T {
    let task = watch.listener.begin("torques");
    run(&|done, total| {
        task.advance(done as f64, total as f64);
        watch.note(format!("torque {done} of {total} solved"));
    })
}

/// Writes a pair's result where a file is named, and tells its warnings.
fn written(result: SceneResult, how: &RunHow<'_>, watch: &Watch<'_>) -> Result<SceneResult> {
    watch.go_on()?;
    if let Some(output) = how.output {
        result.write(output)?;
    }
    let judged = result.ratings.iter().flat_map(RatingResult::reported);
    let warnings = result.warnings.iter().cloned().chain(judged);
    warnings.for_each(|text| watch.warning(text));
    Ok(result)
}

/// Runs a multibody scene; stopped, a run in time goes on later from its checkpoint.
///
/// # Errors
/// As [`run`]; the result is a file, which has to be named.
pub fn run_system(
    loaded: LoadedSystem,
    how: &RunHow<'_>,
    watch: &Watch<'_>,
) -> Result<SystemResult> {
    let output = how.output.ok_or_else(|| {
        Failure::input("output: the result of a multibody scene is a file; name it")
    })?;
    loaded.scene.notes.iter().for_each(|note| watch.note(note));
    let slips = loaded.unit_slips();
    let document = loaded.scene.document.clone();
    // Slips are among the notes of the job; what is refused may follow from them.
    let job = RunJob::from_scene(loaded).inspect_err(|_| watch.unit_slips(slips))?;
    let before = job.head.notes.len();
    job.head.notes.iter().for_each(|note| watch.note(note));
    if let Some(size) = ResultSize::of(&job) {
        demand_size(size.bytes(), (&document, "output.interval_s"), how, watch)?;
    }
    let resumes = job.kind.resumes();
    let task = watch.listener.begin(job.kind.of_result().name_in_files());
    let progress = |advance: Advance| {
        if advance.resumed {
            watch.note(format!(
                "goes on from the checkpoint at {:.6} of {}",
                advance.done, advance.total
            ));
        }
        task.advance(advance.done, advance.total);
    };
    let outcome = run_job(
        job,
        &RunOptions {
            output,
            restart: how.restart,
            checkpoint_interval: how.checkpoint_interval,
            stop: watch.stop,
            progress: &progress,
        },
    );
    drop(task);
    if outcome? == Outcome::Stopped {
        return Err(Failure::stopped(match resumes {
            true => "interrupted; the same command goes on from here, --restart begins anew",
            false => "interrupted; nothing is written",
        }));
    }
    let result = SystemResult::open(output)?;
    (result.head.notes.iter().skip(before)).for_each(|note| watch.note(note));
    let warnings = result.warnings()?;
    warnings.iter().for_each(|text| watch.warning(text));
    Ok(result)
}

/// Refuses a result that is larger than it may be, before anything of it is written; a large one is announced.
fn demand_size(
    bytes: f64,
    place: (&InputDocument, &str),
    how: &RunHow<'_>,
    watch: &Watch<'_>,
) -> Result<()> {
    demand_result_size(place, ("the result", bytes), 1e9 * how.most_result_gb)?;
    if bytes >= WORTH_A_WORD {
        watch.note(format!("the result will have {}", megabytes(bytes)));
    }
    Ok(())
}
