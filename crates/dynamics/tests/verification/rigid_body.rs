//! Motions with a closed form: tops, gyroscope, pendulums, prescribed and coupled rotation.
#![allow(clippy::unwrap_used)] // test code

use std::f64::consts::{FRAC_PI_2, TAU};
use std::ops::ControlFlow;

use gearmesh_dynamics::elements::{AppliedLoad, Axes, Bushing, LoadKind};
use gearmesh_dynamics::{
    Body, Joint, JointKind, Marker, MarkerPair, Motion, Params, Simulation, System, TimeFunction,
};
use nalgebra::{UnitQuaternion, Vector3};

const GRAVITY: f64 = 9.81;

fn params(step_s: f64, rho_infinity: f64) -> Params {
    Params {
        rho_infinity,
        newton_tolerance: Some(1e-12),
        ..Params::fixed(step_s)
    }
}

fn finish(system: System, params: Params, end_s: f64) -> Simulation {
    let mut simulation = Simulation::new(system, params).unwrap();
    simulation
        .run(end_s, |_| ControlFlow::Continue(()))
        .unwrap();
    simulation
}

fn spin(simulation: &Simulation, body: usize) -> Vector3<f64> {
    Vector3::from_column_slice(&simulation.state().velocity[6 * body + 3..6 * body + 6])
}

fn revolute(name: &str, a: Marker, b: Marker) -> Joint {
    Joint::new(name, JointKind::Revolute, a, b).unwrap()
}

#[test]
fn constant_torque_gives_linear_speed() {
    let mut builder = System::builder();
    let wheel = builder
        .body(Body::rigid("wheel", 2.0, [0.3, 0.3, 0.5]))
        .unwrap();
    builder.joint(revolute(
        "axle",
        Marker::ground([0.0; 3]),
        Marker::at(wheel, [0.0; 3]),
    ));
    let torque = AppliedLoad::new(
        "motor",
        wheel,
        LoadKind::Torque,
        (Axes::Body, [0.0, 0.0, 1.0]),
        TimeFunction::Constant(3.0),
    );
    builder.element(torque.unwrap());
    let mut simulation = Simulation::new(builder.build().unwrap(), params(0.01, 0.8)).unwrap();
    simulation
        .run(5.0, |step| {
            let exact = 3.0 / 0.5 * step.to.time_s;
            assert!((step.to.velocity[5] - exact).abs() < 1e-11 * (1.0 + exact));
            ControlFlow::Continue(())
        })
        .unwrap();
    // Work of the torque is all there as kinetic energy.
    assert!(
        simulation.info().energy.largest_error_j < 1e-9 * simulation.info().energy.last.kinetic_j
    );
}

/// sn, cn, dn by descending Landen transformation (Abramowitz and Stegun 16.4).
fn jacobi(u: f64, m: f64) -> [f64; 3] {
    // Arithmetic and geometric means with c = half their last difference.
    let (mut a, mut b) = (1.0_f64, (1.0 - m).sqrt());
    let mut means = Vec::new();
    for _ in 0..8 {
        let mean = 0.5 * (a + b);
        means.push((mean, a - mean));
        (a, b) = (mean, (a * b).sqrt());
    }
    let mut phi = f64::powi(2.0, means.len() as i32) * a * u;
    for (a, c) in means.iter().rev() {
        phi = 0.5 * (phi + (c / a * phi.sin()).asin());
    }
    [phi.sin(), phi.cos(), (1.0 - m * phi.sin().powi(2)).sqrt()]
}

/// Angular velocity of a free body with moments I₁ < I₂ < I₃ that starts with (p, 0, r), L² > 2EI₂. Source: L. D.
/// Landau, E. M. Lifshitz, *Mechanics*, § 37.
fn free_top(i: [f64; 3], p: f64, r: f64, time: f64) -> Vector3<f64> {
    let twice_energy = i[0] * p * p + i[2] * r * r;
    let square = (i[0] * p).powi(2) + (i[2] * r).powi(2);
    let (high, low) = (twice_energy * i[2] - square, square - twice_energy * i[0]);
    let tau = time * ((i[2] - i[1]) * low / (i[0] * i[1] * i[2])).sqrt();
    let [sn, cn, dn] = jacobi(tau, (i[1] - i[0]) * high / ((i[2] - i[1]) * low));
    Vector3::new(
        (high / (i[0] * (i[2] - i[0]))).sqrt() * cn,
        (high / (i[1] * (i[2] - i[1]))).sqrt() * sn,
        (low / (i[2] * (i[2] - i[0]))).sqrt() * dn,
    )
}

