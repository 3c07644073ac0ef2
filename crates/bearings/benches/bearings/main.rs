//! Time and error of bearings: balls in equilibrium and balls that move; one line of JSON for each run. `cargo xtask
//! bench bearings` makes the page of them, beside Exudyn.
//!
//! `cargo bench --workspace --bench bearings --profile dev`
#![allow(clippy::unwrap_used, clippy::print_stdout)] // bench code

mod beside;
mod evaluation;
mod machine;
mod recorded;

use gearmesh_bearings::dynamic::TriangleSize;
use machine::Machine;
use recorded::{Run, repeated, timed};

fn main() {
    evaluation::measure();
    // One bearing with its cage, 0.1 s, at steps that halve.
    for step_s in [1e-5, 5e-6, 2.5e-6] {
        let run = timed(Machine::spindle(1, None), step_s, 0.1, 1e-4);
        tell("cage", 1, step_s, &run);
    }
    // One bearing and four on one shaft.
    for bearings in [1, 4] {
        let run = repeated(3, || Machine::spindle(bearings, None), 5e-6, 0.01);
        tell("shaft", bearings, 5e-6, &run);
    }
    // Races as tori and as triangles.
    for edges_um in [
        None,
        Some([400.0, 200.0]),
        Some([200.0, 100.0]),
        Some([100.0, 50.0]),
    ] {
        let surface = edges_um.map(|[across, along]| TriangleSize {
            across_m: 1e-6 * across,
            along_m: 1e-6 * along,
        });
        let run = timed(Machine::spindle(1, surface), 5e-6, 2e-3, 1e-4);
        let [across, along] = edges_um.unwrap_or_default();
        println!(
            "{{\"case\": \"surface\", \"across_um\": {across}, \"along_um\": {along}, \"steps\": {}, \"cpu_s\": {}, \"iterations\": {}, \"inner_N\": {:?}}}",
            run.steps,
            run.cpu_s,
            run.iterations,
            run.ball_loads()
        );
    }
    beside::measure();
}

fn tell(case: &str, bearings: usize, step_s: f64, run: &Run) {
    let loads = run.ball_loads();
    let mean = loads.iter().sum::<f64>() / loads.len() as f64;
    let peak = loads.iter().copied().fold(0.0, f64::max);
    println!(
        "{{\"case\": \"{case}\", \"bearings\": {bearings}, \"step_s\": {step_s:e}, \"steps\": {}, \"wall_s\": {}, \"cpu_s\": {}, \
         \"iterations\": {}, \"factorisations\": {}, \"mean_N\": {mean}, \"peak_N\": {peak}, \"cage_rad_per_s\": {}}}",
        run.steps,
        run.wall_s,
        run.cpu_s,
        run.iterations,
        run.factorisations,
        run.cage_speed()
    );
}
