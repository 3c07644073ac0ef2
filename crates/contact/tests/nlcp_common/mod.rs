//! Random problems and independent solvers for the tests of the complementarity problem.
#![allow(dead_code, clippy::unwrap_used, clippy::needless_range_loop)] // each test binary uses its own part
pub mod families;
pub mod lemke;
pub mod projected;
pub mod random;

use gearmesh_contact::nlcp::LocalLaw;

/// Owned data of one problem.
#[derive(Clone, Debug)]
pub struct Data {
    pub compliance: Vec<f64>,
    pub local: Vec<LocalLaw>,
    pub separation: Vec<f64>,
    pub closing: Vec<f64>,
    pub lever: Vec<f64>,
}

impl Data {
    pub fn size(&self) -> usize {
        self.separation.len()
    }

    /// The checked problem.
    pub fn problem(&self) -> gearmesh_contact::nlcp::Problem<'_> {
        gearmesh_contact::nlcp::Problem::new(
            &self.compliance,
            &self.local,
            &self.separation,
            &self.closing,
            &self.lever,
        )
        .unwrap()
    }

    /// `(g, s)` at forces and approach, from the definition, without the solver's shift of the origin:
    /// the gaps and the sums of magnitudes of their terms.
    pub fn gaps(&self, force: &[f64], approach: f64) -> (Vec<f64>, Vec<f64>) {
        let n = self.size();
        let first = self
            .separation
            .iter()
            .zip(&self.closing)
            .map(|(e, w)| e / w)
            .fold(f64::INFINITY, f64::min);
        let mut gaps = vec![0.0; n];
        let mut scales = vec![0.0; n];
        for i in 0..n {
            let local = self.local[i].deflection(force[i]);
            let mut gap = local + self.separation[i] - approach * self.closing[i];
            let mut scale = local.abs() + self.separation[i] - first * self.closing[i]
                + (approach - first).abs() * self.closing[i];
            for j in 0..n {
                let term = self.compliance[i * n + j] * force[j];
                gap += term;
                scale += term.abs();
            }
            gaps[i] = gap;
            scales[i] = scale;
        }
        (gaps, scales)
    }

    /// Relative residual of an answer, from the definition.
    ///
    /// `e − x w` is formed here without the solver's shift; the rounding of that difference, at most
    /// `2 ε (|e| + |x| w)`, is no error of the answer and is taken off.
    pub fn residual(&self, force: &[f64], approach: f64, load: Option<f64>) -> f64 {
        let (gaps, scales) = self.gaps(force, approach);
        let mut residual: f64 = 0.0;
        for i in 0..self.size() {
            assert!(force[i] >= 0.0, "negative or NaN force {}", force[i]);
            let rounding =
                2.0 * f64::EPSILON * (self.separation[i].abs() + approach.abs() * self.closing[i]);
            let violation = if force[i] > 0.0 {
                gaps[i].abs()
            } else {
                -gaps[i]
            };
            assert!(!violation.is_nan());
            residual =
                residual.max((violation - rounding).max(0.0) / scales[i].max(f64::MIN_POSITIVE));
        }
        if let Some(load) = load {
            let carried: f64 = self.lever.iter().zip(force).map(|(b, f)| b * f).sum();
            residual = residual.max((carried - load).abs() / load);
        }
        residual
    }
}
