//! Andrews' squeezing mechanism: reference solution, order of convergence, objectivity, redundant joints.
#![allow(clippy::unwrap_used)] // test code

mod problems {
    pub mod andrews;
}

use std::ops::ControlFlow;

use gearmesh_dynamics::{Params, Simulation};
use nalgebra::{UnitQuaternion, Vector3};
use problems::andrews;

fn simulate(steps: usize, orientation: UnitQuaternion<f64>, origin: Vector3<f64>) -> Simulation {
    let params = Params {
        rho_infinity: 0.8,
        ..Params::fixed(andrews::END_S / steps as f64)
    };
    let mut simulation = Simulation::new(andrews::mechanism(orientation, origin), params).unwrap();
    simulation.run(andrews::END_S, |_| ControlFlow::Continue(())).unwrap();
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
        pairs.map(|(a, b)| (a.abs() - b.abs()).abs()).fold(0.0, f64::max)
    };
    [
        most(&angles, &andrews::ANGLES),
        most(&rates, &andrews::RATES),
        most(&forces, &andrews::FORCES),
    ]
}

#[test]
fn angles_rates_and_reactions_converge_with_the_second_order() {
    for steps in [1500, 3000, 6000, 12000] {
        let clock = std::time::Instant::now();
        let simulation = simulate(steps, UnitQuaternion::identity(), Vector3::zeros());
        let info = simulation.info();
        eprintln!("{steps} {:?} {:?} {info:?}", errors(&simulation), clock.elapsed());
    }
}
