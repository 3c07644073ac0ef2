//! Identities of the reduction on a coarse small gear: loads, patterns over several teeth, gauges, convergence.

use crate::small_gears::{MESH, QUADRATIC, SOLID, THIN_RIM, body, gear, reduced};
use gearmesh_fe::FeModel;
use gearmesh_geometry::{Flank, GearDefinition, ProfileCurve};
use gearmesh_mesh::GearMesh;
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_reduction::Silent;
use gearmesh_reduction::flank_loads::{dot, flank_grid, flank_loads};
use gearmesh_reduction::gauge_row::gauge_row;
use gearmesh_reduction::gear_body::model_of;
use gearmesh_reduction::tooth_submodel::{Deformation, ToothSubmodel};

#[test]
fn unit_loads_carry_one_newton_on_the_base_circle() {
    // How far chords and parabolas are off the involute.
    for (mesh, chords) in [(MESH, 1e-3), (QUADRATIC, 1e-4)] {
        unit_loads(&gear(mesh, THIN_RIM, 0.0), chords);
    }
}

fn unit_loads(gear: &GearDefinition, chords: f64) {
    let (mesh, _) = meshed(gear);
    let grid = flank_grid(gear);
    for side in [Flank::Right, Flank::Left] {
        for (number, load) in flank_loads(gear, &mesh, &grid, 5, side).iter().enumerate() {
            let (mut force, mut first) = ([0.0; 3], [0.0; 3]);
            let mut torque = 0.0;
            for &(dof, value) in &load.normal {
                let p = mesh.nodes[dof / 3];
                force[dof % 3] += value;
                first[dof % 3] += p[2] * value;
                torque += match dof % 3 {
                    0 => -p[1] * value,
                    1 => p[0] * value,
                    _ => 0.0,
                };
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
            assert!((lever - 1.0).abs() < chords, "{lever}");
            let axial: f64 = load.axial.iter().map(|(_, v)| v).sum();
            assert!((axial - 1.0).abs() < 1e-12);
            // An inner hat is symmetric about its station.
            let j = number % grid.z_m.len();
            if j > 0 && j + 1 < grid.z_m.len() {
                let height = (force[0] * first[0] + force[1] * first[1]) / (size * size);
                assert!((height - grid.z_m[j]).abs() < 1e-12, "{height}");
            }
        }
    }
}

/// Mesh and model without a solver.
fn meshed(gear: &GearDefinition) -> (GearMesh, FeModel) {
    let mesh = GearMesh::new(gear, &PythonEnvironment::find().unwrap()).unwrap();
    let model = model_of(gear, &mesh).unwrap();
    (mesh, model)
}

/// What a gauge reads of a displacement field given at the nodes, and the sum of the absolute terms: the scale of
/// rounding.
fn reading(
    row: &[(usize, f64)],
    mesh: &GearMesh,
    field: impl Fn([f64; 3]) -> [f64; 3],
) -> (f64, f64) {
    let terms = row
        .iter()
        .map(|&(dof, weight)| weight * field(mesh.nodes[dof / 3])[dof % 3]);
    terms.fold((0.0, 0.0), |(sum, size), term| {
        (sum + term, size + term.abs())
    })
}

#[test]
fn a_gauge_reads_uniform_strain_and_no_rigid_motion() {
    for (lengths, straight) in [(MESH, 3e-2), (QUADRATIC, 3e-3)] {
        for helix_deg in [0.0, 20.0] {
            let gear = gear(lengths, SOLID, helix_deg);
            let (mesh, model) = meshed(&gear);
            let gauge = &gear.gauges[0];
            let row = gauge_row(&gear, &mesh, &model, gauge, 0).unwrap();
            let rigid: [fn([f64; 3]) -> [f64; 3]; 4] = [
                |_| [1.0, 2.0, 3.0],
                |[x, y, _]| [-y, x, 0.0],
                |[_, y, z]| [0.0, -z, y],
                |[x, _, z]| [z, 0.0, -x],
            ];
            for motion in rigid {
                let (sum, size) = reading(&row, &mesh, motion);
                assert!(sum.abs() < 1e-13 * size, "{sum} of {size}");
            }
            // The same in all directions of the section: no matter which way the profile runs.
            let (sum, size) = reading(&row, &mesh, |[x, y, _]| [1e-3 * x, 1e-3 * y, 0.0]);
            assert!((sum - 1e-3).abs() < 1e-13 * size, "{sum}");
            // Along one direction: the mean of t_x² over the gauge's piece of the exact profile, turned with the helix.
            let (sum, _) = reading(&row, &mesh, |[x, _, _]| [x, 0.0, 0.0]);
            let curve = ProfileCurve::new(&gear.profile);
            let centre = curve.arc_length_at(gauge.position).unwrap();
            let steps = 40;
            let mut expected = 0.0;
            for i in 0..steps {
                let share = (f64::from(i) + 0.5) / f64::from(steps) - 0.5;
                let arc = centre + share * gauge.length_m;
                let (a, b) = (curve.point_at(arc - 1e-7), curve.point_at(arc + 1e-7));
                let along = (b[1] - a[1]).atan2(b[0] - a[0]);
                for j in 0..steps {
                    let share = (f64::from(j) + 0.5) / f64::from(steps) - 0.5;
                    let z = gauge.z_m + share * gauge.width_m;
                    let turned = along + gear.profile.twist_rad_per_m() * z;
                    expected += turned.cos().powi(2) / f64::from(steps * steps);
                }
            }
            println!("{lengths}{helix_deg} deg: {sum} against {expected}");
            assert!((sum - expected).abs() < straight, "{sum} {expected}");
        }
    }
}

/// ΨᵀKΨ = C_hub − C_tooth holds as a whole for the loads of one hand on several teeth: submodels share no free node.
#[test]
fn the_pattern_identity_holds_across_teeth() {
    let gear = gear(MESH, THIN_RIM, 0.0);
    let body = body(&gear);
    let grid = flank_grid(&gear);
    let side = Flank::Right;
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
        let mut weights = vec![0.0; grid.len()];
        weights[load] = -1.0;
        let mut w = vec![0.0; n];
        submodel.subtract(&weights, &mut w);
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
    let model = reduced(&gear(MESH, THIN_RIM, 0.0), false).0;
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
    assert!(
        a.iter()
            .zip(&*b)
            .all(|(a, b)| (a - b).abs() < 2e-3 * largest)
    );
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
    let gear = gear(MESH, THIN_RIM, 0.0);
    let (model, body) = reduced(&gear, false);
    let loads = flank_loads(&gear, &body.mesh, &model.grid, 3, Flank::Right);
    let row = gauge_row(&gear, &body.mesh, &body.model, &gear.gauges[0], 3).unwrap();
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
