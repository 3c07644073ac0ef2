//! The M-orthonormal basis of the mode search and its projected problem; see [`crate::modes`] for the relation it keeps.

use faer::{Col, Mat, Side};

use crate::assembly::SparseMatrix;
use crate::factor::Factor;

/// A remainder below this part of the vector is rounding: the basis holds the whole of it already.
const SMALLEST_REMAINDER: f64 = 1e-12;

pub(crate) struct LanczosBasis {
    /// Columns M-orthonormal; the first `len` are in use.
    v: Mat<f64>,
    /// A V_p = V H, one column per processed column of V.
    h: Mat<f64>,
    pub len: usize,
    /// Columns that A was applied to.
    pub processed: usize,
}

/// Ritz pairs, largest θ first.
pub(crate) struct Ritz {
    /// 1/(ω² + s).
    pub theta: Vec<f64>,
    /// Coefficients in the processed part of the basis, one column per pair.
    pub y: Mat<f64>,
    /// ‖A φ − θ φ‖_M / θ.
    pub residuals: Vec<f64>,
}

impl LanczosBasis {
    pub fn new(unknowns: usize, columns: usize) -> Self {
        Self {
            v: Mat::zeros(unknowns, columns),
            h: Mat::zeros(columns, columns),
            len: 0,
            processed: 0,
        }
    }

    /// Appends what is new in `w`. With `image_of`, w is A times that column, and its coefficients enter H.
    pub fn push(&mut self, mut w: Col<f64>, m: &SparseMatrix, image_of: Option<usize>) {
        let norm = |w: &Col<f64>| (w.transpose() * (m * w)).max(0.0).sqrt();
        let before = norm(&w);
        let basis = self.v.subcols(0, self.len);
        // Twice is enough: the second pass removes what rounding of the first left.
        for _ in 0..2 {
            let coefficients = basis.transpose() * (m * &w);
            w -= basis * &coefficients;
            if let Some(column) = image_of {
                for i in 0..self.len {
                    self.h[(i, column)] += coefficients[i];
                }
            }
        }
        let remainder = norm(&w);
        if remainder.is_nan() || remainder <= SMALLEST_REMAINDER * before {
            return;
        }
        if let Some(column) = image_of {
            self.h[(self.len, column)] = remainder;
        }
        for i in 0..w.nrows() {
            self.v[(i, self.len)] = w[i] / remainder;
        }
        self.len += 1;
    }

    /// Applies A = (K + s M)⁻¹ M to the next columns, at most `block`; returns how many.
    pub fn grow(&mut self, block: usize, m: &SparseMatrix, factor: &Factor) -> usize {
        let first = self.processed;
        let count = block.min(self.len - first);
        let mut images = m * self.v.subcols(first, count);
        factor.solve_in_place(images.as_mut());
        for c in 0..count {
            self.push(images.col(c).to_owned(), m, Some(first + c));
        }
        self.processed += count;
        count
    }

    /// Ritz pairs of the processed part; `None` where rounding or NaN leaves no eigenvectors.
    pub fn ritz(&self) -> Option<Ritz> {
        let p = self.processed;
        let symmetric = Mat::from_fn(p, p, |i, j| 0.5 * (self.h[(i, j)] + self.h[(j, i)]));
        let eigen = symmetric.self_adjoint_eigen(Side::Lower).ok()?;
        // Ascending there, descending here.
        let y = Mat::from_fn(p, p, |i, j| eigen.U()[(i, p - 1 - j)]);
        let theta: Vec<f64> = (0..p).map(|j| eigen.S()[p - 1 - j]).collect();
        let coupling = self.h.submatrix(p, 0, self.len - p, p) * &y;
        let residuals = (0..p)
            .map(|j| coupling.col(j).norm_l2() / theta[j])
            .collect();
        Some(Ritz {
            theta,
            y,
            residuals,
        })
    }

    /// The first `count` Ritz vectors φ = V_p y.
    pub fn vectors(&self, ritz: &Ritz, count: usize) -> Mat<f64> {
        self.v.subcols(0, self.processed) * ritz.y.subcols(0, count)
    }

    /// Keeps the first `kept` Ritz vectors as processed columns, and the remainders after them.
    pub fn restart(&mut self, ritz: &Ritz, kept: usize) {
        let (p, remainders) = (self.processed, self.len - self.processed);
        let vectors = self.vectors(ritz, kept);
        let coupling = self.h.submatrix(p, 0, remainders, p) * ritz.y.subcols(0, kept);
        let rest = self.v.subcols(p, remainders).to_owned();
        self.v.subcols_mut(0, kept).copy_from(&vectors);
        self.v.subcols_mut(kept, remainders).copy_from(&rest);
        self.h.fill(0.0);
        for j in 0..kept {
            self.h[(j, j)] = ritz.theta[j];
            for i in 0..remainders {
                self.h[(kept + i, j)] = coupling[(i, j)];
            }
        }
        self.processed = kept;
        self.len = kept + remainders;
    }
}
