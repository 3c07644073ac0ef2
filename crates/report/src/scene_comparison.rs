//! A whole result against a reference record: every quantity and torque that both have.

use crate::comparison::{ComparisonError, SeriesComparison, compare_with_column};
use crate::quantity::Quantity;
use crate::record::ReferenceRecord;
use gearmesh_scene::SceneResult;
use gearmesh_signal::{AngleSeries, AngleSeriesError, RigSettings};

/// Why a result cannot be compared with a record.
#[derive(Debug, thiserror::Error)]
pub enum SceneComparisonError {
    /// The result does not cover a revolution.
    #[error("the result cannot be taken through the rig pipeline, which needs one whole revolution of the driver: {0}; set run.pitches to the driver's number of teeth")]
    Series(#[from] AngleSeriesError),
    /// The pipeline failed.
    #[error(transparent)]
    Comparison(#[from] ComparisonError),
    /// Nothing in common.
    #[error("result and record have no torque and quantity in common; the record has: {columns}")]
    NothingInCommon {
        /// Columns of the record.
        columns: String,
    },
}

/// Orders whose amplitudes are compared: the slots' third and its multiples, the mesh order and twice that.
fn orders(result: &SceneResult) -> Vec<f64> {
    let mesh = result.angle_rad.get(1).map_or(1.0, |second| {
        let pitch_points = scene_points_per_pitch(result);
        (std::f64::consts::TAU / ((second - result.angle_rad[0]) * pitch_points)).round()
    });
    vec![3.0, 6.0, mesh, 2.0 * mesh]
}

fn scene_points_per_pitch(result: &SceneResult) -> f64 {
    gearmesh_scene::Scene::from_document(
        gearmesh_geometry::input::InputDocument::new("scene in result", result.scene_toml.clone()),
        std::path::Path::new(""),
    )
    .map_or(1.0, |scene| scene.points_per_pitch as f64)
}

/// Compares transmission error and the strain of method 2 with every matching column of a record.
///
/// # Errors
/// [`SceneComparisonError`] when the result does not cover a revolution or nothing matches.
pub fn compare_scene(
    result: &SceneResult,
    record: &ReferenceRecord,
) -> Result<Vec<SeriesComparison>, SceneComparisonError> {
    let mut quantities: Vec<(Quantity, &[f64])> = vec![(Quantity::TransmissionError, &result.te_m)];
    for series in &result.strain {
        quantities.push((Quantity::Strain { gauge: series.name.clone() }, &series.method_2));
    }
    let settings = RigSettings::default();
    let orders = orders(result);
    let mut comparisons = Vec::new();
    for (quantity, values) in quantities {
        for (k, &torque) in result.torque_nm.iter().enumerate() {
            let Some(column) = record.column(&quantity, torque) else { continue };
            let ours = AngleSeries::one_revolution(&result.angle_rad, result.curve(values, k))?;
            comparisons.push(compare_with_column(&ours, record, column, &settings, &orders)?);
        }
    }
    if comparisons.is_empty() {
        let columns: Vec<&str> = record.columns.iter().map(|c| c.name.as_str()).collect();
        return Err(SceneComparisonError::NothingInCommon { columns: columns.join(", ") });
    }
    Ok(comparisons)
}
