//! A spiral bevel pair in slices, 20/20 teeth at 600 rpm and 50 steps a mesh period: time of a step against real time,
//! fastest and middle mesh period of many.
//!
//! `cargo bench -p gearmesh-drivetrain --bench bevel_step --profile dev`; on a busy machine only the fastest period
//! says something. With `-- NAME` only the cases of that name; with `-- PINION.h5 GEAR.h5` reduced members of the pair,
//! as dynamics_bevel_20_20_hybrid.toml has them, in place of made-up ones.
#![allow(clippy::unwrap_used, clippy::print_stdout, missing_docs)]

#[path = "../tests/mesh_common/mod.rs"]
mod mesh_common;
#[path = "../tests/mesh_common/running_bevel.rs"]
mod running_bevel;

use std::time::Instant;

use gearmesh_dynamics::Simulation;
use gearmesh_model::ReducedGear;
use running_bevel::*;

const PERIODS: usize = 40;

struct Kind {
    name: &'static str,
    teeth: Teeth,
    slices: usize,
    /// Whether each step is written out.
    output: bool,
}

const KINDS: [Kind; 5] = [
    Kind {
        name: "half spaces, 7 slices",
        teeth: Teeth::HalfSpaces,
        slices: 7,
        output: false,
    },
    Kind {
        name: "half spaces, 15 slices",
        teeth: Teeth::HalfSpaces,
        slices: 15,
        output: false,
    },
    Kind {
        name: "reduced, 7 slices",
        teeth: Teeth::Reduced,
        slices: 7,
        output: false,
    },
    Kind {
        name: "reduced, 15 slices",
        teeth: Teeth::Reduced,
        slices: 15,
        output: false,
    },
    Kind {
        name: "reduced, 15 slices, output",
        teeth: Teeth::Reduced,
        slices: 15,
        output: true,
    },
];

struct Case {
    run: Simulation,
    counts: Vec<usize>,
    out: Vec<f64>,
    output: bool,
}

impl Case {
    fn new(kind: &Kind, models: &[ReducedGear]) -> Self {
        let flanks = flanks(kind.slices);
        let mesh = match (kind.teeth, models) {
            (Teeth::Reduced, [pinion, gear]) => reduced_bevel_mesh([pinion, gear], &flanks),
            (teeth, _) => bevel_mesh(teeth, &flanks),
        };
        let system = running_bevel(&flanks, mesh);
        let run = Simulation::new(system.build().unwrap(), params()).unwrap();
        let names = run.system().channels();
        let of = |name: &str| names.iter().filter(|(element, _)| element == name).count();
        let counts = run.system().elements().map(of).collect();
        Self {
            counts,
            out: vec![0.0; names.len()],
            output: kind.output,
            run,
        }
    }

    fn period(&mut self) {
        let end = self.run.state().time_s + STEPS_A_PERIOD as f64 * STEP_S;
        self.run
            .run(end, |step| {
                if self.output {
                    (step.system).sample(step.to, &self.counts, &mut self.out);
                }
                std::ops::ControlFlow::Continue(())
            })
            .unwrap();
    }
}

fn main() {
    println!(
        "{:28} {:>10} {:>10} {:>9} {:>11} {:>8}",
        "teeth", "fastest µs", "middle µs", "real time", "iterations", "factors"
    );
    let words = || std::env::args().skip(1).filter(|one| !one.starts_with('-'));
    let (files, wanted): (Vec<String>, Vec<String>) = words().partition(|one| one.ends_with(".h5"));
    let read = |file: &String| gearmesh_model::read_reduced_gear(file.as_ref()).unwrap();
    let models: Vec<ReducedGear> = files.iter().map(read).collect();
    let is_wanted = |name: &str| wanted.is_empty() || wanted.iter().any(|one| one == name);
    for kind in KINDS.iter().filter(|kind| is_wanted(kind.name)) {
        let mut case = Case::new(kind, &models);
        (0..4).for_each(|_| case.period());
        let mut times: Vec<f64> = (0..PERIODS)
            .map(|_| {
                let start = Instant::now();
                case.period();
                start.elapsed().as_secs_f64() * 1e6 / STEPS_A_PERIOD as f64
            })
            .collect();
        times.sort_by(f64::total_cmp);
        let info = case.run.info();
        let steps = info.steps as f64;
        println!(
            "{:28} {:10.2} {:10.2} {:8.2}x {:11.3} {:8.4}",
            kind.name,
            times[0],
            times[PERIODS / 2],
            STEP_S * 1e6 / times[0],
            info.iterations as f64 / steps,
            info.factorisations as f64 / steps,
        );
    }
}
