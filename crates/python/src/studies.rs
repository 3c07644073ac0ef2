//! Studies whose cases other processes compute.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use gearmesh_geometry::GearDefinition;
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_model::ReducedGear;
use gearmesh_model::write_text;
use gearmesh_reduction::{ReductionOptions, read_body, reduce, reduce_imported};
use gearmesh_report::study_figures;
use gearmesh_report::study_page::study_page;
use gearmesh_scene::study::{
    CaseResult, CaseRunner, MadeFile, SentCase, Study, StudyCases, StudyError, StudyOptions,
    gather_study as gather, run_study,
};
use pyo3::exceptions::{PyKeyboardInterrupt, PyOSError};
use pyo3::prelude::*;

use crate::errors::{WorkError, file_error, input_error, run_error, system_error};
use crate::watched::{OnInterrupt, Watch, watched};

/// Of a study or of one of its cases.
fn study_error(error: StudyError) -> PyErr {
    match error {
        StudyError::Input(complaint) => input_error(complaint),
        StudyError::Run(error) => system_error(error),
        StudyError::Pair(error) => run_error(error),
        StudyError::File(error) => file_error(error),
        StudyError::Folder { .. } => PyOSError::new_err(error.to_string()),
        StudyError::Stopped => PyKeyboardInterrupt::new_err(""),
        StudyError::Bevel(_)
        | StudyError::BevelLoad(_)
        | StudyError::Bearing(_)
        | StudyError::Column(_)
        | StudyError::Reduction { .. }
        | StudyError::Elsewhere(_) => WorkError::new_err(error.to_string()),
    }
}

/// Runs a study into a folder, as many cases at a time as there are processors: what `gearmesh study --json` prints.
/// interpreter is a Python with gmsh, for gears that have to be reduced. progress("cases", done, count) hears how far
/// it is.
///
/// Raises InputError before the first case, OSError; KeyboardInterrupt after the cases at hand.
#[pyfunction]
#[pyo3(signature = (path, folder, interpreter, progress, most_result_gb = 1.0))]
pub(crate) fn study(
    py: Python<'_>,
    path: PathBuf,
    folder: PathBuf,
    interpreter: PathBuf,
    progress: Option<Bound<'_, PyAny>>,
    most_result_gb: f64,
) -> PyResult<String> {
    watched(py, progress.as_ref(), OnInterrupt::Wait, move |watch| {
        let study = study_at(&path, most_result_gb)?;
        let python = PythonEnvironment::at(interpreter);
        let options = StudyOptions {
            folder: &folder,
            stop: &watch.stop,
            progress: &|done, count| watch.advance("cases", done as f64, count as f64),
            reduce: &|gear| reduced(gear, &python, watch),
        };
        let outcome = run_study(&study, &options).map_err(study_error)?;
        if outcome.stopped {
            return Err(PyKeyboardInterrupt::new_err(""));
        }
        told(&study, &outcome.cases, &folder)
    })
}

/// A study file whose results may have this size together.
fn study_at(path: &Path, most_result_gb: f64) -> PyResult<Study> {
    let mut study = Study::read(path).map_err(input_error)?;
    study.most_result_bytes = 1e9 * most_result_gb;
    Ok(study)
}

/// What `gearmesh study --json` prints; the page study.html is written beside the results.
fn told(study: &Study, cases: &[CaseResult], folder: &Path) -> PyResult<String> {
    let page = study_page(study, cases).render();
    let page = page.map_err(|error| WorkError::new_err(error.to_string()))?;
    write_text(&folder.join("study.html"), &page).map_err(file_error)?;
    Ok(study_figures(study, cases).to_string())
}

fn reduced(
    gear: &GearDefinition,
    python: &PythonEnvironment,
    watch: &Watch,
) -> Result<ReducedGear, String> {
    let outcome = match gear.blank.meshed() {
        Some(body) => {
            let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
            let mesh = read_body(body, python, &folder.path().join("mesh.h5"));
            mesh.and_then(|mesh| reduce_imported(gear, body, mesh, watch))
        }
        None => {
            let options = ReductionOptions {
                estimate_error: true,
            };
            reduce(gear, python, options, watch).map(|(model, _)| model)
        }
    };
    outcome.map_err(|error| error.to_string())
}

