//! The reduction: compliance of the flanks, gauge rows, and the identities they must fulfil.

use crate::dynamics::dynamics;
use crate::error_estimate::{ErrorEstimate, estimate};
use crate::flank_loads::{GridLoad, SparseVector, flank_grid, flank_loads};
use crate::gauge_row::gauge_row;
use crate::gear_body::GearBody;
use crate::near_field::calibrate;
use crate::root_crack::{CRACK_SYMMETRY, root_crack};
use crate::tooth_submodel::{Deformation, ToothSubmodel};
use crate::{Progress, ReductionError, Silent};
use faer::Mat;
use gearmesh_geometry::{Flank, GearDefinition, ProfileCurve};
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_model::{
    FlankGrid, GaugeRows, NearField, Provenance, ReducedGear, ReductionChecks, StoredGear, utc_now,
};
use std::time::Instant;

/// Largest asymmetry of C_hub and largest violation of the pattern identity that round-off explains.
pub(crate) const SYMMETRY_ALLOWED: f64 = 1e-10;
pub(crate) const IDENTITY_ALLOWED: f64 = 1e-9;
/// Patterns on which the identity is checked: K is applied to each, which costs as much as a solve.
const IDENTITY_SAMPLES: usize = 8;

const ROWS_BY_FIELDS: &str = "C_hub against solved fields";

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
    let body = GearBody::new(gear, python, progress)?;
    let mut stage_seconds = body.stage_seconds.clone();
    let mut clock = Instant::now();
    let mut lap = |name: &str| {
        stage_seconds.push((name.to_string(), clock.elapsed().as_secs_f64()));
        clock = Instant::now();
    };
    let grid = flank_grid(gear);
    let flanks = &gear.reduction.flanks;
    let loads: Vec<Vec<GridLoad>> = flanks
        .iter()
        .map(|&side| flank_loads(gear, &body.mesh, &grid, 0, side))
        .collect();
    let (teeth, count) = (gear.tooth.teeth, grid.len());
    let own = teeth / gear.sectors();
    lap("loads");

    let deformation = Deformation::of(gear);
    progress.stage("tooth submodel");
    let submodels: Vec<ToothSubmodel> = flanks
        .iter()
        .zip(&loads)
        .map(|(&side, loads)| ToothSubmodel::new(&body.model, &body.mesh, side, loads, deformation))
        .collect::<Result<_, _>>()?;
    let mut c_tooth = Vec::with_capacity(flanks.len() * count * count);
    for (submodel, loads) in submodels.iter().zip(&loads) {
        let rows: Vec<&SparseVector> = loads.iter().map(|l| &l.normal).collect();
        let products = submodel.products(&rows);
        // products is [response][load]; the file holds [load][response].
        c_tooth.extend((0..count * count).map(|k| products[(k % count) * count + k / count]));
    }
    lap("tooth submodel");

    progress.stage("calibrating the near field");
    let near_field = calibrate(gear, &body.mesh, &body.model, &grid)?;
    lap("near field");

    progress.stage("solving flank loads");
    let normals: Vec<&SparseVector> = loads.iter().flatten().map(|load| &load.normal).collect();
    let c_rows = body.compliance(own, &normals, progress);
    lap("solve");

    progress.stage("checking");
    let symmetry = asymmetry(&c_rows, own, flanks.len(), teeth, count);
    let pattern_identity = pattern_identity(
        &body,
        &submodels[0],
        &normals[..count],
        &c_rows,
        teeth * normals.len(),
        &c_tooth,
    );
    let rows_by_fields = rows_by_fields(&body, &normals, &c_rows, teeth * normals.len());
    let c_hub = by_blocks(&c_rows, own, flanks.len(), teeth, count);
    for (check, found, allowed) in [
        ("symmetry of C_hub", symmetry, SYMMETRY_ALLOWED),
        ("the pattern identity", pattern_identity, IDENTITY_ALLOWED),
        (ROWS_BY_FIELDS, rows_by_fields, IDENTITY_ALLOWED),
    ] {
        checked(check, found, allowed)?;
    }
    lap("checks");

    let gauge_rows: Vec<SparseVector> = gear
        .gauges
        .iter()
        .map(|g| gauge_row(gear, &body.mesh, &body.model, g, g.tooth))
        .collect::<Result<_, _>>()?;
    let mut gauges = gauges(gear, &body, &loads, &submodels, &gauge_rows, progress)?;
    lap("gauges");
    let dynamics = dynamics(gear, &body, &loads, &gauge_rows, progress)?;
    if dynamics.rigid_body.is_some() {
        lap("mass and modes");
    }
    let mut further = vec![(ROWS_BY_FIELDS.to_string(), rows_by_fields)];
    further.extend(dynamics.checks);
    if options.estimate_error {
        let ErrorEstimate {
            loaded_tooth,
            other_teeth,
            gauges: errors,
        } = estimate(gear, python, &gauges, &c_hub, &c_tooth, &grid, progress)?;
        for (name, error) in [
            (ReductionChecks::LOADED_TOOTH_ERROR, loaded_tooth),
            (ReductionChecks::OTHER_TEETH_ERROR, other_teeth),
        ] {
            further.push((name.to_string(), error));
        }
        for (gauge, error) in gauges.iter_mut().zip(errors) {
            gauge.error_estimate_relative = error;
        }
        lap("error estimate");
    }
    let crack = gear.crack.as_ref();
    let crack = crack
        .map(|definition| {
            let of_side = flanks.iter().position(|&side| side == definition.side);
            // Checked when the definition was read.
            let loads = &loads[of_side.unwrap_or_default()];
            root_crack(gear, definition, &body, loads, progress)
        })
        .transpose()?;
    if let Some(crack) = &crack {
        crack.add_to_gauges(gear, &mut gauges);
        further.push((CRACK_SYMMETRY.to_string(), crack.asymmetry));
        lap("crack");
    }
    let mut effort = body.effort();
    let mode_solves = dynamics.solves.map(|solves| solves as f64);
    effort.extend(mode_solves.map(|solves| ("solves for natural modes".to_string(), solves)));
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
    reduced.crack = crack.map(|rows| rows.crack);
    Ok((reduced, body))
}

