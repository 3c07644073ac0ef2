//! Running scenes.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, SystemTime};

use gearmesh_geometry::InputError as InputComplaint;
use gearmesh_geometry::input::InputDocument;
use gearmesh_scene::pair::Scene;
use gearmesh_scene::study::RestCases;
use gearmesh_scene::system::{HostFunctions, SystemPlan, SystemScene};
use gearmesh_scene::system_run::{
    Outcome, ResultSize, RunCost, RunJob, RunOptions, SystemResult, demand_result_size,
    run as run_job,
};
use gearmesh_scene::{SceneFile, load, run as run_pair_scene};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::{InputError, file_error, input_error, run_error, system_error};
use crate::functions::Functions;
use crate::results::NativeResult;
use crate::watched::{OnInterrupt, watched};

/// Wall time between checkpoints of a multibody run.
const CHECKPOINTS: Duration = Duration::from_secs(10);

/// Calls and seconds of each function.
type Cost = BTreeMap<String, (u64, f64)>;

/// What a scene will compute, in lines for people. Raises InputError for what a run would refuse.
#[pyfunction]
#[pyo3(signature = (text, file, folder, functions = None))]
pub(crate) fn plan(
    py: Python<'_>,
    text: String,
    file: String,
    folder: PathBuf,
    functions: Option<Bound<'_, PyDict>>,
) -> PyResult<Vec<String>> {
    let functions = Functions::of(functions.as_ref())?;
    let host = functions.for_scene(String::new());
    let lines = py.detach(
        move || match with_functions(read(text, file, folder)?, host)? {
            SceneFile::Pair(scene) => {
                let loaded = load(*scene).map_err(run_error)?;
                loaded
                    .contact()
                    .map_err(|error| InputError::new_err(error.to_string()))?;
                Ok(loaded.plan().lines)
            }
            SceneFile::System(scene) => {
                let loaded = scene.load().map_err(input_error)?;
                let size =
                    ResultSize::of(&RunJob::from_scene(loaded.clone()).map_err(system_error)?);
                let built = loaded.build().map_err(input_error)?;
                let plan = SystemPlan::new(&loaded.scene, built).map_err(input_error)?;
                let cost = RunCost::timed(&loaded).map_err(input_error)?;
                Ok(plan.with_result(size).with_cost(&loaded.scene, cost).lines)
            }
        },
    );
    functions.judge(lines)
}

/// Runs a scene of either kind: the result and notes, what a user should know about the scene.
///
/// A pair's result stays in memory and is written where output is given. That of a multibody scene is always a file;
/// an unfinished run of the same scene beside it goes on, unless restart. progress(stage, done, total) hears how far
/// the run is. functions: what the scene calls by name; identity tells them from others.
///
/// Third of what is returned: calls and seconds of each function. Raises InputError, WorkError (of a function that has
/// raised, with its exception as the cause), OSError; KeyboardInterrupt after a checkpoint was written.
#[pyfunction]
#[pyo3(signature = (text, file, folder, output, restart, progress, functions = None, identity = String::new(), most_result_gb = 1.0))]
#[allow(clippy::too_many_arguments)]
pub(crate) fn run(
    py: Python<'_>,
    text: String,
    file: String,
    folder: PathBuf,
    output: Option<PathBuf>,
    restart: bool,
    progress: Option<Bound<'_, PyAny>>,
    functions: Option<Bound<'_, PyDict>>,
    identity: String,
    most_result_gb: f64,
) -> PyResult<(NativeResult, Vec<String>, Cost)> {
    let functions = Functions::of(functions.as_ref())?;
    let host = functions.for_scene(identity);
    let scene = py.detach(move || with_functions(read(text, file, folder)?, host))?;
    let outcome = match scene {
        SceneFile::Pair(_) if restart => Err(InputError::new_err(
            "restart: scenes of a gear pair are not resumed; leave it out",
        )),
        SceneFile::Pair(scene) => run_pair(
            py,
            *scene,
            (output, 1e9 * most_result_gb),
            progress.as_ref(),
        ),
        SceneFile::System(scene) => {
            let output = output.ok_or_else(|| {
                InputError::new_err("output: the result of a multibody scene is a file; name it")
            })?;
            run_system(
                py,
                *scene,
                (output, restart, 1e9 * most_result_gb),
                progress.as_ref(),
            )
        }
    };
    let (result, notes) = functions.judge(outcome)?;
    Ok((result, notes, functions.cost()))
}

