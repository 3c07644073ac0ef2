//! What a step of a running pair takes, in counts: they do not depend on the machine.
#![allow(clippy::unwrap_used, clippy::print_stdout)]

mod mesh_common;

use std::ops::ControlFlow;

use gearmesh_dynamics::{Simulation, System};
use mesh_common::running_pair::*;

/// Six-degree bodies at 600 rpm and 50 steps a mesh period: Newton's corrections and factorisations a step, and what is called.
#[test]
fn steps_take_few_evaluations() {
    let (spur, helical) = (pair_a(), helical_pair_a());
    for (name, pair, most) in [
        ("impact", &spur, 2.9),
        ("hybrid", &spur, 2.6),
        ("hybrid", &helical, 0.1),
    ] {
        let begin = |params| {
            let system = running_pair(pair, running_mesh(name, pair), 0);
            Simulation::new(system.build().unwrap(), params).unwrap()
        };
        let mut run = begin(params());
        let calls_of_mesh = |system: &System| {
            let calls = system.calls();
            let mesh = calls.iter().find(|calls| calls.element == "mesh").unwrap();
            (mesh.force, mesh.tangents)
        };
        let (calls, tangents) = calls_of_mesh(run.system());
        let periods = 20;
        let end = (periods * STEPS_A_PERIOD) as f64 * STEP_S;
        run.run(end, |_| ControlFlow::Continue(())).unwrap();
        let info = *run.info();
        let steps = info.steps as f64;
        // Four corrections and more without Broyden's update.
        let corrections = info.iterations as f64 / steps;
        assert!(corrections < most, "{name}: {corrections}");
        // Going by the step's own error costs no more than 1e-8 of its motion did, the default before it.
        let mut stated = begin(gearmesh_dynamics::Params {
            newton_tolerance: Some(1e-8),
            ..params()
        });
        stated.run(end, |_| ControlFlow::Continue(())).unwrap();
        let before = stated.info().iterations as f64 / steps;
        println!("{name}: {corrections} corrections a step, {before} with 1e-8");
        assert!(corrections < 1.1 * before, "{name}: {corrections} {before}");
        let factorisations = info.factorisations as f64 / steps;
        assert!(factorisations < 0.05, "{name}: {factorisations}");
        // The mesh is asked once a correction, and for tangents only where a matrix is factorised.
        let (after, tangents_after) = calls_of_mesh(run.system());
        assert_eq!(after - calls, info.iterations, "{name}");
        assert_eq!(tangents_after - tangents, info.factorisations, "{name}");
        assert_eq!((info.rejected, info.unconverged), (0, 0), "{name}");
    }
}
