//! The bearing in equilibrium as a force element of a system.

use std::ops::ControlFlow;

use gearmesh_bearings::quasi_static_element::{QuasiStaticElement, RingDamping};
use gearmesh_bearings::ring_equilibrium::{AppliedBearingLoad, TiltCondition};
use gearmesh_bearings::{Control, Operation, RingPose};
use gearmesh_dynamics::{
    Body, GROUND, Joint, JointKind, Marker, MarkerPair, Params, Simulation, StaticParams, System,
    equilibrium,
};
use nalgebra::{Matrix6, Vector5};

use crate::common::{B218, B6205, PAIR, ROLLERS, bearing, close, definition};
use crate::rig::{Channels, Held, hold, shaft};

const DAMPING: RingDamping = RingDamping {
    radial_n_s_per_m: 3000.0,
    axial_n_s_per_m: 2000.0,
    tilt_nm_s_per_rad: 1.0,
};

fn element(text: &str, pair: MarkerPair) -> QuasiStaticElement {
    QuasiStaticElement::new(
        "bearing",
        pair,
        &definition(text),
        Control::OuterRace,
        DAMPING,
    )
    .unwrap()
    .with_element_loads()
}

fn system(text: &str, pose: &RingPose, speed: f64, held: &Held) -> System {
    let mut builder = System::builder();
    let shaft = shaft(&mut builder, pose, speed);
    hold(&mut builder, shaft, pose, speed, held);
    let pair = MarkerPair {
        a: Marker::at(GROUND, [0.0; 3]),
        b: Marker::at(shaft, [0.0; 3]),
    };
    builder.element(element(text, pair));
    builder.build().unwrap()
}

/// A shaft under a load comes to rest where the bearing by itself does.
#[test]
fn a_static_shaft_rests_where_the_bearing_does() {
    let load = AppliedBearingLoad {
        force_n: [400.0, -150.0, 300.0],
        tilt: TiltCondition::Moments([0.0; 2]),
    };
    let pose = bearing(PAIR)
        .equilibrium(&load, &Operation::default())
        .unwrap();
    let start = RingPose::default();
    let held = Held::Loaded(load.force_n, [0.0; 3]);
    let mut system = system(PAIR, &start, 0.0, &held);
    let state = system.start().clone();
    let found = equilibrium(&mut system, &state, &StaticParams::default()).unwrap();
    let place = found.state.positions_m[0];
    assert!(
        (place - pose.centre_m).norm() < 1e-8 * pose.centre_m.norm(),
        "{place} {}",
        pose.centre_m
    );
    let channels = Channels::of(&mut system, &found.state);
    close(channels.get("bearing.force_shaft_x_N"), -400.0, 1e-6);
}

