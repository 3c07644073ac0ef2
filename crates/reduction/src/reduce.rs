//! The reduction: compliance of the flanks, gauge rows, and the identities they must fulfil.

use crate::error_estimate::{ErrorEstimate, estimate};
use crate::flank_loads::{GridLoad, SparseVector, dot, flank_grid, flank_loads};
use crate::gauge_row::gauge_row;
use crate::gear_body::GearBody;
use crate::near_field::calibrate;
use crate::tooth_submodel::{Deformation, ToothSubmodel};
use crate::{Progress, ReductionError, flank_of};
use gearmesh_geometry::{FlankSide, GearDefinition, ProfileCurve};
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_model::{FlankGrid, GaugeRows, Provenance, ReducedGear, ReductionChecks, utc_now};
use rayon::prelude::*;
use std::time::Instant;

/// Largest asymmetry of C_hub and largest violation of the pattern identity that round-off explains.
const SYMMETRY_ALLOWED: f64 = 1e-10;
const IDENTITY_ALLOWED: f64 = 1e-9;
/// Patterns on which the identity is checked: K is applied to each, which costs as much as a solve.
const IDENTITY_SAMPLES: usize = 8;

/// What a reduction does besides its main job.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ReductionOptions {
    /// Reduce a coarser mesh too and estimate the discretisation error from the difference.
    pub estimate_error: bool,
}

/// Loads of every tooth: `[tooth][flank of the definition][load]`.
pub(crate) fn all_loads(
    gear: &GearDefinition,
    body: &GearBody,
    grid: &FlankGrid,
) -> Vec<Vec<Vec<GridLoad>>> {
    (0..gear.tooth.teeth)
        .into_par_iter()
        .map(|tooth| {
            gear.reduction
                .flanks
                .iter()
                .map(|&side| flank_loads(gear, &body.mesh, grid, tooth, side))
                .collect()
        })
        .collect()
}

