//! Static condensation: a part is replaced by its stiffness at some kept nodes.
//!
//! With the displacements ordered into interior I and kept B, K = L Lᵀ and p a load,
//!
//! ```text
//!     S   = K_BB - K_BI K_II^-1 K_IB = L'_BB L'_BBᵀ     stiffness of the part at its kept nodes
//!     y_I = L_II^-1 p_I                                 what the load does inside, with B held
//!     p_B' = p_B - K_BI K_II^-1 p_I = p_B - L_BI y_I    the load carried to the kept nodes
//!     p_Iᵀ K_II^-1 q_I = y_I(p)ᵀ y_I(q)                 displacement work inside, with B held
//!     u_I = L_II^-ᵀ (y_I - L_BIᵀ u_B)                   the interior again
//! ```
//!
//! so that one factorisation with the kept nodes last serves everything: carrying loads out is its forward half,
//! finding the interior its backward half. The part may float: its own S is then singular. The factorisation is
//! therefore made of K with the diagonal of K_BB doubled, D = diag K_BB; only L_BB sees this, and
//! S = L_BB L_BBᵀ − D undoes it at the level of rounding in K_BB itself.
//!
//! Source: R. J. Guyan, *Reduction of stiffness and mass matrices*, AIAA J. 3 (1965) 380; the block form of Cholesky.

use crate::compressed_columns::StiffnessMatrix;
use crate::error::FeError;
use crate::factor::{Factor, FactorInfo, SymbolicFactor};
use crate::ordering::DofOrdering;
use faer::{ColMut, Mat, MatRef};
use std::sync::Arc;

/// A part condensed to its kept nodes.
#[derive(Debug)]
pub struct StaticCondensation {
    factor: Factor,
    interior: usize,
    /// L_BB of the part with doubled diagonal.
    kept_factor: Mat<f64>,
    stiffness: Mat<f64>,
}

/// Loads carried to the kept nodes.
#[derive(Debug, Clone)]
pub struct CondensedLoads {
    /// p_B', kept displacements × loads (N).
    pub kept: Mat<f64>,
    /// y_I where it is not zero: `rows` × loads. Loads on a small part of the body reach few rows.
    pub(crate) interior: Mat<f64>,
    /// Places of these rows in the order of elimination, ascending.
    pub(crate) rows: Vec<usize>,
}

impl CondensedLoads {
    /// p_Iᵀ K_II⁻¹ q_I for all pairs of loads p of `self` (rows) and q of `other` (columns), of the same part.
    pub fn gram(&self, other: &Self) -> Mat<f64> {
        if self.rows == other.rows {
            return self.interior.transpose() * &other.interior;
        }
        let common: Vec<(usize, usize)> = (self.rows.iter().enumerate())
            .filter_map(|(i, row)| Some((i, other.rows.binary_search(row).ok()?)))
            .collect();
        let pick = |m: &Mat<f64>, row: &dyn Fn(usize) -> usize| {
            Mat::from_fn(common.len(), m.ncols(), |i, j| m[(row(i), j)])
        };
        pick(&self.interior, &|i| common[i].0).transpose() * pick(&other.interior, &|i| common[i].1)
    }

    /// Numbers kept of each load's y_I: the effort of [`CondensedLoads::gram`].
    pub fn interior_rows(&self) -> usize {
        self.rows.len()
    }

    /// Writes y_I of one load into a column over all interior displacements, as [`StaticCondensation::expand`] wants
    /// it.
    ///
    /// # Panics
    /// If there is no such load or the column is shorter than the interior.
    pub fn put_interior(&self, load: usize, mut column: ColMut<'_, f64>) {
        for (i, &row) in self.rows.iter().enumerate() {
            column[row] = self.interior[(i, load)];
        }
    }
}

impl StaticCondensation {
    /// Condenses a part with stiffness `k` (three rows a node; its lower triangle is read) to the nodes `kept`. What
    /// belongs to kept nodes is ordered as `kept`, three displacements each.
    ///
    /// # Errors
    /// [`FeError::NotPositiveDefinite`] when the interior can move with the kept nodes held; those of
    /// [`DofOrdering::interior_first`].
    pub fn new(k: StiffnessMatrix, kept: &[usize]) -> Result<Self, FeError> {
        Self::announced(k, &[], kept, |_| ())
    }

