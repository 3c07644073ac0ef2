//! Compliance of a finite element model by one factorisation of all of it.

use faer::Mat;
use gearmesh_fe::{DofMap, Factor, FeModel, assemble_stiffness};

/// aᵀ K⁻¹ b for all pairs of sparse vectors over the degrees of freedom; what is fixed counts as nothing.
pub fn products(model: &FeModel, dofs: &DofMap, vectors: &[&Vec<(usize, f64)>]) -> Mat<f64> {
    let k = assemble_stiffness(model, dofs).unwrap();
    let factor = Factor::of_model(model, dofs, &k).unwrap();
    let mut right = Mat::zeros(dofs.free_count(), vectors.len());
    for (column, vector) in vectors.iter().enumerate() {
        for &(dof, value) in *vector {
            if let Some(free) = dofs.free_of(dof) {
                right[(free, column)] = value;
            }
        }
    }
    let mut solved = right.clone();
    factor.solve_in_place(solved.as_mut());
    right.transpose() * &solved
}
