//! Loads on vibrating gears and their tangents.

use gearmesh_contact::LocalContact;
use gearmesh_drivetrain::pose::Vector6;
use gearmesh_drivetrain::*;
use gearmesh_geometry::{Flank, GearPair};
use nalgebra::{DMatrix, DVector, SMatrix, Vector3};

use crate::mesh_common::*;
use crate::modal_bodies::vibrating_pair::*;

#[test]
fn loads_on_modes_follow_from_the_energy() {
    for pair in pairs() {
        let models = models(&pair);
        let mut mesh = hybrid(&pair, &models, [COUNT, COUNT], kinematics(&pair));
        for at in loaded_poses(&pair) {
            check_energy(&mut mesh, &at);
        }
    }
}

/// Loads on bodies and modes, both gears with all modes, are minus the slopes of the energy beside the equilibrium of
/// the modes.
pub fn check_energy(mesh: &mut GearMesh, at: &Pose) {
    let (mut eta, _) = at_rest(mesh, at, [COUNT, COUNT]);
    for (i, eta) in eta.iter_mut().enumerate() {
        *eta += 2e-6 * (i as f64).sin();
    }
    let mut energy = |at: &Pose, eta: &[f64]| {
        let motion = ModalMotion {
            coordinates: [&eta[..COUNT], &eta[COUNT..]],
            ..ModalMotion::default()
        };
        let load = mesh.evaluate_modal(at, &motion, false).unwrap();
        (
            load.power.stored_j,
            load.load,
            mesh.modal_loads().force.clone(),
        )
    };
    let (_, load, force) = energy(at, &eta);
    let scale = load.fixed_rows::<3>(0).norm();
    for (i, force) in force.iter().enumerate() {
        let h = 3e-9;
        let mut moved = eta.clone();
        moved[i] += h;
        let after = energy(at, &moved).0;
        moved[i] -= 2.0 * h;
        let slope = (after - energy(at, &moved).0) / (2.0 * h);
        let off = (slope + force).abs() / (0.3 * scale);
        assert!(off < 3e-6, "mode {i}: {off:e}");
    }
    for direction in 0..6 {
        let h = if direction < 3 { 1e-9 } else { 2e-8 };
        let mut step = Vector6::zeros();
        step[direction] = h;
        let after = energy(&moved(at, &step), &eta).0;
        let slope = (after - energy(&moved(at, &-step), &eta).0) / (2.0 * h);
        let unit = if direction < 3 { 1.0 } else { 0.05 };
        let off = (slope + load[direction]).abs() / (scale * unit);
        assert!(off < 3e-6, "direction {direction}: {off:e}");
    }
}

/// Tangents by place and speed of bodies and modes against central differences, with damping, without friction and with
/// it.
#[test]
fn modal_tangents_agree_with_differences() {
    for pair in pairs() {
        tangents_agree_with_differences(&pair, None, 3e-3);
        // Transitions as wide as the sliding of the test's speeds.
        let friction = Friction::new([0.12, 0.07], [2e-3, 2e-2]).unwrap();
        tangents_agree_with_differences(&pair, Some(friction), 5e-3);
    }
}

fn tangents_agree_with_differences(pair: &GearPair, friction: Option<Friction>, tolerance: f64) {
    let models = models(pair);
    let damping = Damping::StiffnessProportional {
        time_s: 5e-6,
        full_depth_m: 1e-6,
    };
    let local = LocalContact::WeberBanaschek;
    for side in [Flank::Right, Flank::Left] {
        let of = |side| {
            let teeth =
                ReducedTeeth::new(pair, side, [&models[0], &models[1]], local, 4000.0).unwrap();
            Damped::new(teeth, damping, SLICES).unwrap()
        };
        let mut mesh = GearMesh::new(kinematics(pair), side, of(side))
            .unwrap()
            .with_modes(1, &models[0], COUNT)
            .unwrap()
            .with_modes(2, &models[1], COUNT)
            .unwrap();
        if let Some(friction) = friction {
            mesh = mesh.with_friction(friction);
        }
        let phi = angles(pair, side, 0.11, -14e-6);
        let at = pose(
            pair,
            phi,
            Vector3::new(2e-6, 0.0, 0.0),
            Vector3::new(1e-4, 0.0, 0.0),
        );
        check_tangents(
            (&format!("{friction:?} {side:?}"), tolerance),
            &mut mesh,
            &at,
        );
    }
}

