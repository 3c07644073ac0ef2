//! Natural modes of a gear that is cut into its shaft, from held stub ends to held faces, without the stubs' mass.
//!
//! The modes Φ are searched with the stubs' ends held and the stubs' mass there. The inertial loads of the gear in
//! them, P = M_g Φ Ω² with M_g the mass without the stubs, deflect the gear with its faces held by
//!
//! ```text
//! Φ_face = K⁻¹ P − Ψ_face G p,   p = Ψ_faceᵀ P,      Φ_faceᵀ K Φ_face = Pᵀ Φ_face,   Φ_faceᵀ M_g Φ_face
//! ```
//!
//! which is a basis of the same reach, K-orthogonal to the motions of the faces. The eigenvectors of both matrices are
//! the modes that the model keeps. Names as in `shaft_faces.rs`; theory: docs/theory/reduction.md, "Two faces".

use crate::flank_loads::SparseVector;
use crate::gear_body::GearBody;
use crate::repeated_mesh::RepeatedMesh;
use crate::shaft_faces::HeldFaces;
use crate::{Progress, ReductionError};
use faer::Mat;
use nalgebra::DMatrix;

/// A natural mode with the stubs' ends held.
pub(crate) struct FoundMode {
    pub omega_squared: f64,
    pub nodal_diameters: usize,
    /// Over all degrees of freedom.
    pub field: Vec<f64>,
}

/// The modes with the faces held, lowest first.
///
/// # Errors
/// [`ReductionError::Fe`], [`ReductionError::Check`] where the modes are not independent on the gear alone.
pub(crate) fn hold_faces(
    modes: &[FoundMode],
    faces: &HeldFaces,
    body: &GearBody<impl RepeatedMesh>,
    density_kg_per_m3: f64,
    progress: &dyn Progress,
) -> Result<Vec<FoundMode>, ReductionError> {
    let (unknowns, n) = (faces.motions.nrows(), modes.len());
    let fields = Mat::from_fn(unknowns, n, |dof, mode| modes[mode].field[dof]);
    let mut loads = body.mass_product(density_kg_per_m3, fields.as_ref())?;
    for (mode, found) in modes.iter().enumerate() {
        loads
            .col_mut(mode)
            .iter_mut()
            .for_each(|load| *load *= found.omega_squared);
    }
    let sparse: Vec<SparseVector> = (0..n)
        .map(|mode| loads.col(mode).iter().copied().enumerate().collect())
        .collect();
    let mut held = Mat::zeros(unknowns, n);
    body.solve_each(
        &sparse.iter().collect::<Vec<_>>(),
        progress,
        |mode, field| {
            for (dof, value) in field.iter().enumerate() {
                held[(dof, mode)] = *value;
            }
        },
    );
    held -= &faces.motions * (&faces.give * (faces.motions.transpose() * &loads));
    let dense = |m: Mat<f64>| DMatrix::from_fn(n, n, |i, j| 0.5 * (m[(i, j)] + m[(j, i)]));
    let stiffness = dense(loads.transpose() * &held);
    let mass = dense(held.transpose() * body.mass_product(density_kg_per_m3, held.as_ref())?);
    let (squares, shapes) = eigenvectors(&stiffness, mass).ok_or(ReductionError::Check {
        check: "independence of the natural modes on the gear alone, without the stubs of its shaft",
        found: f64::NAN,
        allowed: 0.0,
    })?;
    let fields = held * Mat::from_fn(n, n, |i, j| shapes[(i, j)]);
    let kept = squares
        .into_iter()
        .enumerate()
        .map(|(mode, omega_squared)| FoundMode {
            omega_squared,
            // Those of the mode that it is most like: its share in units of each mode's own mass.
            nodal_diameters: modes[shapes.column(mode).icamax()].nodal_diameters,
            field: fields.col(mode).iter().copied().collect(),
        });
    Ok(kept.collect())
}

/// ω² and shapes of modal mass 1 of K x = ω² M x, lowest first; none where a matrix is not positive.
fn eigenvectors(k: &DMatrix<f64>, m: DMatrix<f64>) -> Option<(Vec<f64>, DMatrix<f64>)> {
    let lower = m.cholesky()?.unpack();
    let half = lower.solve_lower_triangular(k)?;
    let reduced = lower.solve_lower_triangular(&half.transpose())?;
    let eigen = (0.5 * (&reduced + reduced.transpose())).symmetric_eigen();
    let mut order: Vec<usize> = (0..k.nrows()).collect();
    order.sort_by(|a, b| eigen.eigenvalues[*a].total_cmp(&eigen.eigenvalues[*b]));
    let squares: Vec<f64> = order.iter().map(|i| eigen.eigenvalues[*i]).collect();
    let sorted = eigen.eigenvectors.select_columns(&order);
    let shapes = lower.tr_solve_lower_triangular(&sorted)?;
    squares[0].is_sign_positive().then_some((squares, shapes))
}
