//! Long runs, step control, resumed runs, effects left out.

use std::f64::consts::TAU;
use std::ops::ControlFlow;

use gearmesh_dynamics::elements::{LinearBearing, SpringDamper, TorsionSpring};
use gearmesh_dynamics::{
    Body, BodyId, DynamicsError, ElementFailure, ForceElement, Joint, JointKind, Loads, Marker,
    MarkerPair, Motion, OutputGrid, Params, Simulation, System, TimeFunction, View,
};
use nalgebra::Vector3;

use crate::hard_joints::{door, finish, revolute};

/// A rotor on two bearings, driven through a torsion spring by a body with prescribed speed.
fn driven_rotor(speed_rad_per_s: f64) -> System {
    let mut builder = System::builder();
    let mut rotor = Body::rigid("rotor", 5.0, [0.02, 0.02, 0.01]);
    rotor.angular_velocity_rad_per_s.z = speed_rad_per_s;
    let rotor = builder.body(rotor).unwrap();
    let mut driver = Body::rigid("driver", 1.0, [0.001; 3]);
    driver.position_m.z = 0.3;
    driver.angular_velocity_rad_per_s.z = speed_rad_per_s;
    let driver = builder.body(driver).unwrap();
    for (name, z) in [("left", -0.1), ("right", 0.1)] {
        let bearing = LinearBearing {
            radial_stiffness_n_per_m: 1e8,
            axial_stiffness_n_per_m: 5e7,
            radial_damping_n_s_per_m: 2e3,
            axial_damping_n_s_per_m: 2e3,
            ..LinearBearing::default()
        };
        let pair = MarkerPair {
            a: Marker::ground([0.0, 0.0, z]),
            b: Marker::at(rotor, [0.0, 0.0, z]),
        };
        builder.element(bearing.between(name, pair).unwrap());
    }
    let motor = (
        Marker::ground([0.0, 0.0, 0.3]),
        Marker::at(driver, [0.0; 3]),
    );
    builder.joint(revolute("axle", motor.0, motor.1));
    let speed = Motion::Speed(TimeFunction::Constant(speed_rad_per_s));
    builder.joint(Joint::new("motor", JointKind::Rotation(speed), motor.0, motor.1).unwrap());
    let pair = MarkerPair {
        a: Marker::at(driver, [0.0; 3]),
        b: Marker::at(rotor, [0.0; 3]),
    };
    builder.element(
        TorsionSpring::new(1e4, 1.0)
            .between("coupling", pair)
            .unwrap(),
    );
    builder.gravity([0.0, -9.81, 0.0]);
    builder.build().unwrap()
}

/// The door swings by more than a right angle. With the angle φ about the hinge, 0.8 m below the centre of mass, the
/// moments across the hinge are, in the door's own axes,
///
/// ```text
/// I φ̈ = m g_y x cos φ,   I = I_z + m x²
/// M_x = −m x z φ̈ + m g_y z cos φ,     M_y = −m x z φ̇² − m g_y z sin φ − m g x
/// ```
///
/// What Newton's iteration leaves, at most 1e-8 of the step's increment φ̇ h, stands in the reactions as an
/// acceleration of 1e-8 φ̇/(β h): 1.1e-8 s/h of the moment with φ̇ = 1.5 rad/s and β = 0.31.
#[test]
fn reactions_hold_though_the_body_turns_far_from_where_the_matrix_was_made() {
    let (m, x, z, side, down) = (20.0, 0.4, 0.8, 1.0, 9.81);
    let inertia = 4.0 + m * x * x;
    for step_s in [4e-4, 1e-4] {
        let mut simulation = Simulation::new(door(&[0.2]), Params::fixed(step_s)).unwrap();
        let mut worst = 0.0_f64;
        simulation
            .run(2.0, |step| {
                let phi = step.to.orientations[0].scaled_axis().z;
                let rate = step.to.velocity[5];
                let acceleration = m * side * x * phi.cos() / inertia;
                let across = [
                    -m * x * z * acceleration + m * side * z * phi.cos(),
                    -m * x * z * rate * rate - m * side * z * phi.sin() - m * down * x,
                ];
                let expected = across[0].hypot(across[1]);
                let moment = step.lambda[3].hypot(step.lambda[4]);
                let error = moment / expected - 1.0;
                worst = worst.max(error.abs());
                assert!(
                    error.abs() < 1.1e-8 / step_s,
                    "{} s: {moment} N m, error {error:e}",
                    step.to.time_s
                );
                ControlFlow::Continue(())
            })
            .unwrap();
        let turned = simulation.state().orientations[0].angle();
        println!(
            "steps of {step_s:.0e} s: moment off by {worst:.1e} of itself at most (allowed {:.1e}), door turned by {turned:.2} rad (at least 1.7)",
            1.1e-8 / step_s
        );
        assert!(turned > 1.7);
    }
}

