//! A chain of alike links on revolute joints with parallel axes, released level: as many bodies as wanted, two joints
//! to a body.

use gearmesh_dynamics::{Body, GROUND, Joint, JointKind, Marker, System};
use nalgebra::Vector3;

/// Length of a link \[m\].
pub const LINK_M: f64 = 0.1;

/// The chain; its first link hangs on the ground. Links are rods of 0.1 kg, 10 mm thick.
pub fn system(links: usize) -> System {
    let mut builder = System::builder();
    builder.gravity([0.0, -9.81, 0.0]);
    let mass_kg = 0.1;
    let across = mass_kg * LINK_M * LINK_M / 12.0;
    let mut before = GROUND;
    for link in 0..links {
        let mut body = Body::rigid(&format!("link {link}"), mass_kg, [1e-6, across, across]);
        body.position_m = Vector3::new((link as f64 + 0.5) * LINK_M, 0.0, 0.0);
        let id = builder.body(body).unwrap();
        let end = if link == 0 { 0.0 } else { 0.5 * LINK_M };
        builder.joint(
            Joint::new(
                &format!("joint {link}"),
                JointKind::Revolute,
                Marker::at(before, [end, 0.0, 0.0]),
                Marker::at(id, [-0.5 * LINK_M, 0.0, 0.0]),
            )
            .unwrap(),
        );
        before = id;
    }
    builder.build().unwrap()
}
