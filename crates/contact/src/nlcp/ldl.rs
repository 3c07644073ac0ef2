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

/// Pivots that are eliminated at a time.
const TOGETHER: usize = 4;

/// Factor of a symmetric positive definite matrix.
#[derive(Debug, Clone)]
pub(crate) struct Ldl {
    /// What the processor has for the loops; results do not depend on it.
    arch: pulp::Arch,
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
            arch: pulp::Arch::new(),
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
        self.arch.dispatch(Eliminate {
            upper: &mut self.upper[..n * n],
            inverse_pivot: &mut self.inverse_pivot[..n],
            noise,
        })
    }

    /// Writes the inverse, order × order: the solutions of all units side by side.
    pub(crate) fn invert(&self, inverse: &mut [f64], row: &mut [f64]) {
        let n = self.order;
        self.arch.dispatch(Invert {
            upper: &self.upper[..n * n],
            inverse_pivot: &self.inverse_pivot[..n],
            inverse: &mut inverse[..n * n],
            known: &mut row[..n],
        });
    }

    /// Overwrites the first `order` of `values` by the solution.
    pub(crate) fn solve(&self, values: &mut [f64]) {
        let n = self.order;
        self.arch.dispatch(Substitute {
            upper: &self.upper[..n * n],
            inverse_pivot: &self.inverse_pivot[..n],
            values: &mut values[..n],
        });
    }
}

/// Both substitutions, in place.
struct Substitute<'a> {
    upper: &'a [f64],
    inverse_pivot: &'a [f64],
    values: &'a mut [f64],
}

impl pulp::NullaryFnOnce for Substitute<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let (values, n) = (self.values, self.inverse_pivot.len());
        let rows = self.upper.chunks_exact(n.max(1)).zip(self.inverse_pivot);
        for (k, (row, inverse)) in rows.clone().enumerate() {
            let factor = values[k] * inverse;
            subtract(&mut values[k + 1..], factor, &row[k + 1..]);
        }
        for (k, (row, inverse)) in rows.enumerate().rev() {
            values[k] = (values[k] - dot(&row[k + 1..], &values[k + 1..])) * inverse;
        }
    }
}

/// The elimination, in place.
struct Eliminate<'a> {
    upper: &'a mut [f64],
    /// The diagonal before; the inverse pivots after.
    inverse_pivot: &'a mut [f64],
    noise: f64,
}

impl pulp::NullaryFnOnce for Eliminate<'_> {
    type Output = Result<(), BadPivot>;

    #[inline(always)]
    fn call(self) -> Self::Output {
        let Self {
            upper,
            inverse_pivot,
            noise,
        } = self;
        let n = inverse_pivot.len();
        let mut rest = upper;
        // Four pivots at a time, by two and two: every row below is loaded and stored once for all.
        for k in (0..n).step_by(TOGETHER) {
            let together = TOGETHER.min(n - k);
            let (own, below) = rest.split_at_mut(together * n);
            for p in 0..together {
                let (above, row) = own.split_at_mut(p * n);
                let (at, row) = (k + p, &mut row[..n]);
                if p >= 2 {
                    let [first, second] = [0, 1].map(|p: usize| &above[p * n..][..n]);
                    let factors = [
                        first[at] * inverse_pivot[k],
                        second[at] * inverse_pivot[k + 1],
                    ];
                    for ((value, a), b) in row[at..].iter_mut().zip(&first[at..]).zip(&second[at..])
                    {
                        *value -= factors[0] * a + factors[1] * b;
                    }
                }
                if p % 2 == 1 {
                    let before = &above[(p - 1) * n..];
                    subtract(
                        &mut row[at..],
                        before[at] * inverse_pivot[at - 1],
                        &before[at..n],
                    );
                }
                inverse_pivot[at] = checked_inverse(at, row[at], inverse_pivot[at], noise)?;
            }
            rest = below;
            if together < TOGETHER {
                break;
            }
            let [first, second, third, fourth] = [0, 1, 2, 3].map(|p: usize| &own[p * n..][..n]);
            let inverse = &inverse_pivot[k..][..TOGETHER];
            for (i, other) in (k + TOGETHER..n).zip(rest.chunks_exact_mut(n)) {
                let (p, q) = (first[i] * inverse[0], second[i] * inverse[1]);
                let (r, s) = (third[i] * inverse[2], fourth[i] * inverse[3]);
                let pairs =
                    (first[i..].iter().zip(&second[i..])).zip(third[i..].iter().zip(&fourth[i..]));
                for (value, ((a, b), (c, d))) in other[i..n].iter_mut().zip(pairs) {
                    *value = (*value - (p * a + q * b)) - (r * c + s * d);
                }
            }
        }
        Ok(())
    }
}