#[test]
fn a_free_asymmetric_top_follows_the_elliptic_functions() {
    let moments = [0.2, 0.3, 0.4];
    let (p, r) = (2.0, 2.5);
    let error = |steps: usize| {
        let mut body = Body::rigid("top", 1.0, moments);
        body.angular_velocity_rad_per_s = Vector3::new(p, 0.0, r);
        body.orientation = UnitQuaternion::from_euler_angles(0.3, -1.0, 2.0);
        let momentum =
            |q: UnitQuaternion<f64>, w: Vector3<f64>| q * w.component_mul(&Vector3::from(moments));
        let first = momentum(body.orientation, body.angular_velocity_rad_per_s);
        let mut builder = System::builder();
        builder.body(body).unwrap();
        let end = 10.0;
        let simulation = finish(
            builder.build().unwrap(),
            params(end / steps as f64, 0.9),
            end,
        );
        let last = momentum(simulation.state().orientations[0], spin(&simulation, 0));
        let speed = (spin(&simulation, 0) - free_top(moments, p, r, end)).norm();
        [speed, (last - first).norm()]
    };
    let (coarse, fine) = (error(2000), error(4000));
    for (coarse, fine) in coarse.into_iter().zip(fine) {
        let order = (coarse / fine).log2();
        assert!(
            (order - 2.0).abs() < 0.1,
            "order {order}, errors {coarse} and {fine}"
        );
    }
    assert!(fine[0] < 1e-4, "{fine:?}");
}

/// A symmetric top on its tip in regular precession, or released with its axle level.
fn heavy_top(tilt: f64, precession: f64, own_spin: f64) -> System {
    let (mass, arm, axial, across) = (1.5, 0.2, 0.01, 0.008);
    let mut body = Body::rigid("top", mass, [across, across, axial]);
    body.center_of_mass_m = Vector3::new(0.0, 0.0, arm);
    body.orientation = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), tilt);
    body.angular_velocity_rad_per_s = body.orientation.inverse()
        * Vector3::new(0.0, 0.0, precession)
        + Vector3::new(0.0, 0.0, own_spin);
    let mut builder = System::builder();
    let top = builder.body(body).unwrap();
    builder.joint(
        Joint::new(
            "tip",
            JointKind::Spherical,
            Marker::ground([0.0; 3]),
            Marker::at(top, [0.0; 3]),
        )
        .unwrap(),
    );
    builder.gravity([0.0, 0.0, -GRAVITY]);
    builder.build().unwrap()
}

#[test]
fn a_gyroscope_precesses_steadily() {
    let (tilt, precession): (f64, f64) = (1.1, 2.0);
    let (moment, axial, across) = (1.5 * GRAVITY * 0.2, 0.01, 0.008 + 1.5 * 0.04);
    // Regular precession: axial (ψ' + φ' cos θ) φ' − across φ'² cos θ = m g l.
    let own_spin = (moment + across * precession * precession * tilt.cos()) / (axial * precession)
        - precession * tilt.cos();
    let end = 3.0;
    let error = |steps: usize| {
        let simulation = finish(
            heavy_top(tilt, precession, own_spin),
            params(end / steps as f64, 0.9),
            end,
        );
        let axis = simulation.state().orientations[0] * Vector3::z();
        let exact = Vector3::new(
            tilt.sin() * (precession * end).cos(),
            tilt.sin() * (precession * end).sin(),
            tilt.cos(),
        );
        (axis - exact).norm()
    };
    let (coarse, fine) = (error(12_000), error(24_000));
    assert!(
        ((coarse / fine).log2() - 2.0).abs() < 0.1,
        "{coarse} {fine}"
    );
    assert!(fine < 2e-3, "{fine}");
}

fn double_pendulum(orientation: UnitQuaternion<f64>) -> System {
    let mut builder = System::builder();
    let mut bodies = Vec::new();
    for (index, angle) in [2.0, 2.6].into_iter().enumerate() {
        let mut body = Body::rigid(
            ["upper", "lower"][index],
            1.0 + index as f64,
            [0.02, 0.03, 0.04],
        );
        body.center_of_mass_m = Vector3::new(0.3, 0.02, 0.0);
        let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), angle);
        body.orientation = orientation * turn;
        if index == 1 {
            let upper = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), 2.0);
            body.position_m = orientation * (upper * Vector3::new(0.5, 0.0, 0.0));
        }
        bodies.push(builder.body(body).unwrap());
    }
    let ground = Marker::ground([0.0; 3]).oriented(orientation);
    builder.joint(revolute(
        "shoulder",
        ground,
        Marker::at(bodies[0], [0.0; 3]),
    ));
    builder.joint(revolute(
        "elbow",
        Marker::at(bodies[0], [0.5, 0.0, 0.0]),
        Marker::at(bodies[1], [0.0; 3]),
    ));
    let weight = orientation * Vector3::new(GRAVITY, 0.0, 0.0);
    builder.gravity([weight.x, weight.y, weight.z]);
    builder.build().unwrap()
}

