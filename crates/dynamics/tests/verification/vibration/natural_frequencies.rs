//! Discs on torsion springs and a spinning rotor.

use crate::vibration::{close, origin};
use gearmesh_dynamics::elements::{LinearBearing, TorsionSpring};
use gearmesh_dynamics::{
    Body, Joint, JointKind, Marker, MarkerPair, State, System, SystemBuilder, natural_modes,
};
use nalgebra::{UnitQuaternion, Vector3};
use std::f64::consts::PI;

fn on_axle(builder: &mut SystemBuilder, name: &str, moment: f64) -> MarkerPair {
    let wheel = builder.body(Body::rigid(name, 1.0, [moment; 3])).unwrap();
    let pair = MarkerPair {
        a: Marker::ground([0.0; 3]),
        b: origin(wheel),
    };
    builder.joint(Joint::new(name, JointKind::Revolute, pair.a, pair.b).unwrap());
    pair
}

#[test]
fn two_discs_on_a_torsion_spring_have_their_closed_form() {
    let (first, second, stiffness, damping) = (0.02, 0.05, 3e4, 1.5);
    for damping in [0.0, damping] {
        let mut builder = System::builder();
        let a = on_axle(&mut builder, "a", first).b;
        let b = on_axle(&mut builder, "b", second).b;
        let spring = TorsionSpring::new(stiffness, damping);
        builder.element(spring.between("shaft", MarkerPair { a, b }).unwrap());
        let mut system = builder.build().unwrap();
        let start = system.start().clone();
        let modes = natural_modes(&mut system, &start).unwrap();
        let reduced = 1.0 / (1.0 / first + 1.0 / second);
        let omega = (stiffness / reduced).sqrt();
        let top = modes.last().unwrap();
        close(top.natural_angular_frequency_rad_per_s(), omega, 1e-9);
        let ratio = damping / (2.0 * reduced * omega);
        assert!((top.damping_ratio() - ratio).abs() < 1e-9);
        assert!(modes[0].natural_angular_frequency_rad_per_s() < 1e-3);
        // Opposite rotations about z in the ratio of the moments.
        close(top.shape[5][0] / top.shape[11][0], -second / first, 1e-9);
    }
}

#[test]
fn a_sliding_pair_with_a_ratio_has_the_frequency_of_its_equivalent_mass() {
    // Two wheels coupled by a ratio, the first on a torsion spring to ground.
    let (moments, radii, stiffness) = ([0.02, 0.05], [0.03, 0.07], 800.0);
    let mut builder = System::builder();
    let a = on_axle(&mut builder, "a", moments[0]);
    let b = on_axle(&mut builder, "b", moments[1]);
    builder.joint(Joint::ratio("ratio", (a, radii[0]), (b, radii[1])));
    builder.element(
        TorsionSpring::new(stiffness, 0.0)
            .between("spring", a)
            .unwrap(),
    );
    let mut system = builder.build().unwrap();
    let start = system.start().clone();
    let modes = natural_modes(&mut system, &start).unwrap();
    assert_eq!(modes.len(), 1);
    let equivalent = moments[0] + moments[1] * (radii[0] / radii[1]).powi(2);
    close(
        modes[0].natural_angular_frequency_rad_per_s(),
        (stiffness / equivalent).sqrt(),
        1e-9,
    );
}

/// A rotor on a bearing that resists tilt, spinning about z.
fn rotor(spin: f64, turned: UnitQuaternion<f64>) -> (System, State) {
    let mut body = Body::rigid("rotor", 1.0, [0.03, 0.03, 0.05]);
    body.orientation = turned * UnitQuaternion::from_axis_angle(&Vector3::z_axis(), 0.8);
    body.angular_velocity_rad_per_s = Vector3::new(0.0, 0.0, spin);
    let mut builder = System::builder();
    let id = builder.body(body).unwrap();
    let bearing = LinearBearing {
        radial_stiffness_n_per_m: 4e5,
        axial_stiffness_n_per_m: 9e5,
        tilt_stiffness_nm_per_rad: 300.0,
        ..LinearBearing::default()
    };
    let pair = MarkerPair {
        a: Marker::ground([0.0; 3]).oriented(turned),
        b: origin(id),
    };
    builder.element(bearing.between("bearing", pair).unwrap());
    let system = builder.build().unwrap();
    let state = system.start().clone();
    (system, state)
}

#[test]
fn a_spinning_rotor_has_forward_and_backward_whirl() {
    for turned in [
        UnitQuaternion::identity(),
        UnitQuaternion::from_euler_angles(0.0, PI / 2.0, 0.3),
    ] {
        let spin = 150.0;
        let (mut system, state) = rotor(spin, turned);
        let found: Vec<f64> = natural_modes(&mut system, &state)
            .unwrap()
            .iter()
            .map(|mode| mode.angular_frequency_rad_per_s)
            .collect();
        // across ω² ∓ axial Ω ω − k = 0
        let (across, gyroscopic, k) = (0.03, 0.05 * spin, 300.0);
        let root = (gyroscopic * gyroscopic + 4.0 * across * k).sqrt();
        let [forward, backward] =
            [1.0, -1.0].map(|sign| (sign * gyroscopic + root) / (2.0 * across));
        for exact in [forward, backward, 4e5_f64.sqrt(), 9e5_f64.sqrt()] {
            assert!(
                found
                    .iter()
                    .any(|omega| (omega - exact).abs() < 1e-8 * exact),
                "{exact} not in {found:?}"
            );
        }
    }
}
