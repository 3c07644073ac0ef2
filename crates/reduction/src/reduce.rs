//! The reduction: compliance of the flanks, gauge rows, and the identities they must fulfil.

use crate::bore_patterns::{AskedMotions, FoundMotions};
use crate::dynamics::{DynamicsRequest, dynamics};
use crate::error_estimate::{Reduced, coarser_meshes};
use crate::flank_compliance::{
    AskedGauge, FlankCase, FlankCompliance, ROWS_BY_FIELDS, flank_compliance, gauge_readings,
};
use crate::flank_loads::{GridLoad, SparseVector, flank_grid, flank_loads};
use crate::gauge_row::gauge_row;
use crate::gear_body::{GearBody, MeshedGear};
use crate::near_field::calibrate;
use crate::root_crack::{CRACK_SYMMETRY, root_crack};
use crate::shaft_faces::HeldFaces;
use crate::tooth_submodel::Deformation;
use crate::{Progress, ReductionError};
use gearmesh_geometry::{Flank, GearDefinition, ProfileCurve};
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_model::{
    FlankGrid, GaugeRows, NearField, Provenance, ReducedGear, ReductionChecks, StoredGear, utc_now,
};
use std::time::Instant;

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
    let meshed = MeshedGear::new(gear, python, progress)?;
    let motions = AskedMotions::new(gear, &meshed.mesh)?;
    let grid = flank_grid(gear);
    let mut clock = Instant::now();
    let coarser = (options.estimate_error)
        .then(|| coarser_meshes(gear, python, &grid, progress))
        .transpose()?;
    let coarser_s = clock.elapsed().as_secs_f64();
    let body = meshed.held(gear, progress)?;
    let mut stage_seconds = body.stage_seconds.clone();
    if coarser.is_some() {
        stage_seconds.push(("error estimate".to_string(), coarser_s));
    }
    clock = Instant::now();
    let mut lap = |name: &str| {
        stage_seconds.push((name.to_string(), clock.elapsed().as_secs_f64()));
        clock = Instant::now();
    };
    let flanks = &gear.reduction.flanks;
    let loads: Vec<Vec<GridLoad>> = flanks
        .iter()
        .map(|&side| flank_loads(gear, &body.mesh, &grid, 0, side))
        .collect();
    lap("loads");
    let case = FlankCase {
        flanks,
        loads: &loads,
        teeth: gear.tooth.teeth,
        sectors: gear.sectors(),
        deformation: Deformation::of(gear),
    };
    let FlankCompliance {
        submodels,
        mut c_hub,
        c_tooth,
        symmetry,
        pattern_identity,
        rows_by_fields,
        patterns,
    } = flank_compliance(&body, &case, progress, &mut lap)?;
    progress.stage("calibrating the near field");
    let near_field = calibrate(gear, &body.mesh, &body.model, &grid)?;
    lap("near field");

    let gauge_rows: Vec<SparseVector> = gear
        .gauges
        .iter()
        .map(|g| gauge_row(gear, &body.mesh, &body.model, g, g.tooth))
        .collect::<Result<_, _>>()?;
    let asked = gear.gauges.iter().zip(&gauge_rows);
    let asked: Vec<AskedGauge<'_>> = asked
        .map(|(gauge, row)| {
            Ok(AskedGauge {
                name: &gauge.name,
                tooth: gauge.tooth,
                side: gauge.side,
                description: describe(gauge),
                row,
                // W is known on tooth 0; the reading there is the same, because mesh and gauge turn together.
                at_zero: gauge_row(gear, &body.mesh, &body.model, gauge, 0)?,
            })
        })
        .collect::<Result<_, ReductionError>>()?;
    let mut gauges = gauge_readings(&body, &loads, &submodels, &asked, progress);
    lap("gauges");
    let faces = HeldFaces::new(gear, &body, (&loads, &gauge_rows), progress)?;
    if faces.is_some() {
        lap("faces of the shaft");
    }
    let bore = motions
        .map(|motions| motions.solve(&body, (&loads, &gauge_rows), progress))
        .transpose()?;
    if bore.is_some() {
        lap("motions of the bore");
    }
    let request = DynamicsRequest {
        density_kg_per_m3: gear.material.density_kg_per_m3,
        hub: gear.hub,
        modes: gear.modes,
        faces: faces.as_ref(),
    };
    let dynamics = dynamics(&request, &body, &loads, &gauge_rows, progress)?;
    if dynamics.rigid_body.is_some() {
        lap("mass and modes");
    }
    let mut further = vec![(ROWS_BY_FIELDS.to_string(), rows_by_fields)];
    further.extend(dynamics.checks);
    let bore = bore.map(|FoundMotions { patterns, checks }| {
        further.extend(checks);
        patterns
    });
    if let Some(coarser) = coarser {
        let reduced = Reduced {
            teeth: gear.tooth.teeth,
            flanks,
            grid: &grid,
            c_hub: &c_hub,
            c_tooth: &c_tooth,
            gauges: &gauges,
        };
        let errors = coarser.errors_of(&reduced);
        errors.state(&mut further, &mut gauges);
    }
    if let Some(faces) = &faces {
        faces.hold(grid.len(), &mut c_hub, &mut gauges);
    }
    let crack = gear.crack.as_ref();
    let crack = crack
        .map(|definition| {
            let of_side = flanks.iter().position(|&side| side == definition.side);
            // Checked when the definition was read.
            let loads = &loads[of_side.unwrap_or_default()];
            root_crack(gear, definition, (&body, faces.as_ref()), loads, progress)
        })
        .transpose()?;
    if let Some(crack) = &crack {
        crack.add_to_gauges(gear, &mut gauges);
        further.push((CRACK_SYMMETRY.to_string(), crack.asymmetry));
        lap("crack");
    }
    let mut effort = body.effort();
    effort.extend(dynamics.solves.map(mode_solves));
    let jumps = crack.as_ref().map(|crack| crack.jumps as f64);
    effort.extend(jumps.map(|jumps| ("jumps of the crack".to_string(), jumps)));
    let mut reduced = assembled(gear, grid, c_hub, c_tooth, near_field, gauges);
    let provenance = &mut reduced.provenance;
    provenance.element = element_names(&body.model);
    provenance.nodes = body.mesh.nodes.len();
    provenance.elements = body.mesh.elements.len();
    provenance.dofs = body.dofs.free_count();
    provenance.stage_seconds = stage_seconds;
    provenance.effort = effort;
    reduced.checks = ReductionChecks {
        symmetry,
        pattern_identity,
        further,
    };
    reduced.rigid_body = dynamics.rigid_body;
    reduced.reference_point = dynamics.reference_point;
    reduced.modes = dynamics.modes;
    reduced.shaft_faces = dynamics.shaft_faces;
    reduced.bore = bore;
    reduced.crack = crack.map(|rows| rows.crack);
    if let Some((patterns, left_out)) = patterns {
        let name = "C_hub by patterns, largest entry left out".to_string();
        reduced.checks.further.push((name, left_out));
        reduced.c_hub = Vec::new();
        reduced.hub_patterns = Some(patterns);
    }
    Ok((reduced, body))
}

