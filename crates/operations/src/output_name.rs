//! What a name behind `-o` may end in: a file whose ending promises another format than is written misleads every
//! program after.

use crate::failure::{Failure, Result};
use std::path::Path;

/// Endings of HDF5 files.
const HDF5: [&str; 2] = [".h5", ".hdf5"];

/// Endings of what `gearmesh export` writes: tables, series of moving gears, CAD.
const EXPORT: [&str; 8] = [
    ".csv", ".parquet", ".mat", ".uff", ".unv", ".pvd", ".step", ".stp",
];

/// Endings of measured curves.
const MEASURED: [&str; 5] = [".csv", ".txt", ".uff", ".unv", ".uf"];

/// Endings of pages.
const PAGE: [&str; 2] = [".html", ".htm"];

/// Demands the ending of an HDF5 file.
///
/// # Errors
/// [`Failure`] that says what the command writes and how other formats are had.
pub fn demand_hdf5(path: &Path) -> Result<()> {
    demand(
        path,
        &HDF5,
        "HDF5",
        "; `gearmesh export` makes tables of a result: .csv .parquet .mat .uff",
    )
    .map(|_| ())
}

/// Demands the ending of a page.
///
/// # Errors
/// [`Failure`] that says what the command writes.
pub fn demand_page(path: &Path) -> Result<()> {
    demand(path, &PAGE, "an HTML page", "").map(|_| ())
}

/// Demands the ending of a page of what stands behind `--report`.
///
/// # Errors
/// As [`demand_page`], with the option.
pub fn demand_report(path: &Path) -> Result<()> {
    demand_page(path).map_err(|problem| Failure::input(format!("--report: {}", problem.message)))
}

/// Demands the ending of a mesh format that is written.
///
/// # Errors
/// [`Failure`] that lists them.
pub fn demand_mesh(path: &Path) -> Result<()> {
    demand(
        path,
        &gearmesh_model::EXPORT_ENDINGS,
        "a mesh for other programs",
        "",
    )
    .map(|_| ())
}

/// Which of the formats of `gearmesh export` a name ends in.
///
/// # Errors
/// [`Failure`] that lists them.
pub fn export_ending(path: &Path) -> Result<&'static str> {
    demand(path, &EXPORT, "tables, series of moving gears or CAD", "")
}

/// In which form curves were measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Measured {
    /// Columns of text.
    Table,
    /// A universal file.
    Universal,
}

/// What the name of a file with measured curves says about its form.
///
/// # Errors
/// [`Failure`] that lists the endings.
pub fn measured_ending(path: &Path) -> Result<Measured> {
    let name = path.to_string_lossy().to_lowercase();
    match MEASURED.iter().find(|ending| name.ends_with(**ending)) {
        Some(&(".csv" | ".txt")) => Ok(Measured::Table),
        Some(_) => Ok(Measured::Universal),
        None => Err(Failure::input(format!(
            "{}: this reads measured curves; allowed are names that end in {}",
            path.display(),
            MEASURED.join(" ")
        ))),
    }
}

/// The ending that a name has.
fn demand(path: &Path, endings: &[&'static str], what: &str, advice: &str) -> Result<&'static str> {
    let name = path.file_name().unwrap_or_default();
    let name = name.to_string_lossy().to_lowercase();
    let found = endings.iter().find(|ending| name.ends_with(**ending));
    found.copied().ok_or_else(|| {
        Failure::input(format!(
            "{}: this writes {what}; allowed are names that end in {}{advice}",
            path.display(),
            endings.join(" ")
        ))
    })
}