/// A minute of slow rotation: joints hold to rounding, no angle drifts.
#[test]
fn a_minute_of_slow_rotation_does_not_drift() {
    let speed = 10.0 / 60.0 * TAU;
    let simulation = finish(driven_rotor(speed), Params::fixed(1e-3), 60.0);
    let info = simulation.info();
    // Ten turns of the driver, counted; the rotor follows and stays where its bearings hold it.
    let ahead = simulation.system().joints()[1].angle_rad() - 10.0 * TAU;
    println!("driver off by {ahead:.1e} rad after ten turns (allowed 1e-9)");
    assert!(ahead.abs() < 1e-9);
    let z = simulation.state().velocity[5];
    assert!((z - speed).abs() < 1e-7 * speed, "{z}");
    let sag = 5.0 * 9.81 / 2e8;
    println!(
        "rotor: speed off by {:.1e} of itself (allowed 1e-7), sag of {sag:.2e} m by {:.1e} (allowed 1e-5)",
        (z - speed).abs() / speed,
        (simulation.state().positions_m[0].y + sag).abs() / sag
    );
    println!(
        "joints off by {:.1e} m or rad at most (allowed 1e-12), kinetic energy by {:.1e} J (allowed 1e-8)",
        info.largest_violation,
        (info.energy.last.kinetic_j - 0.5 * 0.011 * speed * speed).abs()
    );
    assert!(
        (simulation.state().positions_m[0].y + sag).abs() < 1e-5 * sag,
        "{}",
        simulation.state().positions_m[0].y
    );
    assert!(info.largest_violation < 1e-12, "{info:?}");
    // One minute later there is as much energy as after one second: the bearings' rest and the spin.
    assert!(
        (info.energy.last.kinetic_j - 0.5 * 0.011 * speed * speed).abs() < 1e-8,
        "{info:?}"
    );
}

/// A step of one whole turn: the exponential has no derivative across the axis there. The joints are not to blame.
#[test]
fn a_step_of_a_whole_turn_is_refused_with_advice() {
    let mut wheel = Body::rigid("wheel", 1.0, [0.01; 3]);
    wheel.angular_velocity_rad_per_s = Vector3::new(0.0, 0.0, TAU);
    let mut builder = System::builder();
    let id = builder.body(wheel).unwrap();
    let (place, own) = (Marker::ground([0.0; 3]), Marker::at(id, [0.0; 3]));
    builder.joint(revolute("axle", place, own));
    let mut simulation = Simulation::new(builder.build().unwrap(), Params::fixed(1.0)).unwrap();
    let error = simulation.step().unwrap_err();
    assert!(
        matches!(error, DynamicsError::StepSingular { .. }),
        "{error}"
    );
    let text = error.to_string();
    println!("refused: {text}");
    assert!(text.contains("step of 1.000e0 s") && text.contains("adaptive"));
}

/// A force that is no number from some time on.
struct Broken {
    body: [BodyId; 1],
    from_s: f64,
}

impl ForceElement for Broken {
    fn name(&self) -> &str {
        "broken"
    }

    fn bodies(&self) -> &[BodyId] {
        &self.body
    }

    fn evaluate(&mut self, view: &View<'_>, loads: &mut Loads) -> Result<(), ElementFailure> {
        let force = if view.time_s < self.from_s {
            1.0
        } else {
            f64::NAN
        };
        loads.add_force(0, &[force]);
        Ok(())
    }
}

