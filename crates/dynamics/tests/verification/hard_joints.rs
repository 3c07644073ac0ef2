//! Redundant and contradictory joints, chains that cannot close, motors that do not agree.

use std::ops::ControlFlow;

use gearmesh_dynamics::{
    Body, BodyId, DynamicsError, Joint, JointKind, Marker, Motion, Params, Simulation, System,
    TimeFunction,
};
use nalgebra::Vector3;

pub(crate) fn revolute(name: &str, a: Marker, b: Marker) -> Joint {
    Joint::new(name, JointKind::Revolute, a, b).unwrap()
}

pub(crate) fn door(hinges: &[f64]) -> System {
    let mut body = Body::rigid("door", 20.0, [3.0, 1.0, 4.0]);
    body.center_of_mass_m = Vector3::new(0.4, 0.0, 1.0);
    let mut builder = System::builder();
    let id = builder.body(body).unwrap();
    for (index, &height) in hinges.iter().enumerate() {
        let place = [0.0, 0.0, height];
        builder.joint(revolute(
            &format!("hinge {index}"),
            Marker::ground(place),
            Marker::at(id, place),
        ));
    }
    builder.gravity([0.0, 1.0, -9.81]);
    builder.build().unwrap()
}

pub(crate) fn finish(system: System, params: Params, end_s: f64) -> Simulation {
    let mut simulation = Simulation::new(system, params).unwrap();
    simulation
        .run(end_s, |_| ControlFlow::Continue(()))
        .unwrap();
    simulation
}

/// Two hinges on one axis, five equations too many: they are named, and the door swings as on one.
#[test]
fn redundant_hinges_are_named_and_solved_all_the_same() {
    let two = door(&[0.2, 1.8]);
    assert_eq!(two.redundant().len(), 1);
    let redundancy = &two.redundant()[0];
    assert_eq!(
        (redundancy.joint.as_str(), redundancy.equations),
        ("hinge 1", 5)
    );
    assert_eq!(redundancy.implied_by, ["hinge 0"]);
    println!(
        "redundant: {} equations of {}, implied by {}",
        redundancy.equations,
        redundancy.joint,
        redundancy.implied_by.join(", ")
    );
    let params = Params::fixed(1e-3);
    let [one, two] = [door(&[0.2]), two].map(|system| finish(system, params, 1.0));
    let apart = one.state().orientations[0].angle_to(&two.state().orientations[0]);
    println!("after 1 s {apart:.1e} rad from the door on one hinge (allowed 1e-10)");
    assert!(apart < 1e-10);
}

/// A block held at two places at once is refused with both joints and the distance.
#[test]
fn contradictory_joints_are_refused_by_name() {
    let mut builder = System::builder();
    let id = builder.body(Body::rigid("block", 1.0, [1.0; 3])).unwrap();
    builder.joint(
        Joint::new(
            "left",
            JointKind::Fixed,
            Marker::ground([0.0; 3]),
            Marker::at(id, [0.0; 3]),
        )
        .unwrap(),
    );
    builder.joint(
        Joint::new(
            "right",
            JointKind::Fixed,
            Marker::ground([0.1, 0.0, 0.0]),
            Marker::at(id, [0.0; 3]),
        )
        .unwrap(),
    );
    let built = builder.build();
    if let Err(error) = &built {
        println!("refused: {error}");
    }
    let Err(DynamicsError::Contradiction {
        joints, violation, ..
    }) = built
    else {
        panic!("two places at once were accepted");
    };
    assert!(
        joints.contains(&"left".to_owned()) && joints.contains(&"right".to_owned()),
        "{joints:?}"
    );
    assert!((violation - 0.1).abs() < 1e-9);
}

