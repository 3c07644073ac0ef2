//! The M-orthonormal basis of the mode search and its projected problem; see [`crate::modes`] for the relation it
//! keeps.

use faer::prelude::ReborrowMut;
use faer::{Mat, Scale, Side};

use crate::mode_problem::ModeProblem;

/// A remainder below this part of the vector is rounding: the basis holds the whole of it already.
const SMALLEST_REMAINDER: f64 = 1e-12;

pub(crate) struct LanczosBasis {
    /// Columns M-orthonormal; the first `len` are in use. It grows as needed.
    v: Mat<f64>,
    /// A V_p = V H, one column per processed column of V.
    h: Mat<f64>,
    pub len: usize,
    /// Columns that A was applied to.
    pub processed: usize,
    /// M times the columns after those.
    product: Mat<f64>,
}

/// Parts of new columns W = V C + Q R.
struct Split {
    q: Mat<f64>,
    c: Mat<f64>,
    r: Mat<f64>,
    /// M Q.
    product: Mat<f64>,
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
    pub fn new(unknowns: usize) -> Self {
        Self {
            v: Mat::zeros(unknowns, 0),
            h: Mat::zeros(0, 0),
            len: 0,
            processed: 0,
            product: Mat::zeros(unknowns, 0),
        }
    }

    /// Appends what is new in the columns of `w`. With `image_of`, they are A times the columns from there on, and
    /// their coefficients enter H.
    pub fn append(&mut self, w: Mat<f64>, problem: &impl ModeProblem, image_of: Option<usize>) {
        let product = problem.mass_product(w.as_ref());
        let norms: Vec<f64> = (0..w.ncols())
            .map(|j| (w.col(j).transpose() * product.col(j)).max(0.0).sqrt())
            .collect();
        // Twice is enough: the second pass removes what rounding of the first left. With W = V C₁ + Q₁ R₁ and
        // Q₁ = V C₂ + Q₂ R₂ the coefficients of W are C₁ + C₂ R₁ and R₂ R₁.
        let first = self.orthonormalise((w, &product), problem, &norms);
        let units = vec![1.0; first.q.ncols()];
        // Anew: where little remained, what the first pass made of the product has its rounding.
        let product = problem.mass_product(first.q.as_ref());
        let second = self.orthonormalise((first.q, &product), problem, &units);
        self.reserve(self.len + second.q.ncols());
        if let Some(column) = image_of {
            let in_basis = first.c + second.c * &first.r;
            let in_new = second.r * &first.r;
            let columns = in_basis.ncols();
            let mut h = self.h.subcols_mut(column, columns);
            h.rb_mut().subrows_mut(0, self.len).copy_from(&in_basis);
            h.subrows_mut(self.len, in_new.nrows()).copy_from(&in_new);
        }
        let added = second.q.ncols();
        self.v.subcols_mut(self.len, added).copy_from(&second.q);
        self.len += added;
        self.product = second.product;
    }

    /// Room for so many columns, and a quarter more so that it is not asked for at every step.
    fn reserve(&mut self, columns: usize) {
        if columns > self.v.ncols() {
            let columns = columns + columns / 4;
            self.v.resize_with(self.v.nrows(), columns, |_, _| 0.0);
            self.h.resize_with(columns, columns, |_, _| 0.0);
        }
    }

    /// W = V C + Q R with Q M-orthonormal and M-orthogonal to V, from W and M W; columns without remainder, measured
    /// against `norms`, give none in Q.
    fn orthonormalise(
        &self,
        (mut w, product): (Mat<f64>, &Mat<f64>),
        problem: &impl ModeProblem,
        norms: &[f64],
    ) -> Split {
        let basis = self.v.subcols(0, self.len);
        let c = basis.transpose() * product;
        w -= basis * &c;
        let mut product = problem.mass_product(w.as_ref());
        let columns = w.ncols();
        let mut r = Mat::zeros(columns, columns);
        let mut kept: Vec<usize> = Vec::with_capacity(columns);
        for j in 0..columns {
            for (row, &i) in kept.iter().enumerate() {
                let coefficient = product.col(i).transpose() * w.col(j);
                r[(row, j)] = coefficient;
                for block in [&mut w, &mut product] {
                    let part = block.col(i) * Scale(coefficient);
                    let mut column = block.col_mut(j);
                    column -= part;
                }
            }
            let remainder = (w.col(j).transpose() * product.col(j)).max(0.0).sqrt();
            if remainder.is_nan() || remainder <= SMALLEST_REMAINDER * norms[j] {
                continue;
            }
            r[(kept.len(), j)] = remainder;
            for block in [&mut w, &mut product] {
                let mut column = block.col_mut(j);
                column *= Scale(1.0 / remainder);
            }
            kept.push(j);
        }
        let chosen = |of: Mat<f64>| {
            if kept.len() == columns {
                return of;
            }
            let mut chosen = Mat::zeros(of.nrows(), kept.len());
            for (j, &column) in kept.iter().enumerate() {
                chosen.col_mut(j).copy_from(of.col(column));
            }
            chosen
        };
        Split {
            q: chosen(w),
            product: chosen(product),
            c,
            r: r.subrows(0, kept.len()).to_owned(),
        }
    }

    /// Applies A = (K + s M)⁻¹ M to the next columns, at most `block`; returns how many.
    pub fn grow(&mut self, block: usize, problem: &impl ModeProblem) -> usize {
        let first = self.processed;
        let count = block.min(self.len - first);
        // A block brings as many columns at most: all that were not processed are those of the last one.
        let mut images = self.product.subcols(0, count).to_owned();
        problem.solve_in_place(images.as_mut());
        self.append(images, problem, Some(first));
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