/// A force that is not a number from some time on ends the run there with a state of finite numbers.
#[test]
fn a_force_that_is_no_number_ends_the_run() {
    for joint in [false, true] {
        let mut builder = System::builder();
        let id = builder.body(Body::rigid("mass", 2.0, [1.0; 3])).unwrap();
        builder.element(Broken {
            body: [id],
            from_s: 0.05,
        });
        if joint {
            let (ground, mass) = (Marker::ground([0.0; 3]), Marker::at(id, [0.0; 3]));
            builder.joint(Joint::new("rail", JointKind::Spherical, ground, mass).unwrap());
        }
        let system = builder.build().unwrap();
        let mut simulation = Simulation::new(system, Params::fixed(1e-2)).unwrap();
        let found = simulation.run(1.0, |_| ControlFlow::Continue(()));
        assert!(found.is_err(), "with joint: {joint}");
        println!(
            "{}: ended at {:.2} s with {:.3e} m/s: {}",
            if joint { "with a joint" } else { "free" },
            simulation.state().time_s,
            simulation.state().velocity[0],
            found.as_ref().unwrap_err()
        );
        assert!(simulation.state().time_s < 0.06);
        assert!(simulation.state().velocity.iter().all(|v| v.is_finite()));
    }
}

/// A mass thrown round on a stiff spring: the adaptive step, half a second at most, shortens until it follows the
/// spring.
#[test]
fn an_adaptive_step_finds_the_length_that_a_stiff_spring_needs() {
    let mut builder = System::builder();
    let mut body = Body::rigid("bob", 1.0, [0.01; 3]);
    body.position_m = Vector3::new(0.4, 0.0, 0.0);
    body.velocity_m_per_s = Vector3::new(0.0, 30.0, 5.0);
    let id = builder.body(body).unwrap();
    let spring = SpringDamper {
        stiffness_n_per_m: 1e6,
        damping_n_s_per_m: 0.0,
        free_length_m: 0.4,
    };
    let pair = MarkerPair {
        a: Marker::ground([0.0; 3]),
        b: Marker::at(id, [0.0; 3]),
    };
    builder.element(spring.between("spring", pair).unwrap());
    let simulation = finish(
        builder.build().unwrap(),
        Params::adaptive(0.5, 1e-6, 1e-6),
        0.5,
    );
    let info = simulation.info();
    println!(
        "{} steps (more than 100) of {:.1e} to {:.1e} s (at most 1e-2), energy off by {:.1e} of that at the start (allowed 1e-2)",
        info.steps,
        info.step_range_s.0,
        info.step_range_s.1,
        info.energy.largest_error_j / info.energy.first.kinetic_j
    );
    assert!(info.step_range_s.1 < 0.01 && info.steps > 100, "{info:?}");
    assert!(
        info.energy.largest_error_j < 1e-2 * info.energy.first.kinetic_j,
        "{info:?}"
    );
}

/// A tolerance a hundred times tighter: the error falls, and the steps grow with its cube root.
#[test]
fn the_adaptive_step_follows_its_tolerance() {
    let error = |tolerance: f64| {
        let params = Params::adaptive(0.05, tolerance, tolerance);
        let simulation = finish(door(&[0.2]), params, 3.0);
        let fine = finish(door(&[0.2]), Params::fixed(5e-5), simulation.state().time_s);
        // The reference runs a little past the end: bring it back along its speed.
        let late = fine.state().time_s - simulation.state().time_s;
        let spin = fine.state().velocity[5] * late;
        let angle = fine.state().orientations[0].angle_to(&simulation.state().orientations[0]);
        ((angle.abs() - spin.abs()).abs(), simulation.info().steps)
    };
    let ((coarse, few), (fine, many)) = (error(1e-7), error(1e-9));
    println!("tolerance 1e-7: angle off by {coarse:.1e} rad, {few} steps");
    println!(
        "tolerance 1e-9: angle off by {fine:.1e} rad (allowed 1e-4 and 0.2 of the former), {many} steps"
    );
    assert!(fine < 0.2 * coarse && fine < 1e-4, "{coarse} {fine}");
    // Steps go with the cube root of the tolerance: 100^(1/3) = 4.6.
    let ratio = many as f64 / few as f64;
    println!("{ratio:.2} times as many steps (allowed 3 to 7)");
    assert!((3.0..7.0).contains(&ratio), "{few} {many}");
}

/// A run that is stopped and resumed, with fixed and adaptive steps, ends with the same bits.
#[test]
fn a_resumed_run_gives_the_same_bits() {
    for params in [Params::fixed(1e-3), Params::adaptive(1e-2, 1e-7, 1e-6)] {
        for system in
            [&|| driven_rotor(30.0) as System, &|| door(&[0.2, 1.8])] as [&dyn Fn() -> System; 2]
        {
            let whole = finish(system(), params, 0.4);
            let first = finish(system(), params, 0.15);
            let checkpoint = first.checkpoint();
            let mut second = Simulation::resume(system(), params, &checkpoint).unwrap();
            assert_eq!(second.checkpoint(), checkpoint);
            second.run(0.4, |_| ControlFlow::Continue(())).unwrap();
            assert_eq!(second.state(), whole.state());
            assert_eq!(second.info(), whole.info());
            assert_eq!(second.checkpoint(), whole.checkpoint());
            println!(
                "{}: {} steps of {:.1e} to {:.1e} s, stopped at {:.3} s and resumed: the same bits",
                whole.system().bodies()[0].name,
                whole.info().steps,
                whole.info().step_range_s.0,
                whole.info().step_range_s.1,
                first.state().time_s
            );
        }
    }
}

