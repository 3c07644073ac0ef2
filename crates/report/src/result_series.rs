//! A curve of a pair's result as a periodic function of the angle of either shaft.

use gearmesh_scene::SceneResult;
use gearmesh_scene::periods::Coverage;
use gearmesh_signal::{AngleSeries, AngleSeriesError, ShaftPeriod};

use crate::pair_orders::{PairOrders, Shaft};

/// Why a curve is no periodic function.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ResultSeriesError {
    /// The run has less than a period.
    #[error(
        "the run goes through {run_pitches} of the {period_pitches} pitches after which it repeats{}",
        told(.proposal)
    )]
    NotCovered {
        /// Pitches run.
        run_pitches: usize,
        /// Pitches of a period.
        period_pitches: usize,
        /// A run that covers it, in words; empty where none is known.
        proposal: String,
    },
    /// Its angles or values are none.
    #[error(transparent)]
    Series(#[from] AngleSeriesError),
}

fn told(proposal: &str) -> String {
    if proposal.is_empty() {
        return "; set run.pitches to that".to_owned();
    }
    format!("; {proposal}")
}

/// One torque's `curve` over the angle of a shaft, made of whole periods.
///
/// # Errors
/// [`ResultSeriesError`] where the run does not cover a period.
pub fn series(
    result: &SceneResult,
    coverage: &Coverage,
    curve: &[f64],
    (pair, shaft): (&PairOrders, Shaft),
) -> Result<AngleSeries, ResultSeriesError> {
    let not_covered = || ResultSeriesError::NotCovered {
        run_pitches: coverage.run_pitches,
        period_pitches: coverage.period_pitches,
        proposal: result.proposal.clone(),
    };
    let pitches = (coverage.periodic_pitches(pair.teeth_on(shaft))).ok_or_else(not_covered)?;
    let period = ShaftPeriod::new(pitches, pair.teeth_on(shaft)).ok_or_else(not_covered)?;
    let points = pitches * result.points_per_pitch();
    let of_shaft = 1.0 / pair.driver_turns(shaft);
    let angle: Vec<f64> = result.angle_rad[..points]
        .iter()
        .map(|angle| angle * of_shaft)
        .collect();
    Ok(AngleSeries::new(&angle, &curve[..points], period)?)
}
