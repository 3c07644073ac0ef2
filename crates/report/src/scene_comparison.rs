//! A whole result against a reference record: every quantity and torque that both have.

use crate::comparison::{ComparisonError, SeriesComparison, compare_with_column};
use crate::quantity::Quantity;
use crate::record::ReferenceRecord;
use gearmesh_geometry::GearDefinition;
use gearmesh_geometry::input::InputDocument;
use gearmesh_scene::SceneResult;
use gearmesh_signal::{AngleSeries, AngleSeriesError, RigSettings};

/// Why a result cannot be compared with a record.
#[derive(Debug, thiserror::Error)]
pub enum SceneComparisonError {
    /// The result does not cover a revolution.
    #[error(
        "the result cannot be taken through the rig pipeline, which needs one whole revolution of the driver: {0}; set run.pitches to the driver's number of teeth"
    )]
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

/// Order of the mesh: teeth of the driver, as its gear file in the result says; 1 where that cannot be read.
pub fn mesh_order(result: &SceneResult) -> f64 {
    GearDefinition::from_document(&InputDocument::new(
        "gear in result",
        result.gear_toml[0].clone(),
    ))
    .map_or(1.0, |gear| gear.tooth.teeth as f64)
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
        quantities.push((
            Quantity::Strain {
                gauge: series.name.clone(),
            },
            &series.method_2,
        ));
    }
    let settings = RigSettings::default();
    let mesh = mesh_order(result);
    let mut te_orders = vec![mesh, 2.0 * mesh];
    te_orders.extend(blank_orders(result).iter().flat_map(|n| [*n, 2.0 * n]));
    te_orders.sort_by(f64::total_cmp);
    let mut comparisons = Vec::new();
    for (quantity, values) in quantities {
        for (k, &torque) in result.torque_nm.iter().enumerate() {
            let Some(column) = record.column(&quantity, torque) else {
                continue;
            };
            let ours = AngleSeries::one_revolution(&result.angle_rad, result.curve(values, k))?;
            // A gauge's spectrum is that of a short pulse and tells nothing order by order.
            let orders = match quantity {
                Quantity::TransmissionError => te_orders.as_slice(),
                Quantity::Strain { .. } => &[],
            };
            comparisons.push(compare_with_column(
                &ours, record, column, &settings, orders,
            )?);
        }
    }
    if comparisons.is_empty() {
        let columns: Vec<&str> = record.columns.iter().map(|c| c.name.as_str()).collect();
        return Err(SceneComparisonError::NothingInCommon {
            columns: columns.join(", "),
        });
    }
    Ok(comparisons)
}

/// Orders, per revolution of gear 1, at which slots or holes of the blanks repeat.
pub fn blank_orders(result: &SceneResult) -> Vec<f64> {
    let gears = result.gear_toml.each_ref().map(|text| {
        GearDefinition::from_document(&InputDocument::new("gear in result", text.clone())).ok()
    });
    let [Some(gear_1), Some(gear_2)] = gears else {
        return Vec::new();
    };
    let ratio = gear_1.tooth.teeth as f64 / gear_2.tooth.teeth as f64;
    let mut orders: Vec<f64> = [(gear_1, 1.0), (gear_2, ratio)]
        .into_iter()
        .filter_map(|(gear, turns)| Some(gear.blank.openings?.count() as f64 * turns))
        .collect();
    orders.sort_by(f64::total_cmp);
    orders.dedup();
    orders
}