/// The model of a gear from its computed parts; how they were computed and checked is still empty.
pub(crate) fn assembled(
    gear: &GearDefinition,
    grid: FlankGrid,
    c_hub: Vec<f64>,
    c_tooth: Vec<f64>,
    near_field: NearField,
    gauges: Vec<GaugeRows>,
) -> ReducedGear {
    let curve = ProfileCurve::new(&gear.profile);
    let flanks = &gear.reduction.flanks;
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
        teeth: gear.tooth.teeth,
        sectors: gear.sectors(),
        base_radius_m: gear.profile.base_radius_m,
        face_width_m: gear.tooth.face_width_m,
        young_pa: gear.material.young_pa,
        poisson: gear.material.poisson,
        flanks: flanks.to_vec(),
        opposite_distance_m: opposite.repeat(flanks.len()),
        c_hub,
        c_tooth,
        near_field: Some(near_field),
        gauges,
        rigid_body: None,
        reference_point: None,
        modes: None,
        crack: None,
        hub_patterns: None,
        shaft_faces: None,
        bore: None,
        bevel: None,
        provenance: Provenance {
            program: "gearmesh".into(),
            version: env!("CARGO_PKG_VERSION").into(),
            created_utc: utc_now(),
            threads: rayon::current_num_threads(),
            element: String::new(),
            nodes: 0,
            elements: 0,
            dofs: 0,
            stage_seconds: Vec::new(),
            effort: Vec::new(),
        },
        checks: ReductionChecks {
            symmetry: 0.0,
            pattern_identity: 0.0,
            further: Vec::new(),
        },
        grid,
    }
}

/// What the search for natural modes cost, as a count by name.
pub(crate) fn mode_solves(solves: usize) -> (String, f64) {
    ("solves for natural modes".to_string(), solves as f64)
}

/// Names of the kinds of elements of a model.
pub(crate) fn element_names(model: &gearmesh_fe::FeModel) -> String {
    let names: Vec<&str> = model.blocks().iter().map(|b| b.element.name()).collect();
    names.join(" + ")
}

pub(crate) fn describe(gauge: &gearmesh_geometry::GaugeDefinition) -> String {
    let place = match gauge.position {
        gearmesh_geometry::RootPosition::TangentAngle(a) => {
            format!("{:.2} deg tangent", a.to_degrees())
        }
        gearmesh_geometry::RootPosition::Radius(r) => format!("radius {:.4} mm", r * 1e3),
    };
    let side = match gauge.side {
        Flank::Right => "right",
        Flank::Left => "left",
    };
    format!(
        "tooth {}, {side} root, {place}, {:.3} mm along the profile, {:.3} mm wide at z {:.3} mm",
        gauge.tooth,
        gauge.length_m * 1e3,
        gauge.width_m * 1e3,
        gauge.z_m * 1e3
    )
}
