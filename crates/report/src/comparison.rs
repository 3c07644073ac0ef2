//! How far a computed series and a reference agree, both seen through the rig pipeline.

use crate::pair_orders::{PairOrders, Shaft};
use crate::quantity::Quantity;
use crate::record::{RecordColumn, ReferenceRecord};
use gearmesh_signal::rig::{OrderFilter, RigError, RigSettings, RigSignal, process};
use gearmesh_signal::statistics::{
    StatisticsError, correlation, largest_deviation, peak_to_peak, rms, rms_deviation,
};
use gearmesh_signal::{
    AngleSeries, AngleSeriesError, OrderError, SeriesError, ShaftPeriod, best_offset,
};

/// Why two series cannot be compared.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ComparisonError {
    /// The pipeline refused one of the series.
    #[error("{side} series of {quantity}: {source}")]
    Rig {
        /// "our" or "reference".
        side: &'static str,
        /// The quantity.
        quantity: Quantity,
        /// What the pipeline said.
        source: RigError,
    },
    /// The record's column is no periodic series.
    #[error("column '{column}' of the reference: {source}")]
    Column {
        /// Head of the column.
        column: String,
        /// What is wrong with it.
        source: AngleSeriesError,
    },
    /// An order that is asked for is not in the spectrum.
    #[error("harmonics of {quantity}: {source}")]
    Order {
        /// The quantity.
        quantity: Quantity,
        /// What the spectrum said.
        source: OrderError,
    },
    /// The offset could not be sought.
    #[error("angle offset of {quantity}: {source}")]
    Offset {
        /// The quantity.
        quantity: Quantity,
        /// What the transform said.
        source: SeriesError,
    },
    /// A statistic could not be made.
    #[error("statistics of {quantity}: {source}")]
    Statistics {
        /// The quantity.
        quantity: Quantity,
        /// What the statistic said.
        source: StatisticsError,
    },
}

/// Amplitudes of one order, SI units.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct HarmonicComparison {
    /// The order (periods in one revolution of the record's shaft).
    pub order: f64,
    /// Our amplitude of the cosine.
    pub ours: f64,
    /// The reference's amplitude of the cosine.
    pub reference: f64,
    /// Our phase minus the reference's, rad, in (−π, π].
    pub phase_difference_rad: f64,
}

/// One figure of both sides, SI units.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct BothSides {
    /// Ours.
    pub ours: f64,
    /// The reference's.
    pub reference: f64,
    /// Stated uncertainty of the reference's figure, if any.
    pub uncertainty: Option<f64>,
}

impl BothSides {
    /// ours/reference − 1: negative where ours is the smaller in size; `None` where the reference is zero.
    pub fn relative_difference(&self) -> Option<f64> {
        (self.reference != 0.0).then(|| self.ours / self.reference - 1.0)
    }
}

/// Where a reference has no values.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct ReferenceHole {
    /// Angle of the record's shaft before it, rad.
    pub from_rad: f64,
    /// Its length, rad.
    pub step_rad: f64,
    /// The same in mesh periods.
    pub mesh_periods: f64,
}

/// The comparison of one quantity at one torque. All figures but `mean` are of the filtered signals.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct SeriesComparison {
    /// What is compared.
    pub quantity: Quantity,
    /// Unit of all figures below: "m" for the transmission error, "1" for strain.
    pub si_unit: &'static str,
    /// Torque on the driven gear, N·m.
    pub torque_nm: f64,
    /// Peak-to-peak value (for strain: the range).
    pub peak_to_peak: BothSides,
    /// RMS.
    pub rms: BothSides,
    /// Mean before the filter.
    pub mean: BothSides,
    /// Amplitudes at the orders asked for.
    pub harmonics: Vec<HarmonicComparison>,
    /// Pearson's correlation; `None` where a signal is constant.
    pub correlation: Option<f64>,
    /// Largest |ours − reference|, with the sign of ours − reference.
    pub largest_deviation: f64,
    /// Angle of the record's shaft there, rad.
    pub largest_deviation_angle_rad: f64,
    /// RMS of ours − reference.
    pub rms_deviation: f64,
    /// By how much the reference's angles would have to be less for the best correlation, rad of the record's shaft;
    /// applied to nothing. `None` where a signal is constant.
    pub best_offset_rad: Option<f64>,
    /// The correlation that it would give.
    pub best_offset_correlation: Option<f64>,
    /// Whether the record holds whole periods of ours. Where it does not, what is not locked to the record's
    /// revolutions has been averaged out of ours, as a rig's averaging does.
    pub is_locked: bool,
    /// The widest step of the reference where it leaves out more than half a mesh period: there its curve and what
    /// depends on it are interpolated.
    pub reference_hole: Option<ReferenceHole>,
    /// Our signal as compared: filtered, one block of revolutions, uniform in the angle from 0.
    #[serde(skip)]
    pub ours: RigSignal,
    /// The reference's signal as compared.
    #[serde(skip)]
    pub reference: RigSignal,
}

