//! Static equilibrium: free motions, load steps, and surfaces that are met on the way.
#![allow(clippy::unwrap_used)] // test code

use std::ops::ControlFlow;

use gearmesh_dynamics::elements::{AppliedLoad, Axes, LoadKind, SpringDamper, TorsionSpring};
use gearmesh_dynamics::{
    Body, BodyId, DynamicsError, ElementFailure, ForceElement, FreeMotions, Joint, JointKind,
    Loads, Marker, MarkerPair, Params, Simulation, StaticParams, System, SystemBuilder,
    TimeFunction, View, equilibrium,
};
use nalgebra::Vector3;

fn close(found: f64, exact: f64, tolerance: f64) {
    assert!(
        (found - exact).abs() <= tolerance * exact.abs(),
        "{found} instead of {exact}"
    );
}

/// A wheel on a fixed axle with a torque on it.
fn wheel_with_torque(builder: &mut SystemBuilder, torque_nm: f64) -> MarkerPair {
    let wheel = builder.body(Body::rigid("wheel", 1.0, [0.1; 3])).unwrap();
    let pair = MarkerPair {
        a: Marker::ground([0.0; 3]),
        b: Marker::at(wheel, [0.0; 3]),
    };
    builder.joint(Joint::new("axle", JointKind::Revolute, pair.a, pair.b).unwrap());
    let axis = (Axes::World, [0.0, 0.0, 1.0]);
    let torque = TimeFunction::Constant(torque_nm);
    builder.element(AppliedLoad::new("motor", wheel, LoadKind::Torque, axis, torque).unwrap());
    pair
}

#[test]
fn equilibrium_hangs_reports_and_refuses() {
    let mut builder = System::builder();
    let mut bob = Body::rigid("bob", 2.0, [0.01; 3]);
    bob.position_m = Vector3::new(0.0, 0.4, 0.0);
    let id = builder.body(bob).unwrap();
    builder.joint(
        Joint::new(
            "pivot",
            JointKind::Spherical,
            Marker::ground([0.0; 3]),
            Marker::at(id, [0.0, -0.4, 0.0]),
        )
        .unwrap(),
    );
    builder.gravity([9.81, 0.0, 0.0]);
    let mut system = builder.build().unwrap();
    let start = system.start().clone();
    // Released level: nothing resists at first, then it hangs; its rotation about the line stays free.
    let found = equilibrium(&mut system, &start, &StaticParams::default()).unwrap();
    assert!((found.state.positions_m[0] - Vector3::new(0.4, 0.0, 0.0)).norm() < 1e-10);
    assert_eq!(found.held.len(), 1, "{:?}", found.held);
    assert!(
        found.held[0].contains("`bob`, rotation"),
        "{:?}",
        found.held
    );
    close(
        found.lambda.iter().map(|l| l * l).sum::<f64>().sqrt(),
        2.0 * 9.81,
        1e-10,
    );
    let strict = StaticParams {
        free_motions: FreeMotions::Refuse,
        ..StaticParams::default()
    };
    let error = equilibrium(&mut system, &found.state, &strict).unwrap_err();
    assert!(
        matches!(&error, DynamicsError::Unbalanced { motion, .. } if motion.contains("bob")),
        "{error}"
    );

    let mut builder = System::builder();
    wheel_with_torque(&mut builder, 5.0);
    let mut system = builder.build().unwrap();
    let start = system.start().clone();
    let error = equilibrium(&mut system, &start, &StaticParams::default())
        .unwrap_err()
        .to_string();
    assert!(
        error.contains("wheel")
            && error.contains("rotation about its own z")
            && error.contains("5.000e0"),
        "{error}"
    );
}

#[test]
fn a_loaded_spring_stretches_in_load_steps_too() {
    let mut builder = System::builder();
    let mut body = Body::rigid("mass", 3.0, [0.01; 3]);
    body.position_m = Vector3::new(0.0, 0.0, -0.5);
    let id = builder.body(body).unwrap();
    let pair = MarkerPair {
        a: Marker::ground([0.0; 3]),
        b: Marker::at(id, [0.0; 3]),
    };
    builder.joint(Joint::new("slide", JointKind::Prismatic, pair.a, pair.b).unwrap());
    let spring = SpringDamper {
        stiffness_n_per_m: 500.0,
        damping_n_s_per_m: 2.0,
        free_length_m: 0.5,
    };
    builder.element(spring.between("spring", pair).unwrap());
    builder.gravity([0.0, 0.0, -10.0]);
    let mut system = builder.build().unwrap();
    let start = system.start().clone();
    for load_steps in [1, 5] {
        let params = StaticParams {
            load_steps,
            ..StaticParams::default()
        };
        let found = equilibrium(&mut system, &start, &params).unwrap();
        assert!((found.state.positions_m[0].z + 0.5 + 30.0 / 500.0).abs() < 1e-12);
    }
    // From there a transient stays at rest.
    let still = equilibrium(&mut system, &start, &StaticParams::default())
        .unwrap()
        .state;
    let mut simulation =
        Simulation::from_state(system, still.clone(), Params::fixed(1e-3)).unwrap();
    simulation.run(1.0, |_| ControlFlow::Continue(())).unwrap();
    assert!((simulation.state().positions_m[0] - still.positions_m[0]).norm() < 1e-12);
}

