//! Andrews' squeezing mechanism: reference solution, order of convergence, objectivity, redundant joints.

use std::ops::ControlFlow;

use gearmesh_dynamics::{Params, Simulation};
use nalgebra::{UnitQuaternion, Vector3};

use crate::mechanisms::problems::andrews;

fn params(steps: usize, rho_infinity: f64) -> Params {
    Params {
        rho_infinity,
        ..Params::fixed(andrews::END_S / steps as f64)
    }
}

fn simulate(steps: usize, rho_infinity: f64) -> Simulation {
    simulate_with(params(steps, rho_infinity))
}

fn simulate_with(params: Params) -> Simulation {
    let system = andrews::mechanism(UnitQuaternion::identity(), Vector3::zeros());
    let mut simulation = Simulation::new(system, params).unwrap();
    simulation
        .run(andrews::END_S, |_| ControlFlow::Continue(()))
        .unwrap();
    assert!((simulation.state().time_s - andrews::END_S).abs() < 1e-12);
    simulation
}

/// Largest errors of angles, rates and forces against the reference solution.
fn errors(simulation: &Simulation) -> [f64; 3] {
    let flat = UnitQuaternion::identity();
    let (angles, rates) = andrews::angles(simulation, &flat, &andrews::ANGLES);
    let forces = andrews::forces(simulation, &flat);
    let most = |found: &[f64], reference: &[f64]| {
        let pairs = found.iter().zip(reference);
        pairs
            .map(|(a, b)| (a.abs() - b.abs()).abs())
            .fold(0.0, f64::max)
    };
    [
        most(&angles, &andrews::ANGLES),
        most(&rates, &andrews::RATES),
        most(&forces, &andrews::FORCES),
    ]
}

/// With the defaults; what Newton's iteration adds is less than a tenth of the error.
#[test]
fn angles_rates_and_reactions_converge_with_the_second_order() {
    for (rho_infinity, coarsest) in [(0.8, 1500), (0.3, 3000)] {
        let found = [coarsest, 2 * coarsest, 4 * coarsest].map(|steps| {
            let found = errors(&simulate(steps, rho_infinity));
            let iterated = errors(&simulate_with(Params {
                newton_tolerance: Some(1e-13),
                ..params(steps, rho_infinity)
            }));
            for (error, iterated) in found.iter().zip(iterated) {
                assert!(
                    (error / iterated - 1.0).abs() < 0.1,
                    "{found:?} {iterated:?}"
                );
            }
            found
        });
        for pair in found.windows(2) {
            for (what, (coarse, fine)) in ["angles", "rates", "reactions"]
                .iter()
                .zip(pair[0].into_iter().zip(pair[1]))
            {
                let order = (coarse / fine).log2();
                assert!(
                    (order - 2.0).abs() < 0.1,
                    "{what}, rho {rho_infinity}: order {order}"
                );
            }
        }
    }
}

#[test]
fn the_reference_solution_is_met_to_1e_6() {
    let simulation = simulate(36_000, 0.8);
    let [angles, rates, forces] = errors(&simulation);
    assert!(angles < 1e-6, "{angles} rad");
    // Rates reach 1424 rad/s, reactions 200 N.
    assert!(rates < 1e-6 * 1424.0, "{rates} rad/s");
    // Rounding of the joint equations over βh² adds to the reactions: 1e-14 rad / (βh²) times 1e-5 kg m² over an arm
    // of 0.03 m is 2e-5 N and some such meet in a joint; without it the second order would leave 1.3e-4 N.
    assert!(forces < 2e-6 * 200.0, "{forces} N");
    let info = simulation.info();
    assert!(info.largest_violation < 1e-12, "{info:?}");
    // Of the second order in the step: 3.6e-4 at 1500 steps.
    assert!(info.largest_violation_rate < 1e-6, "{info:?}");
    // The matrix is kept over many steps, while the crank turns by a tenth of a radian or so.
    assert!(info.factorisations < info.steps / 20, "{info:?}");
}

#[test]
fn three_loops_have_nine_redundant_equations() {
    let system = andrews::mechanism(UnitQuaternion::identity(), Vector3::zeros());
    assert_eq!(system.mobility(), 1);
    let redundant: usize = system.redundant().iter().map(|r| r.equations).sum();
    assert_eq!(redundant, 9);
    // The joints that close the loops last are the ones with equations too many.
    assert!(
        system.redundant().iter().all(|r| !r.implied_by.is_empty()),
        "{:?}",
        system.redundant()
    );
}

#[test]
fn a_turned_and_moved_mechanism_moves_alike() {
    // To rounding: what the iteration leaves depends on the axes.
    let exact = Params {
        newton_tolerance: Some(1e-12),
        ..params(400, 0.8)
    };
    let flat = simulate_with(exact);
    let (straight, _) = andrews::angles(&flat, &UnitQuaternion::identity(), &andrews::ANGLES);
    // 90 degrees about y: where Cardan angles have their singularity.
    let upright = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), std::f64::consts::FRAC_PI_2);
    let system = andrews::mechanism(upright, Vector3::new(0.3, -0.2, 0.1));
    let mut simulation = Simulation::new(system, exact).unwrap();
    simulation
        .run(andrews::END_S, |_| ControlFlow::Continue(()))
        .unwrap();
    let (turned, _) = andrews::angles(&simulation, &upright, &andrews::ANGLES);
    for (a, b) in straight.iter().zip(&turned) {
        assert!((a - b).abs() < 1e-8, "{straight:?} {turned:?}");
    }
}

#[test]
fn a_step_that_is_far_too_large_is_refused_with_advice() {
    let system = andrews::mechanism(UnitQuaternion::identity(), Vector3::zeros());
    let run = Simulation::new(system, Params::fixed(5e-3))
        .and_then(|mut simulation| simulation.run(andrews::END_S, |_| ControlFlow::Continue(())));
    let message = run.unwrap_err().to_string();
    assert!(
        message.contains("step of 5.000e-3 s")
            && message.contains("adaptive")
            && message.contains("body `K"),
        "{message}"
    );
}

#[test]
fn adaptive_steps_find_the_solution_too() {
    let system = andrews::mechanism(UnitQuaternion::identity(), Vector3::zeros());
    let mut simulation = Simulation::new(system, Params::adaptive(1e-3, 1e-9, 1e-8)).unwrap();
    simulation
        .run(andrews::END_S, |_| ControlFlow::Continue(()))
        .unwrap();
    let info = simulation.info();
    assert!(info.energy.largest_error_j < 1e-3, "{info:?}");
}