/// A link of one metre between points two metres apart is refused with both joints.
#[test]
fn a_chain_that_cannot_close_is_refused_by_name() {
    let mut builder = System::builder();
    let id = builder.body(Body::rigid("link", 1.0, [1.0; 3])).unwrap();
    builder.joint(
        Joint::new(
            "near",
            JointKind::Spherical,
            Marker::ground([0.0; 3]),
            Marker::at(id, [0.0; 3]),
        )
        .unwrap(),
    );
    builder.joint(
        Joint::new(
            "far",
            JointKind::Spherical,
            Marker::ground([2.0, 0.0, 0.0]),
            Marker::at(id, [1.0, 0.0, 0.0]),
        )
        .unwrap(),
    );
    let error = builder.build().err().unwrap().to_string();
    println!("refused: {error}");
    assert!(error.contains("near") && error.contains("far"), "{error}");
}

fn two_motors(second: TimeFunction) -> Result<Simulation, DynamicsError> {
    let mut builder = System::builder();
    let id = builder.body(Body::rigid("wheel", 1.0, [1.0; 3])).unwrap();
    let (a, b) = (Marker::ground([0.0; 3]), Marker::at(id, [0.0; 3]));
    builder.joint(revolute("axle", a, b));
    let first = TimeFunction::Constant(2.0);
    for (name, speed) in [("motor", first), ("other motor", second)] {
        builder.joint(Joint::new(name, JointKind::Rotation(Motion::Speed(speed)), a, b).unwrap());
    }
    Simulation::new(builder.build()?, Params::fixed(1e-2))
}

/// Two motors on one axle: of one speed they run, of two they are refused, also where they differ only later.
#[test]
fn motors_may_agree_but_not_differ() {
    let mut agreed = two_motors(TimeFunction::Constant(2.0)).unwrap();
    agreed.run(1.0, |_| ControlFlow::Continue(())).unwrap();
    let speed = agreed.state().velocity[5];
    println!("both at 2 rad/s: the wheel turns at {speed:.4} rad/s after 1 s");
    let error = two_motors(TimeFunction::Constant(3.0))
        .err()
        .unwrap()
        .to_string();
    println!("at 2 and 3 rad/s: refused: {error}");
    assert!(error.contains("`") || error.contains("motor"), "{error}");
    // Alike at first, different later: found when it happens.
    let later = TimeFunction::step(0.5, 2.0, 1.0, 3.0).unwrap();
    let mut simulation = two_motors(later).unwrap();
    let error = simulation
        .run(2.0, |_| ControlFlow::Continue(()))
        .unwrap_err();
    println!("one from 2 to 3 rad/s after 0.5 s: refused: {error}");
    assert!(
        matches!(&error, DynamicsError::Contradiction { joints, time_s, .. }
            if joints.contains(&"motor".to_owned()) && joints.contains(&"other motor".to_owned()) && *time_s > 0.5 && *time_s < 0.6),
        "{error}"
    );
}

/// Names given twice and bodies that are not there are refused.
#[test]
fn names_and_bodies_are_checked() {
    let mut builder = System::builder();
    builder.body(Body::rigid("a", 1.0, [1.0; 3])).unwrap();
    builder.body(Body::rigid("a", 1.0, [1.0; 3])).unwrap();
    let built = builder.build();
    println!("refused: {}", built.as_ref().err().unwrap());
    assert!(matches!(built, Err(DynamicsError::Name { name }) if name == "a"));
    let mut other = System::builder();
    let stranger: BodyId = {
        let mut builder = System::builder();
        builder.body(Body::rigid("a", 1.0, [1.0; 3])).unwrap();
        builder.body(Body::rigid("b", 1.0, [1.0; 3])).unwrap()
    };
    other.body(Body::rigid("a", 1.0, [1.0; 3])).unwrap();
    other.joint(revolute(
        "axle",
        Marker::ground([0.0; 3]),
        Marker::at(stranger, [0.0; 3]),
    ));
    let built = other.build();
    println!("refused: {}", built.as_ref().err().unwrap());
    assert!(matches!(
        built,
        Err(DynamicsError::UnknownBody {
            body: 1,
            count: 1,
            ..
        })
    ));
    let negative = Body::rigid("a", -1.0, [1.0; 3]).validate();
    println!("refused: {}", negative.as_ref().unwrap_err());
    assert!(negative.is_err());
}
