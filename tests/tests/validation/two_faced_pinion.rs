//! A pinion cut into its shaft, taken with its frame on its back face: compliance against one finite element model that
//! is held behind its back face, natural frequencies between beams against one of pinion and shaft.

use gearmesh_drivetrain::GearOnFaces;
use gearmesh_fe::{
    DofMap, Factor, ModeSettings, RigidGroup, WantedModes, assemble_mass, assemble_stiffness,
    natural_modes,
};
use gearmesh_geometry::Flank;
use gearmesh_mesh::python::PythonEnvironment;
use gearmesh_reduction::flank_loads::{SparseVector, flank_grid, flank_loads};
use gearmesh_reduction::gauge_row::gauge_row;
use gearmesh_reduction::{GearBody, ReductionOptions, Silent, reduce};
use nalgebra::{DMatrix, Matrix3, Matrix6, Vector3};
use std::f64::consts::{PI, TAU};

use crate::{computed, pinion_with_stubs, whole_compliance};

use pinion_with_stubs::{CASES, Case, WIDTH_M, with_stubs};

const MORE: &str = "[[gauge]]\nname = \"root\"\ntooth = 0\nside = \"right\"\ntangent_deg = 30.0\nlength_mm = 2.0\nwidth_mm = 10.0\n[modes]\ncount = 12\n";
const DENSITY: f64 = 7850.0;
const YOUNG: f64 = 210e9;
const SHEAR: f64 = YOUNG / 2.6;

/// Flexibility of a tube: its end moves by this against its other one, `towards` the sign of z from there to it.
fn flexibility([radius, hole]: [f64; 2], length: f64, towards: f64) -> Matrix6<f64> {
    let area = PI * (radius * radius - hole * hole);
    let second = 0.25 * PI * (radius.powi(4) - hole.powi(4));
    let ratio = (hole / radius).powi(2);
    let kappa = 7.8 / (8.8 + 23.6 * ratio / (1.0 + ratio).powi(2));
    let turn = length / (YOUNG * second);
    let across = length * length * turn / 3.0 + length / (kappa * SHEAR * area);
    let mixed = towards * 0.5 * length * turn;
    let mut h = Matrix6::zeros();
    h.set_diagonal(&nalgebra::Vector6::new(
        across,
        across,
        length / (YOUNG * area),
        turn,
        turn,
        length / (2.0 * SHEAR * second),
    ));
    (h[(0, 4)], h[(4, 0)]) = (-mixed, -mixed);
    (h[(1, 3)], h[(3, 1)]) = (mixed, mixed);
    h
}

/// What a rigid motion of a point on the axis moves another one there, by z behind it.
fn carried(z: f64) -> Matrix6<f64> {
    let mut x = Matrix6::identity();
    (x[(0, 4)], x[(1, 3)]) = (z, -z);
    x
}

fn on_the_whole(vector: &SparseVector, nodes: &[[f64; 3]], about_z: f64) -> [f64; 6] {
    let mut sum = [0.0; 6];
    for &(dof, force) in vector {
        let [x, y, z] = nodes[dof / 3];
        let mut f = Vector3::zeros();
        f[dof % 3] = force;
        let m = Vector3::new(x, y, z - about_z).cross(&f);
        for axis in 0..3 {
            sum[axis] += f[axis];
            sum[3 + axis] += m[axis];
        }
    }
    sum
}