#[test]
fn energy_errors_of_conservative_systems_fall_with_the_square_of_the_step() {
    let systems: [(&str, &dyn Fn() -> System); 2] = [
        ("top", &|| heavy_top(1.0, 0.0, 60.0)),
        ("double pendulum", &|| {
            double_pendulum(UnitQuaternion::identity())
        }),
    ];
    for (what, system) in systems {
        let error = |steps: usize| {
            let simulation = finish(system(), params(1.5 / steps as f64, 1.0), 1.5);
            simulation.info().energy.largest_error_j
        };
        let (coarse, fine) = (error(2000), error(4000));
        let order = (coarse / fine).log2();
        assert!(
            (order - 2.0).abs() < 0.15,
            "{what}: order {order}, errors {coarse} and {fine} J"
        );
    }
}

/// A pendulum released level at rest: at every angle φ from the vertical the pull of its joint along the pendulum is
/// m g cos φ (1 + 2 m l²/(m l² + J)).
fn tension_error(params: Params) -> f64 {
    let (mass, length, moment) = (2.0, 0.7, 0.1);
    let factor = 1.0 + 2.0 / (1.0 + moment / (mass * length * length));
    let mut bob = Body::rigid("bob", mass, [moment; 3]);
    bob.position_m = Vector3::new(0.0, length, 0.0);
    let mut builder = System::builder();
    let bob = builder.body(bob).unwrap();
    builder.joint(revolute(
        "pivot",
        Marker::at(bob, [0.0, -length, 0.0]),
        Marker::ground([0.0; 3]),
    ));
    builder.gravity([GRAVITY, 0.0, 0.0]);
    let mut worst: f64 = 0.0;
    let mut simulation = Simulation::new(builder.build().unwrap(), params).unwrap();
    simulation
        .run(2.0, |step| {
            // The bob hangs along −y of its own frame; marker A is on it, λ pushes the ground.
            let tension = step.lambda[1];
            let exact = factor * mass * GRAVITY * step.to.positions_m[0].x / length;
            worst = worst.max((tension.abs() - exact.abs()).abs());
            ControlFlow::Continue(())
        })
        .unwrap();
    worst
}

#[test]
fn reactions_are_of_the_second_order_from_the_first_step_on() {
    for rho_infinity in [0.0, 0.5, 0.9] {
        let error = |step_s: f64| tension_error(params(step_s, rho_infinity));
        let (coarse, fine) = (error(1e-3), error(5e-4));
        let order = (coarse / fine).log2();
        assert!(
            (order - 2.0).abs() < 0.15,
            "rho {rho_infinity}: order {order}, errors {coarse} and {fine} N"
        );
    }
}

#[test]
fn reactions_stay_smooth_when_the_step_changes() {
    let adaptive = Params {
        newton_tolerance: Some(1e-12),
        ..Params::adaptive(5e-3, 1e-8, 1e-8)
    };
    // Fixed steps of 1e-3 s leave 3e-3 N or less; steps here lie about that length.
    let error = tension_error(adaptive);
    assert!(error < 0.02, "{error} N of {} N", 3.0 * 2.0 * GRAVITY);
}

#[test]
fn a_turned_system_moves_alike_to_rounding() {
    let end = 0.5;
    let flat = finish(
        double_pendulum(UnitQuaternion::identity()),
        params(1e-3, 0.8),
        end,
    );
    // Cardan angles (0.4, 90°, -0.7): the singular position of the second one.
    let turn = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), 0.4)
        * UnitQuaternion::from_axis_angle(&Vector3::y_axis(), FRAC_PI_2)
        * UnitQuaternion::from_axis_angle(&Vector3::z_axis(), -0.7);
    let turned = finish(double_pendulum(turn), params(1e-3, 0.8), end);
    for body in 0..2 {
        let (a, b) = (flat.state(), turned.state());
        assert!((turn * a.positions_m[body] - b.positions_m[body]).norm() < 1e-10);
        assert!((turn * a.orientations[body]).angle_to(&b.orientations[body]) < 1e-10);
        assert!((spin(&flat, body) - spin(&turned, body)).norm() < 1e-9);
    }
    for (a, b) in flat.lambda().iter().zip(turned.lambda()) {
        assert!((a - b).abs() < 1e-6);
    }
}

