//! A thousand bodies in time.
#![allow(clippy::print_stdout, clippy::unwrap_used)] // test code; the figures are printed

use std::f64::consts::PI;

use gearmesh_dynamics::elements::SpringDamper;
use gearmesh_dynamics::{Body, Marker, MarkerPair, Params, Simulation, System};

use crate::hard_joints::finish;
use crate::mechanisms::problems::chain;

const BODIES: usize = 1000;

/// Masses on a line of springs between walls, pushed in the shape of a standing wave of so many half waves, mirrored
/// or not.
fn line_of_masses(half_waves: f64, amplitude_m: f64, mirrored: bool) -> System {
    let (spacing_m, stiffness_n_per_m) = (0.1, 1e6);
    let mut builder = System::builder();
    let mut markers = vec![Marker::ground([0.0; 3])];
    for k in 1..=BODIES {
        let mut body = Body::rigid(&format!("mass {k}"), 1.0, [1e-3; 3]);
        let shape = (PI * half_waves * k as f64 / (BODIES + 1) as f64).sin();
        let sign = if mirrored { -1.0 } else { 1.0 };
        body.position_m.x = spacing_m * k as f64 + sign * amplitude_m * shape;
        markers.push(Marker::at(builder.body(body).unwrap(), [0.0; 3]));
    }
    markers.push(Marker::ground([spacing_m * (BODIES + 1) as f64, 0.0, 0.0]));
    for (k, two) in markers.windows(2).enumerate() {
        let spring = SpringDamper {
            stiffness_n_per_m,
            damping_n_s_per_m: 0.0,
            free_length_m: spacing_m,
        };
        let pair = MarkerPair {
            a: two[0],
            b: two[1],
        };
        builder.element(spring.between(&format!("spring {k}"), pair).unwrap());
    }
    builder.build().unwrap()
}

/// A thousand masses on springs in a standing wave, 6000 degrees of freedom: after a period all are back at their
/// places but for what the scheme lengthens a period by, (ω h)²/12; energy is kept to rounding, the mirror image moves
/// the other way, and the matrix is made once.
#[test]
fn a_thousand_masses_in_a_standing_wave() {
    let (half_waves, amplitude) = (100.0, 1e-3);
    let omega = 2.0 * 1e3 * (0.5 * PI * half_waves / (BODIES + 1) as f64).sin();
    let (steps, period_s) = (200.0, 2.0 * PI / omega);
    let params = Params {
        rho_infinity: 1.0,
        ..Params::fixed(period_s / steps)
    };
    let run = |mirrored: bool| {
        let system = line_of_masses(half_waves, amplitude, mirrored);
        finish(system, params, 1.25 * period_s)
    };
    let [straight, mirrored] = [false, true].map(run);
    // A quarter of a period later all stand at their places, and what they lag behind is what the longer periods leave.
    let late_s = 1.25 * period_s * (omega * period_s / steps).powi(2) / 12.0;
    let (mut lag, mut apart) = (0.0f64, 0.0f64);
    for k in 1..=BODIES {
        let shape = (PI * half_waves * k as f64 / (BODIES + 1) as f64).sin();
        let expected = amplitude * omega * late_s * shape;
        let x = |run: &Simulation| run.state().positions_m[k - 1].x - 0.1 * k as f64;
        lag = lag.max((x(&straight) - expected).abs());
        apart = apart.max((x(&straight) + x(&mirrored)).abs());
    }
    let (info, most) = (straight.info(), amplitude * omega * late_s);
    println!(
        "off by {:.1e} of the lag, mirror image by {apart:.1e} m, energy by {:.1e}, {} factorisations, {} iterations in {} steps",
        lag / most,
        info.energy.largest_error_j / info.energy.first.potential_j,
        info.factorisations,
        info.iterations,
        info.steps
    );
    // The lag's own next order is (ω h)² of it; places of up to 100 m have digits of 1e-14 m.
    assert!(lag < 2e-2 * most, "{lag:e} of {most:e}");
    assert!(apart < 1e-11, "{apart:e}");
    let energy = info.energy;
    assert!(
        energy.largest_error_j < 1e-9 * energy.first.potential_j,
        "{energy:?}"
    );
    assert_eq!(info.factorisations, 1, "{info:?}");
}

/// A chain of a thousand links on revolute joints, 11 000 unknowns, released level: far from both ends links fall
/// freely, joints hold to rounding, energy goes with the second order of the step, and the pattern of the factors is
/// found once.
#[test]
fn a_thousand_links_fall() {
    let end_s = 0.04;
    let run = |step_s: f64| {
        // By default a tenth of the step's own error is left, and 3e-11 m of it in the joints.
        let params = Params {
            newton_tolerance: Some(1e-12),
            ..Params::fixed(step_s)
        };
        let simulation = finish(chain::system(BODIES), params, end_s);
        let info = *simulation.info();
        let fallen = -simulation.state().positions_m[BODIES / 2].y;
        let free = 0.5 * 9.81 * simulation.state().time_s.powi(2);
        println!(
            "{step_s} s: link 500 off by {:.1e} of its fall, joints {:.1e} m, energy {:.1e} J of {:.1} J, {} pivotings",
            fallen / free - 1.0,
            info.largest_violation,
            info.energy.largest_error_j,
            info.energy.last.kinetic_j,
            info.pivotings
        );
        assert!((fallen / free - 1.0).abs() < 1e-6, "{fallen} {free}");
        assert!(info.largest_violation < 1e-11, "{info:?}");
        assert!(info.pivotings <= 2, "{info:?}");
        info.energy.largest_error_j / info.energy.last.kinetic_j
    };
    let [coarse, fine] = [2e-3, 1e-3].map(run);
    assert!(fine < 0.35 * coarse && fine < 1e-2, "{coarse:e} {fine:e}");
}
