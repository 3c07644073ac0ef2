//! Running scenes.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, SystemTime};

use gearmesh_operations::Watch;
use gearmesh_operations::overwriting::refuse_named;
use gearmesh_operations::plan::plan as plan_scene;
use gearmesh_operations::run::{self as operations, RunHow};
use gearmesh_scene::SceneFile;
use gearmesh_scene::pair::{BevelScene, Scene};
use gearmesh_scene::study::RestCases;
use gearmesh_scene::system::SystemScene;
use gearmesh_specification::host_functions::HostFunctions;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::documents::document;
use crate::errors::{InputError, input_error, raised};
use crate::functions::Functions;
use crate::results::NativeResult;
use crate::watched::{OnInterrupt, watched};

/// Wall time between checkpoints of a multibody run.
const CHECKPOINTS: Duration = Duration::from_secs(10);

/// Calls and seconds of each function.
type Cost = BTreeMap<String, (u64, f64)>;

/// What a scene will compute, in lines for people. Raises InputError for what a run would refuse.
#[pyfunction]
#[pyo3(signature = (source, file, folder, functions = None))]
pub(crate) fn plan(
    py: Python<'_>,
    source: String,
    file: String,
    folder: PathBuf,
    functions: Option<Bound<'_, PyDict>>,
) -> PyResult<Vec<String>> {
    let functions = Functions::of(functions.as_ref())?;
    let host = functions.for_scene(String::new());
    let lines = py.detach(move || {
        let scene = with_functions(read(&source, &file, &folder)?, host)?;
        let planned = plan_scene(scene, &Watch::unattended()).map_err(raised)?;
        Ok(planned.lines)
    });
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
#[pyo3(signature = (source, file, folder, output, restart, progress, functions = None, identity = String::new(), most_result_gb = 1.0))]
#[allow(clippy::too_many_arguments)]
pub(crate) fn run(
    py: Python<'_>,
    source: String,
    file: String,
    folder: PathBuf,
    output: Option<PathBuf>,
    restart: bool,
    progress: Option<Bound<'_, PyAny>>,
    functions: Option<Bound<'_, PyDict>>,
    identity: String,
    most_result_gb: f64,
) -> PyResult<(NativeResult, Vec<String>, Cost)> {
    if let Some(output) = &output {
        refuse_named(&source, [Path::new(&file), &folder], output).map_err(raised)?;
    }
    let functions = Functions::of(functions.as_ref())?;
    let host = functions.for_scene(identity);
    let scene = py.detach(move || with_functions(read(&source, &file, &folder)?, host))?;
    let asked = (output, restart, most_result_gb);
    let outcome = match scene {
        SceneFile::Pair(scene) => run_pair(py, *scene, asked, progress.as_ref()),
        SceneFile::Bevel(scene) => run_bevel(py, *scene, asked, progress.as_ref()),
        SceneFile::System(scene) => run_system(py, *scene, asked, progress.as_ref()),
    };
    let (result, notes) = functions.judge(outcome)?;
    Ok((result, notes, functions.cost()))
}

/// The scene with the functions of the caller.
fn with_functions(scene: SceneFile, host: HostFunctions) -> PyResult<SceneFile> {
    match scene {
        SceneFile::Pair(_) | SceneFile::Bevel(_) if !host.is_empty() => Err(InputError::new_err(
            "functions: a gear pair at rest has no loads, motions or elements that call one; leave them out",
        )),
        SceneFile::Pair(_) | SceneFile::Bevel(_) => Ok(scene),
        SceneFile::System(mut scene) => {
            scene.host = host;
            Ok(SceneFile::System(scene))
        }
    }
}

/// Result file, whether to begin anew, and how large the result may be \[GB\].
type Asked = (Option<PathBuf>, bool, f64);

/// How a scene is run from here.
fn how((output, restart, most_result_gb): &Asked) -> RunHow<'_> {
    RunHow {
        output: output.as_deref(),
        restart: *restart,
        most_result_gb: *most_result_gb,
        checkpoint_interval: CHECKPOINTS,
    }
}

fn run_pair(
    py: Python<'_>,
    scene: Scene,
    asked: Asked,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<(NativeResult, Vec<String>)> {
    let (result, notes) = watched(py, progress, OnInterrupt::Leave, None, move |watch| {
        let loaded = shelved_models(&scene).load(&scene)?;
        let slips = loaded.unit_slips();
        let slips = slips.iter().map(ToString::to_string);
        let notes = loaded.scene.notes.iter().cloned().chain(slips).collect();
        Ok((operations::run_pair(&loaded, &how(&asked), watch)?, notes))
    })?;
    Ok((NativeResult::of_pair(py, result)?, notes))
}

fn run_bevel(
    py: Python<'_>,
    scene: BevelScene,
    asked: Asked,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<(NativeResult, Vec<String>)> {
    let (result, notes) = watched(py, progress, OnInterrupt::Leave, None, move |watch| {
        let slips = scene.document.unit_slips();
        let notes = slips.iter().map(ToString::to_string).collect();
        Ok((operations::run_bevel(&scene, &how(&asked), watch)?, notes))
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
    let paths = scene.gears.each_ref().map(|gear| gear.model.clone());
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
    asked: Asked,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<(NativeResult, Vec<String>)> {
    watched(py, progress, OnInterrupt::Wait, None, move |watch| {
        let loaded = scene.load()?;
        let mut notes = loaded.scene.notes.clone();
        let result = operations::run_system(loaded, &how(&asked), watch)?;
        notes.extend(result.head.notes.iter().cloned());
        Ok((NativeResult::of_system(result), notes))
    })
}

/// The scene of a file's text, or of tables as JSON where there is no file.
fn read(source: &str, file: &str, folder: &Path) -> PyResult<SceneFile> {
    SceneFile::from_document(document(source, file, folder)?, folder).map_err(input_error)
}
