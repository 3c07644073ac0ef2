//! Universal files (data set 58) of measuring programs, read by pyuff in a Python process.

use crate::failure::{Failure, Result};
use crate::watch::Watch;
use gearmesh_geometry::input::{MOST_TEXT_BYTES, demand_readable};
use gearmesh_mesh::python::PythonError;
use gearmesh_report::export::Function;
use std::path::Path;

const READ: &str = include_str!("uff/read.py");

/// Reads all real functions of a file.
///
/// # Errors
/// [`Failure`] where Python or pyuff is missing, or the file is no universal file with functions, is cut, or holds what
/// is no number.
pub fn read(path: &Path, watch: &Watch<'_>) -> Result<Vec<Function>> {
    demand_readable(path, MOST_TEXT_BYTES)
        .map_err(|error| Failure::input(format!("{}: {error}", path.display())))?;
    let task = format!("reading {}", path.display());
    let told = watch
        .python()?
        .run(&task, READ, &[&path.display().to_string()], b"")
        .map_err(blame)?;
    // A line each.
    serde_json::Deserializer::from_slice(&told)
        .into_iter()
        .collect::<Result<_, _>>()
        .map_err(Failure::work)
}

/// Exit code 2 of the scripts is the file's fault.
fn blame(error: PythonError) -> Failure {
    match error {
        PythonError::Failed { code: Some(2), .. } => Failure::input(error),
        _ => Failure::work(error),
    }
}
