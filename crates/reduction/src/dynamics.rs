//! What the dynamics needs of a gear beside its compliance: rigid body, reference point of the hub, modal basis.
//!
//! A rigid bore on a reference point changes nothing of the compliance: its six motions zero, the bore is held, so that
//! C at a held reference point is C_hub. What is added are rows under the six motions. docs/theory/modes.md derives it.

use crate::flank_loads::{GridLoad, SparseVector, dot};
use crate::gear_body::GearBody;
use crate::gear_modes::GearModes;
use crate::modes_on_faces::{FoundMode, hold_faces};
use crate::repeated_mesh::RepeatedMesh;
use crate::rigid_mass::REFERENCE_M;
use crate::shaft_faces::{HeldFaces, RIGID_MOTION};
use crate::tooth_vectors::on_all_teeth;
use crate::{Progress, ReductionError};
use faer::{Mat, MatRef};
use gearmesh_geometry::{HubSupport, ModeRange};
use gearmesh_model::{FaceMass, ModalBasis, ReferencePoint, RigidBody, ShaftFaces};
use rayon::prelude::*;

/// What is asked for.
pub struct DynamicsRequest<'a> {
    /// Density; where it is not known, nothing is computed.
    pub density_kg_per_m3: Option<f64>,
    /// How the bore is held.
    pub hub: HubSupport,
    /// Natural modes; none where not asked for.
    pub modes: Option<ModeRange>,
    /// The faces of a gear that is cut into its shaft.
    pub faces: Option<&'a HeldFaces>,
}

/// Parts of the reduced gear for the dynamics.
pub struct Dynamics {
    /// Mass and inertia, where the density is known.
    pub rigid_body: Option<RigidBody>,
    /// Rows of the flanks under rigid motions, where the hub is on a reference point.
    pub reference_point: Option<ReferencePoint>,
    /// Modal basis, where modes were asked for.
    pub modes: Option<ModalBasis>,
    /// The two faces of a gear that is cut into its shaft, with their mass where the density is known.
    pub shaft_faces: Option<ShaftFaces>,
    /// Checks by name.
    pub checks: Vec<(String, f64)>,
    /// Vectors that K was solved for.
    pub solves: Option<usize>,
}

