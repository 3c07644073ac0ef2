//! A gear that is cut into a shaft going on at both faces, on a system of bodies: its frame is carried by the back
//! face, and the front face moves against it by modes.
//!
//! With e the motion of the front face against the back one, η the natural modes with both faces held, and the model's
//! K, T = NᵀΨ, M (docs/theory/reduction.md, "Two faces"):
//!
//! ```text
//! [ ΨᵀMΨ  ΨᵀMΦ ] [ë]   [ K  0  ] [e]   [ Tᵀ   ]         [ force on the front face ]
//! [ ΦᵀMΨ    1  ] [η̈] + [ 0  Ω² ] [η] = [ ΦᵀN ] f   +   [            0            ]  − [ΨᵀMR; ΦᵀMR] a
//! ```
//!
//! Its natural modes are those of the gear held at its back face, and make it a body like any other gear with modes.
//! Held at its back face, it deflects by C + T K⁻¹ Tᵀ under loads on its flanks, of which the modes take their share as
//! of every gear: what is left to the mesh is C, less what natural modes hold of it. The six motions of the front face
//! are always all there, so that nothing is left out at rest.

use std::sync::Arc;

use gearmesh_dynamics::Modes;
use gearmesh_model::{ModalBasis, ReducedGear, ShaftFaces};
use nalgebra::{DMatrix, DVector, Matrix6, Vector6};

use crate::error::DrivetrainError;

/// Motions of the front face: three translations, three rotations.
const MOTIONS: usize = 6;

/// A gear with its frame on its back face.
#[derive(Debug, Clone)]
pub struct GearOnFaces {
    /// The gear held at its back face, with the modes of this body: for meshes and gauges.
    pub model: Arc<ReducedGear>,
    /// Displacement and turn of the front face per modal coordinate, 6 × modes, the gear's axes.
    pub front: DMatrix<f64>,
    /// Centre of the front face in the gear's frame \[m\].
    pub front_m: [f64; 3],
}

impl GearOnFaces {
    /// The gear with the lowest `natural` of its modes besides the motions of its front face.
    ///
    /// # Errors
    /// [`DrivetrainError::NoShaftFaces`] for a model without faces, [`DrivetrainError::NoRigidBody`] without density,
    /// [`DrivetrainError::CrackOnFaces`] of a cracked gear, [`DrivetrainError::Length`] if it has fewer modes,
    /// [`DrivetrainError::FaceMatrix`] where stiffness or mass are not positive.
    pub fn new(model: &ReducedGear, natural: usize) -> Result<Self, DrivetrainError> {
        let gear = || model.name.clone();
        let Some(faces) = &model.shaft_faces else {
            return Err(DrivetrainError::NoShaftFaces { gear: gear() });
        };
        let Some(mass) = &faces.mass else {
            return Err(DrivetrainError::NoRigidBody { gear: gear() });
        };
        if model.crack.is_some() {
            return Err(DrivetrainError::CrackOnFaces { gear: gear() });
        }
        let own = model.modes.as_ref();
        let found = own.map_or(0, ModalBasis::count);
        DrivetrainError::check_modes("gear on the faces of its shaft", found, natural)?;
        let stiffness = Matrix6::from_row_slice(&faces.stiffness);
        let size = MOTIONS + natural;
        let mut k = DMatrix::zeros(size, size);
        let mut m = DMatrix::identity(size, size);
        k.view_mut((0, 0), (MOTIONS, MOTIONS)).copy_from(&stiffness);
        let own_mass = Matrix6::from_row_slice(&mass.mass);
        m.view_mut((0, 0), (MOTIONS, MOTIONS)).copy_from(&own_mass);
        for mode in 0..natural {
            k[(MOTIONS + mode, MOTIONS + mode)] =
                own.map_or(0.0, |basis| basis.omega_squared[mode]);
            for q in 0..MOTIONS {
                let mixed = mass.modes[MOTIONS * mode + q];
                (m[(MOTIONS + mode, q)], m[(q, MOTIONS + mode)]) = (mixed, mixed);
            }
        }
        let fault = || DrivetrainError::FaceMatrix { gear: gear() };
        let (omega_squared, shapes) = natural_modes(&k, m).ok_or_else(fault)?;
        let flexibility = stiffness.cholesky().ok_or_else(fault)?.inverse();
        // `[mode][…]` of the rows of motions, `[…][motion]`, and of natural modes, `[mode][…]`.
        let combine = |of_faces: &[f64], of_modes: &[f64]| -> Vec<f64> {
            let rows = of_faces.len() / MOTIONS;
            let mut all = Vec::with_capacity(rows * size);
            for shape in shapes.column_iter() {
                all.extend((0..rows).map(|row| {
                    let face = &of_faces[MOTIONS * row..][..MOTIONS];
                    let moved: f64 = face.iter().zip(shape.iter()).map(|(t, e)| t * e).sum();
                    let vibrating = shape.iter().skip(MOTIONS).enumerate();
                    moved
                        + vibrating
                            .map(|(n, eta)| of_modes[n * rows + row] * eta)
                            .sum::<f64>()
                }));
            }
            all
        };
        let none = ModalBasis::default();
        let basis = own.unwrap_or(&none);
        // `[motion][rigid motion]` as rows of motions.
        let of_faces: Vec<f64> = (0..36).map(|n| mass.coupling[n % 6 * 6 + n / 6]).collect();
        let mut on_back = model.clone();
        on_back.modes = Some(ModalBasis {
            nodal_diameters: vec![0; size],
            complete_to_hz: omega_squared.max().sqrt() / std::f64::consts::TAU,
            omega_squared: omega_squared.iter().copied().collect(),
            flank: combine(&faces.flank, &basis.flank),
            gauges: combine(&faces.gauges, &basis.gauges),
            coupling: combine(&of_faces, &basis.coupling),
        });
        release_front_face(&mut on_back, faces, &flexibility);
        on_back.shaft_faces = None;
        Ok(Self {
            front: shapes.rows(0, MOTIONS).into_owned(),
            front_m: faces.front_m,
            model: Arc::new(on_back),
        })
    }

