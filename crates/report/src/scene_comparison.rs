//! A whole result of a pair against a reference record: every quantity and torque that both have, as a rig on the
//! record's shaft would show it.

use crate::comparison::{ComparisonError, RigView, SeriesComparison, compare_with_column};
use crate::pair_orders::{PairOrders, Shaft};
use crate::quantity::Quantity;
use crate::record::ReferenceRecord;
use crate::result_series::{ResultSeriesError, series};
use gearmesh_scene::SceneResult;
use gearmesh_scene::periods::Coverage;
use gearmesh_signal::ShaftPeriod;

/// Why a result cannot be compared with a record.
#[derive(Debug, thiserror::Error)]
pub enum SceneComparisonError {
    /// The gears in the result cannot be read.
    #[error("the gear files kept in the result cannot be read; run the scene again")]
    Gears,
    /// The result does not cover a period.
    #[error("{quantity} of the result: {source}")]
    Series {
        /// The quantity.
        quantity: Quantity,
        /// What is missing.
        source: ResultSeriesError,
    },
    /// The record ends before a gauge's strain repeats.
    #[error(
        "{quantity} repeats after {period_pitches} pitches; the record is {revolutions} revolution(s) of {shaft}, {record_pitches} pitches, which holds no \
         whole number of that: give a record of whole revolutions of the gauge's gear (shaft and revolutions in record.toml)"
    )]
    StrainPeriod {
        /// The quantity.
        quantity: Quantity,
        /// Its period.
        period_pitches: usize,
        /// Revolutions of the record.
        revolutions: usize,
        /// Whose.
        shaft: Shaft,
        /// The same in pitches.
        record_pitches: usize,
    },
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

/// Orders of a record's shaft whose amplitudes of the transmission error are compared: mesh and openings, each with its
/// double. Those between the lines of a spectrum over the record's revolutions are left out: a record of so few turns
/// does not have them.
pub fn compared_orders(pair: &PairOrders, shaft: Shaft, revolutions: usize) -> Vec<f64> {
    let mut orders = pair.of_openings(shaft);
    orders.push(pair.teeth_on(shaft) as f64);
    let mut orders: Vec<f64> = orders.iter().flat_map(|n| [*n, 2.0 * n]).collect();
    let is_line = |order: &f64| {
        let line = order * revolutions as f64;
        (line - line.round()).abs() < 1e-9 * line
    };
    orders.retain(is_line);
    orders.sort_by(f64::total_cmp);
    orders.dedup();
    orders
}

/// Compares transmission error and the strain of method 2 with every matching column of a record.
///
/// # Errors
/// [`SceneComparisonError`] when the result does not cover a period or nothing matches.
pub fn compare_scene(
    result: &SceneResult,
    record: &ReferenceRecord,
) -> Result<Vec<SeriesComparison>, SceneComparisonError> {
    let pair = PairOrders::of(result).ok_or(SceneComparisonError::Gears)?;
    let mut quantities: Vec<(Quantity, Coverage, &[f64])> = vec![(
        Quantity::TransmissionError,
        result.contact_coverage,
        &result.te_m,
    )];
    for series in &result.strain {
        let gauge = series.name.clone();
        quantities.push((
            Quantity::Strain { gauge },
            series.coverage,
            &series.method_2,
        ));
    }
    let (shaft, revolutions) = (record.shaft, record.revolutions);
    let te_view = RigView::of(
        &pair,
        shaft,
        revolutions,
        compared_orders(&pair, shaft, revolutions),
    );
    // A gauge's spectrum is that of a short pulse and tells nothing order by order.
    let strain_view = RigView {
        orders: Vec::new(),
        ..te_view.clone()
    };
    let mut comparisons = Vec::new();
    for (quantity, coverage, values) in quantities {
        for (k, &torque) in result.torque_nm.iter().enumerate() {
            let Some(column) = record.column(&quantity, torque) else {
                continue;
            };
            let view = match quantity {
                Quantity::TransmissionError => &te_view,
                Quantity::Strain { .. } => {
                    refuse_strain_of_other_period(&quantity, &coverage, (&pair, record))?;
                    &strain_view
                }
            };
            let ours = series(result, &coverage, result.curve(values, k), (&pair, shaft));
            let ours = ours.map_err(|source| SceneComparisonError::Series {
                quantity: quantity.clone(),
                source,
            })?;
            let compared = compare_with_column(&ours, record, column, view)?;
            // A record of other revolutions averages what is not locked to them out of ours: it has another period
            // then.
            let own = ShaftPeriod::new(coverage.period_pitches, pair.teeth_on(shaft));
            let own = own.filter(|own| revolutions.is_multiple_of(own.whole_revolutions()));
            comparisons.push(match own {
                Some(period) => compared.with_offset_within(period),
                None => compared,
            });
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

/// Passages of a tooth cannot be averaged over revolutions in which it is somewhere else.
fn refuse_strain_of_other_period(
    quantity: &Quantity,
    coverage: &Coverage,
    (pair, record): (&PairOrders, &ReferenceRecord),
) -> Result<(), SceneComparisonError> {
    let teeth = pair.teeth_on(record.shaft);
    let period = ShaftPeriod::new(coverage.period_pitches, teeth);
    if period.is_some_and(|period| record.period().is_multiple_of(&period)) {
        return Ok(());
    }
    Err(SceneComparisonError::StrainPeriod {
        quantity: quantity.clone(),
        period_pitches: coverage.period_pitches,
        revolutions: record.revolutions,
        shaft: record.shaft,
        record_pitches: record.revolutions * teeth,
    })
}
