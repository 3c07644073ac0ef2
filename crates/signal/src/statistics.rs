//! Figures of one signal and of two signals on the same grid.

/// Why a figure cannot be made.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum StatisticsError {
    /// No samples at all.
    #[error("no samples: a statistic needs at least one")]
    Empty,
    /// Two signals that are compared differ in length.
    #[error("signals of {first} and {second} samples cannot be compared; bring both to one grid")]
    Lengths {
        /// Samples of the first signal.
        first: usize,
        /// Samples of the second signal.
        second: usize,
    },
    /// A constant signal has no correlation with anything, no kurtosis, and, if it is zero, no crest factor.
    #[error("a constant signal has no correlation, no kurtosis and, at zero, no crest factor")]
    Constant,
}

/// Arithmetic mean.
///
/// # Errors
/// [`StatisticsError::Empty`].
pub fn mean(x: &[f64]) -> Result<f64, StatisticsError> {
    if x.is_empty() {
        return Err(StatisticsError::Empty);
    }
    Ok(x.iter().sum::<f64>() / x.len() as f64)
}

/// Largest minus smallest value.
///
/// # Errors
/// [`StatisticsError::Empty`].
pub fn peak_to_peak(x: &[f64]) -> Result<f64, StatisticsError> {
    if x.is_empty() {
        return Err(StatisticsError::Empty);
    }
    let (low, high) = x
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
            (low.min(*v), high.max(*v))
        });
    Ok(high - low)
}

/// Root of the mean square; the mean is **not** taken off.
///
/// # Errors
/// [`StatisticsError::Empty`].
pub fn rms(x: &[f64]) -> Result<f64, StatisticsError> {
    if x.is_empty() {
        return Err(StatisticsError::Empty);
    }
    Ok((x.iter().map(|v| v * v).sum::<f64>() / x.len() as f64).sqrt())
}

/// Kurtosis m₄/m₂² of the distribution (means taken off, m_k = mean of (x − mean)^k): 1.5 for a sine over whole
/// periods, 1 for a square wave, 3 for Gaussian noise, more where there are impulses. From n samples of Gaussian noise
/// it scatters by √(24/n).
///
/// # Errors
/// [`StatisticsError::Empty`]; [`StatisticsError::Constant`] where the signal varies by no more than rounding of its
/// mean.
pub fn kurtosis(x: &[f64]) -> Result<f64, StatisticsError> {
    let mean = mean(x)?;
    let (mut second, mut fourth) = (0.0, 0.0);
    for v in x {
        let square = (v - mean).powi(2);
        second += square;
        fourth += square * square;
    }
    if second <= rounding(x.len(), mean) {
        return Err(StatisticsError::Constant);
    }
    Ok(fourth * x.len() as f64 / (second * second))
}

/// Crest factor: largest |x| over the RMS value; the mean is **not** taken off. √2 for a sine, 1 for a square wave.
///
/// # Errors
/// [`StatisticsError::Empty`]; [`StatisticsError::Constant`] for a signal that is zero throughout.
pub fn crest_factor(x: &[f64]) -> Result<f64, StatisticsError> {
    let rms = rms(x)?;
    if rms == 0.0 {
        return Err(StatisticsError::Constant);
    }
    Ok(x.iter().fold(0.0f64, |largest, v| largest.max(v.abs())) / rms)
}

/// Pearson's correlation coefficient, −1 … 1 (means taken off).
///
/// # Errors
/// [`StatisticsError::Empty`], [`StatisticsError::Lengths`]; [`StatisticsError::Constant`] where one signal varies by
/// no more than rounding of its mean.
pub fn correlation(x: &[f64], y: &[f64]) -> Result<f64, StatisticsError> {
    same_length(x, y)?;
    let (mean_x, mean_y) = (mean(x)?, mean(y)?);
    let (mut xx, mut yy, mut xy) = (0.0, 0.0, 0.0);
    for (x, y) in x.iter().zip(y) {
        let (x, y) = (x - mean_x, y - mean_y);
        xx += x * x;
        yy += y * y;
        xy += x * y;
    }
    if xx <= rounding(x.len(), mean_x) || yy <= rounding(y.len(), mean_y) {
        return Err(StatisticsError::Constant);
    }
    Ok((xy / (xx.sqrt() * yy.sqrt())).clamp(-1.0, 1.0))
}

/// The largest deviation of two signals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LargestDeviation {
    /// Sample where it occurs (the first one, if several).
    pub index: usize,
    /// First signal minus second signal there.
    pub value: f64,
}

