//! What a name behind `-o` may end in: a file whose ending promises another format than is written misleads every program after.

use crate::failure::Failure;
use std::path::Path;

/// Endings of HDF5 files.
const HDF5: [&str; 2] = [".h5", ".hdf5"];

/// Endings of pages.
const PAGE: [&str; 2] = [".html", ".htm"];

/// Demands the ending of an HDF5 file.
///
/// # Errors
/// [`Failure`] that says what the command writes and how other formats are had.
pub fn demand_hdf5(path: &Path) -> Result<(), Failure> {
    demand(
        path,
        &HDF5,
        "HDF5",
        "; `gearmesh export` makes .csv, .parquet and .mat files of a result",
    )
}

/// Demands the ending of a page.
///
/// # Errors
/// [`Failure`] that says what the command writes.
pub fn demand_page(path: &Path) -> Result<(), Failure> {
    demand(path, &PAGE, "an HTML page", "")
}

/// Demands the ending of a mesh format that is written.
///
/// # Errors
/// [`Failure`] that lists them.
pub fn demand_mesh(path: &Path) -> Result<(), Failure> {
    demand(
        path,
        &gearmesh_model::EXPORT_ENDINGS,
        "a mesh for other programs",
        "",
    )
}

fn demand(path: &Path, endings: &[&str], what: &str, advice: &str) -> Result<(), Failure> {
    let name = path
        .file_name()
        .map(|name| name.to_string_lossy().to_lowercase());
    if name.is_some_and(|name| endings.iter().any(|ending| name.ends_with(ending))) {
        return Ok(());
    }
    Err(Failure::input(format!(
        "{}: this writes {what}; allowed are names that end in {}{advice}",
        path.display(),
        endings.join(" ")
    )))
}
