//! Sparse Cholesky factorisation K = L Lᵀ and solves for many right-hand sides.
//!
//! The symbolic part (where L has entries) depends on mesh and constraints only, the numeric part on the values.
//! Factor time and memory are those of faer's supernodal factorisation in the order given.

use std::sync::Arc;
use std::time::Instant;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltError as PivotError;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::{Conj, MatMut, Par, Side, Spec};
use rayon::prelude::*;

use crate::compressed_columns::StiffnessMatrix;
use crate::constraints::DofMap;
use crate::error::FeError;
use crate::factor_time::expected_seconds;
use crate::graph::NodeGraph;
use crate::model::FeModel;
use crate::ordering::DofOrdering;

/// Columns solved together by one thread. Fixed, so that the result of a column never depends on the number of
/// threads; 32 columns make the solve a matrix product, and two threads share a block of 64.
pub(crate) const SOLVE_COLUMNS: usize = 32;

/// Smallest pivot accepted, relative to the diagonal entry of K. The last pivot of a held body compares the
/// stiffness of a point in the whole body with that of its element patch alone: some 1e-1 for a compact solid, and
/// never below 1/cond(K), some 1e-9 for a slender one. A rigid motion that nothing holds leaves rounding, 1e-16 to
/// 1e-12, of either sign. The value stands between.
const SMALLEST_RELATIVE_PIVOT: f64 = 1e-11;

/// Where L has entries: elimination order, supernodes, counts. Reusable for every matrix with the same pattern.
#[derive(Debug)]
pub struct SymbolicFactor {
    pub(crate) cholesky: SymbolicCholesky<usize>,
    ordering: DofOrdering,
    nnz_k: usize,
    nnz_l: usize,
    flops: f64,
    seconds: f64,
}

impl SymbolicFactor {
    /// Analyses the pattern of K in the given order of elimination.
    ///
    /// # Errors
    /// [`FeError::SizeMismatch`] when the order has another length; [`FeError::OutOfMemory`].
    pub fn new(k: &StiffnessMatrix, ordering: DofOrdering) -> Result<Self, FeError> {
        let start = Instant::now();
        FeError::check_size("the elimination order", ordering.forward().len(), k.ncols())?;
        let permutation = faer::perm::PermRef::new_checked(
            ordering.forward(),
            ordering.inverse(),
            ordering.forward().len(),
        );
        // Stiffness matrices of solids always gain from supernodes.
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
            ..Default::default()
        };
        let cholesky = factorize_symbolic_cholesky(
            k.symbolic(),
            Side::Lower,
            SymmetricOrdering::Custom(permutation),
            params,
        )
        .map_err(|_| FeError::OutOfMemory { bytes: 0 })?;
        let (nnz_l, flops) = count(&cholesky);
        Ok(Self {
            cholesky,
            ordering,
            nnz_k: k.compute_nnz(),
            nnz_l,
            flops,
            seconds: start.elapsed().as_secs_f64(),
        })
    }

    /// Nonzeros of L, diagonal included.
    pub fn nnz_l(&self) -> usize {
        self.nnz_l
    }

    /// Multiplications and additions of the numeric factorisation.
    pub fn flops(&self) -> f64 {
        self.flops
    }

    /// Wall time (s) that the numeric factorisation will take on this machine, roughly; zero for small ones.
    pub fn expected_seconds(&self) -> f64 {
        expected_seconds(self.flops)
    }

    /// The order of elimination.
    pub fn ordering(&self) -> &DofOrdering {
        &self.ordering
    }
}

/// Nonzeros of L and floating point operations: a column with c entries costs c² multiplications and additions.
fn count(cholesky: &SymbolicCholesky<usize>) -> (usize, f64) {
    match cholesky.raw() {
        SymbolicCholeskyRaw::Supernodal(supernodes) => {
            let (mut nnz, mut flops) = (0, 0.0);
            for s in 0..supernodes.n_supernodes() {
                let columns = supernodes.supernode_end()[s] - supernodes.supernode_begin()[s];
                let below = supernodes.supernode(s).pattern().len();
                for c in 1..=columns {
                    nnz += below + c;
                    flops += ((below + c) as f64).powi(2);
                }
            }
            (nnz, flops)
        }
        SymbolicCholeskyRaw::Simplicial(columns) => {
            let heights = columns.col_ptr().windows(2).map(|w| w[1] - w[0]);
            (columns.len_val(), heights.map(|c| (c as f64).powi(2)).sum())
        }
    }
}