/// The sample where |x − y| is largest, and x − y there.
///
/// # Errors
/// [`StatisticsError::Empty`], [`StatisticsError::Lengths`].
pub fn largest_deviation(x: &[f64], y: &[f64]) -> Result<LargestDeviation, StatisticsError> {
    same_length(x, y)?;
    let mut largest = LargestDeviation {
        index: 0,
        value: 0.0,
    };
    if x.is_empty() {
        return Err(StatisticsError::Empty);
    }
    for (index, (x, y)) in x.iter().zip(y).enumerate() {
        if (x - y).abs() > largest.value.abs() {
            largest = LargestDeviation {
                index,
                value: x - y,
            };
        }
    }
    Ok(largest)
}

/// RMS of x − y.
///
/// # Errors
/// [`StatisticsError::Empty`], [`StatisticsError::Lengths`].
pub fn rms_deviation(x: &[f64], y: &[f64]) -> Result<f64, StatisticsError> {
    same_length(x, y)?;
    let difference: Vec<f64> = x.iter().zip(y).map(|(x, y)| x - y).collect();
    rms(&difference)
}

/// Sum of squares about the mean that rounding alone makes of a constant.
fn rounding(samples: usize, mean: f64) -> f64 {
    samples as f64 * (8.0 * f64::EPSILON * mean).powi(2)
}

fn same_length(x: &[f64], y: &[f64]) -> Result<(), StatisticsError> {
    if x.len() == y.len() {
        Ok(())
    } else {
        Err(StatisticsError::Lengths {
            first: x.len(),
            second: y.len(),
        })
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::TAU;

    #[test]
    fn figures_of_a_cosine() {
        let x: Vec<f64> = (0..360)
            .map(|i| 2.0 + 3.0 * (TAU * f64::from(i) / 360.0).cos())
            .collect();
        assert!((mean(&x).unwrap() - 2.0).abs() < 1e-12);
        assert!((peak_to_peak(&x).unwrap() - 6.0).abs() < 1e-12);
        assert!((rms(&x).unwrap() - (4.0 + 4.5f64).sqrt()).abs() < 1e-12);
        let y: Vec<f64> = (0..360)
            .map(|i| (TAU * f64::from(i) / 360.0).sin())
            .collect();
        assert!(correlation(&x, &y).unwrap().abs() < 1e-12);
    }

    #[test]
    fn the_largest_deviation_keeps_its_sign() {
        let found = largest_deviation(&[1.0, 2.0, 3.0], &[1.5, 5.0, 3.0]).unwrap();
        assert_eq!(
            found,
            LargestDeviation {
                index: 1,
                value: -3.0
            }
        );
    }

    #[test]
    fn of_equal_deviations_the_first_is_told() {
        let found = largest_deviation(&[1.0, 2.0, 3.0], &[2.0, 2.0, 2.0]).unwrap();
        assert_eq!((found.index, found.value), (0, -1.0));
    }

    #[test]
    fn what_has_no_figure_is_refused() {
        assert_eq!(mean(&[]), Err(StatisticsError::Empty));
        assert_eq!(largest_deviation(&[], &[]), Err(StatisticsError::Empty));
        assert_eq!(
            rms_deviation(&[1.0], &[]),
            Err(StatisticsError::Lengths {
                first: 1,
                second: 0
            })
        );
        assert_eq!(
            correlation(&[0.1; 50], &[0.3; 50]),
            Err(StatisticsError::Constant)
        );
    }

    proptest! {
        #[test]
        fn correlation_ignores_scale_and_offset(
            x in prop::collection::vec(-10.0..10.0f64, 3..60), factor in 0.01..50.0f64, offset in -9.0..9.0f64,
        ) {
            prop_assume!(peak_to_peak(&x).unwrap() > 1e-3);
            let y: Vec<f64> = x.iter().map(|v| factor * v + offset).collect();
            let opposite: Vec<f64> = y.iter().map(|v| -v).collect();
            prop_assert!((correlation(&x, &y).unwrap() - 1.0).abs() < 1e-9);
            prop_assert!((correlation(&x, &opposite).unwrap() + 1.0).abs() < 1e-9);
        }

        #[test]
        fn rms_lies_between_mean_and_largest(x in prop::collection::vec(-10.0..10.0f64, 1..60)) {
            let rms = rms(&x).unwrap();
            let largest = x.iter().fold(0.0f64, |m, v| m.max(v.abs()));
            prop_assert!(rms <= largest + 1e-12 && rms + 1e-12 >= mean(&x).unwrap().abs());
        }
    }
}