    /// As [`StaticCondensation::new`]; the nodes `late` of the interior are eliminated after its other ones
    /// ([`DofOrdering::interior_first`]), `before` is told what will be factorised, so that it can say how long that
    /// takes.
    ///
    /// # Errors
    /// As [`StaticCondensation::new`].
    pub fn announced(
        mut k: StiffnessMatrix,
        late: &[usize],
        kept: &[usize],
        before: impl FnOnce(&SymbolicFactor),
    ) -> Result<Self, FeError> {
        let ordering = DofOrdering::interior_first(&k, late, kept)?;
        let diagonal: Vec<f64> = kept
            .iter()
            .flat_map(|node| 3 * node..3 * node + 3)
            .map(|dof| {
                let entry = k.get_mut(dof, dof);
                entry.map_or(0.0, |value| {
                    let single = *value;
                    *value *= 2.0;
                    single
                })
            })
            .collect();
        let symbolic = SymbolicFactor::new(&k, ordering)?;
        before(&symbolic);
        let factor = Factor::from_symbolic(Arc::new(symbolic), &k)?;
        let interior = factor.size() - diagonal.len();
        let kept_factor = factor.trailing_block(interior);
        let mut stiffness = &kept_factor * kept_factor.transpose();
        for (i, value) in diagonal.into_iter().enumerate() {
            stiffness[(i, i)] -= value;
        }
        Ok(Self {
            factor,
            interior,
            kept_factor,
            stiffness,
        })
    }

    /// S, the stiffness at the kept nodes (N/m).
    pub fn stiffness(&self) -> MatRef<'_, f64> {
        self.stiffness.as_ref()
    }

    /// Displacements of the part, interior and kept.
    pub fn size(&self) -> usize {
        self.factor.size()
    }

    /// Displacements of its interior.
    pub fn interior_size(&self) -> usize {
        self.interior
    }

    /// Size and cost of the factorisation.
    pub fn info(&self) -> FactorInfo {
        self.factor.info()
    }

    /// Carries loads (all displacements of the part × loads, N) to the kept nodes.
    ///
    /// # Panics
    /// If `loads` does not have [`StaticCondensation::size`] rows.
    pub fn condense(&self, loads: MatRef<'_, f64>) -> CondensedLoads {
        assert_eq!(loads.nrows(), self.size(), "rows of the loads");
        self.condense_at(|dof| dof, loads)
    }

    /// As [`StaticCondensation::condense`] for loads at some displacements only, `dof` of each row of `loads`. What is
    /// eliminated before the first of them takes neither time nor memory.
    ///
    /// # Panics
    /// If the part has no such displacement.
    pub fn condense_at(
        &self,
        dof: impl Fn(usize) -> usize,
        loads: MatRef<'_, f64>,
    ) -> CondensedLoads {
        let place = self.factor.symbolic().ordering().inverse();
        let columns = loads.ncols();
        let is_loaded = |i: &usize| (0..columns).any(|j| loads[(*i, j)] != 0.0);
        let loaded: Vec<usize> = (0..loads.nrows()).filter(is_loaded).collect();
        let begin = loaded.iter().map(|&i| place[dof(i)]).min();
        let begin = begin.map_or(self.interior, |row| row.min(self.interior));
        let first = self.factor.half_solve_start(begin);
        let mut y = Mat::zeros(self.size() - first, columns);
        for &i in &loaded {
            let row = place[dof(i)] - first;
            for j in 0..columns {
                y[(row, j)] += loads[(i, j)];
            }
        }
        let mut rows = self.factor.lower_solve_in_place(y.as_mut());
        rows.truncate(rows.partition_point(|row| *row < self.interior));
        let (in_part, kept) = y.split_at_row(self.interior - first);
        CondensedLoads {
            kept: &self.kept_factor * kept,
            interior: Mat::from_fn(rows.len(), columns, |i, j| in_part[(rows[i] - first, j)]),
            rows,
        }
    }

    /// All displacements of the part (m) from those of the kept nodes and, where loads act inside, their y_I.
    ///
    /// # Panics
    /// If the arguments do not have the rows of this part or differ in their columns.
    pub fn expand(&self, kept: MatRef<'_, f64>, interior: Option<MatRef<'_, f64>>) -> Mat<f64> {
        let order = self.factor.symbolic().ordering();
        let mut x = Mat::zeros(self.size(), kept.ncols());
        if let Some(y) = interior {
            x.as_mut().subrows_mut(0, self.interior).copy_from(y);
        }
        // Chosen so that the backward half begins by giving back the kept displacements.
        let start = self.kept_factor.transpose() * kept;
        x.as_mut()
            .subrows_mut(self.interior, kept.nrows())
            .copy_from(start);
        self.factor.upper_solve_in_place(x.as_mut());
        let place = order.inverse();
        Mat::from_fn(self.size(), kept.ncols(), |i, j| x[(place[i], j)])
    }
}
