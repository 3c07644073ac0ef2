//! Dry friction that turns round within far less slip than a step changes.

use std::ops::ControlFlow;

use gearmesh_dynamics::{
    Body, BodyId, ElementFailure, ForceElement, Loads, Params, Simulation, System, View,
};
use nalgebra::{Matrix3, Vector3};

/// Friction limit \[N\] and the slip within which it turns round \[m/s\].
const LIMIT_N: f64 = 5.0;
const TURN_M_PER_S: f64 = 1e-6;

/// Pushes from `from_s` on \[N\].
const PUSH_N: f64 = 4.0;
const FROM_S: f64 = 0.25;

/// A floor under a body: −F(v²) v/√(v² + s²), and a push across the way from some time on.
struct Floor {
    body: [BodyId; 1],
    /// Friction limit \[N\] over the square of the slip, and its derivative.
    limit: fn(f64) -> [f64; 2],
    /// Pushes from [`FROM_S`] on \[N\].
    push_n: f64,
}

impl ForceElement for Floor {
    fn name(&self) -> &str {
        "floor"
    }

    fn bodies(&self) -> &[BodyId] {
        &self.body
    }

    fn evaluate(&mut self, view: &View<'_>, loads: &mut Loads) -> Result<(), ElementFailure> {
        let first = loads.starts()[0];
        let v = view.body(self.body[0]).velocity_m_per_s;
        let root = (v.norm_squared() + TURN_M_PER_S.powi(2)).sqrt();
        let [limit, slope] = (self.limit)(v.norm_squared());
        let is_pushed = view.time_s > FROM_S;
        let push = if is_pushed { self.push_n } else { 0.0 };
        let force = Vector3::new(0.0, push, 0.0) - v * (limit / root);
        loads.add_force(first, force.as_slice());
        let outer = v * v.transpose();
        let turning = (Matrix3::identity() - outer / (root * root)) * (-limit / root);
        let by_velocity = turning - outer * (2.0 * slope / root);
        for row in 0..3 {
            for column in 0..3 {
                loads.add_by_velocity(first + row, first + column, by_velocity[(row, column)]);
            }
        }
        Ok(())
    }
}

/// The block, on its way at 1 m/s.
fn sliding() -> System {
    let mut builder = System::builder();
    let mut body = Body::rigid("block", 1.0, [1.0; 3]);
    body.velocity_m_per_s = Vector3::new(0.8, 0.6, 0.0);
    let id = builder.body(body).unwrap();
    builder.element(Floor {
        body: [id],
        limit: |_| [LIMIT_N, 0.0],
        push_n: PUSH_N,
    });
    builder.build().unwrap()
}

/// A block slides to rest after v²/(2 F/m), stays there, and creeps under a push below the limit as the law says, v =
/// s·(P/F)/√(1 − (P/F)²). Whole corrections of Newton's method go to and fro between sliding one way and the other.
#[test]
fn a_block_on_a_rough_floor_comes_to_rest_in_steps_that_are_long_for_it() {
    let mut simulation = Simulation::new(sliding(), Params::fixed(1e-3)).unwrap();
    let mut at_rest = [Vector3::zeros(); 2];
    let mut look = |end_s: f64| {
        simulation
            .run(end_s, |_| ControlFlow::Continue(()))
            .unwrap();
        (
            simulation.state().positions_m[0],
            simulation.state().velocity[1],
        )
    };
    (at_rest[0], _) = look(0.22);
    (at_rest[1], _) = look(0.249);
    let (_, creep) = look(0.4);
    let iterations = simulation.info().iterations as f64 / simulation.info().steps as f64;
    let way = at_rest[0].norm();
    assert!((way - 0.1).abs() < 2e-5, "{way} m");
    assert!((at_rest[0] - at_rest[1]).norm() < 1e-8, "{at_rest:?}");
    let share = PUSH_N / LIMIT_N;
    let expected = TURN_M_PER_S * share / (1.0 - share * share).sqrt();
    assert!(
        (creep / expected - 1.0).abs() < 1e-3,
        "{creep} {expected} m/s"
    );
    assert!(iterations < 5.0, "{iterations} iterations a step");
}

/// Steps found by damped iterations leave nothing behind that a checkpoint does not hold.
#[test]
fn a_run_resumed_after_every_step_is_the_same_to_the_last_bit() {
    let params = Params::fixed(1e-3);
    let mut whole = Simulation::new(sliding(), params).unwrap();
    let mut parts = Simulation::new(sliding(), params).unwrap();
    for _ in 0..300 {
        whole.step().unwrap();
        parts.step().unwrap();
        parts = Simulation::resume(sliding(), params, &parts.checkpoint()).unwrap();
    }
    assert_eq!(whole.checkpoint(), parts.checkpoint());
}

/// Friction that falls from 5 to 1 N within this slip \[m/s\].
const FALL_M_PER_S: f64 = 1e-4;

/// A floor that holds better than it brakes: F = 1 + 4/(1 + v²/w²).
fn sticky(square: f64) -> [f64; 2] {
    let share = 1.0 / (1.0 + square / FALL_M_PER_S.powi(2));
    [1.0 + 4.0 * share, -4.0 * (share / FALL_M_PER_S).powi(2)]
}

/// Friction that falls with the slip by more than h/m of a step has equations between whose solutions iterations get
/// stuck: the step is made in parts, and whole again afterwards.
#[test]
fn a_block_that_sticks_comes_to_rest_in_parts_of_a_step() {
    let mut builder = System::builder();
    let mut body = Body::rigid("block", 1.0, [1.0; 3]);
    body.velocity_m_per_s = Vector3::new(0.32, 0.24, 0.0);
    let id = builder.body(body).unwrap();
    builder.element(Floor {
        body: [id],
        limit: sticky,
        push_n: 0.0,
    });
    let params = Params::fixed(1e-3);
    let mut simulation = Simulation::new(builder.build().unwrap(), params).unwrap();
    simulation.run(0.45, |_| ControlFlow::Continue(())).unwrap();
    let way = simulation.state().positions_m[0].norm();
    let info = simulation.info();
    assert!((way - 0.08).abs() < 2e-5, "{way} m");
    assert!(info.unconverged > 0 && info.unconverged < 20, "{info:?}");
    assert!(info.steps < 800, "{info:?}");
    assert!(simulation.state().velocity[0].abs() < 1e-7);
}
