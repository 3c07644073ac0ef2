//! The rigid body of a reduced gear: mass, centre of mass and inertia of its finite element mesh, from the model file.

use gearmesh_dynamics::Body;
use gearmesh_model::ReducedGear;
use nalgebra::{Matrix3, Vector3};

use crate::error::DrivetrainError;

/// A body at the world's origin whose frame is the gear's: z along the axis, origin at mid-face, tooth 0 on +x. The model states its
/// inertia about the reference point; with c the centre of mass from there, that about the centre of mass is
/// J − m(cᵀc I − c cᵀ).
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
