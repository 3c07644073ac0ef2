//! Files that a scene names and a study changes: their texts, and whether a changed text is still a file of its kind.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use gearmesh_bearings::bearing_file::BearingFromFile;
use gearmesh_bevel::PairFile;
use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{GearDefinition, InputError};
use gearmesh_model::read_reduced_gear;

use super::subject::is_bearing;
use crate::scene_file::InputKind;

/// Checks a changed gear, bevel pair or bearing file, so that a wrong key is reported before anything is computed;
/// files of other kinds are left to who reads them.
///
/// # Errors
/// [`InputError`] with the key, what was found and what is allowed.
pub(super) fn check(document: &InputDocument) -> Result<(), InputError> {
    if PairFile::recognises(document)? {
        PairFile::from_document(document)?;
    } else if is_bearing(document)? {
        BearingFromFile::from_document(document)?;
    } else if document.has("tooth") && InputKind::of(document)? == InputKind::Gear {
        GearDefinition::from_document(document)?;
    }
    Ok(())
}

/// Whether a file is a reduced model.
pub(super) fn is_hdf5(path: &Path) -> bool {
    path.extension().is_some_and(|e| e == "h5")
}

/// The text of a file, of a model that of its gear.
pub(super) fn file_text(path: &Path) -> Result<String, InputError> {
    if !is_hdf5(path) {
        return Ok(InputDocument::read(path)?.text);
    }
    let model = read_reduced_gear(path);
    let model = model.map_err(|error| InputError::of_file(path.display(), error))?;
    Ok(model.input.text)
}

/// A copy stands elsewhere: files that it names keep their places.
pub(super) fn absolute_names(value: &mut toml::Value, named: &BTreeMap<String, PathBuf>) {
    match value {
        toml::Value::String(name) => {
            if let Some(path) = named.get(name) {
                let path = std::path::absolute(path).unwrap_or_else(|_| path.clone());
                *name = path.display().to_string();
            }
        }
        toml::Value::Array(items) => items.iter_mut().for_each(|v| absolute_names(v, named)),
        toml::Value::Table(table) => {
            table.iter_mut().for_each(|(_, v)| absolute_names(v, named));
        }
        _ => {}
    }
}
