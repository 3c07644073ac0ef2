//! The discrete Fourier transform round a ring of equal parts: v(k) = Σ_p v_p e^{-ikpα}, α = 2π/N.
//!
//! Real values have v(N − k) as the conjugate of v(k), so that the harmonics 0 ≤ k ≤ N/2 suffice.

use faer::{Mat, MatRef, c64};
use rayon::prelude::*;
use std::f64::consts::TAU;

/// A ring of N parts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct RingTransform {
    /// N.
    pub parts: usize,
}

impl RingTransform {
    /// Number of harmonics that suffice.
    pub fn harmonics(self) -> usize {
        self.parts / 2 + 1
    }

    /// e^{ikα}, with k reduced first so that the angle is exact to rounding.
    pub fn phase(self, k: usize) -> c64 {
        let (sin, cos) = (TAU * (k % self.parts) as f64 / self.parts as f64).sin_cos();
        c64::new(cos, sin)
    }

    /// Share of a harmonic in the inverse transform: 1/N, and twice that where its conjugate is left out.
    pub fn weight(self, k: usize) -> f64 {
        let alone = k == 0 || 2 * k == self.parts;
        (if alone { 1.0 } else { 2.0 }) / self.parts as f64
    }

    /// Values of a given shape on every part from those of the harmonics: (1/N) Σ_k e^{ikpα} v(k) over all N.
    pub fn back(
        self,
        spectrum: &[MatRef<'_, c64>],
        (rows, columns): (usize, usize),
    ) -> Vec<Mat<f64>> {
        (0..self.parts)
            .into_par_iter()
            .map(|part| {
                let mut sum = Mat::<f64>::zeros(rows, columns);
                for (k, values) in spectrum.iter().enumerate() {
                    let turn = self.phase(k * part) * self.weight(k);
                    for column in 0..columns {
                        for row in 0..rows {
                            let value = values[(row, column)];
                            sum[(row, column)] += turn.re * value.re - turn.im * value.im;
                        }
                    }
                }
                sum
            })
            .collect()
    }
}

/// The matrices by reference.
pub(crate) fn by_reference(spectrum: &[Mat<c64>]) -> Vec<MatRef<'_, c64>> {
    spectrum.iter().map(Mat::as_ref).collect()
}
