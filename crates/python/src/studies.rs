//! Studies whose cases other processes compute.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use gearmesh_geometry::InputError as InputComplaint;
use gearmesh_model::write_text;
use gearmesh_operations::study::{gather, refuse_overwriting, study as run_study};
use gearmesh_operations::{Failure, Watch};
use gearmesh_report::study_figures;
use gearmesh_scene::study::{CaseRunner, MadeFile, SentCase, StudyCases, StudyError};
use gearmesh_specification::study::Study;
use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;

use crate::errors::{file_error, input_error, raised};
use crate::watched::{OnInterrupt, watched};

fn study_error(error: StudyError) -> PyErr {
    raised(error.into())
}

/// Runs a study into a folder, as many cases at a time as there are processors: what `gearmesh study --json` prints.
/// interpreter is a Python with gmsh, for gears that have to be reduced. progress("study", done, count) hears how far
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
    let (progress, python) = (progress.as_ref(), Some(interpreter));
    watched(py, progress, OnInterrupt::Wait, python, move |watch| {
        let study = study_at(&path, most_result_gb)?;
        let outcome = run_study(&study, &folder, watch)?;
        Ok(study_figures(&study, &outcome.cases).to_string())
    })
}

/// A study file whose results may have this size together.
fn study_at(path: &Path, most_result_gb: f64) -> Result<Study, InputComplaint> {
    let mut study = Study::read(path)?;
    study.most_result_bytes = 1e9 * most_result_gb;
    Ok(study)
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
        let outcome = gather(&study, &folder, &failures, &Watch::unattended()).map_err(raised)?;
        Ok(study_figures(&study, &outcome.cases).to_string())
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
        let study = study_at(&path, most_result_gb).map_err(input_error)?;
        refuse_overwriting(&study, &folder).map_err(raised)?;
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
        let study = study_at(&path, most_result_gb).map_err(input_error)?;
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
        watched(py, None, OnInterrupt::Wait, None, move |watch| {
            let case = sent(case);
            // The scheduler counts a case as one thread.
            let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
            let pool = pool.map_err(Failure::work)?;
            let computed = pool.install(|| runner.run(&case, &places, &folder, watch.stop));
            computed?.ok_or_else(|| Failure::stopped(""))
        })
    }
}
