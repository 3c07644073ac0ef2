//! A pair at 600 rpm, both gears with six degrees of freedom: time of a step against real time, fastest and middle mesh period of many;
//! then the same with every step written out, without and with eight gauges.
//!
//! `cargo bench -p gearmesh-drivetrain --bench step --profile dev`; on a busy machine only the fastest period says something. With
//! `-- NAME` only the case of that name.
#![allow(clippy::unwrap_used, clippy::print_stdout, missing_docs)]

#[path = "../tests/mesh_common/mod.rs"]
mod mesh_common;

use std::time::Instant;

use gearmesh_dynamics::{Params, Simulation, StepControl};
use mesh_common::running_pair::*;

const PERIODS: usize = 400;

/// Name, mesh model, steps of a mesh period, whether every step is written out, and gauges.
const CASES: [(&str, &str, usize, bool, usize); 6] = [
    ("impact", "impact", STEPS_A_PERIOD, false, 0),
    ("impact, 12 steps a period", "impact", 12, false, 0),
    ("hybrid", "hybrid", STEPS_A_PERIOD, false, 0),
    ("hybrid, output", "hybrid", STEPS_A_PERIOD, true, 0),
    (
        "hybrid, output, 8 gauges",
        "hybrid",
        STEPS_A_PERIOD,
        true,
        8,
    ),
    (HELICAL, "hybrid", STEPS_A_PERIOD, false, 0),
];

/// The case with helical teeth.
const HELICAL: &str = "hybrid, helical";

struct Case {
    run: Simulation,
    counts: Vec<usize>,
    out: Vec<f64>,
    output: bool,
    steps: usize,
    step_s: f64,
}

impl Case {
    fn new((name, mesh, steps, output, gauges): (&str, &str, usize, bool, usize)) -> Self {
        let pair = match name {
            HELICAL => helical_pair_a(),
            _ => pair_a(),
        };
        let system = running_pair(&pair, running_mesh(mesh, &pair), gauges);
        let step_s = STEP_S * STEPS_A_PERIOD as f64 / steps as f64;
        let params = Params {
            step: StepControl::Fixed { step_s },
            ..params()
        };
        let run = Simulation::new(system.build().unwrap(), params).unwrap();
        let names = run.system().channels();
        let of = |name: &str| names.iter().filter(|(element, _)| element == name).count();
        let counts = run.system().elements().map(of).collect();
        Self {
            counts,
            out: vec![0.0; names.len()],
            output,
            steps,
            step_s,
            run,
        }
    }

    fn period(&mut self) {
        for _ in 0..self.steps {
            let mut left = 1;
            let end = self.run.state().time_s + self.step_s;
            self.run
                .run(end, |step| {
                    if self.output {
                        (step.system).sample(step.to, &self.counts, &mut self.out);
                    }
                    left -= 1;
                    std::ops::ControlFlow::Continue(())
                })
                .unwrap();
            assert_eq!(left, 0);
        }
    }
}

fn main() {
    println!(
        "{:26} {:>10} {:>10} {:>9} {:>11} {:>8}",
        "mesh", "fastest µs", "middle µs", "real time", "iterations", "factors"
    );
    let wanted: Vec<String> = std::env::args().skip(1).collect();
    let is_wanted = |name: &str| {
        !wanted
            .iter()
            .any(|one| !one.starts_with('-') && one != name)
    };
    let chosen: Vec<_> = (CASES.into_iter())
        .filter(|(name, ..)| is_wanted(name))
        .collect();
    let mut cases: Vec<Case> = chosen.iter().copied().map(Case::new).collect();
    let mut times_us = vec![Vec::new(); cases.len()];
    for case in &mut cases {
        (0..10).for_each(|_| case.period());
    }
    // In turns, so that a busy minute hits all alike.
    for _ in 0..PERIODS {
        for (case, times) in cases.iter_mut().zip(&mut times_us) {
            let start = Instant::now();
            case.period();
            times.push(start.elapsed().as_secs_f64() * 1e6 / case.steps as f64);
        }
    }
    for (((name, ..), case), mut times) in chosen.iter().zip(&cases).zip(times_us) {
        times.sort_by(f64::total_cmp);
        let info = case.run.info();
        let steps = info.steps as f64;
        println!(
            "{name:26} {:10.2} {:10.2} {:8.2}x {:11.3} {:8.4}",
            times[0],
            times[PERIODS / 2],
            case.step_s * 1e6 / times[0],
            info.iterations as f64 / steps,
            info.factorisations as f64 / steps,
        );
    }
}
