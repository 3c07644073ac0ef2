//! The linear system of every Newton step, scaled so that its condition depends neither on units nor on the step.
//!
//! ```text
//! [A   Bᵀ] [δ]   [r]
//! [B̄   0 ] [μ] = [p]          A: n × n, like a mass matrix; B̄ = B or B T
//! ```
//!
//! With D = diag(M)^(−1/2) and σ_i = 1/‖D B_i‖ the factorised matrix is [D A D, D Bᵀσ; σ B̄ D, 0], whose entries are of
//! order 1. The caller multiplies the equations of motion by βh² and takes μ = βh² δλ, so that nothing grows as h → 0.
//! Source: C. L. Bottasso, D. Dopico, L. Trainelli, Multibody Syst. Dyn. 19 (2008) 3-20.
//!
//! Coordinates of elements without mass have a column scale from their own, and a row scale that makes the largest of
//! their row 1.
//!
//! The matrix has entries where bodies meet in a joint or an element. Small or full ones are factorised as dense
//! matrices, others as sparse ones, [`LinearSolver::Automatic`]. Where the two cross was measured:
//! docs/decisions/0010-sparse-system-matrix.md.

use std::sync::Arc;

use crate::dense_lu::DenseLu;
use crate::matrix::Matrix;
use crate::pattern::Pattern;
use crate::scheme::LinearSolver;
use crate::sparse_lu::{Ordered, SparseLu};
use crate::structure::Structure;

/// Unknowns below which the dense solver is always as fast.
const SMALLEST_SPARSE: usize = 60;

/// Multiplications that the dense solver makes in the time of one of the sparse solver.
const DENSE_SPEED: f64 = 8.0;

/// The system before its values are known: pattern, order of elimination, and where its parts stand.
#[derive(Debug)]
pub(crate) struct SaddleForm {
    kept: Vec<usize>,
    pattern: Arc<Pattern>,
    /// Where the entries of B̄ stand, for each kept equation those of its gradient.
    lower: Vec<usize>,
    /// None where the dense solver serves.
    ordered: Option<Arc<Ordered>>,
}

impl SaddleForm {
    /// For a structure of matrices and the kept equations.
    pub(crate) fn new(structure: &Structure, kept: &[usize], solver: LinearSolver) -> Self {
        let n = structure.square.columns();
        let mut columns: Vec<Vec<usize>> = (0..n)
            .map(|j| structure.square.column(j).to_vec())
            .collect();
        for (i, &equation) in kept.iter().enumerate() {
            let rows = structure.gradient.column(equation);
            for &dof in rows {
                columns[dof].push(n + i);
            }
            columns.push(rows.to_vec());
        }
        let pattern = Pattern::from_columns(n + kept.len(), columns);
        let of_row = |(i, &equation): (usize, &usize)| {
            let dofs = structure.gradient.column(equation).iter();
            dofs.filter_map(|&dof| pattern.place(n + i, dof))
                .collect::<Vec<_>>()
        };
        let lower = kept.iter().enumerate().flat_map(of_row).collect();
        let size = pattern.columns();
        let ordered = match solver {
            LinearSolver::Dense => None,
            LinearSolver::Automatic if size < SMALLEST_SPARSE => None,
            _ => Ordered::new(pattern.clone()).map(Arc::new),
        };
        let dense = (size as f64).powi(3) / 3.0;
        let ordered = ordered.filter(|ordered| {
            solver == LinearSolver::Sparse || ordered.multiplications * DENSE_SPEED < dense
        });
        Self {
            kept: kept.to_vec(),
            pattern: Arc::new(pattern),
            lower,
            ordered,
        }
    }
}

enum Factors {
    Dense(DenseLu),
    Sparse(Box<SparseLu>),
}

/// Factors and scales.
pub(crate) struct Saddle {
    form: Arc<SaddleForm>,
    scale: Vec<f64>,
    /// Scales of equations; those of the unknowns but where an equation has no mass, whose size is then read off the
    /// matrix.
    left: Vec<f64>,
    massless: Vec<usize>,
    row_scale: Vec<f64>,
    values: Vec<f64>,
    factors: Factors,
    work: Vec<f64>,
}

impl Saddle {
    /// For `mass_diagonal` of all degrees of freedom; `massless` of them have equations without mass.
    pub(crate) fn new(
        mass_diagonal: &[f64],
        massless: impl Iterator<Item = usize>,
        form: &Arc<SaddleForm>,
    ) -> Self {
        let size = form.pattern.columns();
        let scale: Vec<f64> = mass_diagonal.iter().map(|m| 1.0 / m.sqrt()).collect();
        Self {
            left: scale.clone(),
            massless: massless.collect(),
            scale,
            row_scale: vec![1.0; form.kept.len()],
            values: vec![0.0; form.pattern.len()],
            factors: match &form.ordered {
                Some(ordered) => Factors::Sparse(Box::new(SparseLu::new(ordered))),
                None => Factors::Dense(DenseLu::new(size)),
            },
            work: vec![0.0; size],
            form: Arc::clone(form),
        }
    }

    /// Whether the matrix is kept and factorised as a sparse one.
    pub(crate) fn is_sparse(&self) -> bool {
        matches!(self.factors, Factors::Sparse(_))
    }

