//! Teeth that are apart, and how far the tooth thickness leaves them.

use crate::conformance::{DAMPINGS, damped, friction, rates};
use crate::mesh_common::*;
use gearmesh_drivetrain::*;
use gearmesh_geometry::Flank;
use nalgebra::Vector3;

#[test]
fn nothing_acts_on_teeth_that_are_apart() {
    for pair in pairs() {
        let backlash = pair.backlash_m() * pair.working_pressure_angle_rad.cos();
        for name in CONFORMING {
            for damping in DAMPINGS {
                let mut mesh = damped(name, &pair, damping).with_friction(friction());
                for k in 0..20 {
                    let theta = 0.05 * f64::from(k);
                    let phi = angles(&pair, Flank::Right, theta, 0.5 * backlash);
                    let apart = pose(&pair, phi, Vector3::zeros(), Vector3::zeros());
                    let closing = moving(&apart, &rates(3));
                    let load = mesh.evaluate(&closing, true).unwrap();
                    assert_eq!(load, MeshLoad::default(), "{name} at {theta}");
                }
            }
        }
    }
}

/// Loaded on the right, loaded on the left, and free over exactly the backlash between.
#[test]
fn backlash_is_what_the_tooth_thickness_leaves() {
    for pair in pairs() {
        let backlash = pair.backlash_m() * pair.working_pressure_angle_rad.cos();
        for name in CONFORMING {
            let mut mesh = mesh(name, &pair, kinematics(&pair));
            for theta in [0.03, 0.12] {
                let mut moment = |te: f64| {
                    let phi = angles(&pair, Flank::Right, theta, te);
                    let at = pose(&pair, phi, Vector3::zeros(), Vector3::zeros());
                    mesh.evaluate(&at, false).unwrap().load[5]
                };
                let depth = 5e-6;
                assert!(moment(-depth) > 0.0, "{name}: right flanks turn gear 2 on");
                assert!(
                    moment(backlash + depth) < 0.0,
                    "{name}: left flanks hold it back"
                );
                assert_eq!(moment(1e-9), 0.0, "{name}");
                assert_eq!(moment(backlash - 1e-9), 0.0, "{name}");
            }
        }
    }
}

/// The transmission error of the flanks in contact, right or left; between both of the nearer ones.
#[test]
fn transmission_error_is_that_of_the_flanks_in_contact() {
    for pair in pairs() {
        let backlash = pair.backlash_m() * pair.working_pressure_angle_rad.cos();
        for name in CONFORMING {
            let mut mesh = mesh(name, &pair, kinematics(&pair));
            for side in [Flank::Right, Flank::Left] {
                for te in [-10e-6, 0.0, 3e-6, 0.4 * backlash, 0.6 * backlash] {
                    let phi = angles(&pair, side, 0.17, te);
                    let at = pose(&pair, phi, Vector3::zeros(), Vector3::zeros());
                    mesh.evaluate(&at, false).unwrap();
                    let found = mesh.transmission_error_m().unwrap();
                    let expected = te.min(backlash - te);
                    assert!((found - expected).abs() < 1e-14, "{name} {side:?} {te:e}");
                }
            }
        }
    }
}