/// Size and cost of a factorisation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FactorInfo {
    /// Free degrees of freedom.
    pub dofs: usize,
    /// Nonzeros of K, both triangles.
    pub nnz_k: usize,
    /// Nonzeros of L, diagonal included (8 bytes each).
    pub nnz_l: usize,
    /// Floating point operations of the numeric factorisation.
    pub flops: f64,
    /// Smallest pivot relative to its diagonal entry of K, in (1e-11, 1]: small means hardly held.
    pub smallest_relative_pivot: f64,
    /// Wall time of the symbolic part (s).
    pub symbolic_seconds: f64,
    /// Wall time of the numeric part (s).
    pub numeric_seconds: f64,
}

/// A factorised stiffness matrix.
#[derive(Debug)]
pub struct Factor {
    pub(crate) symbolic: Arc<SymbolicFactor>,
    pub(crate) values: Vec<f64>,
    info: FactorInfo,
}

impl Factor {
    /// Orders by nested dissection, analyses and factorises the stiffness of a model under constraints.
    ///
    /// # Errors
    /// As [`NodeGraph::new`], [`DofOrdering::nested_dissection`], [`SymbolicFactor::new`] and
    /// [`Factor::from_symbolic`].
    pub fn of_model(model: &FeModel, dofs: &DofMap, k: &StiffnessMatrix) -> Result<Self, FeError> {
        let ordering = DofOrdering::nested_dissection(&NodeGraph::new(model, dofs)?, dofs)?;
        Self::new(k, ordering)
    }

    /// Analyses and factorises K in the given order.
    ///
    /// # Errors
    /// As [`SymbolicFactor::new`] and [`Factor::from_symbolic`].
    pub fn new(k: &StiffnessMatrix, ordering: DofOrdering) -> Result<Self, FeError> {
        Self::from_symbolic(Arc::new(SymbolicFactor::new(k, ordering)?), k)
    }

    /// Factorises K, whose pattern was analysed before. Only the lower triangle is read.
    ///
    /// # Errors
    /// [`FeError::PatternChanged`], [`FeError::NotPositiveDefinite`], [`FeError::OutOfMemory`].
    pub fn from_symbolic(
        symbolic: Arc<SymbolicFactor>,
        k: &StiffnessMatrix,
    ) -> Result<Self, FeError> {
        let start = Instant::now();
        if k.compute_nnz() != symbolic.nnz_k || k.ncols() != symbolic.cholesky.ncols() {
            return Err(FeError::PatternChanged {
                found: k.compute_nnz(),
                expected: symbolic.nnz_k,
            });
        }
        let length = symbolic.cholesky.len_val();
        let mut values = Vec::new();
        values
            .try_reserve_exact(length)
            .map_err(|_| FeError::OutOfMemory {
                bytes: length.saturating_mul(size_of::<f64>()),
            })?;
        // By all threads: one alone takes a second to touch new memory of a gigabyte for the first time.
        values.par_extend(rayon::iter::repeat_n(0.0, length));

        let par = faer::get_global_parallelism();
        let request = symbolic
            .cholesky
            .factorize_numeric_llt_scratch::<f64>(par, Spec::default());
        let mut memory = MemBuffer::try_new(request).map_err(|_| FeError::OutOfMemory {
            bytes: request.unaligned_bytes_required(),
        })?;
        symbolic
            .cholesky
            .factorize_numeric_llt(
                &mut values,
                k.as_ref(),
                Side::Lower,
                Default::default(),
                par,
                MemStack::new(&mut memory),
                Spec::default(),
            )
            .map_err(
                |PivotError::NonPositivePivot { index }| FeError::NotPositiveDefinite {
                    free_dof: symbolic.ordering.forward()[index],
                },
            )?;
        drop(memory);
        let smallest_relative_pivot = check_pivots(&symbolic, &values, k)?;
        let info = FactorInfo {
            dofs: k.ncols(),
            nnz_k: symbolic.nnz_k,
            nnz_l: symbolic.nnz_l,
            flops: symbolic.flops,
            smallest_relative_pivot,
            symbolic_seconds: symbolic.seconds,
            numeric_seconds: start.elapsed().as_secs_f64(),
        };
        Ok(Self {
            symbolic,
            values,
            info,
        })
    }

