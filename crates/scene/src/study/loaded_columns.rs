//! Columns of a bevel pair: those without load, and under the torques of its `[load]` those of any pair, a number for
//! each torque.

use std::sync::atomic::AtomicBool;

use super::cases::StudyError;
use super::pair_columns::{PairColumns, RestColumn, columns};
use super::rest_cases::RestFigures;
use super::rest_columns;
use crate::model_shelf::ModelShelf;
use crate::pair::bevel_result::BevelRest;
use crate::pair::{BevelScene, SceneResult};

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

impl RestFigures {
    /// All columns of a bevel pair, and its result under the torques of its `[load]`, if it has any. Models are those
    /// of the shelf, which reads each once.
    ///
    /// # Errors
    /// [`StudyError`] where the flanks cannot be made or do not touch, a model cannot be read or is not that of the
    /// pair, and once `stop` is set.
    pub fn solved_bevel(
        subject: &BevelScene,
        shelf: &ModelShelf,
        stop: &AtomicBool,
    ) -> Result<(Self, Option<SceneResult>), StudyError> {
        // Both sides need the flanks: they are made once.
        let load = || -> Result<Option<SceneResult>, StudyError> {
            if subject.file.load.is_none() {
                return Ok(None);
            }
            Ok(Some(subject.load(shelf)?.run(&|_, _| (), stop)?))
        };
        let (unloaded, result) = rayon::join(|| rest_columns::of_bevel(subject), load);
        // A fault of the assembly is said in the words of the analysis without load.
        let unloaded = unloaded.map_err(StudyError::Bevel)?;
        let result = result?;
        let figures = Self::of_columns(unloaded, result.as_ref());
        Ok((figures, result))
    }

    /// All columns of a bevel pair whose torques, if it has any, are solved.
    ///
    /// # Errors
    /// [`StudyError`] where the flanks cannot be made or do not touch.
    pub fn of_bevel(
        subject: &BevelScene,
        result: Option<&SceneResult>,
    ) -> Result<Self, StudyError> {
        let unloaded = rest_columns::of_bevel(subject).map_err(StudyError::Bevel)?;
        Ok(Self::of_columns(unloaded, result))
    }

    fn of_columns(unloaded: Vec<f64>, result: Option<&SceneResult>) -> Self {
        let torques_nm = result.map_or_else(Vec::new, |result| result.torque_nm.clone());
        let rows = torques_nm.len().max(1);
        let without = rest_columns::bevel_names().into_iter().zip(unloaded);
        let without = without.map(|(name, value)| RestColumn {
            name,
            values: vec![value; rows],
        });
        let of_load = result.map_or_else(Vec::new, columns);
        Self {
            columns: without.chain(of_load).collect(),
            torques_nm,
        }
    }
}
