//! Operations by name.

use std::path::PathBuf;

use gearmesh_operations::Failure;
use gearmesh_operations::by_name::call;
use pyo3::prelude::*;

use crate::watched::{OnInterrupt, watched};

/// Does an operation of gearmesh-operations: its request and its figures are JSON. interpreter is a Python with gmsh
/// and meshio. progress(stage, done, total) hears how far it is.
///
/// Raises InputError, WorkError, OSError, MemoryError; KeyboardInterrupt on Ctrl-C.
#[pyfunction]
#[pyo3(signature = (name, request, interpreter, progress))]
pub(crate) fn operate(
    py: Python<'_>,
    name: String,
    request: String,
    interpreter: PathBuf,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<String> {
    // What was tried until then is written.
    let on_interrupt = match &*name {
        "optimise" => OnInterrupt::Wait,
        _ => OnInterrupt::Leave,
    };
    let (progress, python) = (progress.as_ref(), Some(interpreter));
    watched(py, progress, on_interrupt, python, move |watch| {
        let request = serde_json::from_str(&request).map_err(Failure::input)?;
        Ok(call(&name, request, watch)?.to_string())
    })
}
