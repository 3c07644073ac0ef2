//! S-N tables in files that a scene names.

use std::path::Path;

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{InputDocument, TableKeys};
use gearmesh_rating::{SnCurve, SnError, SnTable, SnTableError};

/// Reads an S-N table; complaints name its file, line and key, that of the scene where there is no such file.
///
/// # Errors
/// [`InputError`].
pub fn read_sn_table(path: &Path, keys: &TableKeys<'_>) -> Result<SnCurve, InputError> {
    if !path.is_file() {
        let problem = format!("the S-N table {} does not exist", path.display());
        return Err(keys.error("sn_table", problem));
    }
    sn_curve(&InputDocument::read(path)?)
}

/// The curve of an S-N table that is already in memory.
///
/// # Errors
/// [`InputError`].
pub fn sn_curve(document: &InputDocument) -> Result<SnCurve, InputError> {
    let table: SnTable = document.parse()?;
    table
        .curve()
        .map_err(|error| document.error(&place(&error), error))
}

/// The key that a complaint about an S-N table is about.
fn place(error: &SnTableError) -> String {
    let amplitude = |row: &usize| format!("stress_amplitude_MPa.{}", row - 1);
    let cycles = |row: &usize| format!("cycles.{}", row - 1);
    match error {
        SnTableError::SlopeBelow | SnTableError::Curve(SnError::Slope { .. }) => "below".into(),
        SnTableError::Curve(SnError::NotDecreasing { row, .. }) => amplitude(row),
        SnTableError::Curve(SnError::CyclesNotIncreasing { row, .. }) => cycles(row),
        SnTableError::Curve(SnError::NotPositive { row, what, .. }) if *what == "cycles" => {
            cycles(row)
        }
        SnTableError::Curve(SnError::NotPositive { row, .. }) => amplitude(row),
        _ => "cycles".into(),
    }
}