/// Computes what the definition asks for. `loads` are those of tooth 0, flank by flank; `gauges` the rows of all
/// gauges.
///
/// # Errors
/// [`ReductionError`] when there are no modes in the range or the search does not converge.
pub fn dynamics(
    request: &DynamicsRequest<'_>,
    body: &GearBody<impl RepeatedMesh>,
    loads: &[Vec<GridLoad>],
    gauges: &[SparseVector],
    progress: &dyn Progress,
) -> Result<Dynamics, ReductionError> {
    let mut result = Dynamics {
        rigid_body: None,
        reference_point: None,
        modes: None,
        shaft_faces: None,
        checks: Vec::new(),
        solves: None,
    };
    let directions: Vec<&SparseVector> = loads
        .iter()
        .flatten()
        .flat_map(|load| [&load.normal, &load.tangential, &load.axial])
        .collect();
    let rows = || on_all_teeth(&body.mesh, &directions);
    if let Some(faces) = request.faces {
        result.shaft_faces = faces.front_face();
        let check = (RIGID_MOTION.to_string(), faces.rigid_residual);
        result
            .checks
            .extend(result.shaft_faces.is_some().then_some(check));
    }
    let Some(density) = request.density_kg_per_m3 else {
        return Ok(result);
    };
    progress.stage("mass");
    let alone = request.modes.is_none() && result.shaft_faces.is_none();
    if request.hub == HubSupport::Fixed && alone {
        result.rigid_body = Some(body.rigid_body(density)?);
        return Ok(result);
    }
    let rigid = body.rigid_mass(density)?;
    result.rigid_body = Some(rigid.body.clone());
    let of_front = result.shaft_faces.as_ref().and(request.faces);
    let momenta = of_front
        .map(|faces| body.mass_product(density, faces.front()))
        .transpose()?;
    if let (Some(front), Some(faces), Some(momenta)) = (&mut result.shaft_faces, of_front, &momenta)
    {
        let product = |with: MatRef<'_, f64>| -> Vec<f64> {
            let matrix = momenta.transpose() * with;
            (0..36).map(|n| matrix[(n / 6, n % 6)]).collect()
        };
        front.mass = Some(FaceMass {
            mass: product(faces.front()),
            coupling: product(rigid.motions.as_ref()),
            modes: Vec::new(),
        });
    }
    let rows = rows();
    if request.hub == HubSupport::ReferencePoint {
        let flank = rows
            .par_iter()
            .flat_map_iter(|row| (0..6).map(|q| product(row, rigid.motions.as_ref(), q)))
            .collect();
        result.reference_point = Some(ReferencePoint {
            place_m: REFERENCE_M,
            flank,
        });
        if !gauges.is_empty() {
            let strain = strain_of_rigid_motions(gauges, rigid.motions.as_ref());
            let name = "gauges under rigid motions".to_string();
            result.checks.push((name, strain));
        }
    }
    if let Some(range) = request.modes {
        let mut basis = ModalBasis::default();
        let mut of_front = Vec::new();
        let mut take = |omega_squared: f64, nodal_diameters: usize, field: &[f64]| {
            basis.omega_squared.push(omega_squared);
            basis.nodal_diameters.push(nodal_diameters);
            (basis.flank).par_extend(rows.par_iter().map(|row| dot(row, field)));
            (basis.gauges).extend(gauges.iter().map(|row| dot(row, field)));
            let along = |momenta: &Mat<f64>| -> Vec<f64> {
                let columns = momenta.col_iter();
                columns
                    .map(|column| column.iter().zip(field).map(|(m, u)| m * u).sum())
                    .collect()
            };
            basis.coupling.extend(along(&rigid.momenta));
            of_front.extend(momenta.iter().flat_map(along));
        };
        let mut on_stubs = Vec::new();
        let GearModes {
            modes,
            complete_to_hz,
            solves,
            ..
        } = body.natural_modes(&rigid, range, progress, |_, mode, field| {
            if request.faces.is_some() {
                on_stubs.push(FoundMode {
                    omega_squared: mode.omega_squared,
                    nodal_diameters: mode.nodal_diameters,
                    field: field.to_vec(),
                });
            } else {
                take(mode.omega_squared, mode.nodal_diameters, field);
            }
        })?;
        if let Some(faces) = request.faces {
            let held = hold_faces(&on_stubs, faces, body, density, progress)?;
            for mode in held {
                take(mode.omega_squared, mode.nodal_diameters, &mode.field);
            }
        }
        let worst = modes
            .iter()
            .fold(0.0, |w: f64, m| w.max(m.relative_residual));
        let name = "residual of the natural modes".to_string();
        result.checks.push((name, worst));
        basis.complete_to_hz = complete_to_hz;
        let front = result.shaft_faces.as_mut();
        if let Some(mass) = front.and_then(|front| front.mass.as_mut()) {
            mass.modes = of_front;
        }
        result.modes = Some(basis);
        result.solves = Some(solves);
    }
    Ok(result)
}

fn product(row: &SparseVector, fields: MatRef<'_, f64>, column: usize) -> f64 {
    let terms = row
        .iter()
        .map(|&(dof, value)| value * fields[(dof, column)]);
    terms.sum()
}

/// Largest strain that a gauge reads of a rigid motion, relative to what its terms would come to without cancelling.
fn strain_of_rigid_motions(gauges: &[SparseVector], motions: MatRef<'_, f64>) -> f64 {
    let mut worst: f64 = 0.0;
    for row in gauges {
        for q in 0..6 {
            let terms = row
                .iter()
                .map(|&(dof, value)| (value * motions[(dof, q)]).abs());
            let scale: f64 = terms.sum();
            if scale > 0.0 {
                worst = worst.max(product(row, motions, q).abs() / scale);
            }
        }
    }
    worst
}
