//! Runs of very many steps: what drifts, what grows.

use std::f64::consts::TAU;

use gearmesh_drivetrain::*;
use gearmesh_dynamics::{Params, Simulation};
use gearmesh_geometry::Flank;

use crate::counting_allocator::allocations;
use crate::mesh_common::*;
use crate::scene::{Scene, pose_of};

const STEP_S: f64 = 1e-5;
/// Steps of a mesh period, and the periods of a tenth of the shorter run.
const PERIOD: u64 = 250;
const TENTH: u64 = 40;

/// What a tenth of a run shows.
#[derive(Debug, Clone, Copy)]
struct Tenth {
    /// Transmission error at its end, always at the same place of a mesh period \[m\].
    te_m: f64,
    /// Newton iterations a step.
    iterations: f64,
    /// Error of the energy balance so far over the work done so far.
    energy: f64,
}

/// An `impact` pair, both sides of the teeth, turns under 60 N m, the output free to turn. The clock is the number of
/// steps times their length to the last digit, gear 1 has turned by its speed times that time, a mesh period late in
/// the run is like one early in it, steps take no more iterations, the error of the energy balance stays the same
/// small part of the work, and nothing is allocated, so that memory is steady.
fn long_run(steps: u64) {
    let pair = spur_pair();
    let speed = TAU / 30.0 / (PERIOD as f64 * STEP_S);
    let scene = Scene {
        te_m: -4e-6,
        ..Scene::new(&pair).driven_at(speed).loaded_by(60.0)
    };
    let mesh = || {
        GearMesh::new(kinematics(&pair), Flank::Right, impact())
            .unwrap()
            .with_side(Flank::Left, impact())
            .unwrap()
    };
    let mut run = Simulation::new(scene.system(mesh()), Params::fixed(STEP_S)).unwrap();
    // The second joint drives gear 1.
    let driven_rad = |run: &Simulation| run.system().joints()[1].angle_rad();
    let start_rad = driven_rad(&run);
    let mut alone = mesh();
    let mut te_m = |run: &Simulation| {
        alone.evaluate(&pose_of(run.state()), false).unwrap();
        alone.transmission_error_m().unwrap()
    };
    let mut tenths = Vec::with_capacity(10);
    let mut allocated = 0;
    for tenth in 1..=10 {
        let (before, iterations) = (allocations(), run.info().iterations);
        for _ in 0..steps / 10 {
            run.step().unwrap();
        }
        if tenth > 1 {
            allocated += allocations() - before;
        }
        let info = run.info();
        let energy = info.energy;
        tenths.push(Tenth {
            te_m: te_m(&run),
            iterations: (info.iterations - iterations) as f64 / (steps / 10) as f64,
            energy: energy.error_j() / energy.work_j,
        });
    }
    let (info, time_s) = (run.info(), run.state().time_s);
    assert_eq!(info.steps, steps);
    let exact_s = steps as f64 * STEP_S;
    let turned = (driven_rad(&run) - start_rad).abs();
    let apart_rad = turned - speed * exact_s;
    let (first, last) = (tenths[1], tenths[9]);
    println!(
        "{steps} steps, {:.1} turns: clock off by {:.1e} s, turns by {apart_rad:.1e} rad, te {:.9e} and {:.9e} m, {:.4} and {:.4} iterations, energy {:.1e} and \
         {:.1e} of the work, joints {:.1e}, {allocated} allocations",
        turned / TAU,
        time_s - exact_s,
        first.te_m,
        last.te_m,
        first.iterations,
        last.iterations,
        first.energy,
        last.energy,
        info.largest_violation,
    );
    assert!(
        (time_s - exact_s).abs() <= f64::EPSILON * exact_s,
        "{time_s}"
    );
    assert_eq!(allocated, 0);
    // What Newton's iteration leaves of the joints, here 1e-8 rad or half a nanometre at most, does not add up: the
    // last step's is all that the angle is off by.
    assert!(apart_rad.abs() < 1e-8, "{apart_rad:e}");
    assert!(info.largest_violation < 1e-8, "{info:?}");
    let te_off = (last.te_m / first.te_m - 1.0).abs();
    assert!(te_off < 1e-6, "{te_off:e}");
    assert!(last.iterations < 1.02 * first.iterations);
    assert!(last.energy.abs() < 1e-4 && last.energy.abs() < 1.2 * first.energy.abs().max(1e-9));
}

/// A hundred thousand steps of a pair that turns: clock, turns, energy and effort do not drift, nothing is allocated.
#[test]
fn a_hundred_thousand_steps() {
    long_run(10 * TENTH * PERIOD);
}

/// Ten million steps of the same pair.
#[test]
#[ignore = "minutes: ten million steps"]
fn ten_million_steps() {
    long_run(1000 * TENTH * PERIOD);
}