/// Held at the end of its back stub, its front stub's end rigid and free, it deflects as on its back face and, beyond
/// that, as the back stub is a beam.
#[test]
fn its_compliance_is_that_of_the_body_held_behind_its_back() {
    let case = &CASES[1];
    let gear = case.gear([2.4, 1.2, 6.0, 6.0], MORE);
    let options = ReductionOptions {
        estimate_error: false,
    };
    let python = PythonEnvironment::find().unwrap();
    let (model, body) = reduce(&gear, &python, options, &Silent).unwrap();
    let [back, front] = body.mesh.stub_ends();
    let fixed: Vec<usize> = back
        .iter()
        .flat_map(|&n| (0..3).map(move |a| 3 * n as usize + a))
        .collect();
    let group = RigidGroup {
        nodes: front.iter().map(|&n| n as usize).collect(),
        reference_m: [0.0, 0.0, 0.5 * WIDTH_M],
        fixed: [false; 6],
    };
    let dofs = DofMap::with_rigid_groups(body.model.nodes(), &fixed, &[group]).unwrap();
    let loads = flank_loads(&gear, &body.mesh, &flank_grid(&gear), 0, Flank::Right);
    let root = gauge_row(&gear, &body.mesh, &body.model, &gear.gauges[0], 0).unwrap();
    let mut vectors: Vec<_> = loads.iter().map(|load| &load.normal).collect();
    vectors.push(&root);
    let held_behind = whole_compliance::products(&body.model, &dofs, &vectors);
    let resultants = DMatrix::from_fn(6, vectors.len(), |axis, vector| {
        on_the_whole(vectors[vector], body.model.nodes(), -0.5 * WIDTH_M)[axis]
    });
    let radius = case.radius_m(0);
    let hole = gear.blank.cut_into_shaft().unwrap().hole_radius_m;
    let stub = flexibility([radius, hole], 0.5 * radius, -1.0);
    let of_stub = resultants.tr_mul(&(stub * &resultants));
    let expected = |i: usize, j: usize| held_behind[(i, j)] - of_stub[(i, j)];

    let on_faces = GearOnFaces::new(&model, 12).unwrap();
    let strain = &on_faces.model.gauges[0].adjoint;
    for (load, found) in strain.iter().step_by(3).take(loads.len()).enumerate() {
        let expected = expected(loads.len(), load);
        assert!((found / expected - 1.0).abs() < 1e-8, "{found} {expected}");
    }
    let found = on_faces.model.c_hub_block(0, Flank::Right, 0, Flank::Right);
    let held = model.c_hub_block(0, Flank::Right, 0, Flank::Right);
    for (i, (found, held)) in found.iter().zip(held.iter()).enumerate() {
        let expected = expected(i / loads.len(), i % loads.len());
        assert!((found / expected - 1.0).abs() < 1e-8, "{found} {expected}");
        assert!(expected > 1.01 * held);
    }
}

/// Adds a beam of short pieces between two frames that move with all coordinates by `ends`, or are fixed, with its mass
/// lumped at the pieces' ends; coordinates for them are appended.
fn add_beam(
    (k, m): (&mut DMatrix<f64>, &mut DMatrix<f64>),
    first: usize,
    ends: [Option<&DMatrix<f64>>; 2],
    (radius, length): (f64, f64),
    pieces: usize,
) {
    let size = k.nrows();
    let piece = length / pieces as f64;
    let place = |n: usize| -> DMatrix<f64> {
        let end = match n {
            0 => ends[0],
            n if n == pieces => ends[1],
            _ => {
                let mut own = DMatrix::zeros(6, size);
                own.view_mut((0, first + 6 * (n - 1)), (6, 6))
                    .fill_with_identity();
                return own;
            }
        };
        end.cloned().unwrap_or_else(|| DMatrix::zeros(6, size))
    };
    let area = PI * radius * radius;
    let half = 0.5 * DENSITY * area * piece;
    let disc = half * (0.25 * radius * radius + piece * piece / 12.0);
    let lump = DMatrix::from_diagonal(&nalgebra::DVector::from_row_slice(&[
        half,
        half,
        half,
        disc,
        disc,
        0.5 * half * radius * radius,
    ]));
    let stiff = flexibility([radius, 0.0], piece, -1.0)
        .try_inverse()
        .unwrap();
    for n in 0..pieces {
        let (low, high) = (place(n), place(n + 1));
        // The upper end against the lower one.
        let stretch = &high - carried(piece) * &low;
        *k += stretch.tr_mul(&(stiff * &stretch));
        *m += low.tr_mul(&(&lump * &low)) + high.tr_mul(&(&lump * &high));
    }
}

/// ω² of the lowest modes of pinion and shaft in one finite element model, held at both ends.
fn modes_of_one_body(case: &Case, body: &GearBody) -> Vec<f64> {
    let (whole, ends) = with_stubs(case, body);
    let fixed: Vec<usize> = (ends.iter().flatten())
        .flat_map(|&n| [3 * n, 3 * n + 1, 3 * n + 2])
        .collect();
    let dofs = DofMap::with_fixed_dofs(whole.node_count(), &fixed).unwrap();
    let k = assemble_stiffness(&whole, &dofs).unwrap();
    let m = assemble_mass(&whole, &dofs, DENSITY).unwrap();
    let factor = Factor::of_model(&whole, &dofs, &k).unwrap();
    let settings = ModeSettings {
        wanted: WantedModes::Lowest(6),
        ..ModeSettings::new(1)
    };
    natural_modes(&k, &m, &factor, &settings)
        .unwrap()
        .omega_squared
}

