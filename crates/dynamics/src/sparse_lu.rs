//! LU factorisation of a sparse matrix whose values change while its pattern stays.
//!
//! Columns are ordered once, by approximate minimum degree of the (symmetric) pattern. faer chooses the pivots, row by
//! row the largest; later matrices are factorised with the same pivots on the same pattern, with neither a search nor
//! new memory, until one of them no longer serves: then pivots are chosen anew. Sources: T. A. Davis, E. Palamadai
//! Natarajan, ACM Trans. Math. Softw. 37 (2010) 36 (KLU); J. R. Gilbert, T. Peierls, SIAM J. Sci. Stat. Comput. 9
//! (1988) 862-874; P. R. Amestoy, T. A. Davis, I. S. Duff, SIAM J. Matrix Anal. Appl. 17 (1996) 886-905.

use std::sync::Arc;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::perm::PermRef;
use faer::sparse::linalg::{amd, lu::simplicial};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};

use crate::dense_lu::PIVOT;
use crate::pattern::Pattern;

/// A pattern with the order in which its columns are eliminated.
#[derive(Debug)]
pub(crate) struct Ordered {
    pattern: Pattern,
    forward: Vec<usize>,
    backward: Vec<usize>,
    /// Multiplications that LU needs in this order if diagonal pivots serve.
    pub multiplications: f64,
}

impl Ordered {
    /// Orders a symmetric pattern; `None` if there is no memory for it.
    pub(crate) fn new(pattern: Pattern) -> Option<Self> {
        let size = pattern.columns();
        let mut ordered = Self {
            forward: vec![0; size],
            backward: vec![0; size],
            multiplications: 0.0,
            pattern,
        };
        let scratch = amd::order_scratch::<usize>(size, ordered.pattern.len());
        let mut memory = MemBuffer::try_new(scratch).ok()?;
        let count = amd::order(
            &mut ordered.forward,
            &mut ordered.backward,
            symbolic(&ordered.pattern),
            amd::Control::default(),
            MemStack::new(&mut memory),
        );
        ordered.multiplications = count.ok()?.n_mult_subs_lu;
        Some(ordered)
    }
}

fn symbolic(pattern: &Pattern) -> SymbolicSparseColMatRef<'_, usize> {
    let size = pattern.columns();
    SymbolicSparseColMatRef::new_checked(size, size, pattern.starts(), None, pattern.indices())
}

/// Factors of a matrix on an ordered pattern: columns in the order of elimination, rows numbered by their pivots.
pub(crate) struct SparseLu {
    ordered: Arc<Ordered>,
    /// What faer makes where pivots are chosen.
    found: simplicial::SimplicialLu<usize, f64>,
    row_forward: Vec<usize>,
    /// Number of the pivot in each row.
    row_backward: Vec<usize>,
    memory: MemBuffer,
    /// Values for which the pivots were chosen; empty before.
    pivoted: Vec<f64>,
    lower: Columns,
    /// Without the diagonal, rows rising.
    upper: Columns,
    pivots: Vec<f64>,
    work: Vec<f64>,
    /// How often pivots were chosen anew.
    pub pivotings: u64,
}

/// A triangular factor, column after column.
#[derive(Default)]
struct Columns {
    starts: Vec<usize>,
    rows: Vec<u32>,
    values: Vec<f64>,
}

impl Columns {
    fn clear(&mut self) {
        self.starts.clear();
        self.starts.push(0);
        self.rows.clear();
        self.values.clear();
    }

    fn end_column(&mut self) {
        self.starts.push(self.rows.len());
    }

    #[inline]
    fn column(&self, column: usize) -> (&[u32], &[f64]) {
        let range = self.starts[column]..self.starts[column + 1];
        (&self.rows[range.clone()], &self.values[range])
    }

    /// x ← x − column · factor
    #[inline]
    fn take(&self, column: usize, factor: f64, x: &mut [f64]) {
        let (rows, values) = self.column(column);
        for (&row, value) in rows.iter().zip(values) {
            x[row as usize] -= value * factor;
        }
    }
}

