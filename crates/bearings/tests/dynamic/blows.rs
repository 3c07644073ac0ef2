//! A ball thrown at the outer race: Hertz' impact, energy, restitution.

use std::ops::ControlFlow;

use gearmesh_bearings::RingPose;
use gearmesh_bearings::dynamic::{DynamicEffects, Rebound, StatedContact};
use gearmesh_bearings::quasi_static::{QuasiStaticBearing, Row};
use gearmesh_dynamics::{Params, Simulation};

use crate::common::{B6205, bearing, close};
use crate::rig::{Channels, Held, row, system};

/// One ball between rings that are far apart, just before it meets the outer race.
fn one_ball() -> QuasiStaticBearing {
    let mut bearing = bearing(&format!("{B6205}radial_clearance_um = 200.0\n"));
    if let Row::Ball(row) = &mut bearing.rows[0] {
        row.balls = 1;
    }
    bearing
}

struct Blow {
    contact_time_s: f64,
    peak_n: f64,
    speed_after_m_per_s: f64,
    energy_error_j: f64,
}

/// A ball that flies outwards with this speed; step in shares of the contact's time.
fn throw(rebound: Rebound, speed: f64, step_s: f64, end_s: f64) -> Blow {
    let bearing = one_ball();
    let effects = DynamicEffects {
        rebound,
        ..DynamicEffects::default()
    };
    let system = system(&bearing, effects, &RingPose::default(), 0.0, &Held::Fast);
    let mut state = system.start().clone();
    let outer = &row(&bearing).outer;
    // It touches where its centre is at R + arm.
    let touching = outer.centre_radius_m + outer.arm_m;
    state.unknowns.copy_from_slice(&[touching - 1e-7, 0.0, 0.0]);
    let first = system.layout().first_unknown();
    state.velocity[first] = speed;
    let params = Params {
        rho_infinity: 1.0,
        ..Params::fixed(step_s)
    };
    let mut run = Simulation::from_state(system, state, params).unwrap();
    let (mut since, mut until, mut peak) = (None, 0.0, 0.0_f64);
    let (mut before, mut time_before) = (-1e-7, 0.0);
    run.run(end_s, |step| {
        let depth = step.to.unknowns[0] - touching;
        let (force, _) = outer.contact.load(depth);
        peak = peak.max(force);
        // Where the surface is crossed, along a line within the step.
        let crossing = time_before + (step.to.time_s - time_before) * before / (before - depth);
        if before <= 0.0 && depth > 0.0 {
            since = since.or(Some(crossing));
        }
        if before > 0.0 && depth <= 0.0 {
            until = crossing;
        }
        (before, time_before) = (depth, step.to.time_s);
        ControlFlow::Continue(())
    })
    .unwrap();
    Blow {
        contact_time_s: until - since.unwrap(),
        peak_n: peak,
        speed_after_m_per_s: -run.state().velocity[first],
        energy_error_j: run.info().energy.largest_error_j,
    }
}

/// T = 2.943275184 δ/v and F = k δ^1.5 with δ = (5mv²/4k)^0.4 (REFERENCES §2; H. Hertz 1882).
#[test]
fn a_blow_is_hertzs() {
    let bearing = one_ball();
    let row = row(&bearing);
    let (mass, k) = (row.ball_mass_kg, row.outer.contact.stiffness_n_per_m15);
    let speed: f64 = 0.1;
    let depth = (1.25 * mass * speed * speed / k).powf(0.4);
    let time = 2.943275184 * depth / speed;
    let blow = throw(Rebound::default(), speed, time / 400.0, 2.0 * time);
    close(blow.contact_time_s, time, 1e-3);
    close(blow.peak_n, k * depth.powf(1.5), 1e-3);
    // Nothing is lost.
    close(blow.speed_after_m_per_s, speed, 1e-5);
    let energy = 0.5 * mass * speed * speed;
    assert!(
        blow.energy_error_j < 1e-4 * energy,
        "{}",
        blow.energy_error_j
    );
}

