//! What a scene gives, and what that took: for those who try many scenes and keep none.

use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use cpu_time::ProcessTime;

use super::cases::{Selected, SelectedValue, StudyError};
use super::figure::Wanted;
use super::rest_cases::RestCases;
use super::subject::Subject;
use super::system_cases;
use crate::pair::warnings::{ColumnPressure, yielding};
use crate::system::SystemScene;
use crate::system_run::{Outcome, RunJob, RunOptions, SystemResult, run};

/// What a computation took; reading models and writing files is not in it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Effort {
    /// Wall time \[s\].
    pub wall_s: f64,
    /// Processor time of the whole process \[s\].
    pub cpu_s: f64,
    /// Unknowns: slices that may touch, or degrees of freedom of the system.
    pub states: f64,
    /// Positions of a pair, or evaluations of a system's equations.
    pub calls: f64,
    /// Iterations: of the contact at all positions, or of the integrator's steps.
    pub iterations: f64,
}

/// Takes the time of a computation.
pub(super) struct Clock {
    wall: Instant,
    cpu: ProcessTime,
}

impl Clock {
    pub(super) fn start() -> Self {
        Self {
            wall: Instant::now(),
            cpu: ProcessTime::now(),
        }
    }

    /// Times until now; nothing else.
    pub(super) fn effort(&self) -> Effort {
        Effort {
            wall_s: self.wall.elapsed().as_secs_f64(),
            cpu_s: self.cpu.elapsed().as_secs_f64(),
            ..Effort::default()
        }
    }
}

/// Multibody runs write a checkpoint after this time.
const CHECKPOINTS: Duration = Duration::from_secs(600);

/// Where multibody runs write, and what stops them.
#[derive(Debug)]
pub struct Scratch<'a> {
    folder: &'a Path,
    stop: &'a AtomicBool,
    runs: AtomicUsize,
}

impl<'a> Scratch<'a> {
    /// In a folder that the caller makes and removes.
    #[must_use]
    pub fn new(folder: &'a Path, stop: &'a AtomicBool) -> Self {
        Self {
            folder,
            stop,
            runs: AtomicUsize::new(0),
        }
    }

    /// Set from outside: the user has asked to stop.
    #[must_use]
    pub fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// The folder.
    #[must_use]
    pub fn folder(&self) -> &Path {
        self.folder
    }
}

/// What a scene gives, and what that took.
pub(crate) struct Evaluated {
    /// The columns, row by row (of a pair one for each torque).
    pub selected: Vec<Selected>,
    /// What they took.
    pub effort: Effort,
    /// The column with the largest pressure, where steel yields under it; also where it was not asked for.
    pub yielding: Option<ColumnPressure>,
}

/// The columns of a scene from a time on \[s\].
///
/// # Errors
/// [`StudyError`] for what cannot be loaded or computed, for columns that are not there, and on a stop.
pub(crate) fn evaluate(
    subject: Subject,
    (wanted, from_s): (&[Wanted], f64),
    rest: &RestCases,
    scratch: &Scratch<'_>,
) -> Result<Evaluated, StudyError> {
    let unread = |problem: String| StudyError::Column(problem);
    match subject {
        Subject::System(scene) => of_system(*scene, (wanted, from_s), scratch),
        subject => {
            let (figures, effort) = rest.figures(&subject)?;
            Ok(Evaluated {
                selected: figures.selected(wanted).map_err(unread)?,
                effort,
                yielding: figures.yielding(),
            })
        }
    }
}

fn of_system(
    scene: SystemScene,
    (wanted, from_s): (&[Wanted], f64),
    scratch: &Scratch<'_>,
) -> Result<Evaluated, StudyError> {
    let job = RunJob::from_scene(scene.load()?)?;
    let states = job.system.degrees_of_freedom() as f64;
    let number = scratch.runs.fetch_add(1, Ordering::Relaxed);
    let file = scratch.folder.join(format!("run{number}.h5"));
    let options = RunOptions {
        output: &file,
        restart: true,
        checkpoint_interval: CHECKPOINTS,
        stop: scratch.stop,
        progress: &|_| (),
    };
    let clock = Clock::start();
    let outcome = run(job, &options)?;
    let mut effort = clock.effort();
    if outcome == Outcome::Stopped {
        return Err(StudyError::Stopped);
    }
    let result = SystemResult::open(&file)?;
    let found = system_cases::selected(wanted, from_s, &result);
    let yielding = yielding(result.pressures()?.into_iter());
    let record = result.record;
    // What is left of a failed removal is the caller's folder, which goes as a whole.
    let _ = std::fs::remove_file(&file);
    effort.states = states;
    if let Some(record) = record {
        (effort.calls, effort.iterations) = (record.evaluations, record.iterations);
    }
    Ok(Evaluated {
        selected: found.map_err(StudyError::Column)?,
        effort,
        yielding,
    })
}

/// The number of a column; of a series its mean.
pub(crate) fn number(selected: &Selected) -> f64 {
    match selected.value {
        SelectedValue::Single(value) => value,
        SelectedValue::Series(figures) => figures.mean,
    }
}
