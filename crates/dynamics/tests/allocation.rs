//! A step must not allocate: counted by the global allocator of this test program.
#![allow(clippy::unwrap_used)] // test code

#[path = "../../../tests/support/counting_allocator.rs"]
mod counting_allocator;
#[allow(dead_code)] // the reference solution is for another test
mod problems {
    pub mod andrews;
    pub mod chain;
    pub mod maxwell;
    pub mod two_wheels;
}

use counting_allocator::allocations;
use gearmesh_dynamics::{Body, OutputGrid, Params, Simulation, System};
use nalgebra::{UnitQuaternion, Vector3};
use problems::maxwell::Maxwell;
use problems::{andrews, chain, two_wheels};
use two_wheels::Coupling;

fn with_own_coordinate() -> System {
    let mut builder = System::builder();
    let mut body = Body::rigid("body", 1.0, [1.0; 3]);
    body.velocity_m_per_s.x = 0.1;
    let body = [builder.body(body).unwrap()];
    builder.element(Maxwell {
        body,
        stiffness_n_per_m: 1e4,
        damping_n_s_per_m: 30.0,
    });
    builder.build().unwrap()
}

#[test]
fn steps_and_output_do_not_allocate() {
    let squeezer: fn() -> System =
        || andrews::mechanism(UnitQuaternion::identity(), Vector3::zeros());
    let systems: [(fn() -> System, f64); 5] = [
        (squeezer, 1e-5),
        (|| two_wheels::system(Coupling::Spring), 3.5e-5),
        (|| two_wheels::system(Coupling::Ratio), 3.5e-5),
        // Sparse matrices.
        (|| chain::system(40), 1e-4),
        (with_own_coordinate, 1e-4),
    ];
    for (system, step_s) in systems {
        // The adaptive steps change, are refused and factorised anew on the way.
        for params in [
            Params::fixed(step_s),
            Params::adaptive(100.0 * step_s, 1e-9, 1e-7),
        ] {
            let system = system();
            let channels: Vec<usize> = system.elements().map(|_| 0).collect();
            let mut counts = channels;
            for (name, _) in system.channels() {
                let index = system
                    .elements()
                    .position(|element| element == name)
                    .unwrap();
                counts[index] += 1;
            }
            let mut values = vec![0.0; counts.iter().sum()];
            let mut simulation = Simulation::new(system, params).unwrap();
            let mut grid = OutputGrid::new(1.7 * step_s, simulation.state());
            simulation.step().unwrap();
            let before = allocations();
            simulation
                .run(400.0 * step_s, |step| {
                    grid.visit(step, |state, system| {
                        system.sample(state, &counts, &mut values)
                    });
                    std::ops::ControlFlow::Continue(())
                })
                .unwrap();
            assert_eq!(allocations() - before, 0);
            assert!(simulation.info().steps > 20, "{:?}", simulation.info());
            assert!(values.is_empty() || values.iter().any(|value| *value != 0.0));
        }
    }
}
