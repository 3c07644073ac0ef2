//! What the end of Newton's iteration adds to the error of the step, with the default that goes by the step's own
//! error.

use std::f64::consts::TAU;

use gearmesh_dynamics::Params;
use gearmesh_geometry::GearPair;

use crate::mesh_common::*;
use crate::pairs_in_time::scene::*;

/// Transmission error \[m\] at four hundred times of two mesh periods, with so many steps between two of them, on a
/// speed that lets the stiffness of the mesh excite it.
fn run(name: &str, pair: &GearPair, steps: usize, newton_tolerance: Option<f64>) -> Vec<f64> {
    let speed = 60.0;
    let scene = Scene {
        te_m: -8e-6,
        ..Scene::new(pair).driven_at(speed).loaded_by(100.0)
    };
    let end_s = 2.0 * TAU / speed / pair.gear_1.teeth as f64;
    let params = Params {
        newton_tolerance,
        ..Params::fixed(end_s / (400 * steps) as f64)
    };
    let system = scene.system(mesh(name, pair, kinematics(pair)));
    let (samples, _) = record(system, params, end_s);
    assert_eq!(samples.len(), 400 * steps);
    let kept = samples.iter().skip(steps - 1).step_by(steps);
    kept.map(|sample| sample.te_m).collect()
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    let square: f64 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum();
    (square / a.len() as f64).sqrt()
}

/// Second order with the defaults, where the force is smooth; and everywhere an iteration error ten times below the
/// step's own.
#[test]
fn newton_adds_less_than_a_tenth_to_the_error_of_a_step() {
    let pair = spur_pair();
    for name in ["iso6336", "analytic", "hybrid"] {
        let finest = run(name, &pair, 16, Some(1e-13));
        let errors = [1, 2, 4].map(|steps| {
            let found = run(name, &pair, steps, None);
            let iterated = run(name, &pair, steps, Some(1e-13));
            (distance(&found, &finest), distance(&found, &iterated))
        });
        println!("{name}: errors of steps and of iterations {errors:?} m");
        for (error, of_iteration) in errors {
            assert!(10.0 * of_iteration < error, "{name}: {errors:?}");
        }
        if name == "iso6336" {
            // 1/(1 − 1/16), 1/(1 − 1/64): the finest steps are no exact solution.
            for pair in errors.windows(2) {
                let order = (pair[0].0 / pair[1].0).log2();
                assert!((order - 2.0).abs() < 0.15, "order {order}: {errors:?}");
            }
        }
    }
}