    /// Size and cost.
    pub fn info(&self) -> FactorInfo {
        self.info
    }

    /// The symbolic part, for another matrix with the same pattern.
    pub fn symbolic(&self) -> &Arc<SymbolicFactor> {
        &self.symbolic
    }

    /// Number of free degrees of freedom.
    pub fn size(&self) -> usize {
        self.info.dofs
    }

    /// Solves K X = B; B (free x columns) is overwritten with X. Blocks of 32 columns run in parallel.
    ///
    /// For one factor each column is the same to the last bit for any number of threads; the values of the factor
    /// itself are so after [`crate::split_alike`]. Scratch memory: one block per thread.
    ///
    /// # Panics
    /// If `rhs` does not have [`Factor::size`] rows.
    pub fn solve_in_place(&self, rhs: MatMut<'_, f64>) {
        assert_eq!(rhs.nrows(), self.size(), "rows of the right-hand side");
        let llt = LltRef::new(&self.symbolic.cholesky, &self.values);
        rhs.par_col_chunks_mut(SOLVE_COLUMNS).for_each(|block| {
            let request = self
                .symbolic
                .cholesky
                .solve_in_place_scratch::<f64>(block.ncols(), Par::Seq);
            let mut memory = MemBuffer::new(request);
            llt.solve_in_place_with_conj(Conj::No, block, Par::Seq, MemStack::new(&mut memory));
        });
    }

    /// Solves K x = b for one vector in place. Many vectors are cheaper together, see [`Factor::solve_in_place`].
    ///
    /// # Panics
    /// If `rhs` does not have [`Factor::size`] entries.
    pub fn solve_slice_in_place(&self, rhs: &mut [f64]) {
        assert_eq!(rhs.len(), self.size(), "entries of the right-hand side");
        let rows = rhs.len();
        self.solve_in_place(MatMut::from_column_major_slice_mut(rhs, rows, 1));
    }
}

/// Smallest L_ii²/K_ii.
///
/// # Errors
/// [`FeError::NotPositiveDefinite`] where it is below [`SMALLEST_RELATIVE_PIVOT`].
fn check_pivots(
    symbolic: &SymbolicFactor,
    values: &[f64],
    k: &StiffnessMatrix,
) -> Result<f64, FeError> {
    let pivots: Vec<f64> = match symbolic.cholesky.raw() {
        SymbolicCholeskyRaw::Supernodal(supernodes) => (0..supernodes.n_supernodes())
            .flat_map(|s| {
                let columns = supernodes.supernode_end()[s] - supernodes.supernode_begin()[s];
                let rows = columns + supernodes.supernode(s).pattern().len();
                let first = supernodes.col_ptr_for_val()[s];
                (0..columns).map(move |c| values[first + c * rows + c])
            })
            .collect(),
        SymbolicCholeskyRaw::Simplicial(columns) => columns.col_ptr()[..columns.ncols()]
            .iter()
            .map(|first| values[*first])
            .collect(),
    };
    let mut smallest = f64::INFINITY;
    for (new, l) in pivots.into_iter().enumerate() {
        let old = symbolic.ordering.forward()[new];
        let diagonal = k.get(old, old).copied().unwrap_or(0.0);
        let relative = l * l / diagonal;
        if relative.is_nan() || relative <= SMALLEST_RELATIVE_PIVOT {
            return Err(FeError::NotPositiveDefinite { free_dof: old });
        }
        smallest = smallest.min(relative);
    }
    Ok(smallest)
}