/// Forces and tangents of the element at a moved and tilted housing and shaft, at speed, against differences.
#[test]
fn tangents_of_the_element_are_derivatives() {
    for text in [B218, ROLLERS] {
        let mut builder = System::builder();
        let mut body = |name: &str, x: f64| {
            let mut body = Body::rigid(name, 1.0, [1e-3; 3]);
            body.position_m.x = x;
            body.angular_velocity_rad_per_s.z = if x > 0.0 { 600.0 } else { 0.0 };
            builder.body(body).unwrap()
        };
        let pair = MarkerPair {
            a: Marker::at(body("housing", -0.02), [0.03, 0.0, 0.01]),
            b: Marker::at(body("shaft", 0.04), [-0.03, 0.0, 0.01]),
        };
        builder.element(element(text, pair));
        let mut simulation = {
            let system = builder.build().unwrap();
            Simulation::new(system, Params::fixed(1e-6)).unwrap()
        };
        simulation.step().unwrap();
        let mut system = simulation.into_system();
        let start = system.start().clone();
        let mut increment = vec![0.0; 12];
        increment[6..9].copy_from_slice(&[2e-5, -1e-5, 6e-5]);
        increment[3] = 2e-4;
        let velocity: Vec<f64> = (0..12).map(|i| 0.1 * (i as f64 - 5.0)).collect();
        let exact = system
            .probe("bearing", &start, &increment, &velocity)
            .unwrap();
        let arm = 0.06;
        for dof in 0..12 {
            // Rotations of the housing begin at one: their column is by an increment from there.
            if (3..6).contains(&dof) {
                continue;
            }
            let turn = dof % 6 >= 3;
            for by_velocity in [false, true] {
                let h = match (by_velocity, turn) {
                    (false, false) => 3e-9,
                    (false, true) => 5e-8,
                    (true, _) => 1e-3,
                };
                let mut force = |factor: f64| {
                    let (mut place, mut speed) = (increment.clone(), velocity.clone());
                    if by_velocity {
                        speed[dof] += factor * h;
                    } else {
                        place[dof] += factor * h;
                    }
                    system
                        .probe("bearing", &start, &place, &speed)
                        .unwrap()
                        .force
                };
                let [a, b, c, d] = [-2.0, 2.0, 1.0, -1.0].map(&mut force);
                let matrix = if by_velocity {
                    &exact.by_velocity
                } else {
                    &exact.by_position
                };
                let scale = |row: usize| if row % 6 >= 3 { arm } else { 1.0 };
                let size = (0..12)
                    .map(|r| (matrix[(r, dof)] / scale(r)).abs())
                    .fold(0.0, f64::max);
                for row in 0..12 {
                    let found = (a[row] - b[row] + 8.0 * (c[row] - d[row])) / (12.0 * h);
                    let miss = (found - matrix[(row, dof)]).abs() / scale(row);
                    assert!(
                        miss <= 2e-6 * size.max(1e-3),
                        "{text} {row} {dof} {by_velocity}: {found} {}",
                        matrix[(row, dof)]
                    );
                }
            }
        }
        assert!(exact.by_position.fixed_view::<6, 6>(6, 6).into_owned() != Matrix6::zeros());
    }
}

/// Balls pass: under a radial load the force of a held shaft varies at Z times the cage's frequency, and a step's
/// length does not matter.
#[test]
fn balls_pass_at_the_outer_races_frequency() {
    let pose = RingPose::from_five(&Vector5::new(2e-5, 0.0, 0.0, 0.0, 0.0));
    let speed = 100.0;
    let text = format!("{B6205}radial_clearance_um = 12.0\n");
    let gamma = 7.938 / 39.04;
    let period = 2.0 * std::f64::consts::PI / (9.0 * 0.5 * (1.0 - gamma) * speed);
    for steps in [40.0, 100.0] {
        let system = system(&text, &pose, speed, &Held::Fast);
        let mut run = Simulation::new(system, Params::fixed(period / steps)).unwrap();
        let mut forces = Vec::new();
        run.run(2.0 * period, |step| {
            let found = Channels::of(step.system, step.to);
            forces.push(found.get("bearing.force_shaft_x_N"));
            ControlFlow::Continue(())
        })
        .unwrap();
        let n = steps as usize;
        let (least, most) = forces
            .iter()
            .fold((0.0_f64, f64::NEG_INFINITY), |(a, b), f| {
                (a.min(*f), b.max(*f))
            });
        assert!(most - least > 1e-3 * least.abs(), "{least} {most}");
        for i in 0..n {
            assert!(
                (forces[i] - forces[i + n]).abs() < 1e-3 * (most - least),
                "{i}"
            );
        }
    }
}

