//! A dense matrix in columns with the few additions that assembly needs.

use nalgebra::{Matrix3, Vector3};

/// Dense matrix, column after column.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Matrix {
    rows: usize,
    columns: usize,
    values: Vec<f64>,
}

impl Matrix {
    pub(crate) fn zeros(rows: usize, columns: usize) -> Self {
        Self {
            rows,
            columns,
            values: vec![0.0; rows * columns],
        }
    }

    pub(crate) fn rows(&self) -> usize {
        self.rows
    }

    pub(crate) fn columns(&self) -> usize {
        self.columns
    }

    pub(crate) fn clear(&mut self) {
        self.values.fill(0.0);
    }

    pub(crate) fn get(&self, row: usize, column: usize) -> f64 {
        self.values[column * self.rows + row]
    }

    pub(crate) fn column(&self, column: usize) -> &[f64] {
        &self.values[column * self.rows..][..self.rows]
    }

    pub(crate) fn column_mut(&mut self, column: usize) -> &mut [f64] {
        &mut self.values[column * self.rows..][..self.rows]
    }

    pub(crate) fn add(&mut self, row: usize, column: usize, value: f64) {
        self.values[column * self.rows + row] += value;
    }

    /// Adds a 3×3 block.
    pub(crate) fn add3(&mut self, row: usize, column: usize, block: &Matrix3<f64>) {
        for (j, values) in block.column_iter().enumerate() {
            let target = &mut self.column_mut(column + j)[row..row + 3];
            for (place, value) in target.iter_mut().zip(&values) {
                *place += value;
            }
        }
    }

    /// Adds three entries of one column.
    pub(crate) fn add_column(&mut self, row: usize, column: usize, values: &Vector3<f64>) {
        for i in 0..3 {
            self.add(row + i, column, values[i]);
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
        self.add_column(row, column, values);
        self.add_row(column, row, values);
    }

    /// Takes entries, column after column.
    pub(crate) fn set(&mut self, values: &[f64]) {
        self.values.copy_from_slice(values);
    }

    /// Takes the entries of a matrix of the same shape.
    pub(crate) fn copy_from(&mut self, other: &Self) {
        self.values.copy_from_slice(&other.values);
    }

    /// Σ factor · matrix, all of this one's shape.
    pub(crate) fn set_combination(&mut self, factors: [f64; 3], matrices: [&Self; 3]) {
        let [a, b, c] = matrices.map(|matrix| matrix.values.iter());
        for (((place, a), b), c) in self.values.iter_mut().zip(a).zip(b).zip(c) {
            *place = factors[0] * a + factors[1] * b + factors[2] * c;
        }
    }

    /// Multiplies three columns by `t` from the right.
    pub(crate) fn turn_columns(&mut self, first: usize, t: &Matrix3<f64>) {
        for row in 0..self.rows {
            let old = [0, 1, 2].map(|k| self.get(row, first + k));
            for k in 0..3 {
                let new = old[0] * t[(0, k)] + old[1] * t[(1, k)] + old[2] * t[(2, k)];
                self.values[(first + k) * self.rows + row] = new;
            }
        }
    }

    /// Multiplies three rows by `tᵀ` from the left.
    pub(crate) fn turn_rows(&mut self, first: usize, t: &Matrix3<f64>) {
        for column in self.values.chunks_mut(self.rows) {
            let old = Vector3::from_column_slice(&column[first..first + 3]);
            column[first..first + 3].copy_from_slice(t.tr_mul(&old).as_slice());
        }
    }

    /// The columns one after the other.
    pub(crate) fn values(&self) -> &[f64] {
        &self.values
    }
}
