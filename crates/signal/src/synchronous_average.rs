//! Time-synchronous average: what repeats with a shaft or a mesh stays, everything else falls with the number of
//! periods.
//!
//! The samples are uniform in the angle, with a whole number P of samples in the period that is averaged over (a turn,
//! or a mesh period; resample to such a grid first, see [`crate::resampling`]):
//!
//! ```text
//! average_j = (1/n) Σ_{r<n} x_{j + rP},        residual = x − average, repeated
//! ```
//!
//! A tone of order ν (in periods) comes out multiplied by the comb's gain |sin(πnν)/(n sin(πν))|: 1 for whole ν, at
//! most 1/(n
//! |sin πν|) otherwise (P. D. McFadden, Mechanical Systems and Signal Processing 1 (1987) 83).

use crate::error::{SeriesError, check_samples, check_setting};
use crate::statistics::kurtosis;

/// The average over the periods, and what it leaves.
#[derive(Debug, Clone, PartialEq)]
pub struct SynchronousAverage {
    /// One period; sample j is j/P of the period after the first sample.
    pub average: Vec<f64>,
    /// Periods averaged.
    pub periods: usize,
    /// Samples minus the average, over the averaged periods.
    pub residual: Vec<f64>,
    /// Kurtosis of the residual (3 for Gaussian noise, above for impulses); none where the residual is zero to
    /// rounding.
    pub residual_kurtosis: Option<f64>,
}

/// Averages the first `periods` periods of `samples_per_period` samples each.
///
/// # Errors
/// [`SeriesError::Setting`] for no period or a period of no samples, [`SeriesError::TooShort`] if the series is shorter
/// than that, [`SeriesError::NotFinite`].
pub fn synchronous_average(
    samples: &[f64],
    samples_per_period: usize,
    periods: usize,
) -> Result<SynchronousAverage, SeriesError> {
    check_setting(
        "samples per period",
        samples_per_period as f64,
        samples_per_period > 0,
        "1 or more",
    )?;
    check_setting("periods", periods as f64, periods > 0, "1 or more")?;
    let needed = samples_per_period.saturating_mul(periods);
    check_samples("a synchronous average", samples, needed)?;
    let used = &samples[..needed];
    let mut average = vec![0.0; samples_per_period];
    for period in used.chunks_exact(samples_per_period) {
        for (sum, value) in average.iter_mut().zip(period) {
            *sum += value;
        }
    }
    average.iter_mut().for_each(|v| *v /= periods as f64);
    let residual: Vec<f64> = used
        .iter()
        .zip(average.iter().cycle())
        .map(|(x, mean)| x - mean)
        .collect();
    let largest = used.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    // Below this the residual is the rounding of the sums, whose kurtosis says nothing.
    let rounding = 8.0 * f64::EPSILON * largest * periods as f64;
    let residual_kurtosis = if residual.iter().all(|v| v.abs() <= rounding) {
        None
    } else {
        kurtosis(&residual).ok()
    };
    Ok(SynchronousAverage {
        average,
        periods,
        residual,
        residual_kurtosis,
    })
}
