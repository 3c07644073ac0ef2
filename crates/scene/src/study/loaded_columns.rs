//! Columns of a bevel pair under the torques of its `[load]`: a number for each torque, behind those without load.

use std::path::Path;

use gearmesh_bevel::pair_file::LoadRequest;
use gearmesh_contact::mesh_stiffness::mesh_harmonics;
use gearmesh_drivetrain::LoadedContact;

use super::cases::StudyError;
use super::pair_columns::RestColumn;
use super::rest_cases::RestFigures;
use super::rest_columns;
use super::subject::BevelSubject;
use crate::bevel_load::{BevelTorque, LoadedBevel, bevel_figures, load_bevel};
use crate::pair::ModelShelf;
use crate::pair::figure_table::RestFigure;

/// Harmonics of the mesh that are listed.
const HARMONICS: usize = 3;

/// Names of all columns of a bevel pair.
#[must_use]
pub(super) fn names(subject: &BevelSubject) -> Vec<String> {
    let mut names = rest_columns::bevel_names();
    if subject.file.load.is_some() {
        let studied = bevel_figures().into_iter().filter(RestFigure::is_studied);
        names.extend(studied.map(|figure| figure.name_in_studies()));
        names.extend((1..=HARMONICS).map(|k| format!("loaded_te_harmonic_{k}_urad")));
    }
    names
}

/// Whether a column of a bevel pair is the same under every torque.
#[must_use]
pub(crate) fn is_without_load(column: &str) -> bool {
    rest_columns::bevel_names()
        .iter()
        .any(|name| name == column)
}

/// All columns of a bevel pair. Models are those of the shelf, which reads each once.
///
/// # Errors
/// [`StudyError`] where the flanks cannot be made or do not touch, a model cannot be read or is not that of the pair.
pub(super) fn figures(
    subject: &BevelSubject,
    shelf: &ModelShelf,
) -> Result<RestFigures, StudyError> {
    let mut rows = vec![rest_columns::of_bevel(subject).map_err(StudyError::Bevel)?];
    let mut torques_nm = Vec::new();
    if let Some(load) = &subject.file.load {
        let found = loaded(subject, load, shelf)?;
        let unloaded = rows.remove(0);
        let row = |of: &LoadedContact| [unloaded.clone(), of_torque(of, found.slices)].concat();
        rows.extend(found.found.iter().map(row));
        torques_nm.extend(found.found.iter().map(|of| of.torque_nm));
    }
    let column = |(i, name): (usize, String)| RestColumn {
        name,
        values: rows.iter().map(|row| row[i]).collect(),
    };
    Ok(RestFigures {
        torques_nm,
        columns: names(subject).into_iter().enumerate().map(column).collect(),
    })
}

fn loaded(
    subject: &BevelSubject,
    load: &LoadRequest,
    shelf: &ModelShelf,
) -> Result<LoadedBevel, StudyError> {
    let design = rest_columns::design(subject).map_err(StudyError::Bevel)?;
    let folder = Path::new(&subject.document.file).parent();
    let read = |file: &Path| shelf.model(&folder.unwrap_or(Path::new("")).join(file));
    let models = match &load.models {
        Some([pinion, gear]) => Some([read(pinion)?, read(gear)?]),
        None => None,
    };
    let members = models.as_ref().map(|[a, b]| [&*a.model, &*b.model]);
    Ok(load_bevel((&subject.file, &design), load, members)?)
}

/// In the order of [`names`].
fn of_torque(found: &LoadedContact, slices: usize) -> Vec<f64> {
    let studied = bevel_figures().into_iter().filter(RestFigure::is_studied);
    let torque = BevelTorque { found, slices };
    let mut values: Vec<f64> = studied
        .map(|figure| figure.studied(&torque, None))
        .collect();
    let error_rad: Vec<f64> = found.positions.iter().map(|p| p.error_rad).collect();
    let lines = mesh_harmonics(&error_rad, 1, HARMONICS).1;
    values.extend((0..HARMONICS).map(|k| 1e6 * lines.get(k).map_or(0.0, |line| line.0)));
    values
}
