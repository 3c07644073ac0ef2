//! The linear system of every Newton step, scaled so that its condition depends neither on units nor on the step.
//!
//! ```text
//! [A   Bᵀ] [δ]   [r]
//! [B̄   0 ] [μ] = [p]          A: n × n, like a mass matrix; B̄ = B or B T
//! ```
//!
//! With D = diag(M)^(−1/2) and σ_i = 1/‖D B_i‖ the factorised matrix is [D A D, D Bᵀσ; σ B̄ D, 0], whose entries are of order 1.
//! The caller multiplies the equations of motion by βh² and takes μ = βh² δλ, so that nothing grows as h → 0. Source:
//! C. L. Bottasso, D. Dopico, L. Trainelli, Multibody Syst. Dyn. 19 (2008) 3-20.

use crate::dense_lu::DenseLu;
use crate::matrix::Matrix;

/// Factors and scales.
pub(crate) struct Saddle {
    kept: Vec<usize>,
    scale: Vec<f64>,
    row_scale: Vec<f64>,
    lu: DenseLu,
    work: Vec<f64>,
}

impl Saddle {
    /// For `mass_diagonal` of all degrees of freedom and the kept equations.
    pub(crate) fn new(mass_diagonal: &[f64], kept: &[usize]) -> Self {
        let size = mass_diagonal.len() + kept.len();
        Self {
            kept: kept.to_vec(),
            scale: mass_diagonal.iter().map(|m| 1.0 / m.sqrt()).collect(),
            row_scale: vec![1.0; kept.len()],
            lu: DenseLu::new(size),
            work: vec![0.0; size],
        }
    }

    /// Factorises; `gradient` is Bᵀ and `turned` B̄ᵀ, one column for each equation. `false` if the matrix is singular.
    pub(crate) fn factor(&mut self, a: &Matrix, gradient: &Matrix, turned: &Matrix) -> bool {
        let (n, scale) = (self.scale.len(), &self.scale);
        let size = n + self.kept.len();
        let values = self.lu.values_mut();
        for (j, column) in values.chunks_mut(size).enumerate() {
            if j < n {
                for ((place, entry), d) in column.iter_mut().zip(a.column(j)).zip(scale) {
                    *place = d * entry * scale[j];
                }
            } else {
                let row = gradient.column(self.kept[j - n]);
                let square: f64 = row.iter().zip(scale).map(|(b, d)| (b * d).powi(2)).sum();
                let sigma = if square > 0.0 {
                    1.0 / square.sqrt()
                } else {
                    1.0
                };
                self.row_scale[j - n] = sigma;
                for ((place, entry), d) in column.iter_mut().zip(row).zip(scale) {
                    *place = d * entry * sigma;
                }
                column[n..].fill(0.0);
            }
        }
        for (i, (&equation, sigma)) in self.kept.iter().zip(&self.row_scale).enumerate() {
            for (j, (entry, d)) in turned.column(equation).iter().zip(scale).enumerate() {
                values[j * size + n + i] = sigma * entry * d;
            }
        }
        self.lu.factor()
    }

    /// Solves for right-hand sides r (n) and p (one for each equation, dropped ones ignored); δ goes to `delta`, μ to `mu`, zero
    /// for dropped equations.
    pub(crate) fn solve(&mut self, r: &[f64], p: &[f64], delta: &mut [f64], mu: &mut [f64]) {
        let n = self.scale.len();
        let (upper, lower) = self.work.split_at_mut(n);
        for ((place, value), d) in upper.iter_mut().zip(r).zip(&self.scale) {
            *place = value * d;
        }
        for ((place, &equation), sigma) in lower.iter_mut().zip(&self.kept).zip(&self.row_scale) {
            *place = p[equation] * sigma;
        }
        self.lu.solve(&mut self.work);
        for ((place, value), d) in delta.iter_mut().zip(&self.work).zip(&self.scale) {
            *place = value * d;
        }
        mu.fill(0.0);
        for ((value, &equation), sigma) in
            self.work[n..].iter().zip(&self.kept).zip(&self.row_scale)
        {
            mu[equation] = value * sigma;
        }
    }

    /// What a checkpoint needs to go on with the same factors.
    pub(crate) fn factors(&self) -> (&[f64], &[usize], &[f64]) {
        let (values, permutation) = self.lu.factors();
        (values, permutation, &self.row_scale)
    }

    /// Goes on with stored factors.
    pub(crate) fn restore(&mut self, values: &[f64], permutation: &[usize], row_scale: &[f64]) {
        self.lu.restore(values, permutation);
        self.row_scale.copy_from_slice(row_scale);
    }
}