/// A kept pivot serves while it is at least this share of the largest entry that could take its place.
const SERVES: f64 = 1e-3;

impl SparseLu {
    pub(crate) fn new(ordered: &Arc<Ordered>) -> Self {
        let size = ordered.pattern.columns();
        let scratch = simplicial::factorize_simplicial_numeric_lu_scratch::<usize, f64>(size, size);
        Self {
            ordered: Arc::clone(ordered),
            found: simplicial::SimplicialLu::new(),
            row_forward: vec![0; size],
            row_backward: vec![0; size],
            memory: MemBuffer::new(scratch),
            pivoted: Vec::new(),
            lower: Columns::default(),
            upper: Columns::default(),
            pivots: vec![0.0; size],
            work: vec![0.0; size],
            pivotings: 0,
        }
    }

    /// Factorises the matrix of these values with the pivots that there are, or new ones where those do not serve;
    /// `false` if a pivot vanishes or is not finite.
    pub(crate) fn factor(&mut self, values: &[f64]) -> bool {
        if values.iter().any(|value| !value.is_finite()) {
            return false;
        }
        (!self.pivoted.is_empty() && self.refactor(values)) || self.pivot(values)
    }

    /// Values for which the pivots were chosen.
    pub(crate) fn pivoted(&self) -> &[f64] {
        &self.pivoted
    }

    /// Chooses pivots and factorises.
    pub(crate) fn pivot(&mut self, values: &[f64]) -> bool {
        let ordered = &self.ordered;
        let size = ordered.pattern.columns();
        self.pivotings += 1;
        self.pivoted.clear();
        let made = simplicial::factorize_simplicial_numeric_lu(
            &mut self.row_forward,
            &mut self.row_backward,
            &mut self.found,
            SparseColMatRef::new(symbolic(&ordered.pattern), values),
            PermRef::new_checked(&ordered.forward, &ordered.backward, size),
            MemStack::new(&mut self.memory),
        );
        if made.is_err() {
            return false;
        }
        let (lower, upper) = (
            self.found.l_factor_unsorted(),
            self.found.u_factor_unsorted(),
        );
        self.lower.clear();
        self.upper.clear();
        for column in 0..size {
            for &row in lower.row_idx_of_col_raw(column) {
                if row != column {
                    self.lower.rows.push(row as u32);
                }
            }
            self.lower.end_column();
            let first = self.upper.rows.len();
            for &row in upper.row_idx_of_col_raw(column) {
                if row != column {
                    self.upper.rows.push(row as u32);
                }
            }
            self.upper.rows[first..].sort_unstable();
            self.upper.end_column();
        }
        self.lower.values.resize(self.lower.rows.len(), 0.0);
        self.upper.values.resize(self.upper.rows.len(), 0.0);
        self.pivoted.extend_from_slice(values);
        let served = self.refactor(values);
        if !served {
            self.pivoted.clear();
        }
        served
    }

    /// Factorises with the pivots and the patterns that there are; `false` if they do not serve.
    fn refactor(&mut self, values: &[f64]) -> bool {
        let pattern = &self.ordered.pattern;
        let x = &mut self.work;
        x.fill(0.0);
        let (mut least, mut largest) = (f64::INFINITY, 0.0_f64);
        for column in 0..pattern.columns() {
            let from = self.ordered.forward[column];
            let entries = pattern
                .column(from)
                .iter()
                .zip(&values[pattern.range(from)]);
            for (&row, value) in entries {
                x[self.row_backward[row]] = *value;
            }
            for at in self.upper.starts[column]..self.upper.starts[column + 1] {
                let row = self.upper.rows[at] as usize;
                let value = std::mem::take(&mut x[row]);
                self.upper.values[at] = value;
                if value != 0.0 {
                    self.lower.take(row, value, x);
                }
            }
            let pivot = std::mem::take(&mut x[column]);
            let below = self.lower.starts[column]..self.lower.starts[column + 1];
            let rows = &self.lower.rows[below.clone()];
            let mut most = pivot.abs();
            for (&row, value) in rows.iter().zip(&mut self.lower.values[below]) {
                let entry = std::mem::take(&mut x[row as usize]);
                most = most.max(entry.abs());
                *value = entry / pivot;
            }
            // Not a number fails here, too.
            if !(pivot.abs() >= SERVES * most && most > 0.0) {
                return false;
            }
            self.pivots[column] = pivot;
            least = least.min(pivot.abs());
            largest = largest.max(pivot.abs());
        }
        pattern.columns() == 0 || least > PIVOT * largest
    }

