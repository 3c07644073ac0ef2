//! A stiffness that jumps to and fro: where its vibration grows.

use crate::vibration::origin;
use gearmesh_dynamics::{
    Body, BodyId, ElementFailure, ForceElement, Joint, JointKind, Loads, Marker, Params,
    Simulation, System, View,
};
use std::f64::consts::{PI, TAU};
use std::ops::ControlFlow;

/// A spring along x whose stiffness jumps between two values, half a period each: an element as another crate would
/// write it.
struct SquareWaveSpring {
    body: [BodyId; 1],
    stiffness: [f64; 2],
    half_period: f64,
    /// Jumps lie in the middle of steps.
    shift: f64,
}

impl ForceElement for SquareWaveSpring {
    fn name(&self) -> &str {
        "square wave"
    }

    fn bodies(&self) -> &[BodyId] {
        &self.body
    }

    fn evaluate(&mut self, view: &View<'_>, loads: &mut Loads) -> Result<(), ElementFailure> {
        let half = ((view.time_s + self.shift) / self.half_period).floor() as i64;
        let k = self.stiffness[half.rem_euclid(2) as usize];
        loads.add_force(0, &[-k * view.body(self.body[0]).position_m.x]);
        if loads.wants_tangents() {
            loads.add_by_position(0, 0, -k);
        }
        Ok(())
    }
}

/// Trace of the map over one period, by simulation.
fn trace(stiffness: [f64; 2], period: f64) -> f64 {
    let steps = 400;
    let step_s = period / f64::from(steps);
    let run = |x: f64, v: f64| {
        let mut body = Body::rigid("mass", 1.0, [1.0; 3]);
        body.position_m.x = x;
        body.velocity_m_per_s.x = v;
        let mut builder = System::builder();
        let id = builder.body(body).unwrap();
        builder.joint(
            Joint::new(
                "slide",
                JointKind::Prismatic,
                Marker::ground([0.0; 3]).along([1.0, 0.0, 0.0]),
                origin(id).along([1.0, 0.0, 0.0]),
            )
            .unwrap(),
        );
        builder.element(SquareWaveSpring {
            body: [id],
            stiffness,
            half_period: period / 2.0,
            shift: -0.5 * step_s,
        });
        let params = Params {
            rho_infinity: 1.0,
            ..Params::fixed(step_s)
        };
        let mut simulation = Simulation::new(builder.build().unwrap(), params).unwrap();
        simulation
            .run(period, |_| ControlFlow::Continue(()))
            .unwrap();
        (
            simulation.state().positions_m[0].x,
            simulation.state().velocity[0],
        )
    };
    run(1.0, 0.0).0 + run(0.0, 1.0).1
}

#[test]
fn a_square_wave_stiffness_is_unstable_where_meissner_says() {
    // ẍ + (δ ± ε) x = 0 with period 2π, ε = 0.4: unstable where the trace of the map exceeds 2 in magnitude. The first
    // three regions lie at δ = 1/4, 1 and 9/4; the second is narrow for half-and-half waves.
    let epsilon = 0.4;
    let exact = |delta: f64| {
        let [a, b] = [delta + epsilon, delta - epsilon].map(f64::sqrt);
        let (sa, ca) = (a * PI).sin_cos();
        let (sb, cb) = (b * PI).sin_cos();
        2.0 * ca * cb - (a / b + b / a) * sa * sb
    };
    let simulated = |delta: f64| trace([delta + epsilon, delta - epsilon], TAU);
    let border = |f: &dyn Fn(f64) -> f64, mut low: f64, mut high: f64| {
        let excess = |delta: f64| f(delta).abs() - 2.0;
        let sign = excess(low).signum();
        for _ in 0..30 {
            let middle = 0.5 * (low + high);
            if excess(middle).signum() == sign {
                low = middle
            } else {
                high = middle
            }
        }
        0.5 * (low + high)
    };
    for (inside, outside) in [(0.45, 0.7), (2.25, 2.1), (2.25, 2.4)] {
        assert!(
            exact(inside).abs() > 2.0 && exact(outside).abs() < 2.0,
            "{} {}",
            exact(inside),
            exact(outside)
        );
        let (found, closed) = (
            border(&simulated, inside, outside),
            border(&exact, inside, outside),
        );
        assert!(
            (found - closed).abs() < 1e-3,
            "border between {inside} and {outside}: {found} instead of {closed}"
        );
    }
    for delta in [0.6, 1.0, 1.5, 2.25, 3.0] {
        assert!((simulated(delta) - exact(delta)).abs() < 5e-3, "{delta}");
    }
}
