//! The reduction: compliance of the flanks, gauge rows, and the identities they must fulfil.

use crate::asked_gauges::AskedGauges;
use crate::bore_patterns::{AskedMotions, FoundMotions};
use crate::dynamics::DynamicsRequest;
use crate::error_estimate::{coarser_gears, coarser_meshes};
use crate::flank_loads::{flank_grid, flank_loads};
use crate::gauge_row::{gauge_head, gauge_row};
use crate::gear_body::{GearBody, MeshedGear};
use crate::near_field::calibrate;
use crate::reduction_steps::Reduction;
use crate::root_crack::{CRACK_SYMMETRY, root_crack};
use crate::shaft_faces::HeldFaces;
use crate::stages::Stages;
use crate::{Progress, ReductionError, Silent};
use gearmesh_geometry::{GearDefinition, ProfileCurve};
use gearmesh_mesh::GearMesh;
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_model::{FlankGrid, NearField, ReducedGear, StoredGear};
use rayon::prelude::*;

/// What a reduction does besides its main job.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ReductionOptions {
    /// Reduce a coarser mesh too and estimate the discretisation error from the difference.
    pub estimate_error: bool,
}

/// Reduces a gear to its compliance at the flanks. The finite element model is handed back for pictures.
///
/// C_hub = NᵀK⁻¹N is found for the teeth of one repeating sector only, against all teeth; loads are integrated and
/// C_tooth = NᵀW is solved once, because all teeth have the same mesh.
///
/// # Errors
/// [`ReductionError`] when the gear cannot be meshed or held, a gauge covers nothing, or an identity is violated by
/// more than round-off explains.
pub fn reduce(
    gear: &GearDefinition,
    python: &PythonEnvironment,
    options: ReductionOptions,
    progress: &dyn Progress,
) -> Result<(ReducedGear, GearBody), ReductionError> {
    // Meshed first, so that a mesh that is refused is so at once; factorised after the coarser ones, so that factors of
    // two meshes never stand in memory side by side.
    let coarser = (options.estimate_error).then(|| coarser_gears(gear));
    let (meshed, coarser) = meshed_at_once(gear, coarser, python, progress)?;
    let motions = AskedMotions::new(gear, &meshed.mesh)?;
    let grid = flank_grid(gear);
    let mut estimate = Stages::after(Vec::new());
    let coarser = coarser
        .map(|coarser| coarser_meshes(gear, coarser, &grid, progress))
        .transpose()?;
    if coarser.is_some() {
        estimate.lap("error estimate");
    }
    let body = meshed.held(gear, progress)?;
    let ended = [body.stage_seconds.clone(), estimate.into_seconds()];
    let mut stages = Stages::after(ended.concat());

    let flanks = &gear.reduction.flanks;
    let loads = flanks
        .iter()
        .map(|&side| flank_loads(gear, &body.mesh, &grid, 0, side))
        .collect();
    stages.lap("loads");
    let mut found = Reduction::of_flanks(body, (flanks, loads), stages, progress)?;

    progress.stage("calibrating the near field");
    let near_field = calibrate(gear, &found.body.mesh, &found.body.model, &grid)?;
    found.stages.lap("near field");

    let asked = AskedGauges::new(&gear.gauges, gauge_head, |gauge, tooth| {
        gauge_row(gear, &found.body.mesh, &found.body.model, gauge, tooth)
    })?;
    found.read_gauges(&asked);

    let rows = (&found.loads[..], &asked.rows[..]);
    let faces = HeldFaces::new(gear, &found.body, rows, progress)?;
    if faces.is_some() {
        found.stages.lap("faces of the shaft");
    }
    let bore = motions
        .map(|motions| motions.solve(&found.body, (&found.loads, &asked.rows), progress))
        .transpose()?;
    if bore.is_some() {
        found.stages.lap("motions of the bore");
    }
    let request = DynamicsRequest {
        density_kg_per_m3: gear.material.density_kg_per_m3,
        hub: gear.hub,
        modes: gear.modes,
        faces: faces.as_ref(),
    };
    found.add_dynamics(&request, &asked.rows)?;
    if let Some(FoundMotions { patterns, checks }) = bore {
        found.model.bore = Some(patterns);
        found.model.checks.further.extend(checks);
    }
    if let Some(coarser) = coarser {
        found.estimate_errors(&grid, coarser);
    }
    if let Some(faces) = &faces {
        let model = &mut found.model;
        faces.hold(grid.len(), &mut model.c_hub, &mut model.gauges);
    }
    add_crack(gear, faces.as_ref(), &mut found, progress)?;
    let (model, body) = found.finished();
    Ok((of_definition(gear, grid, near_field, model), body))
}

/// Gears with their meshes.
type Meshed = Vec<(GearDefinition, MeshedGear)>;

/// Meshes a gear, and beside it the coarser ones of the error estimate: a mesher uses one core.
fn meshed_at_once(
    gear: &GearDefinition,
    coarser: Option<Vec<GearDefinition>>,
    python: &PythonEnvironment,
    progress: &dyn Progress,
) -> Result<(MeshedGear, Option<Meshed>), ReductionError> {
    let coarse =
        |gear: GearDefinition| MeshedGear::new(&gear, python, &Silent).map(|meshed| (gear, meshed));
    let (meshed, coarser) = rayon::join(
        || MeshedGear::new(gear, python, progress),
        || coarser.map(|gears| gears.into_par_iter().map(coarse).collect()),
    );
    Ok((meshed?, coarser.transpose()?))
}

/// Adds the crack, where there is one.
fn add_crack(
    gear: &GearDefinition,
    faces: Option<&HeldFaces>,
    found: &mut Reduction<'_, GearMesh>,
    progress: &dyn Progress,
) -> Result<(), ReductionError> {
    let Some(definition) = &gear.crack else {
        return Ok(());
    };
    let mut flanks = gear.reduction.flanks.iter();
    // Checked when the definition was read.
    let of_side = flanks.position(|&side| side == definition.side);
    let loads = &found.loads[of_side.unwrap_or_default()];
    let crack = root_crack(gear, definition, (&found.body, faces), loads, progress)?;
    crack.add_to_gauges(gear, &mut found.model.gauges);
    let asymmetry = (CRACK_SYMMETRY.to_string(), crack.asymmetry);
    found.model.checks.further.push(asymmetry);
    let jumps = ("jumps of the crack".to_string(), crack.jumps as f64);
    found.effort.push(jumps);
    found.model.crack = Some(crack.crack);
    found.stages.lap("crack");
    Ok(())
}

/// The model of a cylindrical gear from what was found, completed by what its definition says.
pub(crate) fn of_definition(
    gear: &GearDefinition,
    grid: FlankGrid,
    near_field: NearField,
    found: ReducedGear,
) -> ReducedGear {
    let curve = ProfileCurve::new(&gear.profile);
    // Along a helical flank's normal the tooth is thinner by the cosine of the base helix.
    let helix_cos = gear.profile.base_helix_angle_rad().cos();
    let opposite: Vec<f64> = grid
        .roll_angles_rad
        .iter()
        .map(|&xi| helix_cos * curve.opposite_distance_m(xi))
        .collect();
    ReducedGear {
        name: gear.name.clone(),
        input: StoredGear::new(gear.clone()),
        base_radius_m: gear.profile.base_radius_m,
        face_width_m: gear.tooth.face_width_m,
        opposite_distance_m: opposite.repeat(found.flanks.len()),
        near_field: Some(near_field),
        grid,
        ..found
    }
}
