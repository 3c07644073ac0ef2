//! The body of a reduced gear, rigid or with vibration modes: mass, centre of mass, inertia and modes of its finite
//! element mesh, from the model file.

use gearmesh_dynamics::{Body, Modes};
use gearmesh_model::ReducedGear;
use nalgebra::{DMatrix, Matrix3, Vector3};

use crate::error::{DrivetrainError, not_negative};

/// A body at the world's origin whose frame is the gear's: z along the axis, origin at mid-face, tooth 0 on +x. The
/// model states its inertia about the reference point; with c the centre of mass from there, that about the centre of
/// mass is J − m(cᵀc I − c cᵀ).
///
/// # Errors
/// [`DrivetrainError::NoRigidBody`] for a model that was reduced without a density.
pub fn gear_body(gear: &ReducedGear) -> Result<Body, DrivetrainError> {
    let Some(rigid) = &gear.rigid_body else {
        return Err(DrivetrainError::NoRigidBody {
            gear: gear.name.clone(),
        });
    };
    let centre = Vector3::from(rigid.centre_m);
    let c = centre - Vector3::from(rigid.reference_m);
    let about_reference = Matrix3::from_fn(|i, j| rigid.inertia_kg_m2[i][j]);
    let steiner = rigid.mass_kg * (c.norm_squared() * Matrix3::identity() - c * c.transpose());
    Ok(Body {
        center_of_mass_m: centre,
        inertia_kg_m2: about_reference - steiner,
        ..Body::rigid(&gear.name, rigid.mass_kg, [1.0; 3])
    })
}

/// [`gear_body`] with the lowest `modes` natural modes of the bore-fixed gear, all with one damping ratio: the
/// Craig-Bampton body. Its bore moves rigidly. The mesh must know the same modes ([`crate::GearMesh::with_modes`]).
///
/// # Errors
/// As [`gear_body`]; [`DrivetrainError::Model`] for a model without modes, [`DrivetrainError::Length`] if it has fewer,
/// [`DrivetrainError::Value`] for a negative damping ratio.
pub fn modal_gear_body(
    gear: &ReducedGear,
    modes: usize,
    damping_ratio: f64,
) -> Result<Body, DrivetrainError> {
    let owner = "modal gear body";
    not_negative(owner, "the damping ratio", damping_ratio)?;
    let basis = gear.modal_basis()?;
    DrivetrainError::check_modes(owner, basis.count(), modes)?;
    let omega = basis.omega_squared[..modes].iter().map(|w| w.sqrt());
    Ok(Body {
        modes: Some(Modes {
            angular_frequency_rad_per_s: omega.collect(),
            damping_ratio: vec![damping_ratio; modes],
            coupling: DMatrix::from_row_slice(modes, 6, &basis.coupling[..6 * modes]),
        }),
        ..gear_body(gear)?
    })
}

/// Number of modes of a model up to a frequency \[Hz\].
///
/// # Errors
/// [`DrivetrainError::Model`] for a model without modes, [`DrivetrainError::ModesBeyond`] if it does not hold all modes
/// up to there.
pub fn modes_up_to(gear: &ReducedGear, up_to_hz: f64) -> Result<usize, DrivetrainError> {
    let basis = gear.modal_basis()?;
    if up_to_hz.is_nan() || up_to_hz > basis.complete_to_hz {
        return Err(DrivetrainError::ModesBeyond {
            gear: gear.name.clone(),
            asked_hz: up_to_hz,
            complete_to_hz: basis.complete_to_hz,
        });
    }
    let frequencies = basis.frequencies_hz();
    Ok(frequencies.iter().filter(|f| **f <= up_to_hz).count())
}