/// Reduces a gear to its compliance at the flanks. The finite element model is handed back for pictures.
///
/// C_hub = NᵀK⁻¹N is solved for the teeth of one repeating sector only, against all teeth; C_tooth = NᵀW once, because
/// all teeth have the same mesh.
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
    let loads = all_loads(gear, &body, &grid);
    let flanks = &gear.reduction.flanks;
    let (teeth, sectors, count) = (gear.tooth.teeth, gear.sectors(), grid.len());
    let own = teeth / sectors;

    let deformation = Deformation::of(gear);
    progress.stage("tooth submodel");
    let submodels: Vec<ToothSubmodel> = flanks
        .iter()
        .enumerate()
        .map(|(f, &side)| {
            ToothSubmodel::new(&body.model, &body.mesh, side, &loads[0][f], deformation)
        })
        .collect::<Result<_, _>>()?;
    let mut c_tooth = Vec::with_capacity(flanks.len() * count * count);
    for (f, submodel) in submodels.iter().enumerate() {
        let rows: Vec<&SparseVector> = loads[0][f].iter().map(|l| &l.normal).collect();
        let products = submodel.products(&rows, body.dofs.dof_count());
        // products is [response][load]; the file holds [load][response].
        c_tooth.extend((0..count * count).map(|k| products[(k % count) * count + k / count]));
    }
    lap("tooth submodel");

    progress.stage("calibrating the near field");
    let near_field = calibrate(gear, &body.mesh, &body.model, &grid)?;
    lap("near field");

    progress.stage("solving flank loads");
    let sector_loads: Vec<&SparseVector> = (0..own)
        .flat_map(|tooth| loads[tooth].iter().flatten().map(|load| &load.normal))
        .collect();
    let responses: Vec<&SparseVector> = loads
        .iter()
        .flatten()
        .flatten()
        .map(|load| &load.normal)
        .collect();
    let row_length = responses.len();
    let mut c_rows = vec![0.0; sector_loads.len() * row_length];
    // Patterns of tooth 0's first flank that the identity is checked on.
    let stride = count.div_ceil(IDENTITY_SAMPLES);
    let mut patterns: Vec<(usize, Vec<f64>)> = Vec::new();
    body.solve_each(&sector_loads, progress, |column, u| {
        let row = &mut c_rows[column * row_length..(column + 1) * row_length];
        row.par_iter_mut()
            .zip(&responses)
            .for_each(|(c, response)| *c = dot(response, u));
        if column < count && column % stride == 0 {
            let w = submodels[0].column(column, u.len());
            patterns.push((column, u.iter().zip(&w).map(|(u, w)| u - w).collect()));
        }
    });
    lap("solve");

    let symmetry = asymmetry(&c_rows, own, flanks.len(), teeth, count);
    let pattern_identity = pattern_identity(&body, &patterns, &c_rows, &c_tooth, row_length, count);
    let c_hub = by_blocks(&c_rows, own, flanks.len(), teeth, count);
    for (check, found, allowed) in [
        ("symmetry of C_hub", symmetry, SYMMETRY_ALLOWED),
        ("the pattern identity", pattern_identity, IDENTITY_ALLOWED),
    ] {
        if found.is_nan() || found > allowed {
            return Err(ReductionError::Check {
                check,
                found,
                allowed,
            });
        }
    }
    lap("checks");

    let mut gauges = gauges(gear, &body, &loads, &submodels, progress)?;
    lap("gauges");
    let mut further = Vec::new();
    if options.estimate_error {
        let ErrorEstimate {
            compliance,
            gauges: errors,
        } = estimate(gear, python, &gauges, &c_hub, &c_tooth, &grid)?;
        further.push(("compliance error estimate".to_string(), compliance));
        for (gauge, error) in gauges.iter_mut().zip(errors) {
            gauge.error_estimate_relative = error;
        }
        lap("error estimate");
    }
    let curve = ProfileCurve::new(&gear.profile);
    let opposite: Vec<f64> = grid
        .roll_angles_rad
        .iter()
        .map(|&xi| curve.opposite_distance_m(xi))
        .collect();
    let reduced = ReducedGear {
        name: gear.name.clone(),
        input_toml: gear.source.clone(),
        teeth,
        sectors,
        base_radius_m: gear.profile.base_radius_m,
        face_width_m: gear.tooth.face_width_m,
        young_pa: gear.material.young_pa,
        poisson: gear.material.poisson,
        flanks: flanks.iter().map(|&side| flank_of(side)).collect(),
        opposite_distance_m: opposite.repeat(flanks.len()),
        c_hub,
        c_tooth,
        near_field: Some(near_field),
        gauges,
        provenance: Provenance {
            program: "gearmesh".into(),
            version: env!("CARGO_PKG_VERSION").into(),
            created_utc: utc_now(),
            threads: rayon::current_num_threads(),
            element: serde_name(gear),
            nodes: body.mesh.nodes.len(),
            elements: body.mesh.hexes.len(),
            dofs: body.dofs.free_count(),
            stage_seconds,
        },
        checks: ReductionChecks {
            symmetry,
            pattern_identity,
            further,
        },
        grid,
    };
    Ok((reduced, body))
}

fn serde_name(gear: &GearDefinition) -> String {
    match gear.mesh.element {
        gearmesh_geometry::ElementKind::Hex8 => "hex8",
        gearmesh_geometry::ElementKind::Hex8Incompatible => "hex8-incompatible",
    }
    .to_string()
}