    /// Solves in place; [`Self::factor`] has found the matrix regular.
    pub(crate) fn solve(&mut self, right_side: &mut [f64]) {
        let x = &mut self.work;
        for (value, &place) in right_side.iter().zip(&self.row_backward) {
            x[place] = *value;
        }
        for column in 0..x.len() {
            let value = x[column];
            if value != 0.0 {
                self.lower.take(column, value, x);
            }
        }
        for column in (0..x.len()).rev() {
            x[column] /= self.pivots[column];
            let value = x[column];
            if value != 0.0 {
                self.upper.take(column, value, x);
            }
        }
        for (value, &place) in x.iter().zip(&self.ordered.forward) {
            right_side[place] = *value;
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)] // test code
mod tests {
    use super::*;

    /// A bordered band with a zero corner, as joints make it; columns that vanish are found.
    #[test]
    fn solves_and_sees_a_singular_matrix() {
        let size = 40;
        let inside = |i: usize, j: usize| i.abs_diff(j) <= 2 || (i + 4 > size) || (j + 4 > size);
        let columns = (0..size).map(|j| (0..size).filter(|&i| inside(i, j)).collect());
        let pattern = Pattern::from_columns(size, columns.collect());
        let entry = |i: usize, j: usize| {
            let corner = i + 4 > size && j + 4 > size;
            if corner {
                0.0
            } else {
                ((3 * i + 7 * j) % 11) as f64 - if i == j { 20.0 } else { 0.0 }
            }
        };
        let list = |keep: &dyn Fn(usize) -> bool| -> Vec<f64> {
            let columns = 0..size;
            columns
                .flat_map(|j| pattern.column(j).iter().map(move |&i| (i, j)))
                .map(|(i, j)| if keep(j) { entry(i, j) } else { 0.0 })
                .collect()
        };
        let ordered = Arc::new(Ordered::new(pattern.clone()).unwrap());
        let mut lu = SparseLu::new(&ordered);
        assert!(lu.factor(&list(&|_| true)));
        let exact: Vec<f64> = (0..size).map(|i| i as f64 - 3.0).collect();
        let mut x: Vec<f64> = (0..size)
            .map(|i| {
                (0..size)
                    .filter(|&j| inside(i, j))
                    .map(|j| entry(i, j) * exact[j])
                    .sum()
            })
            .collect();
        lu.solve(&mut x);
        assert!(x.iter().zip(&exact).all(|(a, b)| (a - b).abs() < 1e-11));
        assert!(!lu.factor(&list(&|j| j != 7)));
        let mut broken = list(&|_| true);
        broken[5] = f64::NAN;
        assert!(!lu.factor(&broken));
        // A pivot that has all but vanished is exchanged for another.
        let before = lu.pivotings;
        assert!(lu.factor(&list(&|_| true)) && lu.factor(&list(&|_| true)));
        assert_eq!(lu.pivotings, before + 1);
        let mut weak = list(&|_| true);
        for j in 0..size {
            if let Some(place) = pattern.place(j, j) {
                weak[place] *= 1e-9;
            }
        }
        assert!(lu.factor(&weak));
        assert_eq!(lu.pivotings, before + 2);
        let mut x = vec![1.0; size];
        lu.solve(&mut x);
        for i in 0..size {
            let product = (0..size).filter_map(|j| Some(weak[pattern.place(i, j)?] * x[j]));
            assert!((product.sum::<f64>() - 1.0).abs() < 1e-11);
        }
    }
}