/// Stops all around a wheel, one each pitch, met from the second half of a pitch on: what teeth are to a gear.
struct Stops {
    body: [BodyId; 1],
    pitch_rad: f64,
    stiffness_nm_per_rad: f64,
}

impl ForceElement for Stops {
    fn name(&self) -> &'static str {
        "stops"
    }

    fn bodies(&self) -> &[BodyId] {
        &self.body
    }

    fn evaluate(&mut self, view: &View<'_>, loads: &mut Loads) -> Result<(), ElementFailure> {
        let rotation = view.body(self.body[0]).rotation;
        let angle = rotation[(1, 0)].atan2(rotation[(0, 0)]);
        let depth = angle.rem_euclid(self.pitch_rad) - 0.5 * self.pitch_rad;
        if depth > 0.0 {
            loads.add_force(5, &[-self.stiffness_nm_per_rad * depth]);
            if loads.wants_tangents() {
                loads.add_by_position(5, 5, -self.stiffness_nm_per_rad);
            }
        }
        Ok(())
    }
}

/// Springs far apart in stiffness are both springs; one that is rounding beside the other is none, and what it alone
/// holds is reported.
#[test]
fn a_soft_spring_beside_a_stiff_one_counts_until_it_is_rounding() {
    let (stiff, torque_nm) = (1e7, 3.0);
    for (soft, is_felt) in [(1e2, true), (1e-9, false)] {
        let mut builder = System::builder();
        let mut wheel = |name: &str, stiffness: f64, torque_nm: f64| {
            let id = builder.body(Body::rigid(name, 1.0, [0.1; 3])).unwrap();
            let (a, b) = (Marker::ground([0.0; 3]), Marker::at(id, [0.0; 3]));
            let axle = format!("axle of {name}");
            builder.joint(Joint::new(&axle, JointKind::Revolute, a, b).unwrap());
            let spring = TorsionSpring::new(stiffness, 0.0);
            let held = format!("spring of {name}");
            builder.element(spring.between(&held, MarkerPair { a, b }).unwrap());
            let (axis, torque) = (
                (Axes::World, [0.0, 0.0, 1.0]),
                TimeFunction::Constant(torque_nm),
            );
            let motor = format!("motor of {name}");
            builder.element(AppliedLoad::new(&motor, id, LoadKind::Torque, axis, torque).unwrap());
        };
        wheel("first", stiff, torque_nm);
        wheel("second", soft, if is_felt { torque_nm } else { 0.0 });
        let mut system = builder.build().unwrap();
        let start = system.start().clone();
        let found = equilibrium(&mut system, &start, &StaticParams::default()).unwrap();
        let angle = |body: usize| found.state.orientations[body].scaled_axis().z;
        close(angle(0), torque_nm / stiff, 1e-9);
        if is_felt {
            close(angle(1), torque_nm / soft, 1e-9);
        }
        let named = found.held.iter().filter(|motion| motion.contains("second"));
        assert_eq!(
            (found.held.len(), named.count()),
            if is_felt { (0, 0) } else { (1, 1) }
        );
    }
}

/// A weak spring would let the torque turn the wheel by many pitches; the first stop holds it.
#[test]
fn the_first_stop_is_found_though_newton_would_jump_over_many() {
    for weak_nm_per_rad in [0.0, 1e-3, 10.0] {
        let mut builder = System::builder();
        let pair = wheel_with_torque(&mut builder, 100.0);
        if weak_nm_per_rad > 0.0 {
            let spring = TorsionSpring::new(weak_nm_per_rad, 0.0);
            builder.element(spring.between("coupling", pair).unwrap());
        }
        let (pitch_rad, stiffness_nm_per_rad) = (0.06, 1e7);
        builder.element(Stops {
            body: [pair.b.body],
            pitch_rad,
            stiffness_nm_per_rad,
        });
        let mut system = builder.build().unwrap();
        let start = system.start().clone();
        let found = equilibrium(&mut system, &start, &StaticParams::default()).unwrap();
        let angle = found.state.orientations[0].scaled_axis().z;
        let torque = 100.0 - weak_nm_per_rad * angle;
        close(angle, 0.5 * pitch_rad + torque / stiffness_nm_per_rad, 1e-9);
        assert!(found.held.is_empty());
        assert!(found.iterations < 40, "{}", found.iterations);
    }
}

