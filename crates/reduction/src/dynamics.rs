//! What the dynamics needs of a gear beside its compliance: rigid body, reference point of the hub, modal basis.
//!
//! A rigid bore on a reference point changes nothing of the compliance: its six motions zero, the bore is held, so that
//! C at a held reference point is C_hub. What is added are rows under the six motions. docs/theory/modes.md derives it.

use crate::flank_loads::{GridLoad, SparseVector, directions, dot};
use crate::gear_body::GearBody;
use crate::modes_on_faces::{FoundMode, hold_faces};
use crate::repeated_mesh::RepeatedMesh;
use crate::rigid_mass::REFERENCE_M;
use crate::shaft_faces::{HeldFaces, RIGID_MOTION};
use crate::tooth_vectors::on_all_teeth;
use crate::{Progress, ReductionError};
use faer::{Mat, MatRef};
use gearmesh_geometry::{HubSupport, ModeRange};
use gearmesh_model::{FaceMass, ModalBasis, ReducedGear, ReferencePoint};
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

/// Computes what the definition asks for, puts it into the model with its checks, and tells how many vectors K was
/// solved for in the search for modes. Rows: the loads of tooth 0, flank by flank, and those of all gauges.
///
/// # Errors
/// [`ReductionError`] when there are no modes in the range or the search does not converge.
pub(crate) fn dynamics(
    request: &DynamicsRequest<'_>,
    body: &GearBody<impl RepeatedMesh>,
    (loads, gauges): (&[Vec<GridLoad>], &[SparseVector]),
    progress: &dyn Progress,
    model: &mut ReducedGear,
) -> Result<Option<usize>, ReductionError> {
    let checks = &mut model.checks.further;
    if let Some(faces) = request.faces {
        model.shaft_faces = faces.front_face();
        let check = (RIGID_MOTION.to_string(), faces.rigid_residual);
        checks.extend(model.shaft_faces.is_some().then_some(check));
    }
    let Some(density) = request.density_kg_per_m3 else {
        return Ok(None);
    };
    progress.stage("mass");
    let alone = request.modes.is_none() && model.shaft_faces.is_none();
    if request.hub == HubSupport::Fixed && alone {
        model.rigid_body = Some(body.rigid_body(density)?);
        return Ok(None);
    }
    let rigid = body.rigid_mass(density)?;
    model.rigid_body = Some(rigid.body.clone());
    let mut of_front = None;
    if let (Some(front), Some(faces)) = (&mut model.shaft_faces, request.faces) {
        let momenta = body.mass_product(density, faces.front())?;
        let mass = face_mass(&momenta, faces, &rigid.motions);
        of_front = Some((momenta, &mut front.mass.insert(mass).modes));
    }
    let rows = on_all_teeth(&body.mesh, &directions(loads.iter().flatten()));
    if request.hub == HubSupport::ReferencePoint {
        let motions = rigid.motions.as_ref();
        let flank = (rows.par_iter()).flat_map_iter(|row| (0..6).map(|q| product(row, motions, q)));
        model.reference_point = Some(ReferencePoint {
            place_m: REFERENCE_M,
            flank: flank.collect(),
        });
        if !gauges.is_empty() {
            let strain = strain_of_rigid_motions(gauges, rigid.motions.as_ref());
            checks.push(("gauges under rigid motions".to_string(), strain));
        }
    }
    let Some(range) = request.modes else {
        return Ok(None);
    };
    let (mut basis, mut on_stubs) = (ModalBasis::default(), Vec::new());
    let mut take = |mode: &FoundMode| {
        let field = &mode.field;
        basis.omega_squared.push(mode.omega_squared);
        basis.nodal_diameters.push(mode.nodal_diameters);
        (basis.flank).par_extend(rows.par_iter().map(|row| dot(row, field)));
        (basis.gauges).extend(gauges.iter().map(|row| dot(row, field)));
        basis.coupling.extend(along(&rigid.momenta, field));
        if let Some((momenta, modes)) = &mut of_front {
            modes.extend(along(momenta, field));
        }
    };
    let found = body.natural_modes(&rigid, range, progress, |_, mode, field| {
        let mode = FoundMode {
            omega_squared: mode.omega_squared,
            nodal_diameters: mode.nodal_diameters,
            field: field.to_vec(),
        };
        match request.faces {
            Some(_) => on_stubs.push(mode),
            None => take(&mode),
        }
    })?;
    if let Some(faces) = request.faces {
        let held = hold_faces(&on_stubs, faces, body, density, progress)?;
        held.iter().for_each(take);
    }
    let residuals = found.modes.iter().map(|mode| mode.relative_residual);
    let check = "residual of the natural modes".to_string();
    checks.push((check, residuals.fold(0.0, f64::max)));
    basis.complete_to_hz = found.complete_to_hz;
    model.modes = Some(basis);
    Ok(Some(found.solves))
}

/// Mass of motions of the front face, and its coupling with those of the whole gear; its modes are still to come.
fn face_mass(momenta: &Mat<f64>, faces: &HeldFaces, motions: &Mat<f64>) -> FaceMass {
    let product = |with: MatRef<'_, f64>| -> Vec<f64> {
        let matrix = momenta.transpose() * with;
        (0..36).map(|n| matrix[(n / 6, n % 6)]).collect()
    };
    FaceMass {
        mass: product(faces.front()),
        coupling: product(motions.as_ref()),
        modes: Vec::new(),
    }
}

/// MᵀU of a field for each column of momenta.
fn along(momenta: &Mat<f64>, field: &[f64]) -> Vec<f64> {
    let columns = momenta.col_iter();
    columns
        .map(|column| column.iter().zip(field).map(|(m, u)| m * u).sum())
        .collect()
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
