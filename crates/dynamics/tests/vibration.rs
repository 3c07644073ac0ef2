//! Natural frequencies, beams, modal bodies and parametric excitation against closed forms.
#![allow(clippy::unwrap_used)] // test code

use std::f64::consts::{PI, TAU};
use std::ops::ControlFlow;

use gearmesh_dynamics::elements::{
    AppliedLoad, Axes, BeamSection, LinearBearing, LoadKind, SpringDamper, TorsionSpring,
};
use gearmesh_dynamics::{
    Body, BodyId, ElementFailure, ForceElement, GROUND, Joint, JointKind, Loads, Marker,
    MarkerPair, Modes, Params, Simulation, State, StaticParams, System, SystemBuilder,
    TimeFunction, View, equilibrium, natural_modes,
};
use nalgebra::{DMatrix, UnitQuaternion, Vector3};

fn origin(body: BodyId) -> Marker {
    Marker::at(body, [0.0; 3])
}

fn on_axle(builder: &mut SystemBuilder, name: &str, moment: f64) -> MarkerPair {
    let wheel = builder.body(Body::rigid(name, 1.0, [moment; 3])).unwrap();
    let pair = MarkerPair {
        a: Marker::ground([0.0; 3]),
        b: origin(wheel),
    };
    builder.joint(Joint::new(name, JointKind::Revolute, pair.a, pair.b).unwrap());
    pair
}

