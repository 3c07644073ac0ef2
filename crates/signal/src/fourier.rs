//! The real Fourier transform of one length, planned once and used for many blocks.

use crate::error::SeriesError;
use realfft::num_complex::Complex64;
use realfft::{ComplexToReal, RealFftPlanner, RealToComplex};
use std::sync::Arc;

/// X_k = Σ_j x_j e^{−2πi jk/N}, k = 0 … N/2, and its inverse, for one N.
#[derive(Clone)]
pub(crate) struct RealFourier {
    forward: Arc<dyn RealToComplex<f64>>,
    inverse: Arc<dyn ComplexToReal<f64>>,
    samples: usize,
}

impl RealFourier {
    /// Plans the transforms of `samples` samples.
    pub(crate) fn new(samples: usize) -> Self {
        let mut planner = RealFftPlanner::new();
        Self {
            forward: planner.plan_fft_forward(samples),
            inverse: planner.plan_fft_inverse(samples),
            samples,
        }
    }

    /// Number of samples N.
    pub(crate) fn samples(&self) -> usize {
        self.samples
    }

    /// The lines X_k, not normalised. `samples` is used up as scratch.
    pub(crate) fn lines(&self, samples: &mut [f64]) -> Result<Vec<Complex64>, SeriesError> {
        let mut lines = self.forward.make_output_vec();
        self.forward
            .process(samples, &mut lines)
            .map_err(|e| self.error(&e))?;
        Ok(lines)
    }

    /// The samples with the lines X_k, normalised so that it undoes [`RealFourier::lines`]. The mean and the Nyquist
    /// line must be real. `lines` is used up as scratch.
    pub(crate) fn samples_of(&self, lines: &mut [Complex64]) -> Result<Vec<f64>, SeriesError> {
        let mut samples = self.inverse.make_output_vec();
        self.inverse
            .process(lines, &mut samples)
            .map_err(|e| self.error(&e))?;
        let factor = 1.0 / self.samples as f64;
        samples.iter_mut().for_each(|v| *v *= factor);
        Ok(samples)
    }

    /// 1 for the mean and the Nyquist line of an even N, 2 for lines that stand for a conjugate pair.
    pub(crate) fn pair_factor(&self, line: usize) -> f64 {
        if line == 0 || 2 * line == self.samples {
            1.0
        } else {
            2.0
        }
    }

    fn error(&self, reason: &realfft::FftError) -> SeriesError {
        SeriesError::Transform {
            samples: self.samples,
            reason: reason.to_string(),
        }
    }
}