/// The outer ring turns, the inner one stands and is displaced: balls pass the load, which stands with it, at Z f_o
/// (1 + γ)/2.
#[test]
fn balls_pass_under_a_turning_outer_ring() {
    let outer_hz = 10.0;
    let speed = std::f64::consts::TAU * outer_hz;
    let mut builder = System::builder();
    let housing = shaft(&mut builder, &RingPose::default(), speed);
    hold(
        &mut builder,
        housing,
        &RingPose::default(),
        speed,
        &Held::Fast,
    );
    let pair = MarkerPair {
        a: Marker::at(housing, [0.0; 3]),
        b: Marker::at(GROUND, [0.0, 2e-5, 0.0]),
    };
    builder.element(element(B6205, pair));
    let gamma = 7.938 / 39.04;
    let passing_hz = 9.0 * outer_hz * 0.5 * (1.0 + gamma);
    let step_s = 1.0 / (200.0 * passing_hz);
    let mut run = Simulation::new(builder.build().unwrap(), Params::fixed(step_s)).unwrap();
    let mut force = Vec::new();
    run.run(400.5 * step_s, |step| {
        let found = Channels::of(step.system, step.to);
        force.push(found.get("bearing.force_world_y_N"));
        ControlFlow::Continue(())
    })
    .unwrap();
    let (least, most) = force
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), f| {
            (a.min(*f), b.max(*f))
        });
    let ripple = most - least;
    assert!(ripple > 1e-3 * most.abs(), "{ripple} N of {most} N");
    for (now, later) in force.iter().zip(&force[200..]) {
        assert!(
            (now - later).abs() < 1e-2 * ripple,
            "{now} {later}, {ripple}"
        );
    }
}

/// A shaft that turns freely under a radial load slows down as its friction torque says, I ω̇ = −M(ω), and the energy
/// that it loses is the heat; an equilibrium with the same speed is found, because the torque does not act in it.
#[test]
fn friction_slows_a_free_shaft_down() {
    let text = format!("{B6205}[friction]\nviscosity_mm2_per_s = 50.0\nseal_torque_Nm = 0.01\n");
    let force_n = [900.0, 0.0, 0.0];
    let load = AppliedBearingLoad {
        force_n,
        tilt: TiltCondition::Held([0.0; 2]),
    };
    let still = Operation::default();
    let pose = bearing(&text).equilibrium(&load, &still).unwrap();
    let (inertia, start, end_s) = (1e-4, 150.0, 0.05);
    let mut builder = System::builder();
    let shaft = shaft(&mut builder, &pose, start);
    let at = Marker::ground(pose.centre_m.into());
    let seat = Marker::at(shaft, [0.0; 3]);
    builder.joint(Joint::new("held", JointKind::Revolute, at, seat).unwrap());
    let pair = MarkerPair {
        a: Marker::at(GROUND, [0.0; 3]),
        b: seat,
    };
    builder.element(element(&text, pair));
    let mut system = builder.build().unwrap();
    let state = system.start().clone();
    let found = equilibrium(&mut system, &state, &StaticParams::default()).unwrap();
    let channels = Channels::of(&mut system, &found.state);
    let torque = |speed: f64| {
        let operation = Operation {
            inner_rad_per_s: speed,
            ..still
        };
        let (_, loads) = bearing(&text).loads(&pose, &operation).unwrap();
        let d = definition(&text);
        d.friction.unwrap().torque(&d, &loads, &operation)
    };
    close(
        channels.get("bearing.friction_torque_Nm"),
        torque(start).total_nm(),
        1e-6,
    );
    close(
        channels.get("bearing.friction_power_W"),
        torque(start).power_w(),
        1e-6,
    );
    let mut run = Simulation::new(system, Params::fixed(1e-4)).unwrap();
    run.run(end_s, |_| ControlFlow::Continue(())).unwrap();
    let speed = run.state().velocity[5];
    // By Runge's midpoint rule in steps of its own.
    let mut expected = start;
    for _ in 0..200 {
        let h = end_s / 200.0;
        let middle = expected - 0.5 * h * torque(expected).total_nm() / inertia;
        expected -= h * torque(middle).total_nm() / inertia;
    }
    assert!(
        expected < 0.95 * start && expected > 0.2 * start,
        "{expected}"
    );
    // The torque of a step is that of the step before.
    close(start - speed, start - expected, 5e-3);
    let heat = 0.5 * inertia * (start * start - speed * speed);
    close(run.info().energy.dissipated_j, heat, 1e-3);
    // Where nothing turns any more nothing rubs, and it does not turn back.
    let mut run = run;
    run.run(2.0, |_| ControlFlow::Continue(())).unwrap();
    assert!(
        run.state().velocity[5].abs() < 1e-3,
        "{}",
        run.state().velocity[5]
    );
}
