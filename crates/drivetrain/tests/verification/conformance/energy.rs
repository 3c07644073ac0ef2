//! Loads and the energy of the teeth; what damping and friction take out of the motion.

use crate::conformance::{DAMPINGS, damped, friction, loaded_poses, rates};
use crate::mesh_common::*;
use gearmesh_drivetrain::pose::Vector6;
use gearmesh_drivetrain::*;
use gearmesh_geometry::Flank;
use nalgebra::Vector3;

/// The undamped load is minus the gradient of the energy.
#[test]
fn undamped_loads_follow_from_the_energy() {
    for pair in pairs() {
        for name in [
            "iso6336",
            "own curve",
            "analytic",
            "hybrid",
            "cracked hybrid",
            "vibrating hybrid",
        ] {
            let mut mesh = mesh(name, &pair, kinematics(&pair));
            check_energy(name, &mut mesh, &loaded_poses(&pair));
        }
    }
}

pub(crate) fn check_energy(name: &str, mesh: &mut GearMesh, poses: &[Pose]) {
    for (number, at) in poses.iter().enumerate() {
        let load = mesh.evaluate(at, false).unwrap();
        let scale = load.load.fixed_rows::<3>(0).norm();
        assert!(scale > 100.0, "{name} {number}: {scale}");
        for direction in 0..6 {
            // Small against the deflection of 10 µm.
            let h = if direction < 3 { 1e-9 } else { 2e-8 };
            let mut step = Vector6::zeros();
            step[direction] = h;
            let mut energy = |at: &Pose| mesh.evaluate(at, false).unwrap().power.stored_j;
            let slope = (energy(&moved(at, &step)) - energy(&moved(at, &-step))) / (2.0 * h);
            let unit = if direction < 3 { 1.0 } else { 0.05 };
            let off = (slope + load.load[direction]).abs() / (scale * unit);
            // 1e-10 N·m of energy to 1e-16, over steps of 1e-9 m; the solver's tolerance in the hybrid's energy.
            assert!(off < 2e-6, "{name} {number} by {direction}: {off:e}");
        }
    }
}

/// A spring stores ½ k δ² however fast it is pressed: damping moves the gap that it feels, not what it has stored.
#[test]
fn what_a_damped_spring_stores_does_not_depend_on_its_speed() {
    let pair = spur_pair();
    let damping = Damping::StiffnessProportional {
        time_s: 1e-5,
        full_depth_m: 1e-6,
    };
    let spring = MeshSpring::new(3e8, SLICES, pair.working_pressure_angle_rad.tan()).unwrap();
    let side = Damped::new(spring, damping, SLICES).unwrap();
    let mut mesh = GearMesh::new(kinematics(&pair), Flank::Right, side).unwrap();
    let depth = 10e-6;
    let phi = angles(&pair, Flank::Right, 0.05, -depth);
    let at = pose(&pair, phi, Vector3::zeros(), Vector3::zeros());
    for turn_rad_per_s in [-0.5, 0.0, 0.5] {
        let turning = Vector6::new(0.0, 0.0, 0.0, 0.0, 0.0, turn_rad_per_s);
        let power = mesh.evaluate(&moving(&at, &turning), false).unwrap().power;
        assert!(
            (power.stored_j / (0.5 * 3e8 * depth * depth) - 1.0).abs() < 1e-9,
            "{power:?}"
        );
        assert_eq!(power.dissipated_w > 0.0, turn_rad_per_s != 0.0);
    }
}

/// Damping and friction spend energy, and exactly what they take out of the motion.
#[test]
fn power_balances() {
    for pair in pairs() {
        for name in CONFORMING {
            for damping in DAMPINGS {
                for with_friction in [false, true] {
                    let mut mesh = damped(name, &pair, damping);
                    if with_friction {
                        mesh = mesh.with_friction(friction());
                    }
                    let what = (name, damping);
                    check_power(what, &mut mesh, &loaded_poses(&pair));
                }
            }
        }
    }
}

pub(crate) fn check_power((name, damping): (&str, Damping), mesh: &mut GearMesh, poses: &[Pose]) {
    for (number, at) in poses.iter().enumerate() {
        for seed in 0..5 {
            let rates = 0.2 * rates(seed);
            let load = mesh.evaluate(&moving(at, &rates), false).unwrap();
            let rest = mesh.evaluate(at, false).unwrap();
            assert!(load.power.dissipated_w >= 0.0);
            let taken = -(load.load - rest.load).dot(&rates);
            // Proportional damping is stated to first order: penetrations change by τ ġ, a percent of the deflection;
            // slices that it brings into contact or out of it add a little.
            let tolerance = match (name, damping) {
                ("impact", _) | (_, Damping::Viscous { .. }) => 1e-9,
                _ => 3e-2,
            };
            let scale = load.power.dissipated_w.max(1e-6);
            let off = (taken - load.power.dissipated_w).abs() / scale;
            assert!(
                off < tolerance,
                "{name} {damping:?} {number} {seed}: {taken} {load:?}"
            );
        }
    }
}
