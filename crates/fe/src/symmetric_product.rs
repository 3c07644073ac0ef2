//! Products of a symmetric sparse matrix with a few vectors, without the zeros that it stores.
//!
//! By symmetry column i is row i, so each row of the result is a sum over one column, rows in parallel and each always
//! in the same order. Two thirds of a mass matrix in the pattern of the stiffness are zeros. faer's product scatters
//! column by column, by one thread and zeros included; it took three quarters of a mode search.

use faer::{Mat, MatRef};
use rayon::prelude::*;
use sprs::CsMatI;

use crate::compressed_columns::{SparseMatrix, compressed_columns};

/// Columns that are summed together: they fill the vector registers.
const WIDTH: usize = 8;

/// A matrix A = Aᵀ, its non-zeros row by row.
#[derive(Debug, Clone)]
pub struct SymmetricRows(CsMatI<f64, u32, usize>);

impl SymmetricRows {
    /// The non-zeros of a symmetric matrix of which both triangles are stored.
    pub fn new(matrix: &SparseMatrix) -> Self {
        let (mut starts, mut columns, mut values) = (vec![0], Vec::new(), Vec::new());
        for column in compressed_columns(matrix).outer_iterator() {
            for (row, &value) in column.iter().filter(|(_, value)| **value != 0.0) {
                columns.push(row as u32);
                values.push(value);
            }
            starts.push(values.len());
        }
        let size = (matrix.nrows(), matrix.ncols());
        Self(CsMatI::new(size, starts, columns, values))
    }

    /// A X; the same to the last bit for any number of threads.
    ///
    /// # Panics
    /// If X does not have the rows of A.
    pub fn product(&self, x: MatRef<'_, f64>) -> Mat<f64> {
        let (n, vectors) = (x.nrows(), x.ncols());
        assert_eq!(self.0.rows(), n, "rows of the vectors");
        let starts = self.0.proper_indptr();
        let (columns, values) = (self.0.indices(), self.0.data());
        let mut result = Mat::zeros(n, vectors);
        for first in (0..vectors).step_by(WIDTH) {
            let count = WIDTH.min(vectors - first);
            // Row by row, so that one entry of A meets neighbouring numbers; columns beyond the last are zero.
            let mut rows = vec![[0.0; WIDTH]; n];
            for c in 0..count {
                for (row, value) in rows.iter_mut().zip(x.col(first + c).iter()) {
                    row[c] = *value;
                }
            }
            let sums: Vec<[f64; WIDTH]> = (0..n)
                .into_par_iter()
                .with_min_len(256)
                .map(|i| {
                    let mut sum = [0.0; WIDTH];
                    let places = starts[i]..starts[i + 1];
                    for (&column, &value) in columns[places.clone()].iter().zip(&values[places]) {
                        let x = &rows[column as usize];
                        for c in 0..WIDTH {
                            sum[c] += value * x[c];
                        }
                    }
                    sum
                })
                .collect();
            for c in 0..count {
                for (value, sum) in result.col_mut(first + c).iter_mut().zip(&sums) {
                    *value = sum[c];
                }
            }
        }
        result
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::{DofMap, Element, FeModel, Material, StructuredMesh, assemble_stiffness};

    #[test]
    fn equals_the_product_of_faer() {
        let mesh = StructuredMesh::block([3, 2, 2], [1.0, 2.0, 3.0]);
        let material = Material::new(1.0, 0.3).unwrap();
        let model = FeModel::new(mesh.nodes, mesh.hexes, material, Element::Hex8).unwrap();
        let dofs = DofMap::with_fixed_dofs(model.node_count(), &[0, 4, 9]).unwrap();
        let k = assemble_stiffness(&model, &dofs).unwrap();
        let x = Mat::from_fn(dofs.free_count(), 13, |i, j| {
            ((7 * i + 3 * j) % 11) as f64 - 5.0
        });
        let difference = SymmetricRows::new(&k).product(x.as_ref()) - &k * &x;
        assert!(difference.norm_max() < 1e-14 * (&k * &x).norm_max());
    }
}
