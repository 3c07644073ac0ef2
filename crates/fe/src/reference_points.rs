//! The rows and columns of reference points beside the nodal part of a matrix.
//!
//! With u = T q and T = [I 0; 0 R] over free nodes and rigid ones, TᵀKT is the nodal part K_ff bordered by K_fr R and
//! Rᵀ K_rr R. Only elements that touch a rigid node contribute to the border.

use faer::sparse::{SparseColMat, SymbolicSparseColMat};
use rayon::prelude::*;

use crate::compressed_columns::SparseMatrix;
use crate::constraints::DofMap;
use crate::element_matrix::ElementMatrix;
use crate::error::FeError;
use crate::model::FeModel;

/// The matrix over all free unknowns from its part over the nodal ones.
pub(crate) fn add_reference_points(
    nodal: &SparseMatrix,
    model: &FeModel,
    dofs: &DofMap,
    element_matrix: impl Fn(usize) -> Result<ElementMatrix, FeError> + Sync,
) -> Result<SparseMatrix, FeError> {
    let border = Border::new(model, dofs, element_matrix)?;
    let (first, size) = (dofs.nodal_free_count(), dofs.free_count());
    let mut offsets = Vec::with_capacity(size + 1);
    let (mut rows, mut values) = (Vec::new(), Vec::new());
    offsets.push(0);
    for column in 0..first {
        rows.extend_from_slice(nodal.row_idx_of_col_raw(column));
        values.extend_from_slice(nodal.val_of_col(column));
        if border.touched[column] {
            rows.extend(first..size);
            values.extend(border.columns.iter().map(|c| c[column]));
        }
        offsets.push(rows.len());
    }
    for (r, column) in border.columns.iter().enumerate() {
        for row in (0..first).filter(|row| border.touched[*row]) {
            rows.push(row);
            values.push(column[row]);
        }
        for (s, other) in border.columns.iter().enumerate() {
            rows.push(first + s);
            // One triangle for both, so that the matrix is symmetric to the last bit.
            values.push(if s <= r {
                column[first + s]
            } else {
                other[first + r]
            });
        }
        offsets.push(rows.len());
    }
    let symbolic = SymbolicSparseColMat::new_checked(size, size, offsets, None, rows);
    Ok(SparseColMat::new(symbolic, values))
}

/// The columns of the reference points.
struct Border {
    /// One full column per free unknown of the reference points.
    columns: Vec<Vec<f64>>,
    /// Nodal unknowns that share an element with a rigid node.
    touched: Vec<bool>,
}

impl Border {
    fn new(
        model: &FeModel,
        dofs: &DofMap,
        element_matrix: impl Fn(usize) -> Result<ElementMatrix, FeError> + Sync,
    ) -> Result<Self, FeError> {
        let first = dofs.nodal_free_count();
        let elements: Vec<usize> = (0..model.element_count())
            .filter(|&e| model.element_nodes(e).iter().any(|n| dofs.is_rigid(*n)))
            .collect();
        let matrices = elements
            .par_iter()
            .map(|&e| element_matrix(e))
            .collect::<Result<Vec<_>, _>>()?;
        let mut columns = vec![vec![0.0; dofs.free_count()]; dofs.free_count() - first];
        let mut touched = vec![false; first];
        for (&element, matrix) in elements.iter().zip(&matrices) {
            let t: Vec<Vec<(usize, f64)>> = model
                .element_dofs(element)?
                .into_iter()
                .map(|dof| dofs.row(dof))
                .collect();
            for (free, _) in t.iter().flatten().filter(|(free, _)| *free < first) {
                touched[*free] = true;
            }
            for (j, row_j) in t.iter().enumerate() {
                for &(q, factor_q) in row_j.iter().filter(|(q, _)| *q >= first) {
                    let column = &mut columns[q - first];
                    for (i, row_i) in t.iter().enumerate() {
                        for &(p, factor_p) in row_i {
                            column[p] += factor_p * matrix[(i, j)] * factor_q;
                        }
                    }
                }
            }
        }
        Ok(Self { columns, touched })
    }
}
