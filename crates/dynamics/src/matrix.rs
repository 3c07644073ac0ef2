//! A sparse matrix in columns, on a pattern that never changes, with the few additions that assembly needs.

use std::sync::Arc;

use nalgebra::{DMatrix, Matrix3, Vector3};
use sprs::CsMatView;

use crate::pattern::Pattern;

/// Values on a pattern, column after column. What is added outside the pattern is not kept, but known.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Matrix {
    pattern: Arc<Pattern>,
    values: Vec<f64>,
    outside: bool,
}

impl Matrix {
    pub(crate) fn zeros(pattern: &Arc<Pattern>) -> Self {
        Self {
            pattern: Arc::clone(pattern),
            values: vec![0.0; pattern.len()],
            outside: false,
        }
    }

    pub(crate) fn pattern(&self) -> &Pattern {
        &self.pattern
    }

    pub(crate) fn clear(&mut self) {
        self.values.fill(0.0);
        self.outside = false;
    }

    /// Whether something other than zero was added outside the pattern since the matrix was cleared.
    pub(crate) fn is_left(&self) -> bool {
        self.outside
    }

    /// Entry, zero outside the pattern.
    pub(crate) fn get(&self, row: usize, column: usize) -> f64 {
        let place = self.pattern.place(row, column);
        place.map_or(0.0, |place| self.values[place])
    }

    /// Rows and values of a column.
    #[inline]
    pub(crate) fn column(&self, column: usize) -> (&[usize], &[f64]) {
        let range = self.pattern.range(column);
        (self.pattern.column(column), &self.values[range])
    }

    /// Rows with their values of a column.
    #[inline]
    pub(crate) fn entries(&self, column: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let (rows, values) = self.column(column);
        rows.iter().copied().zip(values.iter().copied())
    }

    #[inline]
    pub(crate) fn add(&mut self, row: usize, column: usize, value: f64) {
        match self.pattern.place(row, column) {
            Some(place) => self.values[place] += value,
            None => self.outside |= value != 0.0,
        }
    }

    /// Adds to rows that follow one another, from `row` on. Rows of one body have no gaps.
    #[inline]
    pub(crate) fn add_column(&mut self, row: usize, column: usize, values: &[f64]) {
        let Some(place) = self.pattern.place(row, column) else {
            self.outside |= values.iter().any(|value| *value != 0.0);
            return;
        };
        let end = self.pattern.starts()[column + 1];
        let together = self.pattern.indices()[place..end].get(values.len() - 1);
        if together == Some(&(row + values.len() - 1)) {
            for (target, value) in self.values[place..].iter_mut().zip(values) {
                *target += value;
            }
        } else {
            for (i, value) in values.iter().enumerate() {
                self.add(row + i, column, *value);
            }
        }
    }

    /// Adds a 3×3 block.
    pub(crate) fn add3(&mut self, row: usize, column: usize, block: &Matrix3<f64>) {
        for (j, values) in block.as_slice().chunks_exact(3).enumerate() {
            self.add_column(row, column + j, values);
        }
    }

    /// Adds three entries of one row.
    pub(crate) fn add_row(&mut self, row: usize, column: usize, values: &Vector3<f64>) {
        for i in 0..3 {
            self.add(row, column + i, values[i]);
        }
    }

    /// Adds three entries of a column and their mirror images.
    pub(crate) fn add_pair(&mut self, row: usize, column: usize, values: &Vector3<f64>) {
        self.add_column(row, column, values.as_slice());
        self.add_row(column, row, values);
    }

    /// Takes away the values of another matrix, each from the place that `places` names; [`NOWHERE`] drops it.
    pub(crate) fn subtract_at(&mut self, values: &[f64], places: &[usize]) {
        for (value, &place) in values.iter().zip(places) {
            if place != NOWHERE {
                self.values[place] -= value;
            }
        }
    }

    /// Takes entries, column after column.
    pub(crate) fn set(&mut self, values: &[f64]) {
        self.values.copy_from_slice(values);
    }

    /// Takes the entries of a matrix of the same pattern.
    pub(crate) fn copy_from(&mut self, other: &Self) {
        self.values.copy_from_slice(&other.values);
    }

    /// Σ factor · matrix, all of this one's pattern.
    pub(crate) fn set_combination(&mut self, factors: [f64; 3], matrices: [&Self; 3]) {
        let [a, b, c] = matrices.map(|matrix| matrix.values.iter());
        for (((place, a), b), c) in self.values.iter_mut().zip(a).zip(b).zip(c) {
            *place = factors[0] * a + factors[1] * b + factors[2] * c;
        }
    }

    /// Multiplies three columns of one pattern, those of a body's rotation, by `t` from the right.
    pub(crate) fn turn_columns(&mut self, first: usize, t: &Matrix3<f64>) {
        let [a, b, c] = [0, 1, 2].map(|k| self.pattern.starts()[first + k]);
        for i in 0..b - a {
            let old = [a, b, c].map(|start| self.values[start + i]);
            for (k, start) in [a, b, c].into_iter().enumerate() {
                self.values[start + i] =
                    old[0] * t[(0, k)] + old[1] * t[(1, k)] + old[2] * t[(2, k)];
            }
        }
    }

    /// Multiplies three rows, those of a body's rotation, by `tᵀ` from the left; the pattern is symmetric.
    pub(crate) fn turn_rows(&mut self, first: usize, t: &Matrix3<f64>) {
        for at in self.pattern.range(first) {
            if let Some(place) = self.pattern.place(first, self.pattern.indices()[at]) {
                turn(&mut self.values[place..place + 3], t);
            }
        }
    }

    /// The same for all bodies of a gradient, whose rows come in sixes: `t` of the body whose degrees of freedom begin
    /// at a row.
    pub(crate) fn turn_bodies(&mut self, t: impl Fn(usize) -> Matrix3<f64>) {
        for (rows, values) in self
            .pattern
            .indices()
            .chunks_exact(6)
            .zip(self.values.chunks_exact_mut(6))
        {
            turn(&mut values[3..], &t(rows[0]));
        }
    }

    /// The columns one after the other.
    pub(crate) fn values(&self) -> &[f64] {
        &self.values
    }

    /// By compressed columns, nothing copied.
    pub(crate) fn view(&self) -> CsMatView<'_, f64> {
        let size = (self.pattern.rows(), self.pattern.columns());
        CsMatView::new_csc(
            size,
            self.pattern.starts(),
            self.pattern.indices(),
            &self.values,
        )
    }

    /// With all its zeros, for systems small enough.
    pub(crate) fn to_dense(&self) -> DMatrix<f64> {
        let mut dense = DMatrix::zeros(self.pattern.rows(), self.pattern.columns());
        for column in 0..self.pattern.columns() {
            for (row, value) in self.entries(column) {
                dense[(row, column)] = value;
            }
        }
        dense
    }
}

/// Stands for no place.
pub(crate) const NOWHERE: usize = usize::MAX;

/// Three values that follow one another, multiplied by `tᵀ`.
fn turn(values: &mut [f64], t: &Matrix3<f64>) {
    let old = Vector3::from_column_slice(values);
    values.copy_from_slice(t.tr_mul(&old).as_slice());
}
