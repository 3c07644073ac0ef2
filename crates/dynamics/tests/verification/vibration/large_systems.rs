//! Natural frequencies and equilibria of systems that are large enough for sparse matrices, against the dense solution
//! and closed forms.

use std::time::Instant;

use gearmesh_dynamics::elements::{AppliedLoad, Axes, BeamSection, LinearBearing, LoadKind};
use gearmesh_dynamics::{
    Body, Joint, JointKind, Marker, MarkerPair, NaturalMode, StaticParams, System, TimeFunction,
    equilibrium, natural_modes, natural_modes_up_to,
};
use nalgebra::Vector3;

use crate::vibration::{close, origin};

/// A spinning, damped shaft of stations and beams on three bearings, free to turn, with a branch on a hinge:
/// gyroscopic, with double frequencies.
fn rotor(stations: usize) -> System {
    let mut builder = System::builder();
    let section = BeamSection {
        damping_s: 2e-6,
        ..BeamSection::round(0.015, 0.0, 210e9, 0.3)
    };
    let piece = 1.2 / stations as f64;
    let mut before = None;
    for index in 0..stations {
        let mut body = Body::rigid(&format!("station {index}"), 0.15, [3e-5, 3e-5, 2e-5]);
        body.position_m.z = piece * index as f64;
        body.angular_velocity_rad_per_s.z = 300.0;
        let id = builder.body(body).unwrap();
        if index % (stations / 2 - 1) == 0 {
            let bearing = LinearBearing {
                radial_stiffness_n_per_m: 3e7,
                axial_stiffness_n_per_m: 1e7,
                tilt_stiffness_nm_per_rad: 10.0,
                radial_damping_n_s_per_m: 40.0,
                axial_damping_n_s_per_m: 20.0,
                tilt_damping_nm_s_per_rad: 0.01,
                ..LinearBearing::default()
            };
            let pair = MarkerPair {
                a: Marker::ground([0.0, 0.0, piece * index as f64]),
                b: origin(id),
            };
            builder.element(bearing.between(&format!("bearing {index}"), pair).unwrap());
        }
        if let Some(before) = before {
            let pair = MarkerPair {
                a: before,
                b: origin(id),
            };
            builder.element(
                section
                    .between(&format!("beam {index}"), pair, piece)
                    .unwrap(),
            );
        }
        before = Some(origin(id));
    }
    builder.build().unwrap()
}

fn vibrating(modes: &[NaturalMode]) -> Vec<&NaturalMode> {
    modes
        .iter()
        .filter(|mode| mode.frequency_hz() > 1.0)
        .collect()
}

/// All damped, gyroscopic modes up to a frequency are those of the dense solution, shapes included.
#[test]
fn krylov_vectors_find_the_modes_of_the_dense_solution() {
    let mut system = rotor(70);
    assert!(system.degrees_of_freedom() >= 400);
    let start = system.start().clone();
    let most_hz = 3000.0;
    let all = natural_modes(&mut system, &start).unwrap();
    let dense: Vec<&NaturalMode> = vibrating(&all)
        .into_iter()
        .filter(|mode| mode.natural_angular_frequency_rad_per_s() < std::f64::consts::TAU * most_hz)
        .collect();
    let found = natural_modes_up_to(&mut system, &start, most_hz).unwrap();
    let found = vibrating(&found);
    assert_eq!(found.len(), dense.len());
    assert!(found.len() > 20, "{}", found.len());
    for (a, b) in found.iter().zip(&dense) {
        close(
            a.angular_frequency_rad_per_s,
            b.angular_frequency_rad_per_s,
            1e-7,
        );
        let size = b.natural_angular_frequency_rad_per_s();
        assert!((a.growth_per_s - b.growth_per_s).abs() < 1e-7 * size);
        assert!(a.damping_ratio() > 0.0);
        // Forward and backward whirl differ, so shapes are unique but for their phase, which is fixed at the largest
        // entry.
        let product = |a: &NaturalMode, b: &NaturalMode| {
            let pairs = a.shape.iter().zip(&b.shape);
            let [re, im] = pairs.fold([0.0; 2], |[re, im], (x, y)| {
                [
                    re + x[0] * y[0] + x[1] * y[1],
                    im + x[0] * y[1] - x[1] * y[0],
                ]
            });
            re.hypot(im)
        };
        let likeness = product(a, b) / (product(a, a) * product(b, b)).sqrt();
        assert!(
            likeness > 1.0 - 1e-6,
            "{likeness} at {} Hz",
            a.frequency_hz()
        );
    }
}

/// n masses in a row on springs, one end free, have ω_j = 2 √(k/m) sin((2j − 1)π/(4n + 2)); the lowest are sought.
#[test]
fn modes_of_a_long_system_are_those_of_a_closed_form() {
    let (links, stiffness, mass_kg) = (400, 1e6, 0.01);
    let mut builder = System::builder();
    let mut before = Marker::ground([0.0; 3]);
    for index in 0..links {
        let mut body = Body::rigid(&format!("mass {index}"), mass_kg, [1.0; 3]);
        body.position_m.x = 0.1 * (index + 1) as f64;
        let id = builder.body(body).unwrap();
        let here = origin(id);
        let slide = [Marker::ground([0.0; 3]), here].map(|marker| marker.along([1.0, 0.0, 0.0]));
        let joint = Joint::new(
            &format!("guide {index}"),
            JointKind::Prismatic,
            slide[0],
            slide[1],
        );
        builder.joint(joint.unwrap());
        let spring = gearmesh_dynamics::elements::SpringDamper {
            stiffness_n_per_m: stiffness,
            damping_n_s_per_m: 0.0,
            free_length_m: 0.1,
        };
        let pair = MarkerPair { a: before, b: here };
        builder.element(spring.between(&format!("spring {index}"), pair).unwrap());
        before = here;
    }
    let load = AppliedLoad::new(
        "pull",
        before.body,
        LoadKind::Force { point_m: [0.0; 3] },
        (Axes::World, [1.0, 0.0, 0.0]),
        TimeFunction::Constant(50.0),
    );
    builder.element(load.unwrap());
    let mut system = builder.build().unwrap();
    let start = system.start().clone();
    let clock = Instant::now();
    let found = equilibrium(&mut system, &start, &StaticParams::default()).unwrap();
    for (index, place) in found.state.positions_m.iter().enumerate() {
        let stretched = (index + 1) as f64 * (0.1 + 50.0 / stiffness);
        assert!((place - Vector3::new(stretched, 0.0, 0.0)).norm() < 1e-9 * stretched);
    }
    assert!(found.held.is_empty());
    let modes = natural_modes_up_to(&mut system, &found.state, 300.0).unwrap();
    assert!(modes.len() > 20);
    for (j, mode) in modes.iter().enumerate() {
        let half = (2 * j + 1) as f64 * std::f64::consts::PI / (4 * links + 2) as f64;
        let omega = 2.0 * (stiffness / mass_kg).sqrt() * half.sin();
        close(mode.angular_frequency_rad_per_s, omega, 1e-8);
        assert_eq!(mode.growth_per_s, 0.0);
    }
    // Dense matrices of 4400 unknowns would take many minutes.
    assert!(clock.elapsed().as_secs() < 60);
}
