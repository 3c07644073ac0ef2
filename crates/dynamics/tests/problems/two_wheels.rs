//! Two wheels on linear bearings, coupled, with torques: the smallest system that looks like a pair of wheels in mesh,
//! twelve degrees of freedom.

use gearmesh_dynamics::elements::{AppliedLoad, Axes, Bushing, LinearBearing, LoadKind};
use gearmesh_dynamics::{Body, Joint, Marker, MarkerPair, System, TimeFunction};
use nalgebra::Vector3;

/// Distance of the axes \[m\].
const DISTANCE: f64 = 0.15;

/// What holds the wheels together.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Coupling {
    /// A six-component spring between their rims: they stand and quiver.
    Spring,
    /// A ratio of their angles: they spin at 600 rpm.
    Ratio,
}

/// The system on bearings that resist all but the spin.
pub fn system(coupling: Coupling) -> System {
    let mut builder = System::builder();
    let (mut rims, mut axles) = (Vec::new(), Vec::new());
    for (index, name) in ["first", "second"].into_iter().enumerate() {
        let side = if index == 0 { 1.0 } else { -1.0 };
        let mut body = Body::rigid(name, 2.0, [3.2e-3, 3.2e-3, 6e-3]);
        body.position_m = Vector3::new(DISTANCE * index as f64, 0.0, 0.0);
        if coupling == Coupling::Ratio {
            body.angular_velocity_rad_per_s.z = side * 600.0 / 60.0 * std::f64::consts::TAU;
        }
        let wheel = builder.body(body).unwrap();
        let bearing = LinearBearing {
            radial_stiffness_n_per_m: 2e8,
            axial_stiffness_n_per_m: 1e8,
            tilt_stiffness_nm_per_rad: 1e5,
            radial_damping_n_s_per_m: 2e3,
            axial_damping_n_s_per_m: 1e3,
            tilt_damping_nm_s_per_rad: 1.0,
            ..LinearBearing::default()
        };
        let pair = MarkerPair {
            a: Marker::ground([DISTANCE * index as f64, 0.0, 0.0]),
            b: Marker::at(wheel, [0.0; 3]),
        };
        axles.push(pair);
        builder.element(
            bearing
                .between(&format!("bearing of {name}"), pair)
                .unwrap(),
        );
        let torque = TimeFunction::Sine {
            offset: 100.0,
            amplitude: 50.0,
            frequency_hz: 30.0,
            phase_rad: 0.0,
        };
        let load = AppliedLoad::new(
            &format!("torque on {name}"),
            wheel,
            LoadKind::Torque,
            (Axes::World, [0.0, 0.0, 1.0]),
            torque,
        );
        builder.element(load.unwrap());
        rims.push(Marker::at(wheel, [0.5 * side * DISTANCE, 0.0, 0.0]));
    }
    match coupling {
        Coupling::Spring => {
            let mesh = Bushing::diagonal(
                [1e7, 4e8, 1e7, 1e3, 1e3, 1e3],
                [1e2, 2e3, 1e2, 0.1, 0.1, 0.1],
            );
            let pair = MarkerPair {
                a: rims[0],
                b: rims[1],
            };
            builder.element(mesh.between("mesh", pair).unwrap());
        }
        Coupling::Ratio => {
            builder.joint(Joint::ratio("mesh", (axles[0], 1.0), (axles[1], 1.0)));
        }
    }
    builder.gravity([0.0, -9.81, 0.0]);
    builder.build().unwrap()
}