/// The same of what lies in a folder already; nothing is computed. failures: why cases have failed, by the names of
/// their files.
#[pyfunction]
pub(crate) fn gather_study(
    py: Python<'_>,
    path: PathBuf,
    folder: PathBuf,
    failures: BTreeMap<String, String>,
) -> PyResult<String> {
    py.detach(|| {
        let study = Study::read(&path).map_err(input_error)?;
        let outcome = gather(&study, &folder, &failures).map_err(study_error)?;
        told(&study, &outcome.cases, &folder)
    })
}

/// Checks a study and lists the gears that it needs reduced and that are not in its folder yet: (path of the model,
/// text of the gear file). Changed copies of other files are written.
///
/// Raises InputError for a study, scene, key or column that is wrong.
#[pyfunction]
#[pyo3(signature = (path, folder, most_result_gb = 1.0))]
pub(crate) fn study_gears(
    py: Python<'_>,
    path: PathBuf,
    folder: PathBuf,
    most_result_gb: f64,
) -> PyResult<Vec<(PathBuf, String)>> {
    py.detach(|| {
        let study = study_at(&path, most_result_gb)?;
        let cases = StudyCases::new(&study, &folder).map_err(study_error)?;
        let mut gears = Vec::new();
        for (path, made) in cases.missing() {
            match made {
                MadeFile::Model(gear) => gears.push((path.to_owned(), gear.source.clone())),
                MadeFile::Text(text) => {
                    let beside = path.parent().unwrap_or(&folder);
                    std::fs::create_dir_all(beside).map_err(PyOSError::new_err)?;
                    write_text(path, text).map_err(file_error)?;
                }
            }
        }
        Ok(gears)
    })
}

/// A case as a tuple that can be sent: file, identity, text, title, named files, inputs.
type Sent = (
    String,
    String,
    String,
    String,
    Vec<(String, PathBuf)>,
    Vec<String>,
);

fn sent((file, identity, text, title, named, inputs): Sent) -> SentCase {
    SentCase {
        file,
        identity,
        text,
        title,
        named,
        inputs,
    }
}

/// The cases of a study, each scene once, when its gears are reduced.
#[pyfunction]
#[pyo3(signature = (path, folder, most_result_gb = 1.0))]
pub(crate) fn study_cases(
    py: Python<'_>,
    path: PathBuf,
    folder: PathBuf,
    most_result_gb: f64,
) -> PyResult<Vec<Sent>> {
    py.detach(|| {
        let study = study_at(&path, most_result_gb)?;
        let cases = StudyCases::new(&study, &folder).map_err(study_error)?;
        let cases = cases.list().map_err(study_error)?.into_iter();
        let tuple = |case: SentCase| {
            let SentCase {
                file,
                identity,
                text,
                title,
                named,
                inputs,
            } = case;
            (file, identity, text, title, named, inputs)
        };
        Ok(cases.map(tuple).collect())
    })
}

/// Runs cases that were sent, on one thread each; reads a model once.
#[pyclass(frozen, module = "gearmesh._native")]
pub(crate) struct NativeCaseRunner(Arc<CaseRunner>);

#[pymethods]
impl NativeCaseRunner {
    #[new]
    fn new() -> Self {
        Self(Arc::default())
    }

    /// Whether a folder has the whole file of a case.
    fn is_there(&self, py: Python<'_>, case: Sent, folder: PathBuf) -> bool {
        py.detach(|| CaseRunner::is_there(&sent(case), &folder))
    }

    /// Runs a case into a folder unless its file is there; whether it was computed. places: where files lie here that
    /// lie elsewhere where the case comes from.
    ///
    /// Raises InputError, WorkError, OSError.
    fn run(
        &self,
        py: Python<'_>,
        case: Sent,
        places: BTreeMap<PathBuf, PathBuf>,
        folder: PathBuf,
    ) -> PyResult<bool> {
        let runner = Arc::clone(&self.0);
        watched(py, None, OnInterrupt::Wait, move |watch| {
            let case = sent(case);
            // The scheduler counts a case as one thread.
            let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
            let pool = pool.map_err(|error| WorkError::new_err(error.to_string()))?;
            let computed = pool.install(|| runner.run(&case, &places, &folder, &watch.stop));
            computed
                .map_err(study_error)?
                .ok_or_else(|| PyKeyboardInterrupt::new_err(""))
        })
    }
}
