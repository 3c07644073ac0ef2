//! Two wheels on linear bearings, a stiff spring and damper between points of their rims, a torque on the first and a brake on the
//! second: the smallest system that looks like a pair of wheels in mesh, twelve degrees of freedom.

use gearmesh_dynamics::elements::{AppliedLoad, Axes, Bushing, LinearBearing, LoadKind};
use gearmesh_dynamics::{Body, Marker, MarkerPair, System, TimeFunction};
use nalgebra::{UnitQuaternion, Vector3};

/// Distance of the axes \[m\].
const DISTANCE: f64 = 0.15;

/// The system, its wheels held together by a six-component spring, on bearings that resist all but their spin.
pub fn system() -> System {
    let mut builder = System::builder();
    let mut rims = Vec::new();
    for (index, name) in ["first", "second"].into_iter().enumerate() {
        let mut body = Body::rigid(name, 2.0, [3.2e-3, 3.2e-3, 6e-3]);
        body.position_m = Vector3::new(DISTANCE * index as f64, 0.0, 0.0);
        let wheel = builder.body(body).unwrap();
        let bearing = LinearBearing {
            radial_stiffness_n_per_m: 2e8,
            axial_stiffness_n_per_m: 1e8,
            tilt_stiffness_nm_per_rad: 1e5,
            radial_damping_n_s_per_m: 2e3,
            axial_damping_n_s_per_m: 1e3,
            tilt_damping_nm_s_per_rad: 1.0,
        };
        let pair = MarkerPair {
            a: Marker::ground([DISTANCE * index as f64, 0.0, 0.0]),
            b: Marker::at(wheel, [0.0; 3]),
        };
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
        let side = if index == 0 { 0.5 } else { -0.5 };
        rims.push(
            Marker::at(wheel, [side * DISTANCE, 0.0, 0.0]).oriented(UnitQuaternion::identity()),
        );
    }
    let mesh = Bushing::diagonal(
        [1e7, 4e8, 1e7, 1e3, 1e3, 1e3],
        [1e2, 2e3, 1e2, 0.1, 0.1, 0.1],
    );
    let pair = MarkerPair {
        a: rims[0],
        b: rims[1],
    };
    builder.element(mesh.between("mesh", pair).unwrap());
    builder.build().unwrap()
}
