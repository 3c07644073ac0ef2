//! From a bevel gear's definition to its reduced model.

use gearmesh_bevel::{BevelGear, FlankPatch, Hand};
use gearmesh_mesh::BevelMesh;
use gearmesh_model::{BevelBody, BevelMember, FlankGrid, ReducedGear, SpiralHand, StoredGear};

use super::body::{bevel_body, flank_patch};
use super::coarser_meshes::coarser_bevel_meshes;
use super::gauge::{bevel_gauge_head, bevel_gauge_row};
use super::loads::{area_m2, bevel_grid, bevel_loads};
use super::near_field::{opposite_distances_m, section_fields};
use crate::asked_gauges::AskedGauges;
use crate::dynamics::DynamicsRequest;
use crate::reduce::ReductionOptions;
use crate::reduction_steps::Reduction;
use crate::stages::Stages;
use crate::{GearBody, Progress, ReductionError};

/// Reduces a bevel gear to its compliance at the flanks. The finite element model is handed back for pictures.
///
/// # Errors
/// [`ReductionError`] when the gear cannot be meshed or held, a gauge covers nothing, or an identity is violated by
/// more than round-off explains.
pub fn reduce_bevel(
    gear: &BevelGear,
    options: ReductionOptions,
    progress: &dyn Progress,
) -> Result<(ReducedGear, GearBody<BevelMesh>), ReductionError> {
    let body = bevel_body(gear, progress)?;
    let mut stages = Stages::after(body.stage_seconds.clone());
    let grid = bevel_grid(gear);
    let flanks = &gear.reduction.flanks;
    let patches: Vec<FlankPatch> = flanks
        .iter()
        .map(|&side| flank_patch(gear, side))
        .collect::<Result<_, _>>()?;
    let loads = flanks
        .iter()
        .zip(&patches)
        .map(|(&side, patch)| bevel_loads(&body.mesh, patch, side, &grid))
        .collect();
    stages.lap("loads");
    let mut found = Reduction::of_flanks(body, (flanks, loads), stages, progress)?;

    progress.stage("calibrating the near field");
    let near_field = section_fields(gear, &patches, &grid)?;
    found.stages.lap("near field");

    let asked = AskedGauges::new(&gear.gauges, bevel_gauge_head, |gauge, tooth| {
        bevel_gauge_row(gear, &found.body.mesh, &found.body.model, gauge, tooth)
    })?;
    found.read_gauges(&asked);
    let request = DynamicsRequest {
        density_kg_per_m3: gear.material.density_kg_per_m3,
        hub: gear.hub,
        modes: gear.modes,
        faces: None,
    };
    found.add_dynamics(&request, &asked.rows)?;
    if options.estimate_error {
        let body_grid = found.body.mesh.body_grid();
        let coarser = coarser_bevel_meshes(gear, body_grid, &grid, progress)?;
        found.estimate_errors(&grid, coarser);
        found.stages.lap("error estimate");
    }
    let opposite = opposite_distances_m(gear, &patches, &grid.roll_angles_rad, 0.5)?;
    let (model, body) = found.finished();
    let model = ReducedGear {
        name: gear.name.clone(),
        input: StoredGear::without_definition(gear.source.clone()),
        base_radius_m: patches[0].lever_m(),
        face_width_m: gear.blank().face_width_m,
        opposite_distance_m: opposite.concat(),
        bevel: Some(BevelBody {
            near_field: Some(near_field),
            ..surface(gear, &patches, &grid)
        }),
        grid,
        ..model
    };
    Ok((model, body))
}

/// What the model says of its flanks, without the near field.
fn surface(gear: &BevelGear, patches: &[FlankPatch], grid: &FlankGrid) -> BevelBody {
    let blank = gear.blank();
    let (mut points_m, mut normals, mut areas_m2) = (Vec::new(), Vec::new(), Vec::new());
    for patch in patches {
        for u in &grid.roll_angles_rad {
            for z in &grid.z_m {
                let at = [z / blank.face_width_m + 0.5, *u];
                let point = patch.point(at);
                points_m.extend(point.r.iter());
                normals.extend(point.n.iter());
                areas_m2.push(area_m2(patch, at));
            }
        }
    }
    BevelBody {
        pair_text: gear.pair_text.clone(),
        member: match gear.member {
            0 => BevelMember::Pinion,
            _ => BevelMember::Gear,
        },
        hand: match blank.hand {
            Hand::Right => SpiralHand::Right,
            Hand::Left => SpiralHand::Left,
        },
        pitch_angle_rad: blank.pitch_angle_rad,
        cones_m: [blank.inner_cone_m(), blank.outer_cone_m],
        points_m,
        normals,
        areas_m2,
        near_field: None,
    }
}