/// How both sides are looked at.
#[derive(Debug, Clone, PartialEq)]
pub struct RigView {
    /// The rig. Its blocks are as long as the record; the recording is taken as long as our series needs.
    pub settings: RigSettings,
    /// What is taken out of the transmission error.
    pub te_filter: OrderFilter,
    /// Orders of the shaft whose amplitudes are compared.
    pub orders: Vec<f64>,
    /// Teeth on the shaft.
    pub mesh_order: f64,
}

impl RigView {
    /// The rig of pairs A and B (seed 004 in docs/sources.md) on a shaft of a pair, in blocks of so many of its
    /// revolutions.
    pub fn of(
        pair: &PairOrders,
        shaft: Shaft,
        revolutions_per_block: usize,
        orders: Vec<f64>,
    ) -> Self {
        Self {
            settings: RigSettings {
                revolutions_per_block,
                ..RigSettings::default()
            },
            te_filter: pair.filter(shaft),
            orders,
            mesh_order: pair.teeth_on(shaft) as f64,
        }
    }

    /// The widest step of a series, where it is more than half a mesh period.
    fn hole(&self, series: &AngleSeries) -> Option<ReferenceHole> {
        let widest = series.widest_step();
        let mesh_periods = widest.step_rad * self.mesh_order / std::f64::consts::TAU;
        (mesh_periods > 0.5).then_some(ReferenceHole {
            from_rad: widest.from_rad,
            step_rad: widest.step_rad,
            mesh_periods,
        })
    }
}

/// Compares our series with a column of a record.
///
/// # Errors
/// [`ComparisonError`].
pub fn compare_with_column(
    ours: &AngleSeries,
    record: &ReferenceRecord,
    column: &RecordColumn,
    view: &RigView,
) -> Result<SeriesComparison, ComparisonError> {
    let reference = record
        .series(column)
        .map_err(|source| ComparisonError::Column {
            column: column.name.clone(),
            source,
        })?;
    let mut comparison = compare(ours, &reference, &column.quantity, view)?;
    comparison.torque_nm = column.torque_nm;
    comparison.mean.uncertainty = record.uncertainty.mean(&column.quantity);
    comparison.peak_to_peak.uncertainty = record.uncertainty.peak_to_peak(&column.quantity);
    Ok(comparison)
}

/// Compares two series of a quantity, SI units, each over the angle of the same shaft from the same origin.
///
/// Both go through [`gearmesh_signal::rig::process`] with the same settings; of the transmission error the mean and
/// eccentricity are removed, of strain nothing. The signals are never shifted against each other. `torque_nm` is left
/// at 0 and no uncertainty is stated; [`compare_with_column`] knows both.
///
/// # Errors
/// [`ComparisonError`].
pub fn compare(
    ours: &AngleSeries,
    reference: &AngleSeries,
    quantity: &Quantity,
    view: &RigView,
) -> Result<SeriesComparison, ComparisonError> {
    let filter = match quantity {
        Quantity::TransmissionError => view.te_filter,
        Quantity::Strain { .. } => OrderFilter::KeepAll,
    };
    let per_block = view.settings.revolutions_per_block;
    let is_locked = per_block.is_multiple_of(ours.period().whole_revolutions());
    let settings = view.settings.in_blocks(per_block, ours.period());
    let reference_hole = view.hole(reference);
    let through = |side, series: &AngleSeries| {
        process(series, &settings, filter).map_err(|source| ComparisonError::Rig {
            side,
            quantity: quantity.clone(),
            source,
        })
    };
    let (ours, reference) = (through("our", ours)?, through("reference", reference)?);

    let statistic = |source| ComparisonError::Statistics {
        quantity: quantity.clone(),
        source,
    };
    let both = |figure: fn(&[f64]) -> Result<f64, StatisticsError>| {
        Ok(BothSides {
            ours: figure(&ours.values).map_err(statistic)?,
            reference: figure(&reference.values).map_err(statistic)?,
            uncertainty: None,
        })
    };
    let correlation = match correlation(&ours.values, &reference.values) {
        Ok(r) => Some(r),
        Err(StatisticsError::Constant) => None,
        Err(source) => return Err(statistic(source)),
    };
    let offset =
        best_offset(&ours.values, &reference.values).map_err(|source| ComparisonError::Offset {
            quantity: quantity.clone(),
            source,
        })?;
    let largest = largest_deviation(&ours.values, &reference.values).map_err(statistic)?;
    Ok(SeriesComparison {
        quantity: quantity.clone(),
        si_unit: quantity.si_unit(),
        torque_nm: 0.0,
        peak_to_peak: both(peak_to_peak)?,
        rms: both(rms)?,
        mean: BothSides {
            ours: ours.mean_before_filter,
            reference: reference.mean_before_filter,
            uncertainty: None,
        },
        harmonics: harmonics(&ours, &reference, &view.orders).map_err(|source| {
            ComparisonError::Order {
                quantity: quantity.clone(),
                source,
            }
        })?,
        correlation,
        largest_deviation: largest.value,
        largest_deviation_angle_rad: ours.angle_rad(largest.index),
        rms_deviation: rms_deviation(&ours.values, &reference.values).map_err(statistic)?,
        best_offset_rad: offset.map(|offset| offset.angle_rad(per_block)),
        best_offset_correlation: offset.map(|offset| offset.correlation),
        is_locked,
        reference_hole,
        ours,
        reference,
    })
}

