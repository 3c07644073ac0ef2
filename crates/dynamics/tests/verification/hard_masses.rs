//! Bodies of very different mass.
#![allow(clippy::unwrap_used)] // test code

use std::f64::consts::TAU;

use gearmesh_dynamics::elements::SpringDamper;
use gearmesh_dynamics::{Body, Marker, MarkerPair, Params, System};

use crate::hard_joints::finish;

/// A tonne and a gram on one spring, 5 Hz against each other: the gram swings with ω² = k (1/m + 1/M), and momentum
/// and, by the scheme without numerical damping, energy are kept to rounding.
#[test]
fn a_mass_ratio_of_a_million() {
    let (heavy, light): (f64, f64) = (1e3, 1e-3);
    let omega = TAU * 5.0;
    let stiffness_n_per_m = omega * omega / (1.0 / heavy + 1.0 / light);
    let mut builder = System::builder();
    let at = |name: &str, mass: f64, x: f64, v: f64| {
        let mut body = Body::rigid(name, mass, [mass; 3]);
        body.position_m.x = x;
        body.velocity_m_per_s.x = v;
        body
    };
    let first = builder.body(at("tonne", heavy, 0.0, 0.0)).unwrap();
    // Amplitude v/ω of 10 mm.
    let speed = 0.01 * omega;
    let second = builder.body(at("gram", light, 0.5, speed)).unwrap();
    let spring = SpringDamper {
        stiffness_n_per_m,
        damping_n_s_per_m: 0.0,
        free_length_m: 0.5,
    };
    let pair = MarkerPair {
        a: Marker::at(first, [0.0; 3]),
        b: Marker::at(second, [0.0; 3]),
    };
    builder.element(spring.between("spring", pair).unwrap());
    let params = Params {
        rho_infinity: 1.0,
        ..Params::fixed(1e-3)
    };
    let periods = 20.0;
    let simulation = finish(builder.build().unwrap(), params, periods * 0.2);
    let state = simulation.state();
    let momentum = heavy * state.velocity[0] + light * state.velocity[6];
    println!(
        "momentum off by {:.1e} of itself (allowed 1e-9)",
        (momentum / (light * speed) - 1.0).abs()
    );
    assert!(
        (momentum / (light * speed) - 1.0).abs() < 1e-9,
        "{momentum}"
    );
    // After whole periods the gram is where it began; the scheme lengthens a period by (ω h)²/12 of itself.
    let length = state.positions_m[1].x - state.positions_m[0].x;
    let late_s = periods * 0.2 * (omega * 1e-3).powi(2) / 12.0;
    let off = (length - 0.5 + speed * late_s).abs();
    println!(
        "after {periods} periods the gram lags by {:.3e} m, off by {:.1e} of that (allowed 2e-2)",
        speed * late_s,
        off / (speed * late_s)
    );
    assert!(off < 0.02 * speed * late_s, "{off} of {}", speed * late_s);
    let energy = &simulation.info().energy;
    println!(
        "energy off by {:.1e} of that at the start (allowed 1e-9)",
        energy.largest_error_j / energy.first.kinetic_j
    );
    assert!(
        energy.largest_error_j < 1e-9 * energy.first.kinetic_j,
        "{energy:?}"
    );
}
