//! Texts of files: TOML from Python's dicts and back, what may be in them, whether they are sound.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use gearmesh_geometry::GearDefinition;
use gearmesh_geometry::input::InputDocument;
use gearmesh_scene::{SceneFile, named_files, renamed_files};
use pyo3::prelude::*;

use crate::errors::{InputError, file_error, input_error};

/// The document of a file's text; of a JSON object where there is no file.
///
/// Raises InputError for what TOML cannot hold.
pub(crate) fn document(source: &str, file: &str, folder: &Path) -> PyResult<InputDocument> {
    if file.is_empty() {
        InputDocument::of_values(&table(source)?, folder).map_err(input_error)
    } else {
        Ok(InputDocument::new(file, source))
    }
}

fn table(json: &str) -> PyResult<toml::Table> {
    serde_json::from_str(json).map_err(|error| InputError::new_err(error.to_string()))
}

/// TOML text of a JSON object.
///
/// Raises InputError for what TOML cannot hold: null, or numbers beyond 64 bits.
#[pyfunction]
pub(crate) fn toml_from_json(json: &str) -> PyResult<String> {
    toml::to_string(&table(json)?).map_err(|error| InputError::new_err(error.to_string()))
}

/// JSON text of a TOML document; file is its name in complaints. Raises InputError for a text that is no TOML.
#[pyfunction]
pub(crate) fn json_from_toml(text: &str, file: &str) -> PyResult<String> {
    let table = InputDocument::new(file, text)
        .table()
        .map_err(input_error)?;
    serde_json::to_string(&table).map_err(|error| InputError::new_err(error.to_string()))
}

/// Writes a text file whole or not at all. Raises InputError where the path is a link or no file, OSError.
#[pyfunction]
pub(crate) fn write_text(path: PathBuf, text: &str) -> PyResult<()> {
    gearmesh_model::write_text(&path, text).map_err(file_error)
}

/// JSON Schema (draft 2020-12) of gear, scene, study or optimise files, as text.
#[pyfunction]
pub(crate) fn schema(kind: &str) -> PyResult<String> {
    let schema = match kind {
        "gear" => gearmesh_geometry::gear_file::schema(),
        "scene" => gearmesh_specification::schema::scene(),
        "study" => gearmesh_specification::schema::study(),
        "optimise" => gearmesh_specification::schema::optimise(),
        other => {
            return Err(InputError::new_err(format!(
                "kind: found {other:?}, allowed are \"gear\", \"scene\", \"study\", \"optimise\""
            )));
        }
    };
    Ok(schema.to_value().to_string())
}

/// Checks a gear file's text. Returns (name, teeth, tip, pitch, root and base radius in m, notes).
///
/// Notes are numbers that look like those of another unit. Raises InputError with the place of what is wrong.
#[pyfunction]
pub(crate) fn check_gear(
    text: &str,
    file: &str,
) -> PyResult<(String, usize, [f64; 4], Vec<String>)> {
    let document = InputDocument::new(file, text);
    let gear = GearDefinition::from_document(&document).map_err(input_error)?;
    let profile = &gear.profile;
    let radii_m = [
        profile.tip_radius_m,
        profile.reference_radius_m,
        profile.root_radius_m,
        profile.base_radius_m,
    ];
    let slips = document.unit_slips();
    let notes = slips.iter().map(ToString::to_string).collect();
    Ok((gear.name, profile.teeth, radii_m, notes))
}

/// Checks a scene's text, or its tables as JSON where file is empty; other files are relative to folder. Returns (kind,
/// title): kind is "pair" or "system".
///
/// Files that the scene names are not opened. Raises InputError with the place of what is wrong.
#[pyfunction]
pub(crate) fn check_scene(
    source: &str,
    file: &str,
    folder: PathBuf,
) -> PyResult<(&'static str, String)> {
    let document = document(source, file, &folder)?;
    let scene = SceneFile::from_document(document, &folder).map_err(input_error)?;
    let kind = match &scene {
        SceneFile::Pair(_) | SceneFile::Bevel(_) => "pair",
        SceneFile::System(_) => "system",
    };
    Ok((kind, scene.title().to_owned()))
}

/// The files that a TOML text names, relative to folder: (name in the text, path).
#[pyfunction]
pub(crate) fn files_of(text: &str, folder: PathBuf) -> Vec<(String, PathBuf)> {
    named_files(text, &folder).into_iter().collect()
}

/// The text with other names of files. Raises InputError where it is no TOML.
#[pyfunction]
pub(crate) fn with_files(text: &str, names: BTreeMap<String, String>) -> PyResult<String> {
    renamed_files(text, &names).map_err(InputError::new_err)
}
