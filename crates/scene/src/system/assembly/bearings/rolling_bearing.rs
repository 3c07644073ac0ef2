//! The bearing file that a model names.

use std::path::Path;

use gearmesh_bearings::BearingDefinition;
use gearmesh_bearings::bearing_file::BearingFromFile;
use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{InputDocument, TableKeys};

/// As [`definition`], for balls that move: what they lose is the slip of their contacts, which a torque would count
/// twice.
pub(in crate::system::assembly) fn without_friction(
    key: &str,
    file: &str,
    folder: &Path,
    keys: &TableKeys<'_>,
) -> Result<BearingDefinition, InputError> {
    let found = definition(key, file, folder, keys)?;
    if found.friction.is_some() {
        let problem = format!(
            "the bearing file {file} has [friction], which `dynamic` bearings do not use: what their balls lose is the slip of `traction`, and a torque would count it twice; remove the table, or take the model `quasi-static`, or `linear` with tangent_of"
        );
        return Err(keys.error(key, problem));
    }
    Ok(found)
}

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