/// A torsion spring that goes soft, k atan(angle): it holds at most k π/2.
struct Softening {
    body: [BodyId; 1],
    stiffness_nm: f64,
}

impl ForceElement for Softening {
    fn name(&self) -> &'static str {
        "softening"
    }

    fn bodies(&self) -> &[BodyId] {
        &self.body
    }

    fn evaluate(&mut self, view: &View<'_>, loads: &mut Loads) -> Result<(), ElementFailure> {
        // Below half a turn.
        let angle = view.body(self.body[0]).orientation.scaled_axis().z;
        loads.add_force(5, &[-self.stiffness_nm * angle.atan()]);
        if loads.wants_tangents() {
            let slope = self.stiffness_nm / (1.0 + angle * angle);
            loads.add_by_position(5, 5, -slope);
        }
        Ok(())
    }
}

fn softening_wheel(torque_nm: f64) -> System {
    let mut builder = System::builder();
    let pair = wheel_with_torque(&mut builder, torque_nm);
    builder.element(Softening {
        body: [pair.b.body],
        stiffness_nm: 10.0,
    });
    builder.build().unwrap()
}

/// Six iterations of 0.2 rad at most do not reach 2.5 rad: the load is brought up in as many steps as it takes.
#[test]
fn loads_are_brought_up_in_as_many_steps_as_they_need() {
    let params = StaticParams {
        most_iterations: 9,
        ..StaticParams::default()
    };
    let angle = |torque: f64| {
        let mut system = softening_wheel(torque);
        let start = system.start().clone();
        let found = equilibrium(&mut system, &start, &params).unwrap();
        (
            found.state.orientations[0].scaled_axis().z,
            found.iterations,
        )
    };
    let (near, few) = angle(10.0 * 0.5_f64.atan());
    close(near, 0.5, 1e-10);
    assert!(few <= params.most_iterations, "{few}");
    let (far, more) = angle(10.0 * 2.5_f64.atan());
    close(far, 2.5, 1e-10);
    assert!(more > params.most_iterations, "{more}");
}

#[test]
fn what_does_not_balance_is_named() {
    let mut system = softening_wheel(50.0);
    let start = system.start().clone();
    let error = equilibrium(&mut system, &start, &StaticParams::default()).unwrap_err();
    let text = error.to_string();
    assert!(
        matches!(error, DynamicsError::NoEquilibrium { .. }),
        "{text}"
    );
    for part in [
        "forces balance least along body `wheel`, rotation about its own z",
        "`motor` with ",
        "`softening` with ",
        "is left over",
    ] {
        assert!(text.contains(part), "`{part}` is not in\n{text}");
    }
}

/// A spring against a turn that knows small turns only, as contacts do that are computed for parallel axes.
struct SmallTurns {
    body: [BodyId; 1],
    stiffness_nm_per_rad: f64,
    largest_rad: f64,
}

impl ForceElement for SmallTurns {
    fn name(&self) -> &str {
        "small turns"
    }

    fn bodies(&self) -> &[BodyId] {
        &self.body
    }

    fn evaluate(&mut self, view: &View<'_>, loads: &mut Loads) -> Result<(), ElementFailure> {
        let turn = view.body(self.body[0]).orientation.scaled_axis().z;
        if turn.abs() > self.largest_rad {
            return Err(format!("turned by {:.1} mrad", 1e3 * turn).into());
        }
        loads.add_force(5, &[-self.stiffness_nm_per_rad * turn]);
        loads.add_by_position(5, 5, -self.stiffness_nm_per_rad);
        Ok(())
    }
}

/// Where no equilibrium lies within what an element can follow, the message names the motion that nothing holds, not
/// the element's limit alone.
#[test]
fn a_search_that_leaves_what_an_element_follows_says_which_motion_went_too_far() {
    let settle = |torque_nm: f64| {
        let mut builder = System::builder();
        let pair = wheel_with_torque(&mut builder, torque_nm);
        builder.element(SmallTurns {
            body: [pair.b.body],
            stiffness_nm_per_rad: 1e3,
            largest_rad: 10e-3,
        });
        let mut system = builder.build().unwrap();
        let start = system.start().clone();
        equilibrium(&mut system, &start, &StaticParams::default())
    };
    let found = settle(9.0).unwrap();
    close(found.state.orientations[0].scaled_axis().z, 9e-3, 1e-9);
    let error = settle(30.0).unwrap_err();
    let message = error.to_string();
    assert!(
        matches!(error, DynamicsError::LeftOnTheWay { .. }),
        "{message}"
    );
    for part in [
        "`wheel`, rotation about its own z",
        "`small turns`",
        "mrad",
        "too soft",
        "fault",
    ] {
        assert!(message.contains(part), "`{part}` is not in {message}");
    }
}