/// Frequencies between beams that are clamped at their other ends against one finite element model of pinion and shaft.
#[test]
fn its_natural_frequencies_between_beams_are_those_of_one_body() {
    // The thickest one's model has many times their unknowns.
    for case in &CASES[..2] {
        let coarse = [0.8 * case.module_mm, 0.4 * case.module_mm, 6.0, 6.0];
        let gear = case.gear(coarse, MORE);
        let options = ReductionOptions {
            estimate_error: false,
        };
        let python = PythonEnvironment::find().unwrap();
        let (model, body) = reduce(&gear, &python, options, &Silent).unwrap();

        // Recorded: so many unknowns take some 20 s. Modes of a body in one piece are solved each time in
        // crates/reduction/tests/verification/natural_modes.rs.
        let [back_m, front_m] = case.stub_m;
        let from = format!(
            "stubs of {back_m} and {front_m} m, {}",
            case.gear(coarse, "").source
        );
        let name = format!("pinion_and_shaft_modes_of_{}_mm", case.shaft_mm[0]);
        let expected = computed::numbers(&name, &from, || modes_of_one_body(case, &body));

        let natural = 12;
        let on_faces = GearOnFaces::new(&model, natural).unwrap();
        let basis = on_faces.model.modes.as_ref().unwrap();
        let own = 12 + natural;
        let pieces = 20;
        let size = own + 2 * 6 * (pieces - 1);
        let (mut k, mut m) = (DMatrix::zeros(size, size), DMatrix::zeros(size, size));
        let rigid = on_faces.model.rigid_body.as_ref().unwrap();
        let inertia = Matrix3::from_fn(|i, j| rigid.inertia_kg_m2[i][j]);
        let c = Vector3::from(rigid.centre_m).cross_matrix();
        for axis in 0..3 {
            m[(axis, axis)] = rigid.mass_kg;
        }
        m.view_mut((0, 3), (3, 3)).copy_from(&(-rigid.mass_kg * c));
        m.view_mut((3, 0), (3, 3)).copy_from(&(rigid.mass_kg * c));
        m.view_mut((3, 3), (3, 3)).copy_from(&inertia);
        let coupling = DMatrix::from_row_slice(6 + natural, 6, &basis.coupling);
        m.view_mut((6, 0), (6 + natural, 6)).copy_from(&coupling);
        m.view_mut((0, 6), (6, 6 + natural))
            .copy_from(&coupling.transpose());
        for mode in 0..6 + natural {
            k[(6 + mode, 6 + mode)] = basis.omega_squared[mode];
            m[(6 + mode, 6 + mode)] = 1.0;
        }
        let [back, mut front] = [-0.5, 0.5].map(|share| {
            let mut frame = DMatrix::zeros(6, size);
            frame
                .view_mut((0, 0), (6, 6))
                .copy_from(&carried(share * WIDTH_M));
            frame
        });
        front
            .view_mut((0, 6), (6, 6 + natural))
            .copy_from(&on_faces.front);
        let [of_back, of_front] = [0, 1].map(|face| (case.radius_m(face), case.stub_m[face]));
        add_beam((&mut k, &mut m), own, [None, Some(&back)], of_back, pieces);
        let second = own + 6 * (pieces - 1);
        add_beam(
            (&mut k, &mut m),
            second,
            [Some(&front), None],
            of_front,
            pieces,
        );

        let lower = m.cholesky().unwrap().unpack();
        let half = lower.solve_lower_triangular(&k).unwrap();
        let reduced = lower.solve_lower_triangular(&half.transpose()).unwrap();
        let mut found = (0.5 * (&reduced + reduced.transpose())).symmetric_eigenvalues();
        found.as_mut_slice().sort_by(f64::total_cmp);
        for mode in 0..6 {
            let hz = |omega_squared: f64| omega_squared.sqrt() / TAU;
            let (found, expected) = (hz(found[mode]), hz(expected[mode]));
            let off = found / expected - 1.0;
            println!(
                "{:?} mm: {expected:.0} Hz, {:+.2} %",
                case.shaft_mm,
                1e2 * off
            );
            assert!(off.abs() < 0.02, "{found} {expected}");
        }
    }
}
