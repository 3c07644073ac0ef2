//! Products of a symmetric sparse matrix with a few vectors, without the zeros that it stores.
//!
//! By symmetry column i is row i, so each row of the result is a sum over one column, rows in parallel and each always
//! in the same order. Two thirds of a mass matrix in the pattern of the stiffness are zeros. faer's product scatters
//! column by column, by one thread and zeros included; it took three quarters of a mode search.

use faer::{Mat, MatRef};
use rayon::prelude::*;

use crate::assembly::SparseMatrix;

/// Columns that are summed together: they fill the vector registers.
const WIDTH: usize = 8;

/// A matrix A = Aᵀ, its non-zeros row by row.
#[derive(Debug, Clone)]
pub struct SymmetricRows {
    offsets: Vec<usize>,
    entries: Vec<(u32, f64)>,
}

impl SymmetricRows {
    /// The non-zeros of a symmetric matrix of which both triangles are stored.
    pub fn new(matrix: &SparseMatrix) -> Self {
        let mut offsets = vec![0];
        let mut entries = Vec::new();
        for i in 0..matrix.ncols() {
            let column = matrix.row_idx_of_col(i).zip(matrix.val_of_col(i));
            entries.extend(
                column
                    .filter(|(_, v)| **v != 0.0)
                    .map(|(r, v)| (r as u32, *v)),
            );
            offsets.push(entries.len());
        }
        Self { offsets, entries }
    }

    /// A X; the same to the last bit for any number of threads.
    ///
    /// # Panics
    /// If X does not have the rows of A.
    pub fn product(&self, x: MatRef<'_, f64>) -> Mat<f64> {
        let (n, columns) = (x.nrows(), x.ncols());
        assert_eq!(self.offsets.len(), n + 1, "rows of the vectors");
        let mut result = Mat::zeros(n, columns);
        for first in (0..columns).step_by(WIDTH) {
            let count = WIDTH.min(columns - first);
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
                    for &(row, value) in &self.entries[self.offsets[i]..self.offsets[i + 1]] {
                        let x = &rows[row as usize];
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
