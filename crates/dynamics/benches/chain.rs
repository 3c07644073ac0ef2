//! Time of a step of a chain over its number of links, dense and sparse; one line of JSON for each. `cargo xtask bench
//! chain` sets it beside Exudyn.
//!
//! `cargo bench --workspace --bench chain --profile dev`
#![allow(clippy::unwrap_used, clippy::print_stdout)] // bench code

#[path = "../tests/problems/chain.rs"]
mod chain;

use std::time::Instant;

use gearmesh_dynamics::{LinearSolver, Params, Simulation};

/// Links, and whether the dense solver is measured, too.
const SIZES: [(usize, bool); 9] = [
    (2, true),
    (4, true),
    (8, true),
    (12, true),
    (20, true),
    (80, true),
    (160, true),
    (500, false),
    (2000, false),
];

/// Steps of 1 ms from the release: the same part of the motion for every length and program.
const STEPS: usize = 50;

fn main() {
    for (links, with_dense) in SIZES {
        let solvers = [
            ("dense", LinearSolver::Dense),
            ("sparse", LinearSolver::Sparse),
        ];
        for (name, linear_solver) in &solvers[usize::from(!with_dense)..] {
            measure(links, name, *linear_solver);
        }
    }
}

fn measure(links: usize, name: &str, linear_solver: LinearSolver) {
    let params = Params {
        linear_solver,
        ..Params::fixed(1e-3)
    };
    // Several runs: the fastest says most on a busy machine.
    let runs = (2000 / links).clamp(3, 30);
    let (mut least, mut last) = (f64::INFINITY, None);
    for _ in 0..runs {
        let mut simulation = Simulation::new(chain::system(links), params).unwrap();
        let clock = Instant::now();
        for _ in 0..STEPS {
            simulation.step().unwrap();
        }
        least = least.min(clock.elapsed().as_secs_f64());
        last = Some(simulation);
    }
    let last = last.unwrap();
    let (info, x) = (last.info(), last.state().positions_m[links - 1]);
    println!(
        "{{\"links\": {links}, \"solver\": \"{name}\", \"step_ms\": {}, \"iterations\": {}, \"factorisations\": {}, \"last_body_m\": [{}, {}]}}",
        1e3 * least / STEPS as f64,
        info.iterations,
        info.factorisations,
        x.x,
        x.y,
    );
}
