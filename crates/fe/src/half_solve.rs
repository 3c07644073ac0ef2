//! The two halves of a solve, in the order of elimination, and a block of L: what static condensation is made of.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::matmul::matmul;
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::reborrow::{Reborrow, ReborrowMut};
use faer::sparse::linalg::cholesky::SymbolicCholeskyRaw;
use faer::sparse::linalg::cholesky::supernodal::SupernodalLltRef;
use faer::{Accum, ColRef, Conj, Mat, MatMut, Par};
use rayon::prelude::*;

use crate::factor::{Factor, SOLVE_COLUMNS};

impl Factor {
    /// The supernodes of L. [`SymbolicFactor::new`] asks for them, and an empty matrix is no stiffness.
    fn supernodes(&self) -> Option<SupernodalLltRef<'_, usize, f64>> {
        match self.symbolic.cholesky.raw() {
            SymbolicCholeskyRaw::Supernodal(raw) => Some(SupernodalLltRef::new(raw, &self.values)),
            SymbolicCholeskyRaw::Simplicial(_) => None,
        }
    }

    /// Where a half solve begins whose first load acts on `row` in the order of elimination: the first row of its
    /// supernode. Rows before it stay zero.
    pub(crate) fn half_solve_start(&self, row: usize) -> usize {
        self.supernodes().map_or(row, |l| {
            let begins = l.symbolic().supernode_begin();
            begins[begins
                .partition_point(|begin| *begin <= row)
                .saturating_sub(1)]
        })
    }

    /// Overwrites B (the last rows in the order of elimination, from one of [`Factor::half_solve_start`] on) with L⁻¹ B
    /// and tells the rows that may not be zero, ascending. Supernodes that a block of 32 columns does not reach cost
    /// nothing; the blocks run in parallel. The last supernode alone, a dense triangle, is read once for all columns.
    ///
    /// # Panics
    /// If `rhs` has more rows than the factor.
    pub(crate) fn lower_solve_in_place(&self, rhs: MatMut<'_, f64>) -> Vec<usize> {
        let first = self.size() - rhs.nrows();
        let Some(l) = self.supernodes() else {
            return Vec::new();
        };
        let count = l.symbolic().n_supernodes();
        let begin = (l.symbolic().supernode_begin()).partition_point(|begin| *begin < first);
        let columns = if begin + 1 == count {
            rhs.ncols().max(1)
        } else {
            SOLVE_COLUMNS
        };
        let reached = rhs
            .par_col_chunks_mut(columns)
            .map(|block| lower_solve_block(l, begin, block))
            .reduce(
                || vec![false; count],
                |a, b| a.iter().zip(b).map(|(x, y)| *x || y).collect(),
            );
        (0..count)
            .filter(|s| reached[*s])
            .flat_map(|s| l.symbolic().supernode_begin()[s]..l.symbolic().supernode_end()[s])
            .collect()
    }

    /// Overwrites B (rows in the order of elimination) with L⁻ᵀ B. Blocks of 32 columns run in parallel.
    ///
    /// # Panics
    /// If `rhs` does not have [`Factor::size`] rows.
    pub(crate) fn upper_solve_in_place(&self, rhs: MatMut<'_, f64>) {
        assert_eq!(rhs.nrows(), self.size(), "rows of the right-hand side");
        let Some(l) = self.supernodes() else {
            return;
        };
        rhs.par_col_chunks_mut(SOLVE_COLUMNS).for_each(|block| {
            let symbolic = &self.symbolic.cholesky;
            let request = symbolic.solve_in_place_scratch::<f64>(block.ncols(), Par::Seq);
            let mut memory = MemBuffer::new(request);
            l.l_transpose_solve_with_conj(Conj::No, block, Par::Seq, MemStack::new(&mut memory));
        });
    }

    /// The lower triangle of L from row and column `first` (in the order of elimination) on, as a dense matrix.
    pub(crate) fn trailing_block(&self, first: usize) -> Mat<f64> {
        let size = self.size() - first;
        let mut block = Mat::zeros(size, size);
        let Some(l) = self.supernodes() else {
            return block;
        };
        for s in 0..l.symbolic().n_supernodes() {
            let node = l.supernode(s);
            let (start, values) = (node.start(), node.val());
            let columns = values.ncols();
            for c in first.saturating_sub(start)..columns {
                let column = start + c - first;
                for r in c..columns {
                    block[(start + r - first, column)] = values[(r, c)];
                }
                for (r, &row) in node.pattern().iter().enumerate() {
                    block[(row - first, column)] = values[(columns + r, c)];
                }
            }
        }
        block
    }
}

/// L⁻¹ B for some columns from a supernode on, and which supernodes they reach.
fn lower_solve_block(
    l: SupernodalLltRef<'_, usize, f64>,
    begin: usize,
    mut x: MatMut<'_, f64>,
) -> Vec<bool> {
    let count = l.symbolic().n_supernodes();
    let first = l.symbolic().supernode_begin().get(begin);
    let first = first.copied().unwrap_or(0);
    let mut below = Mat::<f64>::zeros(0, x.ncols());
    (0..count)
        .map(|s| {
            if s < begin {
                return false;
            }
            let node = l.supernode(s);
            let (start, size) = (node.start() - first, node.val().ncols());
            let mut own = x.rb_mut().subrows_mut(start, size);
            let is_zero = |column: ColRef<'_, f64>| column.iter().all(|value| *value == 0.0);
            if own.rb().col_iter().all(is_zero) {
                return false;
            }
            let (diagonal, rest) = node.val().split_at_row(size);
            solve_lower_triangular_in_place(diagonal, own.rb_mut(), Par::Seq);
            below.resize_with(rest.nrows(), x.ncols(), |_, _| 0.0);
            let own = x.rb().subrows(start, size);
            matmul(below.as_mut(), Accum::Replace, rest, own, 1.0, Par::Seq);
            for (column, update) in below.col_iter().enumerate() {
                for (&row, value) in node.pattern().iter().zip(update.iter()) {
                    x[(row - first, column)] -= value;
                }
            }
            true
        })
        .collect()
}
