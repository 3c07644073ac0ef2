//! The assembled matrices, by compressed columns; and as sprs sees them: products, sums, slices and Matrix Market files
//! for whoever takes them further.

use faer::sparse::SparseColMat;
use sprs::CsMatView;

/// A full symmetric matrix, compressed columns, rows ascending, over the free degrees of freedom.
pub type SparseMatrix = SparseColMat<usize, f64>;

/// Stiffness (N/m) over the free degrees of freedom.
pub type StiffnessMatrix = SparseMatrix;

/// A view of K or M by compressed columns; nothing is copied.
///
/// ```
/// use gearmesh_fe::{DofMap, Element, FeModel, Material, StructuredMesh};
/// use gearmesh_fe::{assemble_mass, assemble_stiffness, compressed_columns};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let mesh = StructuredMesh::block([2, 2, 2], [0.04, 0.02, 0.02]);
/// let model = FeModel::new(mesh.nodes, mesh.hexes, Material::new(210e9, 0.3)?, Element::Hex8)?;
/// let dofs = DofMap::all_free(model.node_count())?;
/// let (k, m) = (assemble_stiffness(&model, &dofs)?, assemble_mass(&model, &dofs, 7850.0)?);
/// let (k, m) = (compressed_columns(&k), compressed_columns(&m));
///
/// // A rigid translation along z costs no force, and its momentum is that of the whole mass.
/// let along_z: Vec<f64> = (0..dofs.free_count()).map(|i| f64::from(i % 3 == 2)).collect();
/// let product = |matrix, of: &[f64]| {
///     let mut result = vec![0.0; of.len()];
///     sprs::prod::mul_acc_mat_vec_csc(matrix, of, &mut result[..]);
///     result
/// };
/// let force = product(k, &along_z);
/// let stiffest = k.data().iter().fold(0.0_f64, |most, value| most.max(value.abs()));
/// assert!(force.iter().all(|f| f.abs() < 1e-12 * stiffest));
/// let momentum = product(m, &along_z);
/// assert!((momentum.iter().sum::<f64>() - 7850.0 * 1.6e-5).abs() < 1e-12);
///
/// // Another program reads it as text.
/// let mut text = Vec::new();
/// sprs::io::write_matrix_market_to_bufwrite(&mut text, &k)?;
/// assert!(text.starts_with(b"%%MatrixMarket matrix coordinate real general"));
/// # Ok(())
/// # }
/// ```
#[must_use]
pub fn compressed_columns(matrix: &SparseMatrix) -> CsMatView<'_, f64> {
    let places = matrix.symbolic();
    CsMatView::new_csc(
        (matrix.nrows(), matrix.ncols()),
        places.col_ptr(),
        places.row_idx(),
        matrix.val(),
    )
}
