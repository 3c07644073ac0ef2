//! Order spectrum of a periodic signal sampled uniformly over whole revolutions.

use crate::error::SeriesError;
use crate::fourier::RealFourier;
use realfft::num_complex::Complex64;

/// Why a spectrum cannot be made or read.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum OrderError {
    /// No samples, or no revolution.
    #[error(
        "{samples} samples over {revolutions} revolutions; at least 2 samples and 1 revolution are needed"
    )]
    Empty {
        /// Number of samples.
        samples: usize,
        /// Number of revolutions.
        revolutions: usize,
    },
    /// NaN or infinity among the samples.
    #[error("sample {index} is {value}; samples must be finite numbers")]
    NotFinite {
        /// Index of the sample, from 0.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// An order beyond the Nyquist order, or between the lines of the spectrum.
    #[error(
        "order {order} is not in the spectrum; it has the multiples of 1/{revolutions} up to {highest}"
    )]
    NoSuchOrder {
        /// The order asked for.
        order: f64,
        /// Number of revolutions the spectrum was taken over.
        revolutions: usize,
        /// The Nyquist order.
        highest: f64,
    },
    /// Spectra of different grids cannot be averaged.
    #[error(
        "spectra of {first_samples} and {other_samples} samples (or of different revolutions) cannot be averaged"
    )]
    DifferentGrids {
        /// Samples of the first spectrum.
        first_samples: usize,
        /// Samples of the one that differs.
        other_samples: usize,
    },
    /// The Fourier transform failed.
    #[error(transparent)]
    Series(#[from] SeriesError),
}

/// Single-sided complex order spectrum.
///
/// With N samples x_j at the angles θ_j = 2πRj/N over R revolutions, line k belongs to the order m = k/R and
///
/// x(θ) = c_0 + Σ_{k≥1} Re(c_k e^{i m θ}) = c_0 + Σ A_k cos(m θ + φ_k),
///
/// so that A_k = |c_k| is the **amplitude of the cosine** (half its peak-to-peak) and φ_k = arg c_k its phase; c_0 is
/// the mean. c_k = (2/N) Σ_j x_j e^{−2πi jk/N}, without the factor 2 for k = 0 and, if N is even, k = N/2 (whose
/// imaginary part is zero). Parseval: mean of x² = c_0² + ½ Σ |c_k|² (Nyquist line without the ½).
#[derive(Debug, Clone, PartialEq)]
pub struct OrderSpectrum {
    coefficients: Vec<Complex64>,
    samples: usize,
    revolutions: usize,
}

impl OrderSpectrum {
    /// Spectrum of samples that cover `revolutions` whole revolutions uniformly, the end left out.
    ///
    /// # Errors
    /// [`OrderError::Empty`], [`OrderError::NotFinite`].
    pub fn from_samples(samples: &[f64], revolutions: usize) -> Result<Self, OrderError> {
        let n = samples.len();
        if n < 2 || revolutions == 0 {
            return Err(OrderError::Empty {
                samples: n,
                revolutions,
            });
        }
        if let Some((index, &value)) = samples
            .iter()
            .enumerate()
            .find(|(_, value)| !value.is_finite())
        {
            return Err(OrderError::NotFinite { index, value });
        }
        let fourier = RealFourier::new(n);
        let mut coefficients = fourier.lines(&mut samples.to_vec())?;
        for (k, c) in coefficients.iter_mut().enumerate() {
            *c *= fourier.pair_factor(k) / n as f64;
        }
        Ok(Self {
            coefficients,
            samples: n,
            revolutions,
        })
    }

    /// The complex mean of spectra on one grid: what is not locked to the revolution averages out.
    ///
    /// # Errors
    /// [`OrderError::Empty`] without a spectrum, [`OrderError::DifferentGrids`].
    pub fn average(spectra: &[Self]) -> Result<Self, OrderError> {
        let Some(first) = spectra.first() else {
            return Err(OrderError::Empty {
                samples: 0,
                revolutions: 0,
            });
        };
        let mut mean = first.clone();
        for other in &spectra[1..] {
            if other.samples != first.samples || other.revolutions != first.revolutions {
                return Err(OrderError::DifferentGrids {
                    first_samples: first.samples,
                    other_samples: other.samples,
                });
            }
            for (sum, c) in mean.coefficients.iter_mut().zip(&other.coefficients) {
                *sum += c;
            }
        }
        for c in &mut mean.coefficients {
            *c /= spectra.len() as f64;
        }
        Ok(mean)
    }

    /// The samples that have this spectrum.
    ///
    /// # Errors
    /// [`OrderError::Series`].
    pub fn to_samples(&self) -> Result<Vec<f64>, OrderError> {
        let fourier = RealFourier::new(self.samples);
        let mut lines: Vec<Complex64> = self
            .coefficients
            .iter()
            .enumerate()
            .map(|(k, c)| c * (self.samples as f64 / fourier.pair_factor(k)))
            .collect();
        Ok(fourier.samples_of(&mut lines)?)
    }

    /// Order of every line: k/R.
    pub fn orders(&self) -> Vec<f64> {
        (0..self.coefficients.len())
            .map(|k| k as f64 / self.revolutions as f64)
            .collect()
    }

    /// Amplitude of every line (the mean's for order 0, which is |mean|).
    pub fn amplitudes(&self) -> Vec<f64> {
        self.coefficients.iter().map(|c| c.norm()).collect()
    }

    /// The mean, with its sign.
    pub fn mean(&self) -> f64 {
        self.coefficients[0].re
    }

    /// The complex coefficient c of an order.
    ///
    /// # Errors
    /// [`OrderError::NoSuchOrder`].
    pub fn coefficient(&self, order: f64) -> Result<Complex64, OrderError> {
        Ok(self.coefficients[self.line(order)?])
    }