/// Refuses a violation of an identity that round-off does not explain.
pub(crate) fn checked(check: &'static str, found: f64, allowed: f64) -> Result<(), ReductionError> {
    if found.is_nan() || found > allowed {
        return Err(ReductionError::Check {
            check,
            found,
            allowed,
        });
    }
    Ok(())
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

/// Names of the kinds of elements of a model.
pub(crate) fn element_names(model: &gearmesh_fe::FeModel) -> String {
    let names: Vec<&str> = model.blocks().iter().map(|b| b.element.name()).collect();
    names.join(" + ")
}

/// From rows over all responses, `[s][f][l][t][f'][m]`, to blocks `[s][f][t][f'][l][m]`.
pub(crate) fn by_blocks(
    rows: &[f64],
    own: usize,
    flanks: usize,
    teeth: usize,
    count: usize,
) -> Vec<f64> {
    let mut blocks = Vec::with_capacity(rows.len());
    for load_flank in 0..own * flanks {
        for response_flank in 0..teeth * flanks {
            for l in 0..count {
                let start = ((load_flank * count + l) * teeth * flanks + response_flank) * count;
                blocks.extend_from_slice(&rows[start..start + count]);
            }
        }
    }
    blocks
}

/// Largest |C_lm − C_ml| over the sector's own teeth, relative to the largest entry.
pub(crate) fn asymmetry(
    rows: &[f64],
    own: usize,
    flanks: usize,
    teeth: usize,
    count: usize,
) -> f64 {
    let size = own * flanks * count;
    let row_length = teeth * flanks * count;
    let mut worst: f64 = 0.0;
    let mut largest: f64 = 0.0;
    for i in 0..size {
        for j in 0..=i {
            let (a, b) = (rows[i * row_length + j], rows[j * row_length + i]);
            worst = worst.max((a - b).abs());
            largest = largest.max(a.abs());
        }
    }
    worst / largest
}

/// Largest difference, relative to the largest value, between rows of C_hub and what all teeth read of the solved
/// fields of some loads. By repetition C_hub is made of products of half solves, symmetric by construction: this goes
/// the other way, out to every tooth again.
fn rows_by_fields(
    body: &GearBody,
    normals: &[&SparseVector],
    c_rows: &[f64],
    row_length: usize,
) -> f64 {
    let sampled: Vec<usize> = (0..normals.len())
        .step_by(normals.len().div_ceil(IDENTITY_SAMPLES))
        .collect();
    let loads: Vec<&SparseVector> = sampled.iter().map(|&load| normals[load]).collect();
    let (mut worst, mut largest): (f64, f64) = (0.0, 0.0);
    for (&load, reading) in sampled.iter().zip(body.readings(&loads, normals, &Silent)) {
        for (a, b) in c_rows[load * row_length..].iter().zip(&reading) {
            worst = worst.max((a - b).abs());
            largest = largest.max(a.abs());
        }
    }
    worst / largest
}

/// ‖ΨᵀKΨ − C_g‖ / ‖C_g‖ over some patterns of tooth 0's first flank, with K applied to them.
fn pattern_identity(
    body: &GearBody,
    submodel: &ToothSubmodel,
    normals: &[&SparseVector],
    c_rows: &[f64],
    row_length: usize,
    c_tooth: &[f64],
) -> f64 {
    pattern_identity_of(
        submodel,
        normals,
        c_rows,
        row_length,
        c_tooth,
        |loads, each| body.solve_each(loads, &Silent, each),
        |patterns| body.energy_products(patterns),
    )
}

/// As [`pattern_identity`], for any way to solve for loads and to take XᵀKX of fields.
pub(crate) fn pattern_identity_of(
    submodel: &ToothSubmodel,
    normals: &[&SparseVector],
    c_rows: &[f64],
    row_length: usize,
    c_tooth: &[f64],
    solve_each: impl FnOnce(&[&SparseVector], &mut dyn FnMut(usize, &[f64])),
    energy_products: impl FnOnce(&[Vec<f64>]) -> Mat<f64>,
) -> f64 {
    let count = normals.len();
    let sampled: Vec<usize> = (0..count)
        .step_by(count.div_ceil(IDENTITY_SAMPLES))
        .collect();
    let loads: Vec<&SparseVector> = sampled.iter().map(|&load| normals[load]).collect();
    let mut patterns: Vec<Vec<f64>> = Vec::with_capacity(loads.len());
    solve_each(&loads, &mut |k, u| {
        let w = submodel.column(sampled[k], u.len());
        patterns.push(u.iter().zip(&w).map(|(u, w)| u - w).collect());
    });
    let energy = energy_products(&patterns);
    let (mut difference, mut norm) = (0.0, 0.0);
    for (a, load_a) in sampled.iter().enumerate() {
        for (b, load_b) in sampled.iter().enumerate() {
            let c_g = c_rows[load_a * row_length + load_b] - c_tooth[load_a * count + load_b];
            difference += (energy[(a, b)] - c_g).powi(2);
            norm += c_g * c_g;
        }
    }
    (difference / norm).sqrt()
}

/// One adjoint solution per gauge: y = K⁻¹g, read at all grid loads in three directions; and gᵀW on its own tooth.
fn gauges(
    gear: &GearDefinition,
    body: &GearBody,
    loads: &[Vec<GridLoad>],
    submodels: &[ToothSubmodel],
    rows: &[SparseVector],
    progress: &dyn Progress,
) -> Result<Vec<GaugeRows>, ReductionError> {
    if gear.gauges.is_empty() {
        return Ok(Vec::new());
    }
    progress.stage("solving gauges");
    let directions: Vec<&SparseVector> = loads
        .iter()
        .flatten()
        .flat_map(|load| [&load.normal, &load.tangential, &load.axial])
        .collect();
    let adjoints = body.readings(&rows.iter().collect::<Vec<_>>(), &directions, progress);
    gear.gauges
        .iter()
        .zip(adjoints)
        .map(|(gauge, adjoint)| {
            // W is known on tooth 0; the reading there is the same, because mesh and gauge turn together.
            let at_zero = gauge_row(gear, &body.mesh, &body.model, gauge, 0)?;
            Ok(GaugeRows {
                name: gauge.name.clone(),
                tooth: gauge.tooth,
                side: gauge.side,
                description: describe(gauge),
                error_estimate_relative: 0.0,
                adjoint,
                own_tooth: submodels
                    .iter()
                    .flat_map(|s| s.products(&[&at_zero]))
                    .collect(),
            })
        })
        .collect()
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