/// The scene with the functions of the caller.
fn with_functions(scene: SceneFile, host: HostFunctions) -> PyResult<SceneFile> {
    match scene {
        SceneFile::Pair(_) if !host.is_empty() => Err(InputError::new_err(
            "functions: a gear pair at rest has no loads, motions or elements that call one; leave them out",
        )),
        SceneFile::Pair(scene) => Ok(SceneFile::Pair(scene)),
        SceneFile::System(mut scene) => {
            scene.host = host;
            Ok(SceneFile::System(scene))
        }
    }
}

fn run_pair(
    py: Python<'_>,
    scene: Scene,
    (output, most_bytes): (Option<PathBuf>, f64),
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<(NativeResult, Vec<String>)> {
    let (result, notes) = watched(py, progress, OnInterrupt::Leave, move |watch| {
        let loaded = shelved_models(&scene).load(&scene).map_err(run_error)?;
        let notes = notes(&loaded.scene.notes, &loaded.unit_slips());
        let place = (&loaded.scene.document, "run.pitches");
        demand_result_size(place, ("the result", loaded.result_bytes()), most_bytes)
            .map_err(input_error)?;
        let told = |done: usize, total: usize| {
            watch.advance("torques", done as f64, total as f64);
        };
        let result = run_pair_scene(&loaded, &told).map_err(run_error)?;
        if let Some(output) = output {
            result.write(&output).map_err(file_error)?;
        }
        Ok((result, notes))
    })?;
    Ok((NativeResult::of_pair(py, result)?, notes))
}

/// Models that this process has read, and what their files were then: a relief is varied in milliseconds, where reading
/// models would take a tenth of a second.
struct Shelf {
    stamps: BTreeMap<PathBuf, Option<(SystemTime, u64)>>,
    pairs: Arc<RestCases>,
}

static SHELF: Mutex<Option<Shelf>> = Mutex::new(None);

/// Models beyond which all are read again: scripts that go through many gears shall not fill the memory.
const MOST_MODELS: usize = 16;

/// The shelf with the models of a scene, unless their files have changed.
fn shelved_models(scene: &Scene) -> Arc<RestCases> {
    let stamp = |path: &PathBuf| {
        let found = path.metadata().ok()?;
        Some((found.modified().ok()?, found.len()))
    };
    let mut held = SHELF.lock().unwrap_or_else(PoisonError::into_inner);
    let paths = [scene.gear_1.clone(), scene.gear_2.clone()];
    let is_known = |shelf: &Shelf| {
        let same = |path: &PathBuf| shelf.stamps.get(path).is_none_or(|old| *old == stamp(path));
        paths.iter().all(same) && shelf.stamps.len() <= MOST_MODELS
    };
    let mut shelf = held.take().filter(is_known).unwrap_or_else(|| Shelf {
        stamps: BTreeMap::new(),
        pairs: Arc::default(),
    });
    for path in paths {
        let now = stamp(&path);
        shelf.stamps.insert(path, now);
    }
    let pairs = Arc::clone(&shelf.pairs);
    *held = Some(shelf);
    pairs
}

fn run_system(
    py: Python<'_>,
    scene: SystemScene,
    (output, restart, most_bytes): (PathBuf, bool, f64),
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<(NativeResult, Vec<String>)> {
    watched(py, progress, OnInterrupt::Wait, move |watch| {
        let loaded = scene.load().map_err(input_error)?;
        let mut notes = loaded.scene.notes.clone();
        let document = loaded.scene.document.clone();
        let job = RunJob::from_scene(loaded).map_err(system_error)?;
        if let Some(size) = ResultSize::of(&job) {
            let place = (&document, "output.interval_s");
            demand_result_size(place, ("the result", size.bytes()), most_bytes)
                .map_err(input_error)?;
        }
        notes.extend(job.head.notes.iter().cloned());
        let stage = job.kind.of_result().to_string();
        let options = RunOptions {
            output: &output,
            restart,
            checkpoint_interval: CHECKPOINTS,
            stop: &watch.stop,
            progress: &|advance| watch.advance(&stage, advance.done, advance.total),
        };
        match run_job(job, &options).map_err(system_error)? {
            Outcome::Finished => {
                let result = SystemResult::open(&output).map_err(file_error)?;
                Ok((NativeResult::of_system(result), notes))
            }
            Outcome::Stopped => Err(PyKeyboardInterrupt::new_err("")),
        }
    })
}

fn read(text: String, file: String, folder: PathBuf) -> PyResult<SceneFile> {
    SceneFile::from_document(InputDocument::new(file, text), &folder).map_err(input_error)
}

fn notes(of_scene: &[String], slips: &[InputComplaint]) -> Vec<String> {
    let slips = slips.iter().map(ToString::to_string);
    of_scene.iter().cloned().chain(slips).collect()
}
