//! A pair at 600 rpm, both gears with six degrees of freedom: time of a step against real time, fastest and middle mesh
//! period of many; then the same with every step written out, without and with eight gauges.
//!
//! `cargo bench -p gearmesh-drivetrain --bench step --profile dev`; on a busy machine only the fastest period says
//! something. With `-- NAME` only the cases of that name. With `-- accuracy` what Newton's tolerance and the step cost
//! in accuracy, in place of times.
#![allow(clippy::unwrap_used, clippy::print_stdout, missing_docs)]

#[path = "../tests/mesh_common/mod.rs"]
mod mesh_common;

use std::f64::consts::TAU;
use std::time::Instant;

use gearmesh_dynamics::{Params, Simulation};
use gearmesh_geometry::GearPair;
use mesh_common::running_pair::*;

const PERIODS: usize = 400;

#[derive(Clone, Copy)]
struct Kind {
    name: &'static str,
    pair: fn() -> GearPair,
    mesh: &'static str,
    steps: usize,
    /// Stated share of the step's own motion to which Newton's method goes; none: the default, a tenth of the step's
    /// own error.
    tolerance: Option<f64>,
    output: bool,
    gauges: usize,
}

const HYBRID: Kind = Kind {
    name: "hybrid",
    pair: pair_a,
    mesh: "hybrid",
    steps: STEPS_A_PERIOD,
    tolerance: None,
    output: false,
    gauges: 0,
};

const IMPACT: Kind = Kind {
    name: "impact",
    mesh: "impact",
    ..HYBRID
};

const IMPACT_SEED_002: Kind = Kind {
    name: "impact, seed 002",
    pair: pair_of_seed_002,
    ..IMPACT
};

const KINDS: [Kind; 9] = [
    IMPACT,
    Kind {
        name: "impact, tolerance 1e-8",
        tolerance: Some(1e-8),
        ..IMPACT
    },
    Kind {
        name: "impact, 12 steps a period",
        steps: 12,
        ..IMPACT
    },
    IMPACT_SEED_002,
    HYBRID,
    Kind {
        name: "hybrid, tolerance 1e-8",
        tolerance: Some(1e-8),
        ..HYBRID
    },
    Kind {
        name: "hybrid, output",
        output: true,
        ..HYBRID
    },
    Kind {
        name: "hybrid, output, 8 gauges",
        output: true,
        gauges: 8,
        ..HYBRID
    },
    Kind {
        name: "hybrid, helical",
        pair: helical_pair_a,
        ..HYBRID
    },
];

struct Case {
    run: Simulation,
    counts: Vec<usize>,
    out: Vec<f64>,
    output: bool,
    steps: usize,
    step_s: f64,
}

impl Case {
    fn new(kind: &Kind) -> Self {
        let pair = (kind.pair)();
        let system = running_pair(&pair, running_mesh(kind.mesh, &pair), kind.gauges);
        let step_s = TAU / SPEED / (pair.gear_1.teeth * kind.steps) as f64;
        let params = Params {
            newton_tolerance: kind.tolerance,
            ..Params::fixed(step_s)
        };
        let run = Simulation::new(system.build().unwrap(), params).unwrap();
        let names = run.system().channels();
        let of = |name: &str| names.iter().filter(|(element, _)| element == name).count();
        let counts = run.system().elements().map(of).collect();
        Self {
            counts,
            out: vec![0.0; names.len()],
            output: kind.output,
            steps: kind.steps,
            step_s,
            run,
        }
    }

    fn period(&mut self) {
        self.watched_period(|_| {});
    }

    /// A mesh period; `watch` sees the outputs of each step where there are any.
    fn watched_period(&mut self, mut watch: impl FnMut(&[f64])) {
        for _ in 0..self.steps {
            let mut left = 1;
            let end = self.run.state().time_s + self.step_s;
            self.run
                .run(end, |step| {
                    if self.output {
                        (step.system).sample(step.to, &self.counts, &mut self.out);
                        watch(&self.out);
                    }
                    left -= 1;
                    std::ops::ControlFlow::Continue(())
                })
                .unwrap();
            assert_eq!(left, 0);
        }
    }

    /// Root mean square \[N\] of the varying part of the force on the right flanks in the last 20 of 60 mesh periods.
    fn varying_force_n(&mut self) -> f64 {
        let names = self.run.system().channels();
        let is_force = |name: &str| name == "normal_force_right_N";
        let place = (names.iter()).position(|(_, channel)| is_force(&channel.name));
        let (place, mut forces) = (place.unwrap(), Vec::new());
        (0..40).for_each(|_| self.period());
        (0..20).for_each(|_| self.watched_period(|out| forces.push(out[place])));
        let mean = forces.iter().sum::<f64>() / forces.len() as f64;
        let square: f64 = forces.iter().map(|f| (f - mean).powi(2)).sum();
        (square / forces.len() as f64).sqrt()
    }
}

/// What Newton's tolerance changes the varying force by, against steps of two and four times as many.
fn print_accuracy() {
    for kind in [IMPACT, IMPACT_SEED_002, HYBRID] {
        let kind = Kind {
            output: true,
            ..kind
        };
        let of = |tolerance: Option<f64>, steps: usize| {
            let mut case = Case::new(&Kind {
                tolerance,
                steps,
                ..kind
            });
            let force = case.varying_force_n();
            let info = case.run.info();
            (force, info.iterations as f64 / info.steps as f64)
        };
        let (exact, _) = of(Some(1e-13), STEPS_A_PERIOD);
        println!("{}: {exact:.4} N varying, Newton to 1e-13", kind.name);
        let stated = [1e-10, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4].map(Some);
        for tolerance in [None].into_iter().chain(stated) {
            let (force, corrections) = of(tolerance, STEPS_A_PERIOD);
            let off = force / exact - 1.0;
            let name = tolerance.map_or("the default".to_owned(), |share| format!("{share:e}"));
            println!("  Newton to {name}: {off:+.1e}, {corrections:.2} corrections a step");
        }
        // Seed 002's pair refuses a step as long as the first one.
        let fits = |steps: &usize| *steps > 12 || kind.name == IMPACT.name;
        let all = [12, 2 * STEPS_A_PERIOD, 4 * STEPS_A_PERIOD];
        for steps in all.into_iter().filter(fits) {
            let (force, _) = of(Some(1e-12), steps);
            println!("  {steps} steps a period: {:+.3}", force / exact - 1.0);
        }
    }
}

fn main() {
    if std::env::args().any(|one| one == "accuracy") {
        return print_accuracy();
    }
    println!(
        "{:26} {:>10} {:>10} {:>9} {:>11} {:>8}",
        "mesh", "fastest µs", "middle µs", "real time", "iterations", "factors"
    );
    let wanted: Vec<String> = (std::env::args().skip(1))
        .filter(|one| !one.starts_with('-'))
        .collect();
    let is_wanted = |name: &str| wanted.is_empty() || wanted.iter().any(|one| one == name);
    let kinds = KINDS.iter().filter(|kind| is_wanted(kind.name));
    let chosen: Vec<&Kind> = kinds.collect();
    let mut cases: Vec<Case> = chosen.iter().map(|kind| Case::new(kind)).collect();
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
    for ((kind, case), mut times) in chosen.iter().zip(&cases).zip(times_us) {
        let name = kind.name;
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
