//! Timoshenko beams between bodies: bending, torsion, stretch, and a spinning shaft.

use crate::vibration::{close, origin};
use gearmesh_dynamics::elements::{AppliedLoad, Axes, BeamSection, LinearBearing, LoadKind};
use gearmesh_dynamics::{
    Body, BodyId, Marker, MarkerPair, Params, Simulation, StaticParams, System, SystemBuilder,
    TimeFunction, equilibrium, natural_modes,
};
use nalgebra::Vector3;
use std::ops::ControlFlow;

fn shaft() -> BeamSection {
    BeamSection::round(0.015, 0.0, 210e9, 0.3)
}

/// A cantilever of some beams in a row, a body at every joint of them.
fn cantilever(pieces: usize, length: f64, tip: Body) -> (SystemBuilder, BodyId) {
    let mut builder = System::builder();
    let mut before = Marker::ground([0.0; 3]);
    let piece = length / pieces as f64;
    for index in 1..=pieces {
        let mut body = if index == pieces {
            tip.clone()
        } else {
            Body::rigid(&format!("station {index}"), 1e-6, [1e-9; 3])
        };
        body.position_m = Vector3::new(0.0, 0.0, piece * index as f64);
        let id = builder.body(body).unwrap();
        let pair = MarkerPair {
            a: before,
            b: origin(id),
        };
        builder.element(
            shaft()
                .between(&format!("beam {index}"), pair, piece)
                .unwrap(),
        );
        before = pair.b;
        if index == pieces {
            return (builder, id);
        }
    }
    unreachable!("there is at least one piece")
}

#[test]
fn a_cantilever_bends_and_shears_as_timoshenko_says() {
    let (length, force): (f64, f64) = (0.2, 1.0);
    let s = shaft();
    let (ei, kga) = (
        s.youngs_modulus_pa * s.second_moment_x_m4,
        s.shear_factor * s.shear_modulus_pa * s.area_m2,
    );
    let deflection = force * (length.powi(3) / (3.0 * ei) + length / kga);
    let slope = force * length * length / (2.0 * ei);
    for pieces in [1, 4] {
        for (axis, other, sign) in [(0, 1, 1.0), (1, 0, -1.0)] {
            let (mut builder, tip) = cantilever(pieces, length, Body::rigid("tip", 1.0, [1e-3; 3]));
            let mut direction = [0.0; 3];
            direction[axis] = 1.0;
            let load = AppliedLoad::new(
                "pull",
                tip,
                LoadKind::Force { point_m: [0.0; 3] },
                (Axes::World, direction),
                TimeFunction::Constant(force),
            );
            builder.element(load.unwrap());
            let mut system = builder.build().unwrap();
            let start = system.start().clone();
            let found = equilibrium(&mut system, &start, &StaticParams::default()).unwrap();
            assert!(found.held.is_empty(), "{:?}", found.held);
            let body = pieces - 1;
            // Large-deflection terms are of the order of slope², 1e-11 here.
            close(found.state.positions_m[body][axis], deflection, 1e-8);
            close(
                found.state.orientations[body].scaled_axis()[other],
                sign * slope,
                1e-8,
            );
        }
    }
}

#[test]
fn a_disc_on_a_shaft_has_its_bending_torsion_and_stretch_frequencies() {
    let (length, mass, across, axial): (f64, f64, f64, f64) = (0.2, 3.0, 4e-3, 7e-3);
    let s = shaft();
    for pieces in [1, 3] {
        let (builder, _) = cantilever(
            pieces,
            length,
            Body::rigid("disc", mass, [across, across, axial]),
        );
        let mut system = builder.build().unwrap();
        let start = system.start().clone();
        let found: Vec<f64> = natural_modes(&mut system, &start)
            .unwrap()
            .iter()
            .map(|mode| mode.natural_angular_frequency_rad_per_s())
            .collect();
        let (ei, kga) = (
            s.youngs_modulus_pa * s.second_moment_x_m4,
            s.shear_factor * s.shear_modulus_pa * s.area_m2,
        );
        // Compliance [a b; b d] of the tip; (K − ω² M) singular ⇔ 1/ω² eigenvalue of compliance · mass.
        let (a, b, d) = (
            length.powi(3) / (3.0 * ei) + length / kga,
            length * length / (2.0 * ei),
            length / ei,
        );
        let (trace, det) = (a * mass + d * across, (a * d - b * b) * mass * across);
        let root = (trace * trace / 4.0 - det).sqrt();
        let torsion = (s.shear_modulus_pa * s.torsion_constant_m4 / (length * axial)).sqrt();
        let stretch = (s.youngs_modulus_pa * s.area_m2 / (length * mass)).sqrt();
        for exact in [
            (1.0 / (trace / 2.0 + root)).sqrt(),
            (det.recip() * (trace / 2.0 + root)).sqrt(),
            torsion,
            stretch,
        ] {
            let nearest = found
                .iter()
                .fold(f64::INFINITY, |near, omega| near.min((omega - exact).abs()));
            // The stations between carry 1e-6 kg and 1e-9 kg m².
            assert!(
                nearest < 1e-6 * exact,
                "{pieces} pieces: {exact} not in {found:?}"
            );
        }
    }
}

#[test]
fn a_shaft_spins_with_its_beams_without_straining_them() {
    let mut builder = System::builder();
    let mut previous: Option<BodyId> = None;
    for index in 0..3 {
        let mut body = Body::rigid(&format!("disc {index}"), 1.0, [1e-3; 3]);
        body.position_m = Vector3::new(0.0, 0.0, 0.1 * f64::from(index));
        body.angular_velocity_rad_per_s = Vector3::new(0.0, 0.0, 300.0);
        let id = builder.body(body).unwrap();
        if let Some(before) = previous {
            let pair = MarkerPair {
                a: origin(before),
                b: origin(id),
            };
            builder.element(
                shaft()
                    .between(&format!("beam {index}"), pair, 0.1)
                    .unwrap(),
            );
        }
        let bearing = LinearBearing {
            radial_stiffness_n_per_m: 1e8,
            axial_stiffness_n_per_m: 1e8,
            ..LinearBearing::default()
        };
        let housing = Marker::ground([0.0, 0.0, 0.1 * f64::from(index)]);
        builder.element(
            bearing
                .between(
                    &format!("bearing {index}"),
                    MarkerPair {
                        a: housing,
                        b: origin(id),
                    },
                )
                .unwrap(),
        );
        previous = Some(id);
    }
    let mut simulation = Simulation::new(builder.build().unwrap(), Params::fixed(1e-4)).unwrap();
    // 24 turns.
    simulation.run(0.5, |_| ControlFlow::Continue(())).unwrap();
    let energy = simulation.info().energy;
    assert!(energy.last.potential_j < 1e-12, "{energy:?}");
    close(
        energy.last.kinetic_j,
        3.0 * 0.5 * 1e-3 * 300.0 * 300.0,
        1e-10,
    );
}