/// Tangents by all coordinates of bodies and modes, both gears with all modes.
pub fn check_tangents((what, tolerance): (&str, f64), mesh: &mut GearMesh, at: &Pose) {
    let (eta, _) = at_rest(mesh, at, [COUNT, COUNT]);
    let n = 6 + 2 * COUNT;
    // Force on (pose, modes) at a change of place and of speed.
    let mut force = |place: &DVector<f64>, speed: &DVector<f64>, tangents: bool| {
        let six = |v: &DVector<f64>| Vector6::from_fn(|i, _| v[i]);
        let moved = moving(&moved(at, &six(place)), &six(speed));
        let eta: Vec<f64> = (0..2 * COUNT).map(|i| eta[i] + place[6 + i]).collect();
        let rate: Vec<f64> = (0..2 * COUNT).map(|i| speed[6 + i]).collect();
        let motion = ModalMotion {
            coordinates: [&eta[..COUNT], &eta[COUNT..]],
            rates: [&rate[..COUNT], &rate[COUNT..]],
        };
        let load = mesh.evaluate_modal(&moved, &motion, tangents).unwrap();
        let modal = mesh.modal_loads();
        let value = DVector::from_fn(n, |i, _| match i {
            0..6 => load.load[i],
            _ => modal.force[i - 6],
        });
        let m = 2 * COUNT;
        let tangent =
            |pose: &SMatrix<f64, 6, 6>, rows: &[Vector6], columns: &[Vector6], own: &[f64]| {
                DMatrix::from_fn(n, n, |i, j| match (i < 6, j < 6) {
                    (true, true) => pose[(i, j)],
                    (false, true) => rows[i - 6][j],
                    (true, false) => columns[j - 6][i],
                    (false, false) => own[(i - 6) * m + j - 6],
                })
            };
        let by_place = tangent(
            &load.by_position,
            &modal.force_by_pose,
            &modal.load_by_coordinates,
            &modal.by_coordinates,
        );
        let by_speed = tangent(
            &load.by_velocity,
            &modal.force_by_rates,
            &modal.load_by_rates,
            &modal.by_rates,
        );
        (value, by_place, by_speed)
    };
    let zero = DVector::zeros(n);
    let speed = DVector::from_fn(n, |i, _| 0.01 * (1.0 + 3.0 * i as f64).sin());
    let (_, by_place, by_speed) = force(&zero, &speed, true);
    for dof in 0..n {
        for (velocity, whole) in [(false, &by_place), (true, &by_speed)] {
            let h = match (velocity, dof) {
                (true, _) => 1e-6,
                (false, 3..6) => 2e-9,
                _ => 2e-10,
            };
            let mut at = |by: f64| {
                let (mut place, mut speed) = (zero.clone(), speed.clone());
                if velocity {
                    speed[dof] += by;
                } else {
                    place[dof] += by;
                }
                force(&place, &speed, false).0
            };
            let difference = (at(h) - at(-h)) / (2.0 * h);
            // Rows of forces, moments and modes have their own scale.
            for rows in [0..3, 3..6, 6..n] {
                let (first, count) = (rows.start, rows.len());
                let column = whole.column(dof);
                let off = (difference.rows(first, count) - column.rows(first, count)).norm();
                let beside = if dof < 6 {
                    3 * (dof / 3)..3 * (dof / 3) + 3
                } else {
                    6..n
                };
                let scale = whole
                    .view((first, beside.start), (count, beside.len()))
                    .norm();
                assert!(
                    off < tolerance * scale,
                    "{what} dof {dof} rows {first} {velocity}: {off:e} of {scale:e}"
                );
            }
        }
    }
}
