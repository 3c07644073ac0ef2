//! Time of one step.
//!
//! Run on a quiet machine: `cargo bench -p gearmesh-dynamics --profile dev`; on a busy one only the fastest column says
//! something.
#![allow(clippy::unwrap_used)] // bench code

#[path = "../tests/problems/andrews.rs"]
#[allow(dead_code)] // the reference solution is for the test
mod andrews;
#[path = "../tests/problems/two_wheels.rs"]
mod two_wheels;

use divan::Bencher;
use gearmesh_dynamics::{Params, Simulation, System};
use nalgebra::{UnitQuaternion, Vector3};
use two_wheels::Coupling;

fn main() {
    divan::main();
}

/// 50 steps a mesh period at 600 rpm with 57 teeth: 28 500 steps a second, 35 µs each in real time.
#[divan::bench(sample_size = 50)]
fn two_wheels_on_a_spring(bencher: Bencher) {
    steps(bencher, two_wheels::system(Coupling::Spring));
}

/// The same wheels at speed: one joint equation, and factors that age as they turn.
#[divan::bench(sample_size = 50)]
fn two_wheels_spinning(bencher: Bencher) {
    steps(bencher, two_wheels::system(Coupling::Ratio));
}

fn steps(bencher: Bencher, system: System) {
    let mut simulation = Simulation::new(system, Params::fixed(1.0 / 28_500.0)).unwrap();
    bencher.bench_local(|| simulation.step().unwrap());
}

/// Seven bodies, ten revolute joints with nine redundant equations.
#[divan::bench(sample_size = 10)]
fn squeezing_mechanism(bencher: Bencher) {
    let system = andrews::mechanism(UnitQuaternion::identity(), Vector3::zeros());
    let mut simulation = Simulation::new(system, Params::fixed(1e-5)).unwrap();
    bencher.bench_local(|| simulation.step().unwrap());
}
