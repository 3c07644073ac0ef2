//! Identities of the reduction on a coarse small gear: loads, patterns over several teeth, gauges, convergence.
#![allow(clippy::unwrap_used, missing_docs)]

use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{FlankSide, GearDefinition};
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_model::Flank;
use gearmesh_reduction::flank_loads::{dot, flank_grid, flank_loads};
use gearmesh_reduction::tooth_submodel::{Deformation, ToothSubmodel};
use gearmesh_reduction::{GearBody, ReductionOptions, Silent, reduce};

const SMALL: &str = r#"
name = "small"
[tooth]
teeth = 18
module_mm = 3.0
profile_shift = 0.1
face_width_mm = 12.0
[blank]
kind = "thin-rim"
bore_diameter_mm = 14.0
hub_diameter_mm = 20.0
rim_inner_diameter_mm = 38.0
web_thickness_mm = 4.0
[material]
young_GPa = 210.0
poisson = 0.3
[reduction]
roll_stations = 4
slices = 2
flanks = ["right", "left"]
[[gauge]]
name = "root"
tooth = 3
side = "right"
length_mm = 0.9
width_mm = 4.0
"#;

fn gear(extra: &str) -> GearDefinition {
    let text = format!("{SMALL}\n[mesh]\n{extra}");
    GearDefinition::from_document(&InputDocument::new("small.toml", text)).unwrap()
}

const COARSE: &str = "flank_mm = 1.5\nfillet_mm = 0.6\nbody_mm = 4.0\naxial_mm = 3.0\n";

#[test]
fn unit_loads_carry_one_newton_on_the_base_circle() {
    let gear = gear(COARSE);
    let python = PythonEnvironment::find().unwrap();
    let body = GearBody::new(&gear, &python, &Silent).unwrap();
    let grid = flank_grid(&gear);
    for side in [FlankSide::Right, FlankSide::Left] {
        for (number, load) in flank_loads(&gear, &body.mesh, &grid, 5, side)
            .iter()
            .enumerate()
        {
            let mut force = [0.0; 3];
            let (mut torque, mut moment) = (0.0, 0.0);
            for &(dof, value) in &load.normal {
                let p = body.mesh.nodes[dof / 3];
                force[dof % 3] += value;
                torque += match dof % 3 {
                    0 => -p[1] * value,
                    1 => p[0] * value,
                    _ => 0.0,
                };
                moment += p[2] * value.abs();
            }
            let size = force[0].hypot(force[1]);
            // The normal turns over the hat: with spacing d its mean is shorter by d²/12. Chords add a little.
            let spacing = grid.roll_angles_rad[1] - grid.roll_angles_rad[0];
            assert!(
                size <= 1.0 && 1.0 - size < 1.1 * spacing * spacing / 12.0,
                "{size}"
            );
            assert!(force[2] == 0.0);
            // Each normal is tangent to the base circle; only the chords' sagitta is left.
            let lever = side.mirror() * torque / gear.profile.base_radius_m;
            assert!((lever - 1.0).abs() < 1e-3, "{lever}");
            let axial: f64 = load.axial.iter().map(|(_, v)| v).sum();
            assert!((axial - 1.0).abs() < 1e-12);
            // An inner hat is symmetric about its station.
            let j = number % grid.z_m.len();
            if j > 0 && j + 1 < grid.z_m.len() {
                let total: f64 = load.normal.iter().map(|(_, v)| v.abs()).sum();
                assert!((moment / total - grid.z_m[j]).abs() < 1e-9);
            }
        }
    }
}

/// ΨᵀKΨ = C_hub − C_tooth holds as a whole for the loads of one hand on several teeth: submodels share no free node.
#[test]
fn the_pattern_identity_holds_across_teeth() {
    let gear = gear(COARSE);
    let python = PythonEnvironment::find().unwrap();
    let body = GearBody::new(&gear, &python, &Silent).unwrap();
    let grid = flank_grid(&gear);
    let side = FlankSide::Right;
    let n = body.dofs.dof_count();
    let loads: Vec<_> = (0..3)
        .map(|t| flank_loads(&gear, &body.mesh, &grid, t, side))
        .collect();
    let submodel = ToothSubmodel::new(
        &body.model,
        &body.mesh,
        side,
        &loads[0],
        Deformation::Spatial,
    )
    .unwrap();
    // W of teeth 1 and 2 by turning W of tooth 0: node by node, because every tooth has the same mesh.
    let turned = |tooth: usize, load: usize| -> Vec<f64> {
        let w = submodel.column(load, n);
        let angle = std::f64::consts::TAU * tooth as f64 / 18.0;
        let (s, c) = angle.sin_cos();
        let mut full = vec![0.0; n];
        let mesh = &body.mesh;
        for (a, b) in mesh.cell_nodes(0).into_iter().zip(mesh.cell_nodes(tooth)) {
            let (a, b) = (a as usize, b as usize);
            let [x, y, z] = [w[3 * a], w[3 * a + 1], w[3 * a + 2]];
            if [x, y, z] != [0.0; 3] {
                full[3 * b] = c * x - s * y;
                full[3 * b + 1] = s * x + c * y;
                full[3 * b + 2] = z;
            }
        }
        full
    };
    let columns: Vec<_> = loads.iter().flatten().map(|l| &l.normal).collect();
    let mut psi = Vec::new();
    let mut c_hub = vec![0.0; columns.len() * columns.len()];
    body.solve_each(&columns, &Silent, |k, u| {
        for (m, row) in columns.iter().enumerate() {
            c_hub[k * columns.len() + m] = dot(row, u);
        }
        let w = turned(k / grid.len(), k % grid.len());
        psi.push(
            body.dofs
                .restrict(&u.iter().zip(&w).map(|(u, w)| u - w).collect::<Vec<_>>()),
        );
    });
    let (mut difference, mut norm) = (0.0, 0.0);
    let stiffness = gearmesh_fe::assemble_stiffness(&body.model, &body.dofs).unwrap();
    for (b, column) in psi.iter().enumerate() {
        let mut force = vec![0.0; column.len()];
        let k = stiffness.as_ref();
        for (j, &value) in column.iter().enumerate() {
            for (i, entry) in k.row_idx_of_col(j).zip(k.val_of_col(j)) {
                force[i] += entry * value;
            }
        }
        for (a, row) in psi.iter().enumerate() {
            let reduced: f64 = row.iter().zip(&force).map(|(x, y)| x * y).sum();
            let w = turned(b / grid.len(), b % grid.len());
            let c_g = c_hub[b * columns.len() + a] - dot(columns[a], &w);
            difference += (reduced - c_g).powi(2);
            norm += c_g * c_g;
        }
    }
    let relative = (difference / norm).sqrt();
    assert!(relative < 1e-9, "{relative}");
}