    /// Amplitude of the cosine of an order.
    ///
    /// # Errors
    /// [`OrderError::NoSuchOrder`].
    pub fn amplitude(&self, order: f64) -> Result<f64, OrderError> {
        Ok(self.coefficient(order)?.norm())
    }

    /// Phase φ of an order in rad, A cos(order·θ + φ), in (−π, π].
    ///
    /// # Errors
    /// [`OrderError::NoSuchOrder`].
    pub fn phase_rad(&self, order: f64) -> Result<f64, OrderError> {
        Ok(self.coefficient(order)?.arg())
    }

    /// Whether an order is one of the lines.
    pub fn has(&self, order: f64) -> bool {
        self.line(order).is_ok()
    }

    /// Sets an order to zero.
    ///
    /// # Errors
    /// [`OrderError::NoSuchOrder`].
    pub fn remove(&mut self, order: f64) -> Result<(), OrderError> {
        let line = self.line(order)?;
        self.coefficients[line] = Complex64::ZERO;
        Ok(())
    }

    fn line(&self, order: f64) -> Result<usize, OrderError> {
        let line = order * self.revolutions as f64;
        // A line is met to rounding: orders are written as decimal numbers.
        let meets = line.is_finite() && (line - line.round()).abs() < 1e-9 * line.abs().max(1.0);
        if meets && line > -0.5 && (line.round() as usize) < self.coefficients.len() {
            return Ok(line.round() as usize);
        }
        Err(OrderError::NoSuchOrder {
            order,
            revolutions: self.revolutions,
            highest: (self.coefficients.len() - 1) as f64 / self.revolutions as f64,
        })
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::TAU;

    fn signal() -> impl Strategy<Value = Vec<f64>> {
        prop::collection::vec(-1e3..1e3f64, 2..200)
    }

    #[test]
    fn amplitude_and_phase_are_those_of_the_cosine() {
        let n = 600;
        let x: Vec<f64> = (0..n)
            .map(|j| {
                let angle = 3.0 * TAU * f64::from(j) / f64::from(n);
                -4.0 + 2.5 * (57.0 * angle + 0.3).cos() + 0.2 * (angle / 3.0 - 1.0).cos()
            })
            .collect();
        let spectrum = OrderSpectrum::from_samples(&x, 3).unwrap();
        assert!((spectrum.mean() + 4.0).abs() < 1e-12);
        assert!((spectrum.amplitude(57.0).unwrap() - 2.5).abs() < 1e-12);
        assert!((spectrum.phase_rad(57.0).unwrap() - 0.3).abs() < 1e-12);
        assert!((spectrum.amplitude(1.0 / 3.0).unwrap() - 0.2).abs() < 1e-12);
        assert!(spectrum.amplitude(58.0).unwrap() < 1e-12);
    }

    #[test]
    fn orders_outside_are_refused() {
        let spectrum = OrderSpectrum::from_samples(&[1.0; 10], 2).unwrap();
        for order in [-1.0, 0.3, 3.0, f64::NAN, f64::INFINITY] {
            assert!(
                matches!(
                    spectrum.amplitude(order),
                    Err(OrderError::NoSuchOrder { .. })
                ),
                "{order}"
            );
        }
        assert!(spectrum.amplitude(2.5).is_ok());
    }

    proptest! {
        #[test]
        fn parseval(x in signal()) {
            let spectrum = OrderSpectrum::from_samples(&x, 1).unwrap();
            let mean_square = x.iter().map(|v| v * v).sum::<f64>() / x.len() as f64;
            let of_lines: f64 = spectrum.amplitudes().iter().enumerate()
                .map(|(k, a)| if k == 0 || 2 * k == x.len() { a * a } else { 0.5 * a * a }).sum();
            prop_assert!((mean_square - of_lines).abs() <= 1e-11 * mean_square.max(1e-300));
        }

        #[test]
        fn there_and_back(x in signal()) {
            let back = OrderSpectrum::from_samples(&x, 1).unwrap().to_samples().unwrap();
            for (a, b) in x.iter().zip(&back) {
                prop_assert!((a - b).abs() < 1e-9);
            }
        }

        #[test]
        fn linear(x in signal(), factor in -5.0..5.0f64) {
            let y: Vec<f64> = x.iter().enumerate().map(|(j, v)| factor * v + (j as f64).cos()).collect();
            let cosine: Vec<f64> = (0..x.len()).map(|j| (j as f64).cos()).collect();
            let of = |v: &[f64]| OrderSpectrum::from_samples(v, 1).unwrap();
            let (sx, sy, sc) = (of(&x), of(&y), of(&cosine));
            for k in 0..sx.coefficients.len() {
                let expected = sx.coefficients[k] * factor + sc.coefficients[k];
                prop_assert!((sy.coefficients[k] - expected).norm() < 1e-9);
            }
        }

        #[test]
        fn a_turn_of_the_signal_turns_the_phases(x in signal(), by in 0usize..200) {
            let n = x.len();
            let by = by % n;
            // turned[j] = x[j - by]: the signal comes later by `by` samples.
            let mut turned = x.clone();
            turned.rotate_right(by);
            let of = |v: &[f64]| OrderSpectrum::from_samples(v, 1).unwrap();
            let (sx, st) = (of(&x), of(&turned));
            for k in 0..sx.coefficients.len() {
                let angle = -TAU * (k * by) as f64 / n as f64;
                let expected = sx.coefficients[k] * Complex64::cis(angle);
                prop_assert!((st.coefficients[k] - expected).norm() < 1e-8);
            }
        }
    }
}