/// From rows over all responses, `[s][f][l][t][f'][m]`, to blocks `[s][f][t][f'][l][m]`.
fn by_blocks(rows: &[f64], own: usize, flanks: usize, teeth: usize, count: usize) -> Vec<f64> {
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
fn asymmetry(rows: &[f64], own: usize, flanks: usize, teeth: usize, count: usize) -> f64 {
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

/// ‖ΨᵀKΨ − C_g‖ / ‖C_g‖ over the sampled patterns, with K applied to them.
fn pattern_identity(
    body: &GearBody,
    patterns: &[(usize, Vec<f64>)],
    c_rows: &[f64],
    c_tooth: &[f64],
    row_length: usize,
    count: usize,
) -> f64 {
    let free: Vec<Vec<f64>> = patterns
        .iter()
        .map(|(_, psi)| body.dofs.restrict(psi))
        .collect();
    let forces: Vec<Vec<f64>> = free.par_iter().map(|psi| multiply(body, psi)).collect();
    let (mut difference, mut norm) = (0.0, 0.0);
    for (a, (load_a, _)) in patterns.iter().enumerate() {
        for (b, (load_b, _)) in patterns.iter().enumerate() {
            let reduced: f64 = free[a].iter().zip(&forces[b]).map(|(x, y)| x * y).sum();
            let c_g = c_rows[load_a * row_length + load_b] - c_tooth[load_a * count + load_b];
            difference += (reduced - c_g).powi(2);
            norm += c_g * c_g;
        }
    }
    (difference / norm).sqrt()
}

fn multiply(body: &GearBody, x: &[f64]) -> Vec<f64> {
    let mut y = vec![0.0; x.len()];
    let k = body.stiffness.as_ref();
    for (column, &value) in x.iter().enumerate() {
        for (row, entry) in k.row_idx_of_col(column).zip(k.val_of_col(column)) {
            y[row] += entry * value;
        }
    }
    y
}

/// One adjoint solve per gauge: y = K⁻¹g, read at all grid loads in three directions; and gᵀW on its own tooth.
fn gauges(
    gear: &GearDefinition,
    body: &GearBody,
    loads: &[Vec<Vec<GridLoad>>],
    submodels: &[ToothSubmodel],
    progress: &dyn Progress,
) -> Result<Vec<GaugeRows>, ReductionError> {
    if gear.gauges.is_empty() {
        return Ok(Vec::new());
    }
    progress.stage("solving gauges");
    let rows: Vec<SparseVector> = gear
        .gauges
        .iter()
        .map(|g| gauge_row(gear, &body.mesh, &body.model, g, g.tooth))
        .collect::<Result<_, _>>()?;
    let mut adjoints = Vec::with_capacity(rows.len());
    body.solve_each(&rows.iter().collect::<Vec<_>>(), progress, |_, y| {
        let adjoint: Vec<f64> = loads
            .iter()
            .flatten()
            .flatten()
            .flat_map(|load| {
                [
                    dot(&load.normal, y),
                    dot(&load.tangential, y),
                    dot(&load.axial, y),
                ]
            })
            .collect();
        adjoints.push(adjoint);
    });
    gear.gauges
        .iter()
        .zip(adjoints)
        .map(|(gauge, adjoint)| {
            // W is known on tooth 0; the reading there is the same, because mesh and gauge turn together.
            let at_zero = gauge_row(gear, &body.mesh, &body.model, gauge, 0)?;
            Ok(GaugeRows {
                name: gauge.name.clone(),
                tooth: gauge.tooth,
                side: flank_of(gauge.side),
                description: describe(gauge),
                error_estimate_relative: 0.0,
                adjoint,
                own_tooth: submodels
                    .iter()
                    .flat_map(|s| s.products(&[&at_zero], body.dofs.dof_count()))
                    .collect(),
            })
        })
        .collect()
}

fn describe(gauge: &gearmesh_geometry::GaugeDefinition) -> String {
    let place = match gauge.position {
        gearmesh_geometry::RootPosition::TangentAngle(a) => {
            format!("{:.2} deg tangent", a.to_degrees())
        }
        gearmesh_geometry::RootPosition::Radius(r) => format!("radius {:.4} mm", r * 1e3),
    };
    let side = match gauge.side {
        FlankSide::Right => "right",
        FlankSide::Left => "left",
    };
    format!(
        "tooth {}, {side} root, {place}, {:.3} mm along the profile, {:.3} mm wide at z {:.3} mm",
        gauge.tooth,
        gauge.length_m * 1e3,
        gauge.width_m * 1e3,
        gauge.z_m * 1e3
    )
}
