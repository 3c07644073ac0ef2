//! The bearing file that a model names.

use std::path::Path;

use gearmesh_bearings::BearingDefinition;
use gearmesh_bearings::bearing_file::BearingFromFile;
use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{InputDocument, TableKeys};

/// Reads it; `key` names it.
pub(in crate::system::assembly) fn definition(
    key: &str,
    file: &str,
    folder: &Path,
    keys: &TableKeys<'_>,
) -> Result<BearingDefinition, InputError> {
    Ok(read(key, file, folder, keys)?.definition)
}

/// Everything that the file says.
pub(super) fn read(
    key: &str,
    file: &str,
    folder: &Path,
    keys: &TableKeys<'_>,
) -> Result<BearingFromFile, InputError> {
    let path = folder.join(file);
    if !path.exists() {
        let problem = format!("the bearing file {} does not exist", path.display());
        return Err(keys.error(key, problem));
    }
    BearingFromFile::from_document(&InputDocument::read(&path)?)
}