impl SeriesComparison {
    /// Counts the best offset within half of our period to either side: turned by a period, ours is itself, and which
    /// of the equal offsets is the best is rounding.
    #[must_use]
    pub fn with_offset_within(mut self, period: ShaftPeriod) -> Self {
        let turn = period.rad();
        self.best_offset_rad = self
            .best_offset_rad
            .map(|angle| angle - turn * (angle / turn).round());
        self
    }
}

fn harmonics(
    ours: &RigSignal,
    reference: &RigSignal,
    orders: &[f64],
) -> Result<Vec<HarmonicComparison>, OrderError> {
    orders
        .iter()
        .map(|&order| {
            let a = ours.spectrum.coefficient(order)?;
            let b = reference.spectrum.coefficient(order)?;
            Ok(HarmonicComparison {
                order,
                ours: a.norm(),
                reference: b.norm(),
                phase_difference_rad: (a * b.conj()).arg(),
            })
        })
        .collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn view(orders: &[f64]) -> RigView {
        let pair = PairOrders {
            teeth: [57, 57],
            openings: [0, 3],
        };
        RigView::of(&pair, Shaft::Gear1, 1, orders.to_vec())
    }

    fn te(scale: f64, phase: f64, mean: f64) -> AngleSeries {
        let values: Vec<f64> = (0..1368)
            .map(|i| {
                let a = TAU * f64::from(i) / 1368.0;
                mean + 9e-6 * a.cos()
                    + scale * (2e-6 * (57.0 * a + phase).cos() + 1e-6 * (3.0 * a).cos())
            })
            .collect();
        AngleSeries::uniform(0.0, &values, 1).unwrap()
    }

    #[test]
    fn a_known_difference_is_found() {
        let (ours, reference) = (te(1.1, 0.25, -41e-6), te(1.0, 0.0, -40e-6));
        let c = compare(
            &ours,
            &reference,
            &Quantity::TransmissionError,
            &view(&[3.0, 57.0]),
        )
        .unwrap();
        assert!((c.mean.ours + 41e-6).abs() < 1e-12 && (c.mean.reference + 40e-6).abs() < 1e-12);
        assert!((c.rms.relative_difference().unwrap() - 0.1).abs() < 1e-6);
        assert!((c.mean.relative_difference().unwrap() - 0.025).abs() < 1e-6);
        assert!((c.harmonics[1].ours / c.harmonics[1].reference - 1.1).abs() < 1e-9);
        assert!((c.harmonics[1].phase_difference_rad - 0.25).abs() < 1e-9);
        assert!((c.harmonics[0].reference - 1e-6).abs() < 1e-12);
        // Of the two cosines only order 57 is out of phase: r = (1 + 4 cos 0.25) / 5.
        assert!((c.correlation.unwrap() - (1.0 + 4.0 * 0.25f64.cos()) / 5.0).abs() < 1e-6);
    }

    #[test]
    fn equal_series_agree_and_filters_follow_the_quantity() {
        let series = te(1.0, 0.0, -40e-6);
        let view_of_both = view(&[0.0, 1.0]);
        let c = compare(
            &series,
            &series,
            &Quantity::TransmissionError,
            &view_of_both,
        )
        .unwrap();
        assert_eq!((c.largest_deviation, c.rms_deviation), (0.0, 0.0));
        assert!((c.correlation.unwrap() - 1.0).abs() < 1e-12);
        assert_eq!(c.harmonics[0].ours + c.harmonics[1].ours, 0.0);
        let strain = Quantity::Strain {
            gauge: "t0_tension".into(),
        };
        let c = compare(&series, &series, &strain, &view_of_both).unwrap();
        assert!(
            (c.harmonics[0].ours - 40e-6).abs() < 1e-12
                && (c.harmonics[1].ours - 9e-6).abs() < 1e-12
        );
    }

    #[test]
    fn the_largest_deviation_is_where_it_was_put() {
        let reference = te(1.0, 0.0, 0.0);
        let values: Vec<f64> = (0..1368)
            .map(|i| {
                let a = TAU * f64::from(i) / 1368.0;
                reference.value(a) - 1e-6 * (-((a - 2.0) / 0.05).powi(2)).exp()
            })
            .collect();
        let ours = AngleSeries::uniform(0.0, &values, 1).unwrap();
        let strain = Quantity::Strain { gauge: "g".into() };
        let c = compare(&ours, &reference, &strain, &view(&[])).unwrap();
        assert!((c.largest_deviation + 1e-6).abs() < 1e-9);
        assert!((c.largest_deviation_angle_rad - 2.0).abs() < 2e-3);
    }

    #[test]
    fn an_order_beyond_the_spectrum_is_refused() {
        let series = te(1.0, 0.0, 0.0);
        let error = compare(
            &series,
            &series,
            &Quantity::TransmissionError,
            &view(&[2501.0]),
        );
        assert!(matches!(error, Err(ComparisonError::Order { .. })));
    }
}
