//! Columns of a bevel pair: those without load, and under the torques of its `[load]` those of any pair, a number for
//! each torque.

use std::sync::atomic::AtomicBool;

use super::cases::StudyError;
use super::pair_columns::{PairColumns, RestColumn, columns};
use super::rest_cases::RestFigures;
use super::rest_columns;
use crate::model_shelf::ModelShelf;
use crate::pair::BevelScene;
use crate::pair::bevel_result::BevelRest;

/// Names of all columns of a bevel pair.
///
/// # Errors
/// [`StudyError`] for a load whose models cannot be read.
pub(super) fn names(subject: &BevelScene, shelf: &ModelShelf) -> Result<Vec<String>, StudyError> {
    let mut names = rest_columns::bevel_names();
    if let Some(load) = &subject.file.load {
        let loaded = subject.load(shelf)?;
        let bevel = BevelRest {
            friction: load.friction,
            ..BevelRest::default()
        };
        let of_load = PairColumns {
            bevel: Some(bevel),
            points_per_pitch: loaded.points_per_pitch(),
            gauges: loaded.gauges(),
        };
        names.extend(of_load.names());
    }
    Ok(names)
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
pub(super) fn figures(subject: &BevelScene, shelf: &ModelShelf) -> Result<RestFigures, StudyError> {
    let unloaded = rest_columns::of_bevel(subject).map_err(StudyError::Bevel)?;
    let mut figures = RestFigures {
        torques_nm: Vec::new(),
        columns: Vec::new(),
    };
    let mut of_load = Vec::new();
    if subject.file.load.is_some() {
        let result = subject
            .load(shelf)?
            .run(&|_, _| (), &AtomicBool::new(false))?;
        of_load = columns(&result);
        figures.torques_nm = result.torque_nm;
    }
    let rows = figures.torques_nm.len().max(1);
    let without = rest_columns::bevel_names().into_iter().zip(unloaded);
    let without = without.map(|(name, value)| RestColumn {
        name,
        values: vec![value; rows],
    });
    figures.columns = without.chain(of_load).collect();
    Ok(figures)
}
