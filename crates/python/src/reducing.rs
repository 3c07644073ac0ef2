//! The offline stage.

use std::path::{Path, PathBuf};

use gearmesh_geometry::input::InputDocument;
use gearmesh_operations::gear_file::GearFile;
use gearmesh_operations::overwriting::refuse_named;
use gearmesh_operations::reduce::{Reduction, reduce_to};
use pyo3::prelude::*;

use crate::watched::{OnInterrupt, watched};

/// Meshes and reduces the gear of a text, cylindrical or bevel, and writes the model. interpreter is a Python with gmsh
/// and meshio, which run in a process of their own. progress(stage, done, total) hears how far it is.
///
/// Raises InputError, WorkError, OSError; KeyboardInterrupt on Ctrl-C, and no model is written.
#[pyfunction]
#[pyo3(signature = (text, file, output, interpreter, error_estimate, progress, even_if_memory_is_short = false))]
#[allow(clippy::too_many_arguments)]
pub(crate) fn reduce(
    py: Python<'_>,
    text: String,
    file: String,
    output: PathBuf,
    interpreter: PathBuf,
    error_estimate: bool,
    progress: Option<Bound<'_, PyAny>>,
    even_if_memory_is_short: bool,
) -> PyResult<()> {
    let how = Reduction {
        estimate_error: error_estimate,
        even_if_memory_is_short,
    };
    let (progress, python) = (progress.as_ref(), Some(interpreter));
    watched(py, progress, OnInterrupt::Leave, python, move |watch| {
        let folder = Path::new(&file).parent().unwrap_or(Path::new(""));
        refuse_named(&text, [Path::new(&file), folder], &output)?;
        let gear = GearFile::of(&InputDocument::new(file, text), watch)?;
        reduce_to(&gear, how, &output, watch).map(|_| ())
    })
}