/// Both substitutions for all units at once.
struct Invert<'a> {
    upper: &'a [f64],
    inverse_pivot: &'a [f64],
    /// `[entry][unit]`.
    inverse: &'a mut [f64],
    known: &'a mut [f64],
}

impl pulp::NullaryFnOnce for Invert<'_> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let (inverse, known, n) = (self.inverse, self.known, self.inverse_pivot.len());
        if n == 0 {
            return;
        }
        inverse.fill(0.0);
        let rows = self.upper.chunks_exact(n).zip(self.inverse_pivot);
        for (k, (row, pivot)) in rows.clone().enumerate() {
            inverse[k * n + k] = 1.0;
            // Units behind this one are still zero here.
            let (above, below) = inverse.split_at_mut((k + 1) * n);
            let own = &above[k * n..][..=k];
            for (value, target) in known.iter_mut().zip(own) {
                *value = target * pivot;
            }
            for (entry, other) in row[k + 1..].iter().zip(below.chunks_exact_mut(n)) {
                subtract(&mut other[..=k], *entry, &known[..=k]);
            }
        }
        for (k, (row, pivot)) in rows.enumerate().rev() {
            let (above, below) = inverse.split_at_mut((k + 1) * n);
            known.fill(0.0);
            for (entry, other) in row[k + 1..].iter().zip(below.chunks_exact(n)) {
                for (sum, value) in known.iter_mut().zip(other) {
                    *sum += entry * value;
                }
            }
            for (value, sum) in above[k * n..].iter_mut().zip(&*known) {
                *value = (*value - sum) * pivot;
            }
        }
    }
}

/// The inverse of a pivot that is positive and above `noise` of its diagonal entry.
#[inline(always)]
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

/// Σ a b, in as many sums as a processor adds at once, always in the same order.
#[inline(always)]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    let (a, b) = (a.chunks_exact(8), b.chunks_exact(8));
    let rest = a.remainder().iter().zip(b.remainder());
    for (a, b) in a.zip(b) {
        for (sum, (a, b)) in sums.iter_mut().zip(a.iter().zip(b)) {
            *sum += a * b;
        }
    }
    sums.iter().sum::<f64>() + rest.map(|(a, b)| a * b).sum::<f64>()
}

/// `target −= factor × row`.
#[inline(always)]
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
    fn the_inverse_is_what_solutions_of_units_are() {
        for order in [1, 2, 7, 8, 21] {
            let entry = |i: usize, j: usize| {
                let apart = i.abs_diff(j) as f64;
                (-0.3 * apart).exp() + if i == j { 1.0 + i as f64 } else { 0.0 }
            };
            let ldl = factored(order, entry).unwrap().0;
            let mut inverse = vec![f64::NAN; order * order];
            ldl.invert(&mut inverse, &mut vec![f64::NAN; order]);
            for j in 0..order {
                let mut unit = vec![0.0; order];
                unit[j] = 1.0;
                ldl.solve(&mut unit);
                // Sums of a row in another order.
                let most = unit.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
                for i in 0..order {
                    let apart = (inverse[i * order + j] - unit[i]).abs();
                    assert!(apart <= 1e-15 * most, "{order} {i} {j}: {apart:e}");
                }
            }
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
