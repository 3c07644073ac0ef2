//! Universal files (data set 58), which measuring programs read and write, by pyuff in a Python process.

use crate::failure::Failure;
use crate::watch::Watch;
use gearmesh_geometry::input::{MOST_TEXT_BYTES, demand_readable};
use gearmesh_mesh::python::PythonError;
use gearmesh_model::write_by;
use gearmesh_report::export::Function;
use serde_json::json;
use std::path::Path;

const WRITE: &str = include_str!("uff/write.py");
const READ: &str = include_str!("uff/read.py");

/// Writes functions; `title` is that of the result.
///
/// # Errors
/// [`Failure`] where Python or pyuff is missing or the file cannot be written; the file is then as it was.
pub fn write(
    path: &Path,
    title: &str,
    functions: &[Function],
    watch: &Watch<'_>,
) -> Result<(), Failure> {
    let program = format!("gearmesh {}", env!("CARGO_PKG_VERSION"));
    let input = json!({ "functions": functions, "title": title, "program": program }).to_string();
    write_by(path, |beside| {
        let task = format!("writing {}", path.display());
        let beside = beside.display().to_string();
        let python = watch.python()?;
        python
            .run(&task, WRITE, &[&beside], input.as_bytes())
            .map(|_| ())
            .map_err(blame)
    })
}

/// Reads all real functions of a file.
///
/// # Errors
/// [`Failure`] where Python or pyuff is missing, or the file is no universal file with functions, is cut, or holds what is no number.
pub fn read(path: &Path, watch: &Watch<'_>) -> Result<Vec<Function>, Failure> {
    demand_readable(path, MOST_TEXT_BYTES)
        .map_err(|error| Failure::input(format!("{}: {error}", path.display())))?;
    let task = format!("reading {}", path.display());
    let told = watch
        .python()?
        .run(&task, READ, &[&path.display().to_string()], b"")
        .map_err(blame)?;
    serde_json::from_slice(&told).map_err(Failure::work)
}

/// Exit code 2 of the scripts is the file's fault.
fn blame(error: PythonError) -> Failure {
    match error {
        PythonError::Failed { code: Some(2), .. } => Failure::input(error),
        _ => Failure::work(error),
    }
}