    /// Modes of its body, the damping ratio of each by its angular frequency \[rad/s\].
    #[must_use]
    pub fn modes(&self, damping_ratio: impl Fn(f64) -> f64) -> Modes {
        let none = ModalBasis::default();
        let basis = self.model.modes.as_ref().unwrap_or(&none);
        let omega: Vec<f64> = basis.omega_squared.iter().map(|w| w.sqrt()).collect();
        Modes {
            damping_ratio: omega.iter().map(|w| damping_ratio(*w)).collect(),
            coupling: DMatrix::from_row_slice(omega.len(), 6, &basis.coupling),
            angular_frequency_rad_per_s: omega,
        }
    }
}

/// ω² and shapes of modal mass 1 of K x = ω² M x, lowest first; none where a matrix is not positive.
fn natural_modes(k: &DMatrix<f64>, m: DMatrix<f64>) -> Option<(DVector<f64>, DMatrix<f64>)> {
    let lower = m.cholesky()?.unpack();
    // L⁻¹ K L⁻ᵀ
    let half = lower.solve_lower_triangular(k)?;
    let reduced = lower.solve_lower_triangular(&half.transpose())?;
    let reduced = 0.5 * (&reduced + reduced.transpose());
    let eigen = reduced.symmetric_eigen();
    let mut order: Vec<usize> = (0..k.nrows()).collect();
    order.sort_by(|a, b| eigen.eigenvalues[*a].total_cmp(&eigen.eigenvalues[*b]));
    let omega_squared = DVector::from_fn(k.nrows(), |i, _| eigen.eigenvalues[order[i]]);
    let ordered = DMatrix::from_fn(k.nrows(), k.nrows(), |i, j| {
        eigen.eigenvectors[(i, order[j])]
    });
    let shapes = lower.transpose().solve_upper_triangular(&ordered)?;
    (omega_squared.min() > 0.0).then_some((omega_squared, shapes))
}

/// Adds what flanks and gauges move where the front face is free: C + T K⁻¹ Tᵀ, and the same of the gauges' rows.
fn release_front_face(model: &mut ReducedGear, faces: &ShaftFaces, flexibility: &Matrix6<f64>) {
    let (hands, loads) = (model.flanks.len(), model.grid.len());
    let own_teeth = model.teeth_per_sector();
    let row = |place: usize| Vector6::from_column_slice(&faces.flank[MOTIONS * place..][..MOTIONS]);
    let normals: Vec<Vector6<f64>> = (0..model.teeth * hands * loads)
        .map(|place| row(3 * place))
        .collect();
    let mut entries = model.c_hub.iter_mut();
    for load_flank in normals[..own_teeth * hands * loads].chunks(loads) {
        for response_flank in normals.chunks(loads) {
            for load in load_flank {
                let moved = flexibility * load;
                for (response, entry) in response_flank.iter().zip(entries.by_ref()) {
                    *entry += moved.dot(response);
                }
            }
        }
    }
    for (number, gauge) in model.gauges.iter_mut().enumerate() {
        let reading = Vector6::from_column_slice(&faces.gauges[MOTIONS * number..][..MOTIONS]);
        let moved = flexibility * reading;
        for (place, entry) in gauge.adjoint.iter_mut().enumerate() {
            *entry += moved.dot(&row(place));
        }
    }
}
