//! A pair at 600 rpm, both gears with six degrees of freedom: time of a step against real time, fastest and middle mesh period of many.
//!
//! `cargo bench -p gearmesh-drivetrain --bench step --profile dev`; on a busy machine only the fastest period says something.
#![allow(clippy::unwrap_used, clippy::print_stdout, missing_docs)]

#[path = "../tests/mesh_common/mod.rs"]
mod mesh_common;

use std::time::Instant;

use gearmesh_dynamics::Simulation;
use mesh_common::running_pair::*;

const PERIODS: usize = 400;

fn main() {
    println!(
        "{:10} {:>12} {:>12} {:>10} {:>12} {:>12} {:>12}",
        "mesh", "fastest µs", "middle µs", "real time", "iterations", "factors", "steps"
    );
    let only: Option<String> = std::env::args().nth(1).filter(|a| !a.starts_with('-'));
    for name in ["impact", "hybrid"] {
        if only.as_deref().is_some_and(|only| only != name) {
            continue;
        }
        let pair = pair_a();
        let system = running_pair(&pair, running_mesh(name, &pair))
            .build()
            .unwrap();
        let mut run = Simulation::new(system, params()).unwrap();
        for _ in 0..10 * STEPS_A_PERIOD {
            run.step().unwrap();
        }
        let before = *run.info();
        let mut times_us: Vec<f64> = (0..PERIODS)
            .map(|_| {
                let start = Instant::now();
                for _ in 0..STEPS_A_PERIOD {
                    run.step().unwrap();
                }
                start.elapsed().as_secs_f64() * 1e6 / STEPS_A_PERIOD as f64
            })
            .collect();
        times_us.sort_by(f64::total_cmp);
        let info = run.info();
        let steps = (info.steps - before.steps) as f64;
        println!(
            "{name:10} {:12.2} {:12.2} {:9.2}x {:12.3} {:12.4} {:12}",
            times_us[0],
            times_us[PERIODS / 2],
            STEP_S * 1e6 / times_us[0],
            (info.iterations - before.iterations) as f64 / steps,
            (info.factorisations - before.factorisations) as f64 / steps,
            steps
        );
    }
}