#[test]
fn a_reduced_gear_is_symmetric_and_its_mirror_image_equal() {
    let gear = gear(COARSE);
    let python = PythonEnvironment::find().unwrap();
    let model = reduce(
        &gear,
        &python,
        ReductionOptions {
            estimate_error: false,
        },
        &Silent,
    )
    .unwrap()
    .0;
    model.validate().unwrap();
    assert!(
        model.checks.symmetry < 1e-10 && model.checks.pattern_identity < 1e-9,
        "{:?}",
        model.checks
    );
    let n = model.grid.len();
    let largest = model
        .c_hub_block(0, Flank::Right, 0, Flank::Right)
        .iter()
        .fold(0.0f64, |a, b| a.max(b.abs()));
    for (t, f) in [
        (1, Flank::Right),
        (4, Flank::Right),
        (9, Flank::Left),
        (0, Flank::Left),
    ] {
        let there = model.c_hub_block(0, Flank::Right, t, f);
        let back = model.c_hub_block(t, f, 0, Flank::Right);
        for l in 0..n {
            for m in 0..n {
                assert!(
                    (there[l * n + m] - back[m * n + l]).abs() < 1e-10 * largest,
                    "Maxwell-Betti, tooth {t}"
                );
            }
        }
    }
    // Mirror at the tooth's centre plane: right becomes left, tooth t becomes −t. The body's mesh is not symmetric,
    // so that the two agree only to its discretisation error.
    let (a, b) = (
        model.c_hub_block(0, Flank::Right, 2, Flank::Right),
        model.c_hub_block(0, Flank::Left, 16, Flank::Left),
    );
    assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 2e-3 * largest));
    // A gauge on the tension side reads tension for a load at the tip of its tooth, in both methods.
    let gauge = &model.gauges[0];
    let tip = model.grid.load(
        model.grid.roll_angles_rad.len() - 1,
        model.grid.z_m.len() / 2,
    );
    let adjoint = gauge.adjoint[3 * (gauge.tooth * 2 * n + tip)];
    assert!(adjoint > 0.0 && adjoint - gauge.own_tooth[tip] > 0.0);
    assert!(
        gauge.own_tooth[tip].abs() < 0.3 * adjoint,
        "W hardly strains the root"
    );
}

/// Superposition against one direct solution: strain by the adjoint row equals strain taken from the field.
#[test]
fn adjoint_rows_read_what_the_field_holds() {
    let gear = gear(COARSE);
    let python = PythonEnvironment::find().unwrap();
    let (model, body) = reduce(
        &gear,
        &python,
        ReductionOptions {
            estimate_error: false,
        },
        &Silent,
    )
    .unwrap();
    let loads = flank_loads(&gear, &body.mesh, &model.grid, 3, FlankSide::Right);
    let row = gearmesh_reduction::gauge_row::gauge_row(
        &gear,
        &body.mesh,
        &body.model,
        &gear.gauges[0],
        3,
    )
    .unwrap();
    let n = model.grid.len();
    for load in [0, n / 2, n - 1] {
        for (direction, vector) in [
            &loads[load].normal,
            &loads[load].tangential,
            &loads[load].axial,
        ]
        .into_iter()
        .enumerate()
        {
            let mut strain = 0.0;
            body.solve_each(&[vector], &Silent, |_, u| strain = dot(&row, u));
            let adjoint = model.gauges[0].adjoint[3 * (3 * 2 * n + load) + direction];
            let scale = model.gauges[0]
                .adjoint
                .iter()
                .fold(0.0f64, |a, b| a.max(b.abs()));
            assert!(
                (strain - adjoint).abs() < 1e-9 * scale,
                "{strain} {adjoint}"
            );
        }
    }
}