fn close(found: f64, exact: f64, tolerance: f64) {
    assert!(
        (found - exact).abs() <= tolerance * exact.abs(),
        "{found} instead of {exact}"
    );
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

/// A spring along x whose stiffness jumps between two values, half a period each: an element as another crate would write it.
struct SquareWaveSpring {
    body: [BodyId; 1],
    stiffness: [f64; 2],
    half_period: f64,
    /// Jumps lie in the middle of steps.
    shift: f64,
}

impl ForceElement for SquareWaveSpring {
    fn name(&self) -> &str {
        "square wave"
    }

    fn bodies(&self) -> &[BodyId] {
        &self.body
    }

    fn evaluate(&mut self, view: &View<'_>, loads: &mut Loads) -> Result<(), ElementFailure> {
        let half = ((view.time_s + self.shift) / self.half_period).floor() as i64;
        let k = self.stiffness[half.rem_euclid(2) as usize];
        loads.add_force(0, &[-k * view.body(self.body[0]).position_m.x]);
        if loads.wants_tangents() {
            loads.add_by_position(0, 0, -k);
        }
        Ok(())
    }
}

/// Trace of the map over one period, by simulation.
fn trace(stiffness: [f64; 2], period: f64) -> f64 {
    let steps = 400;
    let step_s = period / f64::from(steps);
    let run = |x: f64, v: f64| {
        let mut body = Body::rigid("mass", 1.0, [1.0; 3]);
        body.position_m.x = x;
        body.velocity_m_per_s.x = v;
        let mut builder = System::builder();
        let id = builder.body(body).unwrap();
        builder.joint(
            Joint::new(
                "slide",
                JointKind::Prismatic,
                Marker::ground([0.0; 3]).along([1.0, 0.0, 0.0]),
                origin(id).along([1.0, 0.0, 0.0]),
            )
            .unwrap(),
        );
        builder.element(SquareWaveSpring {
            body: [id],
            stiffness,
            half_period: period / 2.0,
            shift: -0.5 * step_s,
        });
        let params = Params {
            rho_infinity: 1.0,
            ..Params::fixed(step_s)
        };
        let mut simulation = Simulation::new(builder.build().unwrap(), params).unwrap();
        simulation
            .run(period, |_| ControlFlow::Continue(()))
            .unwrap();
        (
            simulation.state().positions_m[0].x,
            simulation.state().velocity[0],
        )
    };
    run(1.0, 0.0).0 + run(0.0, 1.0).1
}

#[test]
fn a_square_wave_stiffness_is_unstable_where_meissner_says() {
    // ẍ + (δ ± ε) x = 0 with period 2π, ε = 0.4: unstable where the trace of the map exceeds 2 in magnitude. The first three
    // regions lie at δ = 1/4, 1 and 9/4; the second is narrow for half-and-half waves.
    let epsilon = 0.4;
    let exact = |delta: f64| {
        let [a, b] = [delta + epsilon, delta - epsilon].map(f64::sqrt);
        let (sa, ca) = (a * PI).sin_cos();
        let (sb, cb) = (b * PI).sin_cos();
        2.0 * ca * cb - (a / b + b / a) * sa * sb
    };
    let simulated = |delta: f64| trace([delta + epsilon, delta - epsilon], TAU);
    let border = |f: &dyn Fn(f64) -> f64, mut low: f64, mut high: f64| {
        let excess = |delta: f64| f(delta).abs() - 2.0;
        let sign = excess(low).signum();
        for _ in 0..30 {
            let middle = 0.5 * (low + high);
            if excess(middle).signum() == sign {
                low = middle
            } else {
                high = middle
            }
        }
        0.5 * (low + high)
    };
    for (inside, outside) in [(0.45, 0.7), (2.25, 2.1), (2.25, 2.4)] {
        assert!(
            exact(inside).abs() > 2.0 && exact(outside).abs() < 2.0,
            "{} {}",
            exact(inside),
            exact(outside)
        );
        let (found, closed) = (
            border(&simulated, inside, outside),
            border(&exact, inside, outside),
        );
        assert!(
            (found - closed).abs() < 1e-3,
            "border between {inside} and {outside}: {found} instead of {closed}"
        );
    }
    for delta in [0.6, 1.0, 1.5, 2.25, 3.0] {
        assert!((simulated(delta) - exact(delta)).abs() < 5e-3, "{delta}");
    }
}

/// A body whose mode is a mass on a spring along x: total mass 2 kg, of which 0.5 kg swing.
fn modal_body(damping_ratio: f64) -> Body {
    let (total, swinging, stiffness): (f64, f64, f64) = (2.0, 0.5, 800.0);
    let mut body = Body::rigid("modal", total, [0.2, 0.3, 0.25]);
    body.modes = Some(Modes {
        angular_frequency_rad_per_s: vec![(stiffness / swinging).sqrt()],
        damping_ratio: vec![damping_ratio],
        coupling: DMatrix::from_row_slice(1, 6, &[swinging.sqrt(), 0.0, 0.0, 0.0, 0.0, 0.0]),
    });
    body
}

#[test]
fn a_modal_body_rings_like_the_two_masses_it_stands_for() {
    let mut builder = System::builder();
    builder.body(modal_body(0.0)).unwrap();
    let mut system = builder.build().unwrap();
    let start = system.start().clone();
    let modes = natural_modes(&mut system, &start).unwrap();
    let exact = (800.0_f64 * (1.0 / 0.5 + 1.0 / 1.5)).sqrt();
    close(
        modes.last().unwrap().natural_angular_frequency_rad_per_s(),
        exact,
        1e-9,
    );
    assert!(modes[modes.len() - 2].natural_angular_frequency_rad_per_s() < 1e-6);
}

#[test]
fn a_tumbling_modal_body_keeps_momentum_and_energy() {
    let run = |steps: usize, boost: f64| {
        let mut body = modal_body(0.0);
        body.angular_velocity_rad_per_s = Vector3::new(1.0, 2.0, 0.5);
        body.velocity_m_per_s = Vector3::new(0.3 + boost, 0.0, 0.0);
        let mut builder = System::builder();
        builder.body(body).unwrap();
        let system = builder.build().unwrap();
        let mut start = system.start().clone();
        start.modal[0] = 0.02;
        let params = Params {
            rho_infinity: 1.0,
            newton_tolerance: 1e-12,
            ..Params::fixed(1.0 / steps as f64)
        };
        let mut simulation = Simulation::from_state(system, start, params).unwrap();
        simulation.run(1.0, |_| ControlFlow::Continue(())).unwrap();
        simulation
    };
    let [coarse, fine] = [1000, 2000].map(|steps| run(steps, 0.0).info().energy.largest_error_j);
    assert!(
        ((coarse / fine).log2() - 2.0).abs() < 0.1,
        "{coarse} {fine}"
    );
    // An observer who moves along sees the same.
    let (still, moving) = (run(1000, 0.0), run(1000, 5.0));
    let shift = moving.state().positions_m[0] - still.state().positions_m[0];
    assert!(
        (shift - Vector3::new(5.0, 0.0, 0.0)).norm() < 1e-9,
        "{shift}"
    );
    let difference = moving.state().modal[0] - still.state().modal[0];
    assert!(difference.abs() < 1e-8, "{difference}");
}

#[test]
fn the_energy_of_a_damped_vibration_is_all_accounted_for() {
    let error = |steps: usize| {
        let mut builder = System::builder();
        let mut body = modal_body(0.05);
        body.velocity_m_per_s.x = 1.0;
        let id = builder.body(body).unwrap();
        let spring = SpringDamper {
            stiffness_n_per_m: 500.0,
            damping_n_s_per_m: 3.0,
            free_length_m: 0.0,
        };
        let pair = MarkerPair {
            a: Marker::at(GROUND, [-0.3, 0.0, 0.0]),
            b: origin(id),
        };
        builder.element(spring.between("spring", pair).unwrap());
        let pull = TimeFunction::Sine {
            offset: 1.0,
            amplitude: 20.0,
            frequency_hz: 3.0,
            phase_rad: 0.0,
        };
        builder.element(
            AppliedLoad::new(
                "pull",
                id,
                LoadKind::Force { point_m: [0.0; 3] },
                (Axes::World, [1.0, 0.0, 0.0]),
                pull,
            )
            .unwrap(),
        );
        let mut simulation = Simulation::new(
            builder.build().unwrap(),
            Params::fixed(1.0 / f64::from(steps as u32)),
        )
        .unwrap();
        simulation.run(1.0, |_| ControlFlow::Continue(())).unwrap();
        let energy = simulation.info().energy;
        assert!(
            energy.dissipated_j > 0.5 && energy.supplied_j.abs() > 0.5,
            "{energy:?}"
        );
        energy.largest_error_j
    };
    let (coarse, fine) = (error(500), error(1000));
    assert!(
        ((coarse / fine).log2() - 2.0).abs() < 0.2,
        "{coarse} {fine}"
    );
}
