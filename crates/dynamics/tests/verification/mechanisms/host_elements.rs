//! Elements and loads that the calling program computes: beside the same written as elements and functions of this
//! crate.

use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use gearmesh_dynamics::elements::{
    AppliedLoad, Axes, ForceElement, HostElement, HostMotion, LoadKind, TorsionSpring,
};
use gearmesh_dynamics::{
    Body, BodyId, Derivatives, DynamicsError, HostFunction, Joint, JointKind, Marker, MarkerPair,
    Params, Simulation, System, TimeFunction,
};

const STIFFNESS: f64 = 3.0;
const DAMPING: f64 = 0.05;

/// A wheel on a revolute joint under an element between it and the ground; its speed after a while, and the iterations.
fn wheel(element: impl FnOnce(BodyId, MarkerPair) -> Box<dyn ForceElement>) -> (f64, u64) {
    let mut builder = System::builder();
    let mut body = Body::rigid("wheel", 1.0, [0.1, 0.1, 0.02]);
    body.angular_velocity_rad_per_s.z = 100.0;
    let id = builder.body(body).unwrap();
    let pair = MarkerPair {
        a: Marker::ground([0.0; 3]),
        b: Marker::at(id, [0.0; 3]),
    };
    builder.joint(Joint::new("axis", JointKind::Revolute, pair.a, pair.b).unwrap());
    builder.boxed_element(element(id, pair));
    let system = builder.build().unwrap();
    let mut run = Simulation::new(system, Params::fixed(1e-3)).unwrap();
    run.run(0.8, |_| ControlFlow::Continue(())).unwrap();
    (run.state().velocity[5], run.info().iterations)
}

/// A torsion spring that is wound up by more than a turn and swings back.
#[test]
fn a_law_of_the_caller_moves_a_body_as_the_same_spring_does() {
    let (expected, iterations) = wheel(|_, pair| {
        let spring = TorsionSpring::new(STIFFNESS, DAMPING);
        Box::new(spring.between("spring", pair).unwrap())
    });
    let calls = Arc::new(AtomicUsize::new(0));
    let counted = Arc::clone(&calls);
    let (found, more) = wheel(|_, pair| {
        let law = move |motion: &HostMotion| {
            counted.fetch_add(1, Ordering::Relaxed);
            let [_, _, turn] = motion.rotation_rad;
            let [_, _, speed] = motion.angular_velocity_rad_per_s;
            Ok([0.0, 0.0, 0.0, 0.0, 0.0, -STIFFNESS * turn - DAMPING * speed])
        };
        Box::new(HostElement::new("spring", pair, Arc::new(law)))
    });
    assert!(
        (found - expected).abs() < 1e-6 * expected.abs(),
        "{found} {expected}"
    );
    // Tangents by differences serve Newton as well as exact ones.
    assert_eq!(more, iterations);
    assert!(calls.load(Ordering::Relaxed) > 800);
}

#[test]
fn a_load_of_the_caller_is_that_of_the_same_function() {
    let load = |id, magnitude| {
        let about = (Axes::Body, [0.0, 0.0, 1.0]);
        let load = AppliedLoad::new("torque", id, LoadKind::Torque, about, magnitude);
        Box::new(load.unwrap()) as Box<dyn ForceElement>
    };
    let sine = TimeFunction::Sine {
        offset: 0.1,
        amplitude: 2.0,
        frequency_hz: 3.0,
        phase_rad: 0.2,
    };
    let (expected, _) = wheel(|id, _| load(id, sine.clone()));
    let host = HostFunction::new("sine", Arc::new(move |time_s| sine.at(time_s)));
    let (found, _) = wheel(|id, _| load(id, TimeFunction::Host(host)));
    assert_eq!(found, expected);
}

#[test]
fn what_the_caller_cannot_compute_ends_the_run_with_its_words() {
    let fail = |element: Box<dyn FnOnce(BodyId, MarkerPair) -> Box<dyn ForceElement>>| {
        let mut builder = System::builder();
        let id = builder.body(Body::rigid("wheel", 1.0, [1.0; 3])).unwrap();
        let pair = MarkerPair {
            a: Marker::ground([0.0; 3]),
            b: Marker::at(id, [0.0; 3]),
        };
        builder.boxed_element(element(id, pair));
        let run = Simulation::new(builder.build().unwrap(), Params::fixed(1e-3));
        let end = run.and_then(|mut run| run.run(0.1, |_| ControlFlow::Continue(())).map(|_| ()));
        match end {
            Err(DynamicsError::Element { source, .. }) => source.to_string(),
            other => format!("{other:?}"),
        }
    };
    let told = fail(Box::new(|_, pair| {
        let law = |_: &HostMotion| Err("no table for this speed".into());
        Box::new(HostElement::new("law", pair, Arc::new(law)))
    }));
    assert_eq!(told, "no table for this speed");
    let told = fail(Box::new(|_, pair| {
        let law = |_: &HostMotion| Ok([0.0, f64::NAN, 0.0, 0.0, 0.0, 0.0]);
        Box::new(HostElement::new("law", pair, Arc::new(law)))
    }));
    assert!(told.contains("not all finite"), "{told}");
    let told = fail(Box::new(|id, _| {
        let nothing = Derivatives {
            value: f64::NAN,
            ..Derivatives::default()
        };
        let function = HostFunction::new("f", Arc::new(move |_| nothing));
        let about = (Axes::Body, [0.0, 0.0, 1.0]);
        let magnitude = TimeFunction::Host(function);
        Box::new(AppliedLoad::new("t", id, LoadKind::Torque, about, magnitude).unwrap())
    }));
    assert!(told.contains("its function gave NaN"), "{told}");
}