    /// Factorises; `gradient` is Bᵀ and `turned` B̄ᵀ, one column for each equation. `false` if the matrix is singular.
    pub(crate) fn factor(&mut self, a: &Matrix, gradient: &Matrix, turned: &Matrix) -> bool {
        let (n, scale) = (self.scale.len(), &self.scale);
        for &dof in &self.massless {
            // The largest of its row is 1.
            let row = a.pattern().column(dof).iter();
            let size = row.map(|&j| (a.get(dof, j) * scale[j]).abs());
            let most = size.fold(0.0, f64::max);
            self.left[dof] = if most > 0.0 { 1.0 / most } else { 1.0 };
        }
        let left = &self.left;
        let starts = self.form.pattern.starts();
        for j in 0..n {
            let (rows, entries) = a.column(j);
            let places = self.values[starts[j]..].iter_mut();
            for ((place, entry), &row) in places.zip(entries).zip(rows) {
                *place = left[row] * entry * scale[j];
            }
        }
        for (i, &equation) in self.form.kept.iter().enumerate() {
            let (rows, entries) = gradient.column(equation);
            let scaled = rows.iter().zip(entries);
            let square: f64 = scaled.map(|(&row, b)| (b * scale[row]).powi(2)).sum();
            let sigma = if square > 0.0 {
                1.0 / square.sqrt()
            } else {
                1.0
            };
            self.row_scale[i] = sigma;
            let places = self.values[starts[n + i]..].iter_mut();
            for ((place, entry), &row) in places.zip(entries).zip(rows) {
                *place = scale[row] * entry * sigma;
            }
        }
        let mut places = self.form.lower.iter();
        for (&equation, sigma) in self.form.kept.iter().zip(&self.row_scale) {
            let (rows, entries) = turned.column(equation);
            for ((&row, entry), &place) in rows.iter().zip(entries).zip(places.by_ref()) {
                self.values[place] = sigma * entry * scale[row];
            }
        }
        self.factor_values()
    }

    fn factor_values(&mut self) -> bool {
        match &mut self.factors {
            Factors::Sparse(lu) => lu.factor(&self.values),
            Factors::Dense(lu) => {
                let pattern = &self.form.pattern;
                let dense = lu.values_mut();
                dense.fill(0.0);
                let size = pattern.columns();
                for (j, column) in dense.chunks_mut(size.max(1)).enumerate() {
                    let values = &self.values[pattern.range(j)];
                    for (&row, value) in pattern.column(j).iter().zip(values) {
                        column[row] = *value;
                    }
                }
                lu.factor()
            }
        }
    }

    /// Solves for right-hand sides r (n) and p (one for each equation, dropped ones ignored); δ goes to `delta`, μ to
    /// `mu`, zero for dropped equations.
    pub(crate) fn solve(&mut self, r: &[f64], p: &[f64], delta: &mut [f64], mu: &mut [f64]) {
        let n = self.scale.len();
        let kept = &self.form.kept;
        let (upper, lower) = self.work.split_at_mut(n);
        for ((place, value), d) in upper.iter_mut().zip(r).zip(&self.left) {
            *place = value * d;
        }
        for ((place, &equation), sigma) in lower.iter_mut().zip(kept).zip(&self.row_scale) {
            *place = p[equation] * sigma;
        }
        match &mut self.factors {
            Factors::Dense(lu) => lu.solve(&mut self.work),
            Factors::Sparse(lu) => lu.solve(&mut self.work),
        }
        for ((place, value), d) in delta.iter_mut().zip(&self.work).zip(&self.scale) {
            *place = value * d;
        }
        mu.fill(0.0);
        for ((value, &equation), sigma) in self.work[n..].iter().zip(kept).zip(&self.row_scale) {
            mu[equation] = value * sigma;
        }
    }

    /// What a checkpoint needs to go on with the same factors: the scaled matrix, the scales of its joint rows, and the
    /// matrix for which the pivots of a sparse one were chosen.
    pub(crate) fn save(&self, out: &mut Vec<f64>) {
        out.extend_from_slice(&self.values);
        out.extend_from_slice(&self.row_scale);
        out.extend(self.massless.iter().map(|&dof| self.left[dof]));
        if let Factors::Sparse(lu) = &self.factors {
            out.extend_from_slice(lu.pivoted());
            // Before the first factors there are none.
            out.resize(self.saved(), 0.0);
        }
    }

    /// Length of what [`Self::save`] appends.
    pub(crate) fn saved(&self) -> usize {
        let matrices = if self.is_sparse() { 2 } else { 1 };
        matrices * self.values.len() + self.row_scale.len() + self.massless.len()
    }

    /// Factorises what was saved, which gives the same bits as when it was made.
    pub(crate) fn restore(&mut self, saved: &[f64]) {
        let (values, rest) = saved.split_at(self.values.len());
        let (row_scale, rest) = rest.split_at(self.row_scale.len());
        let (left, pivoted) = rest.split_at(self.massless.len());
        for (&dof, value) in self.massless.iter().zip(left) {
            self.left[dof] = *value;
        }
        self.values.copy_from_slice(values);
        self.row_scale.copy_from_slice(row_scale);
        if let Factors::Sparse(lu) = &mut self.factors {
            lu.pivot(pivoted);
        }
        // A run that has not begun has no factors yet, nothing but zeros.
        self.factor_values();
    }

    /// How often pivots of a sparse matrix were chosen.
    pub(crate) fn pivotings(&self) -> u64 {
        match &self.factors {
            Factors::Sparse(lu) => lu.pivotings,
            Factors::Dense(_) => 0,
        }
    }
}