/// A checkpoint of a system of other bodies is refused.
#[test]
fn a_checkpoint_of_another_system_is_refused() {
    let checkpoint = finish(door(&[0.2]), Params::fixed(1e-3), 0.01).checkpoint();
    let error = Simulation::resume(driven_rotor(1.0), Params::fixed(1e-3), &checkpoint)
        .err()
        .unwrap();
    println!("of another system, refused: {error}");
    assert!(matches!(error, DynamicsError::Checkpoint { .. }), "{error}");
    let mut damaged = checkpoint;
    damaged.matrix.pop();
    let resumed = Simulation::resume(door(&[0.2]), Params::fixed(1e-3), &damaged);
    println!(
        "one number short, refused: {}",
        resumed.as_ref().err().unwrap()
    );
    assert!(resumed.is_err());
}

/// What a system does not name is never called, what it names once an evaluation.
#[test]
fn what_a_system_does_not_name_is_not_called() {
    let plain = {
        let mut builder = System::builder();
        builder.body(Body::rigid("a", 1.0, [1.0; 3])).unwrap();
        finish(builder.build().unwrap(), Params::fixed(1e-2), 1.0)
    };
    let called = plain.system().calls();
    println!("a body alone: {} force elements called", called.len());
    assert!(called.is_empty());
    let rotor = finish(driven_rotor(3.0), Params::fixed(1e-2), 1.0);
    let calls = rotor.system().calls();
    let named: Vec<&str> = rotor.system().elements().collect();
    assert_eq!(
        named,
        [
            "left",
            "right",
            "coupling",
            "weight of rotor",
            "weight of driver"
        ]
    );
    println!(
        "rotor: {} elements, the first called {} times ({} evaluations and 3 at the start), {} with tangents ({} factorisations and 3)",
        calls.len(),
        calls[0].force,
        rotor.info().evaluations,
        calls[0].tangents,
        rotor.info().factorisations
    );
    for call in &calls {
        // The start takes three evaluations with tangents; then one for each Newton iteration.
        assert_eq!(call.force, rotor.info().evaluations + 3, "{calls:?}");
        assert_eq!(call.tangents, rotor.info().factorisations + 3, "{calls:?}");
    }
}

/// Rows between steps: those of steps a hundred times longer are the same to 2e-5 rad.
#[test]
fn output_on_a_uniform_grid_does_not_depend_on_the_steps() {
    let sampled = |params: Params| {
        let mut simulation = Simulation::new(door(&[0.2]), params).unwrap();
        let mut grid = OutputGrid::new(0.01, simulation.state());
        let mut angles = Vec::new();
        simulation
            .run(1.0, |step| {
                grid.visit(step, |state, _| {
                    if state.time_s < 1.0 + 1e-9 {
                        angles.push((state.time_s, state.orientations[0].scaled_axis().z));
                    }
                });
                ControlFlow::Continue(())
            })
            .unwrap();
        angles
    };
    let fine = sampled(Params::fixed(1e-4));
    let coarse = sampled(Params::adaptive(0.02, 1e-7, 1e-7));
    assert_eq!((fine.len(), coarse.len()), (101, 101));
    let both = || fine.iter().zip(&coarse);
    let late_s = both().map(|((t, _), (s, _))| (t - s).abs());
    let apart = both().map(|((_, a), (_, b))| (a - b).abs());
    println!(
        "{} rows: angles apart by {:.1e} rad at most (allowed 2e-5), times by {:.1e} s (allowed 1e-12)",
        fine.len(),
        apart.fold(0.0, f64::max),
        late_s.fold(0.0, f64::max)
    );
    for ((t, a), (s, b)) in fine.iter().zip(&coarse) {
        assert!(
            (t - s).abs() < 1e-12 && (a - b).abs() < 2e-5,
            "{t}: {a} {b}"
        );
    }
}