/// The stated coefficient is the ratio of the speeds, at its own speed to 0.1 %; slower blows lose less.
#[test]
fn restitution_is_the_ratio_of_speeds() {
    for (e, v) in [
        (0.9, 0.1),
        (0.5, 0.1),
        (0.8, 0.02),
        (0.999, 0.05),
        (1.0, 0.1),
    ] {
        let rebound = Rebound::from_restitution(e, v).unwrap();
        let blow = throw(rebound, v, 1e-7, 1e-6 / v + 1.5e-4);
        close(blow.speed_after_m_per_s, e * v, 1e-3);
        if e < 0.95 {
            let slower = throw(rebound, 0.5 * v, 1e-7, 2e-6 / v + 2e-4);
            assert!(slower.speed_after_m_per_s > 1.02 * e * 0.5 * v);
        }
    }
    for (e, v) in [(0.0, 0.1), (1.1, 0.1), (f64::NAN, 0.1), (0.5, 0.0)] {
        assert!(Rebound::from_restitution(e, v).is_err(), "{e} {v}");
    }
}

/// A stated contact K δ^e gives back what a ball brings: ½ m v² = K δ^(e+1)/(e + 1) at the deepest place; 398 N at 10
/// µm of 1e7 N/mm^2.2. Its damping takes energy and never pulls.
#[test]
fn a_stated_contact_is_its_law() {
    let bearing = one_ball();
    let outer = &row(&bearing).outer;
    let touching = outer.centre_radius_m + outer.arm_m;
    let (stiffness, exponent) = (1e7 * 1e3_f64.powf(2.2), 2.2_f64);
    assert!((stiffness * 1e-5_f64.powf(exponent) - 398.1).abs() < 0.1);
    let speed = 0.05;
    let thrown = |damping_n_s_per_m: f64| {
        let contact = StatedContact {
            stiffness_n_per_m_e: stiffness,
            exponent,
            damping_n_s_per_m,
            full_damping_depth_m: 1e-5,
        };
        let effects = DynamicEffects {
            contact: Some(contact.validated().unwrap()),
            ..DynamicEffects::default()
        };
        let system = system(&bearing, effects, &RingPose::default(), 0.0, &Held::Fast);
        let mut state = system.start().clone();
        state.unknowns.copy_from_slice(&[touching - 1e-7, 0.0, 0.0]);
        let first = system.layout().first_unknown();
        state.velocity[first] = speed;
        let params = Params {
            rho_infinity: 1.0,
            ..Params::fixed(2e-7)
        };
        let mut run = Simulation::from_state(system, state, params).unwrap();
        let (mut peak, mut least) = (0.0_f64, f64::INFINITY);
        run.run(1.2e-3, |step| {
            let force = Channels::of(step.system, step.to).get("bearing.ball_1_outer_N");
            (peak, least) = (peak.max(force), least.min(force));
            ControlFlow::Continue(())
        })
        .unwrap();
        (peak, least, -run.state().velocity[first] / speed)
    };
    let (peak, _, after) = thrown(0.0);
    let mass = row(&bearing).ball_mass_kg;
    let depth =
        (0.5 * mass * speed * speed * (exponent + 1.0) / stiffness).powf(1.0 / (exponent + 1.0));
    close(peak, stiffness * depth.powf(exponent), 1e-3);
    close(after, 1.0, 1e-4);
    let (_, least, damped) = thrown(200.0);
    assert!(least >= 0.0, "{least} N");
    // The same blow by a method of its own: m δ̈ = −(K δ^e + c STEP δ̇), classical Runge-Kutta steps of 10 ns.
    let load = |[depth, rate]: [f64; 2]| {
        let s = (depth / 1e-5).min(1.0);
        (stiffness * depth.powf(exponent) + 200.0 * s * s * (3.0 - 2.0 * s) * rate).max(0.0)
    };
    let slope = |at: [f64; 2]| [at[1], -load([at[0].max(0.0), at[1]]) / mass];
    let (mut at, h) = ([0.0, speed], 1e-8);
    while at[0] >= 0.0 {
        let ahead = |by: f64, k: [f64; 2]| [at[0] + by * k[0], at[1] + by * k[1]];
        let k1 = slope(at);
        let k2 = slope(ahead(0.5 * h, k1));
        let k3 = slope(ahead(0.5 * h, k2));
        let k4 = slope(ahead(h, k3));
        let sum = [0, 1].map(|i| (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]) / 6.0);
        at = ahead(h, sum);
    }
    let expected = -at[1] / speed;
    close(damped, expected, 1e-3);
    assert!(expected < 0.95, "{expected}");
}
