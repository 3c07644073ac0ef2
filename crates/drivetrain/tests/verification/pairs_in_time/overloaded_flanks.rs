//! Loads that would push teeth through each other: refused, with the flank that is missing or too soft.

use std::ops::ControlFlow;

use gearmesh_drivetrain::*;
use gearmesh_dynamics::{Params, Simulation};
use gearmesh_geometry::Flank;

use crate::mesh_common::*;
use crate::pairs_in_time::hard_cases::{backlash_m, damped_mesh};
use crate::pairs_in_time::scene::*;

/// A load of the other sign on teeth that have flanks on one side only: they would pass through those of the mate, half
/// a base pitch deep, and the mesh would push out of nothing. The run ends before, with the side and the sign that it
/// can carry. With both sides the left flanks carry.
#[test]
fn teeth_do_not_pass_through_each_other_where_flanks_are_left_out() {
    let pair = spur_pair();
    let depth = 0.02 * std::f64::consts::TAU * pair.gear_1.base_radius_m / 30.0;
    for (side, torque, words) in [
        (
            Flank::Right,
            -30.0,
            ["left flanks", "clockwise (torques negative"],
        ),
        (
            Flank::Left,
            30.0,
            ["right flanks", "counter-clockwise (torques positive"],
        ),
    ] {
        let one_sided = GearMesh::new(kinematics(&pair), side, model("hybrid", &pair, side));
        let scene = Scene::new(&pair).driven_at(0.0).loaded_by(torque);
        let mut run =
            Simulation::new(scene.system(one_sided.unwrap()), Params::fixed(5e-6)).unwrap();
        let mut energy = 0.0f64;
        let ended = run.run(0.1, |step| {
            energy = energy.max(step.info.energy.last.kinetic_j);
            ControlFlow::Continue(())
        });
        let message = ended.unwrap_err().to_string();
        for word in words.iter().chain(&["`mesh`", "which the mesh leaves out"]) {
            assert!(message.contains(word), "`{word}` is not in {message}");
        }
        // No more than the load's own work over what is allowed, and over the backlash where it starts on the other
        // side of it.
        let free = [0.0, backlash_m(&pair)][usize::from(side == Flank::Right)];
        let way = free + 1.05 * depth;
        let work = torque.abs() * way / pair.gear_2.base_radius_m;
        assert!(energy > 0.5 * work && energy < work, "{energy} of {work}");
        // Flanks on both sides stop at the backlash and bounce.
        let both = damped_mesh("hybrid", &pair, 2e-6);
        let (samples, _) = record(scene.system(both), Params::fixed(5e-6), 0.02);
        let most = samples.iter().map(|s| s.te_m.abs()).fold(0.0, f64::max);
        assert!(most < backlash_m(&pair) + 50e-6, "{most}");
    }
}

/// Flanks that are pressed into each other deeper than any tooth deflects end the run, too.
#[test]
fn teeth_are_not_pressed_through_each_other() {
    let pair = spur_pair();
    let law = Impact::new(
        PowerStiffness::n_per_mm_e(10.0, 1.0).unwrap(),
        0.0,
        1e-6,
        SLICES,
    );
    let mesh = GearMesh::new(kinematics(&pair), Flank::Right, law.unwrap()).unwrap();
    let system = Scene::new(&pair)
        .driven_at(0.0)
        .loaded_by(1000.0)
        .system(mesh);
    let ended = Simulation::new(system, Params::fixed(1e-5))
        .unwrap()
        .run(0.1, |_| ControlFlow::Continue(()));
    let message = ended.unwrap_err().to_string();
    for word in ["right flanks", "a tenth of the base pitch", "`mesh`"] {
        assert!(message.contains(word), "`{word}` is not in {message}");
    }
}
