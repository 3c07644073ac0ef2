//! What a step of a running pair takes, in counts: they do not depend on the machine.

use crate::mesh_common;
use crate::running_bevel;

use std::ops::ControlFlow;

use gearmesh_dynamics::{Simulation, System};
use mesh_common::running_pair::*;

/// Six-degree bodies at 600 rpm and 50 steps a mesh period: Newton's corrections and factorisations a step, and what is
/// called.
#[test]
fn steps_take_few_evaluations() {
    let (spur, helical) = (pair_a(), helical_pair_a());
    for (name, pair, most) in [
        ("impact", &spur, 2.9),
        ("hybrid", &spur, 2.6),
        ("hybrid", &helical, 3.2),
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
        // A step of five corrections is followed by 32 that begin with new factors.
        let factorisations = info.factorisations as f64 / steps;
        assert!(factorisations < 0.08, "{name}: {factorisations}");
        // The mesh is asked once a correction, and for tangents only where a matrix is factorised.
        let (after, tangents_after) = calls_of_mesh(run.system());
        assert_eq!(after - calls, info.iterations, "{name}");
        assert_eq!(tangents_after - tangents, info.factorisations, "{name}");
        assert_eq!((info.rejected, info.unconverged), (0, 0), "{name}");
    }
}

/// The bevel pair of seed 001 in 15 slices: corrections a step, factorisations, and points of flanks that a call of the
/// mesh computes.
#[test]
fn bevel_steps_take_few_evaluations() {
    for (name, kind, most) in [
        ("half spaces", running_bevel::Teeth::HalfSpaces, 3.3),
        ("reduced", running_bevel::Teeth::Reduced, 3.3),
    ] {
        let flanks = running_bevel::flanks(15);
        let mesh = running_bevel::bevel_mesh(kind, &flanks);
        let system = running_bevel::running_bevel(&flanks, mesh);
        let params = running_bevel::params();
        let mut run = Simulation::new(system.build().unwrap(), params).unwrap();
        // The torque has its full size after the first two mesh periods.
        let end = |periods: usize| {
            (periods * running_bevel::STEPS_A_PERIOD) as f64 * running_bevel::STEP_S
        };
        run.run(end(3), |_| ControlFlow::Continue(())).unwrap();
        let calls = |run: &Simulation| {
            let calls = run.system().calls();
            calls
                .iter()
                .find(|calls| calls.element == "mesh")
                .unwrap()
                .force
        };
        let (before, calls_before) = (*run.info(), calls(&run));
        let points_before = flanks.pair().computed_points();
        run.run(end(6), |_| ControlFlow::Continue(())).unwrap();
        let info = *run.info();
        let steps = (info.steps - before.steps) as f64;
        let corrections = (info.iterations - before.iterations) as f64 / steps;
        let factorisations = (info.factorisations - before.factorisations) as f64 / steps;
        let points = (flanks.pair().computed_points() - points_before) as f64;
        let points = points / (calls(&run) - calls_before) as f64;
        println!(
            "{name}: {corrections} corrections, {factorisations} factorisations, {points} points"
        );
        // Five and more by old factors.
        assert!(corrections < most, "{name}: {corrections}");
        assert!(factorisations < 1.05, "{name}: {factorisations}");
        // 175 where each call searches.
        assert!(points < 130.0, "{name}: {points}");
        assert_eq!((info.rejected, info.unconverged), (0, 0), "{name}");
    }
}
