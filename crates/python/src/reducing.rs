//! The offline stage.

use std::path::PathBuf;

use gearmesh_geometry::GearDefinition;
use gearmesh_geometry::input::InputDocument;
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_model::write_reduced_gear;
use gearmesh_reduction::{ReductionOptions, read_body, reduce as reduce_gear, reduce_imported};
use pyo3::exceptions::PyOSError;
use pyo3::prelude::*;

use crate::errors::{file_error, input_error, reduction_error};
use crate::watched::{OnInterrupt, watched};

/// Meshes and reduces the gear of a text and writes the model. interpreter is a Python with gmsh and meshio, which run
/// in a process of their own. progress(stage, done, total) hears how far it is.
///
/// Raises InputError, WorkError, OSError. On Ctrl-C the call ends at once, the computation in the background; no model
/// is written.
#[pyfunction]
#[pyo3(signature = (text, file, output, interpreter, error_estimate, progress))]
pub(crate) fn reduce(
    py: Python<'_>,
    text: String,
    file: String,
    output: PathBuf,
    interpreter: PathBuf,
    error_estimate: bool,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<()> {
    watched(py, progress.as_ref(), OnInterrupt::Leave, move |watch| {
        let document = InputDocument::new(file, text);
        let gear = GearDefinition::from_document(&document).map_err(input_error)?;
        let python = PythonEnvironment::at(interpreter);
        let model = match gear.blank.meshed() {
            Some(body) => {
                let folder = tempfile::tempdir().map_err(PyOSError::new_err)?;
                let mesh = read_body(body, &python, &folder.path().join("mesh.h5"));
                mesh.and_then(|mesh| reduce_imported(&gear, body, mesh, watch))
            }
            None => {
                let options = ReductionOptions {
                    estimate_error: error_estimate,
                };
                reduce_gear(&gear, &python, options, watch).map(|(model, _)| model)
            }
        };
        let model = model.map_err(reduction_error)?;
        if watch.stop.load(std::sync::atomic::Ordering::Relaxed) {
            return Ok(());
        }
        write_reduced_gear(&output, &model).map_err(file_error)
    })
}
