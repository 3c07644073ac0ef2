//! `L D Lᵀ` factorisation of the active block, in memory that is allocated once.
//!
//! The upper triangle is eliminated row by row: row k keeps `d_k (Lᵀ)_k`, so that every inner loop runs along
//! contiguous memory and no square root is needed. The matrices are small (10 to 150) and dense.

/// Pivots below this fraction of their own diagonal entry, times the order, are rounding noise.
const PIVOT_TOLERANCE: f64 = 4.0 * f64::EPSILON;

/// What is added to each diagonal entry, relative to it, when the block is singular to rounding.
///
/// Corrections made with the shifted factor are proximal-point steps: they still lead to a solution of the
/// unshifted problem (Rockafellar, SIAM J. Control Optim. 14 (1976) 877-898), only the rate suffers. 1e-12 is an
/// order above the pivot noise of a block of 150.
const SHIFT: f64 = 1e-12;

/// Factor of a symmetric positive definite matrix.
#[derive(Debug, Clone)]
pub(crate) struct Ldl {
    order: usize,
    /// Order × order in rows; right of the diagonal row k is `d_k (Lᵀ)_k`, the rest is not used.
    upper: Vec<f64>,
    /// `1/d_k`.
    inverse_pivot: Vec<f64>,
}

/// A pivot that is not positive even with the shift.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BadPivot {
    pub(crate) index: usize,
    pub(crate) pivot: f64,
    pub(crate) diagonal: f64,
}

/// Whether the diagonal was shifted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Shifted {
    No,
    Yes,
}

impl Ldl {
    pub(crate) fn new(capacity: usize) -> Self {
        Ldl {
            order: 0,
            upper: vec![0.0; capacity * capacity],
            inverse_pivot: vec![0.0; capacity],
        }
    }

    /// Factors the matrix of the given order; shifts the diagonal if it must.
    ///
    /// `fill_row(i, row)` writes the entries (i, i), (i, i + 1), … into `row`.
    pub(crate) fn factor(
        &mut self,
        order: usize,
        fill_row: impl Fn(usize, &mut [f64]),
    ) -> Result<Shifted, BadPivot> {
        self.order = order;
        if self.try_factor(&fill_row, 0.0).is_ok() {
            return Ok(Shifted::No);
        }
        self.try_factor(&fill_row, SHIFT).map(|()| Shifted::Yes)
    }

    fn try_factor(
        &mut self,
        fill_row: &impl Fn(usize, &mut [f64]),
        shift: f64,
    ) -> Result<(), BadPivot> {
        let n = self.order;
        let noise = PIVOT_TOLERANCE * n as f64;
        for (i, row) in self.upper[..n * n].chunks_exact_mut(n.max(1)).enumerate() {
            fill_row(i, &mut row[i..]);
            row[i] *= 1.0 + shift;
            // Kept for the test of the pivot.
            self.inverse_pivot[i] = row[i];
        }
        let mut rest = &mut self.upper[..n * n];
        // Two pivots at a time: every row below is loaded and stored once for both.
        for k in (0..n).step_by(2) {
            let (first, below) = rest.split_at_mut(n);
            let first = &first[..n];
            let first_inverse = checked_inverse(k, first[k], self.inverse_pivot[k], noise)?;
            self.inverse_pivot[k] = first_inverse;
            if k + 1 == n {
                break;
            }
            let (second, below) = below.split_at_mut(n);
            let second = &mut second[..n];
            subtract(
                &mut second[k + 1..],
                first[k + 1] * first_inverse,
                &first[k + 1..],
            );
            let second_inverse =
                checked_inverse(k + 1, second[k + 1], self.inverse_pivot[k + 1], noise)?;
            self.inverse_pivot[k + 1] = second_inverse;
            rest = below;
            for (i, other) in (k + 2..n).zip(rest.chunks_exact_mut(n)) {
                let (p, q) = (first[i] * first_inverse, second[i] * second_inverse);
                for ((value, a), b) in other[i..].iter_mut().zip(&first[i..]).zip(&second[i..]) {
                    *value -= p * a + q * b;
                }
            }
        }
        Ok(())
    }

    /// Overwrites the first `order` of `values` by the solution.
    pub(crate) fn solve(&self, values: &mut [f64]) {
        let n = self.order;
        let values = &mut values[..n];
        let rows = self.upper[..n * n]
            .chunks_exact(n.max(1))
            .zip(&self.inverse_pivot);
        for (k, (row, inverse)) in rows.clone().enumerate() {
            let factor = values[k] * inverse;
            subtract(&mut values[k + 1..], factor, &row[k + 1..]);
        }
        for (k, (row, inverse)) in rows.enumerate().rev() {
            let known: f64 = row[k + 1..]
                .iter()
                .zip(&values[k + 1..])
                .map(|(a, b)| a * b)
                .sum();
            values[k] = (values[k] - known) * inverse;
        }
    }
}

/// The inverse of a pivot that is positive and above `noise` of its diagonal entry.
fn checked_inverse(index: usize, pivot: f64, diagonal: f64, noise: f64) -> Result<f64, BadPivot> {
    // NaN fails too.
    if pivot > noise * diagonal {
        Ok(1.0 / pivot)
    } else {
        Err(BadPivot {
            index,
            pivot,
            diagonal,
        })
    }
}

/// `target −= factor × row`.
#[inline]
fn subtract(target: &mut [f64], factor: f64, row: &[f64]) {
    for (value, entry) in target.iter_mut().zip(row) {
        *value -= factor * entry;
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::needless_range_loop)] // index notation of the formula
mod tests {
    use super::*;

    fn factored(
        order: usize,
        entry: impl Fn(usize, usize) -> f64,
    ) -> Result<(Ldl, Shifted), BadPivot> {
        let mut ldl = Ldl::new(order);
        let fill = |i: usize, row: &mut [f64]| {
            for (k, value) in row.iter_mut().enumerate() {
                *value = entry(i, i + k);
            }
        };
        let shifted = ldl.factor(order, fill)?;
        Ok((ldl, shifted))
    }

    #[test]
    fn hilbert_system_has_a_small_residual() {
        let hilbert = |i: usize, j: usize| 1.0 / (i + j + 1) as f64;
        let (ldl, shifted) = factored(6, hilbert).unwrap();
        assert_eq!(shifted, Shifted::No);
        let right: Vec<f64> = (0..6).map(|i| f64::from(i as u8) - 2.0).collect();
        let mut x = right.clone();
        ldl.solve(&mut x);
        let size: f64 = x.iter().map(|v| v.abs()).sum();
        for i in 0..6 {
            let product: f64 = (0..6).map(|j| hilbert(i, j) * x[j]).sum();
            // Backward stable: relative to ‖A‖‖x‖, whatever the condition (1.5e7).
            assert!((product - right[i]).abs() <= 1e-15 * size);
        }
    }

    #[test]
    fn singular_matrix_is_shifted_and_indefinite_one_refused() {
        assert_eq!(factored(3, |_, _| 1.0).unwrap().1, Shifted::Yes);
        let bad = factored(2, |i, j| if i == j { 1.0 } else { 2.0 }).unwrap_err();
        assert_eq!(bad.index, 1);
        assert!((bad.pivot + 3.0).abs() < 1e-10);
    }
}
