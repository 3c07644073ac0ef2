//! How far one signal would have to be turned against another for the best correlation. Reported, never applied by
//! itself.

use std::f64::consts::TAU;

use crate::error::SeriesError;
use crate::fourier::RealFourier;

/// Correlations that differ by less are one: of equal peaks the one nearest to no offset counts.
const EQUAL_CORRELATIONS: f64 = 1e-6;

/// The offset with the best correlation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BestOffset {
    /// Share of the period by which the second signal comes later than the first, −½ to ½: x(t) is most like y(t +
    /// share).
    pub share: f64,
    /// Pearson's correlation that it would give.
    pub correlation: f64,
}

/// The circular offset between two signals of one period at which Pearson's correlation is largest; none where one is
/// constant.
///
/// r(s) = Σ_j x_j y_{j+s} / √(Σ x² Σ y²) about the means, for all s at once by the transforms, conj(X) Y; between
/// samples by the parabola through the largest and its neighbours. Where several offsets are as good (signals that
/// repeat within the period), the smallest is given.
///
/// # Errors
/// [`SeriesError::Lengths`], and those of the transform.
pub fn best_offset(x: &[f64], y: &[f64]) -> Result<Option<BestOffset>, SeriesError> {
    let n = x.len();
    if y.len() != n {
        return Err(SeriesError::Lengths {
            first_what: "the first signal",
            first: n,
            second_what: "the second",
            second: y.len(),
        });
    }
    if n < 3 {
        return Ok(None);
    }
    let centred = |values: &[f64]| {
        let mean = values.iter().sum::<f64>() / n as f64;
        let values: Vec<f64> = values.iter().map(|v| v - mean).collect();
        let square: f64 = values.iter().map(|v| v * v).sum();
        (values, square)
    };
    let ((mut x, xx), (mut y, yy)) = (centred(x), centred(y));
    let scale = (xx * yy).sqrt();
    if scale == 0.0 {
        return Ok(None);
    }
    let fourier = RealFourier::new(n);
    let (of_x, mut product) = (fourier.lines(&mut x)?, fourier.lines(&mut y)?);
    for (y, x) in product.iter_mut().zip(&of_x) {
        *y *= x.conj();
    }
    // The lines that stand for themselves are real but for rounding; the inverse transform asks for it.
    for (line, value) in product.iter_mut().enumerate() {
        if fourier.pair_factor(line) == 1.0 {
            value.im = 0.0;
        }
    }
    let sums = fourier.samples_of(&mut product)?;
    let correlations: Vec<f64> = sums.iter().map(|sum| sum / scale).collect();
    let largest = correlations.iter().copied().fold(f64::MIN, f64::max);
    let signed = |s: usize| {
        if 2 * s > n {
            s as f64 - n as f64
        } else {
            s as f64
        }
    };
    let is_peak = |s: &usize| correlations[*s] >= largest - EQUAL_CORRELATIONS;
    let nearest = (0..n)
        .filter(is_peak)
        .min_by(|a, b| signed(*a).abs().total_cmp(&signed(*b).abs()));
    let Some(mut best) = nearest else {
        return Ok(None);
    };
    // Climb to the top that this point belongs to.
    loop {
        let (before, after) = ((best + n - 1) % n, (best + 1) % n);
        if correlations[before] > correlations[best] {
            best = before;
        } else if correlations[after] > correlations[best] {
            best = after;
        } else {
            break;
        }
    }
    let [before, top, after] = [(best + n - 1) % n, best, (best + 1) % n].map(|s| correlations[s]);
    let curvature = before - 2.0 * top + after;
    let beside = if curvature < 0.0 {
        0.5 * (before - after) / curvature
    } else {
        0.0
    };
    Ok(Some(BestOffset {
        share: (signed(best) + beside) / n as f64,
        correlation: (top - 0.25 * (before - after) * beside).min(1.0),
    }))
}

impl BestOffset {
    /// The offset as an angle of a shaft, for signals over so many of its revolutions \[rad\].
    pub fn angle_rad(&self, revolutions: usize) -> f64 {
        TAU * revolutions as f64 * self.share
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn sampled(n: usize, f: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..n).map(|i| f(TAU * i as f64 / n as f64)).collect()
    }

    #[test]
    fn a_turned_signal_is_found_between_samples() {
        for n in [720, 721] {
            for turned in [0.0, 0.3, -0.123, 3.0] {
                let f = |a: f64| a.cos() + 0.5 * (3.0 * a + 1.0).cos() + 0.2 * (23.0 * a).cos();
                let (x, y) = (sampled(n, f), sampled(n, |a| 2.0 * f(a - turned) - 4.0));
                let best = best_offset(&x, &y).unwrap().unwrap();
                assert!(
                    (best.angle_rad(1) - turned).abs() < 1e-4,
                    "{best:?} {turned}"
                );
                assert!((best.correlation - 1.0).abs() < 1e-5, "{best:?}");
                assert!((best.angle_rad(47) - 47.0 * best.angle_rad(1)).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn of_equal_offsets_the_smallest_is_given() {
        let x = sampled(920, |a| (23.0 * a).cos());
        let y = sampled(920, |a| (23.0 * a - 0.5).cos());
        let best = best_offset(&x, &y).unwrap().unwrap();
        assert!((best.angle_rad(1) - 0.5 / 23.0).abs() < 1e-4, "{best:?}");
    }

    #[test]
    fn a_constant_has_none() {
        assert_eq!(best_offset(&[1.0; 8], &sampled(8, f64::cos)).unwrap(), None);
        assert!(best_offset(&[1.0; 8], &[1.0; 7]).is_err());
    }
}
