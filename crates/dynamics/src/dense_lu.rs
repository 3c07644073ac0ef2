//! LU factorisation of a dense matrix in place, with faer, without allocation after its making.
//!
//! Systems have some ten to some hundred unknowns and few factorisations, but a solution for every correction.
//! Substitution is nalgebra's, column by column: faer's, made for many right-hand sides, takes five times as long for a
//! dozen unknowns.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting::factor;
use faer::{MatMut, Par, Spec};
use nalgebra::{DMatrixView, DVectorViewMut};

/// Least pivot over the largest: the matrix is scaled, a pivot at the level of rounding is none.
pub(crate) const PIVOT: f64 = 1e-15;

/// A square matrix of fixed size, then its factors.
pub(crate) struct DenseLu {
    size: usize,
    values: Vec<f64>,
    forward: Vec<usize>,
    backward: Vec<usize>,
    memory: MemBuffer,
    work: Vec<f64>,
}

impl DenseLu {
    pub(crate) fn new(size: usize) -> Self {
        let memory =
            factor::lu_in_place_scratch::<usize, f64>(size, size, Par::Seq, Spec::default());
        Self {
            size,
            values: vec![0.0; size * size],
            forward: (0..size).collect(),
            backward: (0..size).collect(),
            memory: MemBuffer::new(memory),
            work: vec![0.0; size],
        }
    }

    /// The matrix to be filled before [`Self::factor`], column after column.
    pub(crate) fn values_mut(&mut self) -> &mut [f64] {
        &mut self.values
    }

    /// Replaces the matrix by its factors; `false` if a pivot vanishes or is not finite.
    pub(crate) fn factor(&mut self) -> bool {
        if self.size == 0 {
            return true;
        }
        factor::lu_in_place(
            MatMut::from_column_major_slice_mut(&mut self.values, self.size, self.size),
            &mut self.forward,
            &mut self.backward,
            Par::Seq,
            MemStack::new(&mut self.memory),
            Spec::default(),
        );
        let (mut least, mut largest) = (f64::INFINITY, 0.0_f64);
        for i in 0..self.size {
            let pivot = self.values[i * self.size + i].abs();
            if !pivot.is_finite() {
                return false;
            }
            least = least.min(pivot);
            largest = largest.max(pivot);
        }
        least > PIVOT * largest
    }

    /// Solves in place.
    pub(crate) fn solve(&mut self, right_side: &mut [f64]) {
        if self.size == 0 {
            return;
        }
        for (place, &from) in self.work.iter_mut().zip(&self.forward) {
            *place = right_side[from];
        }
        right_side.copy_from_slice(&self.work);
        let factors = DMatrixView::from_slice(&self.values, self.size, self.size);
        let mut x = DVectorViewMut::from_slice(right_side, self.size);
        // Pivots do not vanish: `factor` has seen them.
        factors.solve_lower_triangular_with_diag_mut(&mut x, 1.0);
        factors.solve_upper_triangular_mut(&mut x);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_and_sees_a_singular_matrix() {
        let size = 17;
        let entry =
            |i: usize, j: usize| ((3 * i + 7 * j) % 11) as f64 - if i == j { 20.0 } else { 0.0 };
        let mut lu = DenseLu::new(size);
        let fill = |lu: &mut DenseLu| {
            for j in 0..size {
                for i in 0..size {
                    lu.values_mut()[j * size + i] = entry(i, j);
                }
            }
        };
        fill(&mut lu);
        assert!(lu.factor());
        let exact: Vec<f64> = (0..size).map(|i| i as f64 - 3.0).collect();
        let mut x: Vec<f64> = (0..size)
            .map(|i| (0..size).map(|j| entry(i, j) * exact[j]).sum())
            .collect();
        lu.solve(&mut x);
        assert!(x.iter().zip(&exact).all(|(a, b)| (a - b).abs() < 1e-12));
        fill(&mut lu);
        lu.values_mut()[..size].fill(0.0);
        assert!(!lu.factor());
    }
}
