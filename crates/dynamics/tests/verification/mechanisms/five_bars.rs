//! Five bars of two parallelograms in a row, released upright: three cranks on the ground, two couplers between their
//! ends. They turn round and round, and whenever all lie in one line the joints are singular and other motions branch
//! off.
//!
//! Reference: M. González, D. Dopico, U. Lugrís, J. Cuadrado, *A benchmarking system for MBS simulation software*,
//! Multibody Syst. Dyn. 16 (2006) 179-190 (double four-bar mechanism). Bars of 1 m and 1 kg, gravity 9.81 m/s², the
//! ends of the cranks at 1 m/s at first.
//!
//! On the branch of the parallelograms it is one pendulum: with the angle θ of the cranks from the horizontal
//! T = ½ (3 · ⅓ + 2) m l² θ̇², V = (3 · ½ + 2) m g l sin θ, so that θ̈ = −(7/6) (g/l) cos θ.

use std::ops::ControlFlow;

use gearmesh_dynamics::{Body, BodyId, Joint, JointKind, Marker, Params, Simulation, System};
use nalgebra::{UnitQuaternion, Vector3};

const GRAVITY: f64 = 9.81;
const END_S: f64 = 10.0;

fn mechanism() -> System {
    let mut builder = System::builder();
    // Angle, place of the first end.
    let upright = std::f64::consts::FRAC_PI_2;
    let parts = [
        ("crank 0", upright, [0.0, 0.0]),
        ("crank 1", upright, [1.0, 0.0]),
        ("crank 2", upright, [2.0, 0.0]),
        ("coupler 0", 0.0, [0.0, 1.0]),
        ("coupler 1", 0.0, [1.0, 1.0]),
    ];
    let ids: Vec<BodyId> = parts
        .iter()
        .map(|(name, angle, [x, y])| {
            let mut bar = Body::rigid(name, 1.0, [1e-3, 1.0 / 12.0, 1.0 / 12.0]);
            bar.center_of_mass_m = Vector3::new(0.5, 0.0, 0.0);
            bar.position_m = Vector3::new(*x, *y, 0.0);
            bar.orientation = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), *angle);
            if *angle == upright {
                bar.angular_velocity_rad_per_s.z = -1.0;
            } else {
                bar.velocity_m_per_s.x = 1.0;
            }
            builder.body(bar).unwrap()
        })
        .collect();
    let on = |bar: usize, x: f64| Marker::at(ids[bar], [x, 0.0, 0.0]);
    let hinges = [
        ("A0", Marker::ground([0.0; 3]), on(0, 0.0)),
        ("A1", Marker::ground([1.0, 0.0, 0.0]), on(1, 0.0)),
        ("A2", Marker::ground([2.0, 0.0, 0.0]), on(2, 0.0)),
        ("B0", on(0, 1.0), on(3, 0.0)),
        ("B1", on(1, 1.0), on(3, 1.0)),
        ("C1", on(1, 1.0), on(4, 0.0)),
        ("C2", on(2, 1.0), on(4, 1.0)),
    ];
    for (name, a, b) in hinges {
        builder.joint(Joint::new(name, JointKind::Revolute, a, b).unwrap());
    }
    builder.gravity([0.0, -GRAVITY, 0.0]);
    builder.build().unwrap()
}

/// θ at the end, by the classical Runge-Kutta method with steps of 10 µs: an error below 1e-12.
fn angle_at_end() -> f64 {
    let slope = |[angle, rate]: [f64; 2]| [rate, -7.0 / 6.0 * GRAVITY * angle.cos()];
    let moved = |at: [f64; 2], by: [f64; 2], h: f64| [at[0] + h * by[0], at[1] + h * by[1]];
    let (h, mut at) = (1e-5, [std::f64::consts::FRAC_PI_2, -1.0]);
    for _ in 0..(END_S / h).round() as usize {
        let a = slope(at);
        let b = slope(moved(at, a, 0.5 * h));
        let c = slope(moved(at, b, 0.5 * h));
        let d = slope(moved(at, c, h));
        at = std::array::from_fn(|i| at[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
    }
    at[0]
}

/// Place of the end of crank 0 at the end of the run.
fn finish(params: Params) -> Vector3<f64> {
    let mut run = Simulation::new(mechanism(), params).unwrap();
    run.run(END_S, |_| ControlFlow::Continue(())).unwrap();
    assert!((run.state().time_s - END_S).abs() < 1e-9);
    run.state().orientations[0] * Vector3::x()
}

/// Second order with the defaults, and an iteration error ten times below the step's own.
#[test]
fn five_bars_pass_their_straight_position_with_the_second_order() {
    assert_eq!(
        mechanism()
            .redundant()
            .iter()
            .map(|r| r.equations)
            .sum::<usize>(),
        6
    );
    let angle = angle_at_end();
    let exact = Vector3::new(angle.cos(), angle.sin(), 0.0);
    let mut errors = Vec::new();
    for step_s in [2e-3, 1e-3, 5e-4] {
        let found = finish(Params::fixed(step_s));
        let iterated = finish(Params {
            newton_tolerance: Some(1e-14),
            ..Params::fixed(step_s)
        });
        let [error, of_iteration] = [found - exact, found - iterated].map(|x| x.norm());
        errors.push((error, of_iteration));
    }
    for (error, of_iteration) in &errors {
        assert!(10.0 * of_iteration < *error, "{errors:?}");
    }
    for pair in errors.windows(2) {
        let order = (pair[0].0 / pair[1].0).log2();
        assert!((order - 2.0).abs() < 0.1, "order {order}: {errors:?}");
    }
}
