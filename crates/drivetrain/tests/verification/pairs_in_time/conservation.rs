//! What must not change: energy without damping, and what is seen when the scene is turned as a whole.

use std::ops::ControlFlow;

use gearmesh_drivetrain::*;
use gearmesh_dynamics::{Params, Simulation, TimeFunction};
use gearmesh_geometry::{Flank, GearPair};
use nalgebra::{UnitQuaternion, Vector3};

use crate::mesh_common::*;
use crate::pairs_in_time::scene::*;

/// Largest error of the energy balance \[J\] of a frictionless undamped `hybrid` pair at a full load with a step, up to
/// an end; root mean square over as many runs that begin differently.
pub fn energy_error_j(
    pair: &GearPair,
    ends: PathEnds,
    (step_s, end_s): (f64, f64),
    runs: usize,
) -> f64 {
    let torque = 200.0;
    let [r1, r2] = [&pair.gear_1, &pair.gear_2].map(|g| g.base_radius_m);
    let squares = (0..runs).map(|k| {
        let k = k as f64;
        let scene = Scene {
            te_m: -4e-6 - 0.3e-6 * k,
            speed_rad_per_s: 60.0 + 0.37 * k,
            torque_1: Some(TimeFunction::Constant(torque * r1 / r2)),
            ..Scene::new(pair).loaded_by(torque)
        };
        let kinematics = kinematics_with(pair, [Vec::new(), Vec::new()], ends);
        let mesh = mesh("hybrid", pair, kinematics);
        let params = Params {
            rho_infinity: 1.0,
            newton_tolerance: Some(1e-12),
            ..Params::fixed(step_s)
        };
        let mut run = Simulation::new(scene.system(mesh), params).unwrap();
        run.run(end_s, |_| ControlFlow::Continue(())).unwrap();
        run.info().energy.largest_error_j.powi(2)
    });
    (squares.sum::<f64>() / runs as f64).sqrt()
}

/// Unmodified teeth at a full load, nothing damped: pairs come and go at tip edges, where the force has a kink, and the
/// compliance has kinks at the roll stations. A kink within a step costs the balance h² times the change of slope times
/// a factor that depends on where in the step it falls, so that the largest error of one run is a matter of luck, up or
/// down by two; the root mean square over runs that begin differently falls with h². On the rigid path a pair's elastic
/// energy is lost with its jump, whatever the step.
#[test]
fn energy_of_a_hybrid_pair_at_full_load() {
    let pair = spur_pair();
    let error = |ends: PathEnds, step_s: f64| energy_error_j(&pair, ends, (step_s, 7e-3), 3);
    let errors = [8e-6, 4e-6, 1e-6].map(|step_s| error(PathEnds::Extended, step_s));
    let order = (errors[0] / errors[2]).log2() / 3.0;
    println!("{errors:?} {order}");
    // Of 20 mJ in the teeth. Seen: 4.9e-5, 1.2e-5 and 1.2e-6 J, and 2.1e-7 J at 0.5 µs: order 1.8 to here, 2.0 to
    // there.
    assert!(
        (1.5..2.5).contains(&order) && errors[1] < 0.4 * errors[0],
        "{errors:?}"
    );
    assert!(errors[2] < 2.5e-6, "{errors:?}");
    let lost = error(PathEnds::LineOfAction, 4e-6);
    println!("{lost}");
    assert!((5e-3..50e-3).contains(&lost), "{lost}");
}

/// With damping proportional to stiffness the balance closes to what the stiffness changes within τ ġ, where a pair
/// begins to carry: the same at any step. Seen: 3.6e-6 and 3.4e-6 J at 0.25 and 0.125 µs of 3.1 mJ of heat; 1.25e-5 J
/// at both where the stored energy is that of the felt gaps to first order.
#[test]
fn energy_of_a_damped_hybrid_pair_at_full_load() {
    let pair = spur_pair();
    let torque = 200.0;
    let [r1, r2] = [&pair.gear_1, &pair.gear_2].map(|g| g.base_radius_m);
    let scene = Scene {
        te_m: -4e-6,
        speed_rad_per_s: 60.0,
        torque_1: Some(TimeFunction::Constant(torque * r1 / r2)),
        ..Scene::new(&pair).loaded_by(torque)
    };
    let damping = Damping::StiffnessProportional {
        time_s: 2e-6,
        full_depth_m: 1e-6,
    };
    let of = |side| Damped::new(model("hybrid", &pair, side), damping, SLICES).unwrap();
    let mesh = GearMesh::new(kinematics(&pair), Flank::Right, of(Flank::Right))
        .unwrap()
        .with_side(Flank::Left, of(Flank::Left))
        .unwrap();
    let params = Params {
        rho_infinity: 1.0,
        newton_tolerance: Some(1e-12),
        ..Params::fixed(0.5e-6)
    };
    let mut run = Simulation::new(scene.system(mesh), params).unwrap();
    run.run(3e-3, |_| ControlFlow::Continue(())).unwrap();
    let energy = run.info().energy;
    assert!(energy.dissipated_j > 2e-3, "{energy:?}");
    let off = energy.largest_error_j / energy.dissipated_j;
    assert!(off < 1.8e-3, "{off:e} {energy:?}");
}

/// The scene turned by 90° about its second Cardan angle, turned at random and moved: the same run, to rounding.
#[test]
fn the_scene_may_stand_anywhere() {
    let pair = spur_pair();
    let quarter = UnitQuaternion::from_euler_angles(0.0, 0.5 * std::f64::consts::PI, 0.0);
    let askew = UnitQuaternion::from_scaled_axis(Vector3::new(0.7, -1.9, 1.1));
    for name in MODELS {
        let run = |turned: UnitQuaternion<f64>, moved_m: Vector3<f64>| {
            let scene = Scene {
                te_m: -5e-6,
                turned,
                moved_m,
                tilt: Vector3::new(2e-4, -1e-4, 0.0),
                ..Scene::new(&pair).driven_at(60.0).loaded_by(60.0)
            };
            let friction = Friction::new([0.1, 0.05], [1e-2, 1e-1]).unwrap();
            let mesh = mesh(name, &pair, kinematics(&pair)).with_friction(friction);
            record(scene.system(mesh), Params::fixed(4e-6), 4e-3).0
        };
        let still = run(UnitQuaternion::identity(), Vector3::zeros());
        for (turned, moved) in [
            (quarter, Vector3::zeros()),
            (askew, Vector3::new(0.1, -0.2, 0.3)),
        ] {
            let other = run(turned, moved);
            let (mut te, mut force) = (0.0_f64, 0.0_f64);
            for (a, b) in still.iter().zip(&other) {
                te = te.max((a.te_m - b.te_m).abs());
                force = force.max((a.right_n - b.right_n).abs());
            }
            println!("{name} {te:e} {force:e}");
            assert_eq!(still.len(), other.len());
            // Of 5 µm and 1 kN. Seen: 1e-14 m and 6e-6 N turned, 3e-12 m and 1e-3 N moved by 0.4 m, too.
            assert!(te < 2e-11 && force < 1e-2, "{name} {te:e} {force:e}");
        }
    }
}
