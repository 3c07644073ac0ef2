//! Systems made in code and a desk to run them on.
#![allow(clippy::unwrap_used, dead_code, missing_docs)]

use std::path::PathBuf;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use gearmesh_dynamics::elements::{AppliedLoad, Axes, LoadKind, TorsionSpring};
use gearmesh_dynamics::{
    Body, Joint, JointKind, Marker, MarkerPair, Motion, Params, System, SystemBuilder, TimeFunction,
};
use gearmesh_scene::system_run::*;
use gearmesh_specification::system::solver::Start;
use nalgebra::Vector3;

/// A folder with an output file.
pub struct Desk {
    pub folder: tempfile::TempDir,
    pub output: PathBuf,
}

impl Desk {
    pub fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let output = folder.path().join("result.h5");
        Self { folder, output }
    }

    pub fn options<'a>(&'a self, stop: &'a AtomicBool) -> RunOptions<'a> {
        RunOptions {
            output: &self.output,
            restart: false,
            checkpoint_interval: Duration::from_secs(3600),
            stop,
            progress: &|_| {},
        }
    }

    /// Runs to the end at once.
    pub fn run(&self, job: RunJob) -> SystemResult {
        let stop = AtomicBool::new(false);
        assert_eq!(run(job, &self.options(&stop)).unwrap(), Outcome::Finished);
        SystemResult::open(&self.output).unwrap()
    }
}

pub fn job(system: System, kind: RunKind) -> RunJob {
    RunJob {
        head: RunHead {
            title: "test".to_owned(),
            scene_toml: "title = \"test\"".to_owned(),
            ..RunHead::default()
        },
        selection: Selection::all(&system),
        ratings: Vec::new(),
        system,
        kind,
    }
}

pub fn transient(params: Params, end_s: f64, interval_s: f64) -> RunKind {
    RunKind::Transient(InTime {
        params,
        start: Start::AsGiven,
        end_s,
        interval_s,
        statistics_from_s: 0.0,
        windows: Vec::new(),
    })
}

/// The same with statistics from a time on.
pub fn transient_from(
    params: Params,
    end_s: f64,
    interval_s: f64,
    statistics_from_s: f64,
) -> RunKind {
    match transient(params, end_s, interval_s) {
        RunKind::Transient(run) => RunKind::Transient(InTime {
            statistics_from_s,
            ..run
        }),
        other => other,
    }
}

/// A wheel on a revolute joint about z: 0.5 kg m².
pub fn wheel(name: &str, builder: &mut SystemBuilder, speed: f64) -> MarkerPair {
    let mut body = Body::rigid(name, 4.0, [0.3, 0.3, 0.5]);
    body.angular_velocity_rad_per_s = Vector3::new(0.0, 0.0, speed);
    let id = builder.body(body).unwrap();
    let pair = MarkerPair {
        a: Marker::ground([0.0; 3]),
        b: Marker::at(id, [0.0; 3]),
    };
    let joint = Joint::new(
        &format!("bearing of {name}"),
        JointKind::Revolute,
        pair.a,
        pair.b,
    );
    builder.joint(joint.unwrap());
    pair
}

pub fn torque(builder: &mut SystemBuilder, on: MarkerPair, name: &str, torque: TimeFunction) {
    let axis = (Axes::World, [0.0, 0.0, 1.0]);
    let load = AppliedLoad::new(name, on.b.body, LoadKind::Torque, axis, torque);
    builder.element(load.unwrap());
}

/// A pendulum of 0.3 m on a torsion spring, driven by a sine: not linear, with damping, gravity and reactions.
pub fn driven_pendulum() -> System {
    let mut builder = System::builder();
    let mut body = Body::rigid("bob", 1.2, [2e-3, 3e-3, 4e-3]);
    body.position_m = Vector3::new(0.3, 0.0, 0.0);
    let bob = builder.body(body).unwrap();
    let pair = MarkerPair {
        a: Marker::ground([0.0; 3]),
        b: Marker::at(bob, [-0.3, 0.0, 0.0]),
    };
    let hinge = Joint::new("hinge", JointKind::Revolute, pair.a, pair.b);
    builder.joint(hinge.unwrap());
    let spring = TorsionSpring::new(2.0, 0.05);
    builder.element(spring.between("spring", pair).unwrap());
    let sine = TimeFunction::Sine {
        offset: 0.0,
        amplitude: 6.0,
        frequency_hz: 1.3,
        phase_rad: 0.2,
    };
    torque(&mut builder, pair, "drive", sine);
    builder.gravity([0.0, -9.81, 0.0]);
    builder.build().unwrap()
}

/// A wheel whose angle or speed is prescribed.
pub fn driven_wheel(motion: Motion) -> (SystemBuilder, MarkerPair) {
    let mut builder = System::builder();
    let pair = wheel("wheel", &mut builder, 0.0);
    let driver = Joint::new("driver", JointKind::Rotation(motion), pair.a, pair.b);
    builder.joint(driver.unwrap());
    (builder, pair)
}