#[test]
fn coupled_wheels_accelerate_together_over_many_turns() {
    let (radii, moments, torque) = ([0.05, 0.08], [0.01, 0.03], 2.0);
    let mut builder = System::builder();
    let mut pairs = Vec::new();
    for (index, moment) in moments.into_iter().enumerate() {
        let name = ["first", "second"][index];
        let mut body = Body::rigid(name, 1.0, [moment; 3]);
        body.position_m = Vector3::new(0.13 * index as f64, 0.0, 0.0);
        let wheel = builder.body(body).unwrap();
        let ground = Marker::ground([0.13 * index as f64, 0.0, 0.0]);
        let pair = MarkerPair {
            a: ground,
            b: Marker::at(wheel, [0.0; 3]),
        };
        builder.joint(revolute(name, pair.a, pair.b));
        pairs.push(pair);
        if index == 0 {
            let torque = TimeFunction::Constant(torque);
            builder.element(
                AppliedLoad::new(
                    "motor",
                    wheel,
                    LoadKind::Torque,
                    (Axes::World, [0.0, 0.0, 1.0]),
                    torque,
                )
                .unwrap(),
            );
        }
    }
    builder.joint(Joint::ratio(
        "mesh",
        (pairs[0], radii[0]),
        (pairs[1], radii[1]),
    ));
    let end = 4.0;
    let simulation = finish(builder.build().unwrap(), params(2e-3, 0.8), end);
    let exact = torque / (moments[0] + moments[1] * (radii[0] / radii[1]).powi(2)) * end;
    assert!((spin(&simulation, 0).z - exact).abs() < 1e-9 * exact);
    assert!((spin(&simulation, 1).z * radii[1] + exact * radii[0]).abs() < 1e-9 * exact);
    // 58 turns of the first wheel, counted.
    let angle = simulation.system().joints()[2].angle_rad();
    assert!(
        (angle - 0.5 * exact * end).abs() < 1e-8 * angle && angle > 50.0 * TAU,
        "{angle}"
    );
}

#[test]
fn prescribed_rotation_is_followed_and_its_torque_is_the_inertia_s() {
    let moment = 0.4;
    let mut builder = System::builder();
    let wheel = builder
        .body(Body::rigid("wheel", 2.0, [0.3, 0.3, moment]))
        .unwrap();
    let (a, b) = (Marker::ground([0.0; 3]), Marker::at(wheel, [0.0; 3]));
    builder.joint(revolute("axle", a, b));
    let speed = TimeFunction::step(0.0, 0.0, 1.0, 20.0).unwrap();
    builder.joint(
        Joint::new(
            "drive",
            JointKind::Rotation(Motion::Speed(speed.clone())),
            a,
            b,
        )
        .unwrap(),
    );
    let mut simulation = Simulation::new(builder.build().unwrap(), params(1e-3, 0.6)).unwrap();
    simulation
        .run(1.5, |step| {
            let f = speed.at(step.to.time_s);
            assert!((step.to.velocity[5] - f.value).abs() < 2e-4);
            // STEP's acceleration jumps in its rate at 0 s and 1 s: a few steps after those are left out.
            let settled = [0.0, 1.0]
                .iter()
                .all(|corner| !(0.0..0.03).contains(&(step.to.time_s - corner)));
            assert!(
                !settled || (step.lambda[5] + moment * f.rate).abs() < 2e-3,
                "{} {}",
                step.to.time_s,
                step.lambda[5]
            );
            ControlFlow::Continue(())
        })
        .unwrap();
    let exact = 20.0 * 0.5 + 20.0 * 0.5;
    assert!((simulation.system().joints()[1].angle_rad() - exact).abs() < 1e-10);
    // The drive's work is the kinetic energy.
    let energy = simulation.info().energy;
    assert!(
        (energy.supplied_j - 0.5 * moment * 400.0).abs() < 1e-3,
        "{energy:?}"
    );
    assert!(energy.error_j().abs() < 1e-3, "{energy:?}");
}

#[test]
fn a_bushing_that_replaces_a_joint_behaves_like_it() {
    // Steps that do not resolve the bushing (46 kHz) by far: factor 30 between the shortest and the longest.
    for step_s in [3e-3, 1e-3, 3e-4, 1e-4] {
        let system = |stiff: bool| {
            let mut body = Body::rigid("pendulum", 1.0, [0.01, 0.01, 0.01]);
            body.position_m = Vector3::new(0.0, 0.5, 0.0);
            let mut builder = System::builder();
            let id = builder.body(body).unwrap();
            let pair = MarkerPair {
                a: Marker::ground([0.0; 3]),
                b: Marker::at(id, [0.0, -0.5, 0.0]),
            };
            if stiff {
                let k = 1e10;
                let bushing = Bushing::diagonal([k, k, k, k, k, 0.0], [0.0; 6]);
                builder.element(bushing.between("hinge", pair).unwrap());
            } else {
                builder.joint(revolute("hinge", pair.a, pair.b));
            }
            builder.gravity([GRAVITY, 0.0, 0.0]);
            builder.build().unwrap()
        };
        let [soft, rigid] =
            [true, false].map(|stiff| finish(system(stiff), params(step_s, 0.5), 0.9));
        let difference = (soft.state().positions_m[0] - rigid.state().positions_m[0]).norm();
        assert!(difference < 1e-6, "step {step_s}: {difference} m");
    }
}
