//! `[[bearing]]` with balls that move.

use std::fmt::Write;
use std::fs;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use gearmesh_bearings::bearing_file::BearingFromFile;
use gearmesh_bearings::dynamic::{PocketShape, Pockets, Rebound, Traction};
use gearmesh_bearings::{
    AppliedBearingLoad, DynamicBearing, DynamicEffects, Operation, QuasiStaticBearing, RingPose,
    TiltCondition,
};
use gearmesh_dynamics::elements::{AppliedLoad, Axes, LoadKind};
use gearmesh_dynamics::{
    Body, GROUND, Marker, MarkerPair, Params, Simulation, System, TimeFunction,
};
use gearmesh_geometry::input::InputDocument;
use gearmesh_scene::system_run::{Outcome, RunJob, RunOptions, SystemResult, run};

use crate::assert_labelled;
use crate::common::{Outputs, build_in, changed, load};

const BALLS: &str = r#"name = "6205"
kind = "deep-groove"
balls = 9
ball_diameter_mm = 7.94
pitch_diameter_mm = 39.04
inner_conformity = 0.52
outer_conformity = 0.53
"#;

const SCENE: &str = r#"title = "a shaft in a bearing whose balls move"
[run]
kind = "transient"
end_s = 2e-3
[solver]
step_s = 1e-5
[output]
interval_s = 1e-4
[[body]]
name = "shaft"
mass_kg = 0.3
inertia_kg_m2 = [3e-4, 3e-4, 1e-4]
speed_rpm = 1500.0
[[bearing]]
name = "front"
body_2 = "shaft"
axis = [0, 0, 1]
[bearing.model]
kind = "dynamic"
file = "balls.toml"
ball_loads = true
rebound = { restitution = 0.9, at_speed_mm_per_s = 100.0 }
traction = { kind = "coulomb", coefficient = 0.06, transition_speed_mm_per_s = 20.0 }
[bearing.model.cage]
mass_kg = 0.02
pockets = { clearance_um = 100.0, film_stiffness_N_per_mm = 0.1, stiffness_N_per_mm_e = 3000.0, rebound = { restitution = 0.8, at_speed_mm_per_s = 100.0 } }
[[load]]
name = "push"
body = "shaft"
force_N = 300.0
along = [0.0, 0.6, 0.8]
"#;

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("balls.toml"), BALLS).unwrap();
    folder
}

fn bearing() -> QuasiStaticBearing {
    let document = InputDocument::new("balls.toml", BALLS);
    let read = BearingFromFile::from_document(&document).unwrap();
    QuasiStaticBearing::new(&read.definition).unwrap()
}

/// The same system by calls of the library.
fn by_hand() -> System {
    let mut builder = System::builder();
    let speed = 1500.0 * std::f64::consts::TAU / 60.0;
    let mut shaft = Body::rigid("shaft", 0.3, [3e-4, 3e-4, 1e-4]);
    shaft.angular_velocity_rad_per_s.z = speed;
    let shaft = builder.body(shaft).unwrap();
    let polar = 0.02 * 0.01952_f64.powi(2);
    let mut cage = Body::rigid("front/cage", 0.02, [0.5 * polar, 0.5 * polar, polar]);
    cage.angular_velocity_rad_per_s.z = 0.5 * speed * (1.0 - 7.94 / 39.04);
    let cage = builder.body(cage).unwrap();
    let load = AppliedLoad::new(
        "push",
        shaft,
        LoadKind::Force { point_m: [0.0; 3] },
        (Axes::World, [0.0, 0.6, 0.8]),
        TimeFunction::Constant(300.0),
    );
    builder.element(load.unwrap());
    let pockets = Pockets {
        shape: PocketShape::Cylindrical,
        clearance_m: 1e-4,
        film_stiffness_n_per_m: 100.0,
        contact_stiffness_n_per_m15: 3e6 * 1e3_f64.sqrt(),
        rebound: Rebound::from_restitution(0.8, 0.1).unwrap(),
        traction: None,
    };
    let effects = DynamicEffects {
        rebound: Rebound::from_restitution(0.9, 0.1).unwrap(),
        traction: Some(Traction::coulomb(0.06, 0.02).unwrap()),
        cages: vec![(cage, pockets)],
        ..DynamicEffects::default()
    };
    let pair = MarkerPair {
        a: Marker::at(GROUND, [0.0; 3]),
        b: Marker::at(shaft, [0.0; 3]),
    };
    let element = DynamicBearing::new("front", pair, &bearing(), effects).unwrap();
    builder.element(element.with_ball_loads());
    builder.build().unwrap()
}

fn options<'a>(output: &'a Path, stop: &'a AtomicBool) -> RunOptions<'a> {
    RunOptions {
        output,
        restart: false,
        checkpoint_interval: Duration::from_secs(3600),
        stop,
        progress: &|_| {},
    }
}

fn finish(text: &str, folder: &Path, stop: bool) -> (SystemResult, usize) {
    let output = folder.join(if stop { "stopped.h5" } else { "whole.h5" });
    let stop = AtomicBool::new(stop);
    let mut legs = 1;
    loop {
        let job = RunJob::from_scene(load(text, folder).unwrap()).unwrap();
        if run(job, &options(&output, &stop)).unwrap() == Outcome::Finished {
            return (SystemResult::open(&output).unwrap(), legs);
        }
        legs += 1;
    }
}

fn assert_same(a: &SystemResult, b: &SystemResult) {
    assert_eq!(a.rows.columns(), b.rows.columns());
    for column in a.rows.columns() {
        let [a, b] = [a, b].map(|result| result.rows.read(&column.name).unwrap());
        let bits = |values: &[f64]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&a), bits(&b), "{}", column.name);
    }
}

/// Balls, cage and shaft of a scene move as those that calls of the library make, and their loads are channels.
#[test]
fn a_scene_is_what_the_library_makes() {
    let folder = folder();
    let built = build_in(SCENE, folder.path()).unwrap();
    assert_labelled(&built);
    let names: Vec<&str> = built.bodies.iter().map(|body| &*body.name).collect();
    assert_eq!(names, ["shaft", "front/cage"]);
    let end = |system: System| {
        let mut run = Simulation::new(system, Params::fixed(1e-5)).unwrap();
        run.run(2e-3, |_| ControlFlow::Continue(())).unwrap();
        run.state().clone()
    };
    let (scene, library) = (end(built.system), end(by_hand()));
    for (a, b) in scene.positions_m.iter().zip(&library.positions_m) {
        assert!((a - b).norm() < 1e-12, "{a} {b}");
    }
    assert_eq!(scene.unknowns.len(), 54);
    for (a, b) in scene.unknowns.iter().zip(&library.unknowns) {
        assert!((a - b).abs() < 1e-11, "{a} {b}");
    }
}

/// A run that is broken off and resumed after every step is the same to the last bit, balls and cage included.
#[test]
fn a_resumed_run_is_the_same() {
    let folder = folder();
    let short = changed(SCENE, "end_s = 2e-3", "end_s = 3e-4");
    let (whole, _) = finish(&short, folder.path(), false);
    let (stopped, legs) = finish(&short, folder.path(), true);
    assert!(legs >= 30, "{legs}");
    assert_same(&whole, &stopped);
    let names: Vec<&str> = whole.rows.columns().iter().map(|c| &*c.name).collect();
    for name in [
        "elements/front/ball_9_outer_N",
        "elements/front/orbit_speed_rad_per_s",
        "elements/front/cage_1_force_x_N",
        "bodies/front_cage/x_m",
    ] {
        assert!(names.contains(&name), "{name} is not in {names:?}");
    }
}

/// The same of balls in equilibrium at speed, whose places begin each search.
#[test]
fn a_resumed_run_on_balls_in_equilibrium_is_the_same() {
    let folder = folder();
    let short = changed(SCENE, "end_s = 2e-3", "end_s = 3e-4");
    let [model, load] = ["[bearing.model]", "[[load]]"].map(|part| short.find(part).unwrap());
    let resting = format!(
        "{}model = {{ kind = \"quasi-static\", file = \"balls.toml\", radial_damping_N_s_per_mm = 1.0, element_loads = true }}\n{}",
        &short[..model],
        &short[load..]
    );
    let (whole, _) = finish(&resting, folder.path(), false);
    let (stopped, legs) = finish(&resting, folder.path(), true);
    assert!(legs >= 30, "{legs}");
    assert_same(&whole, &stopped);
}

/// `start = "equilibrium"`: the shaft begins where it rests on balls in equilibrium at speed, and every ball with its
/// load there.
#[test]
fn a_run_begins_in_equilibrium() {
    let folder = folder();
    let scene = changed(
        SCENE,
        "step_s = 1e-5",
        "step_s = 1e-5\nstart = \"equilibrium\"",
    );
    // Damping would add what a ball feels on its way through the load zone.
    let rebound = "rebound = { restitution = 0.9, at_speed_mm_per_s = 100.0 }\n";
    let scene = changed(&scene, rebound, "");
    let loaded = load(&scene, folder.path()).unwrap();
    let mut built = loaded.build().unwrap();
    let start = built.system.start().clone();
    let load = AppliedBearingLoad {
        force_n: [0.0, 180.0, 240.0],
        tilt: TiltCondition::Moments([0.0; 2]),
    };
    let operation = Operation {
        inner_rad_per_s: 1500.0 * std::f64::consts::TAU / 60.0,
        ..Operation::default()
    };
    let bearing = bearing();
    let pose = bearing.equilibrium(&load, &operation).unwrap();
    let away = (start.positions_m[0] - pose.centre_m).norm();
    assert!(away < 1e-6 * pose.centre_m.norm(), "{away}");
    let (_, loads) = bearing.loads(&pose, &operation).unwrap();
    let values = Outputs::at(&mut built.system, &start);
    for (number, ball) in loads.elements[0].iter().enumerate() {
        for (race, expected) in [("inner", ball.inner_load_n), ("outer", ball.outer_load_n)] {
            let seen = values.value("front", &format!("ball_{}_{race}_N", number + 1));
            assert!((seen - expected).abs() < 1e-3, "{seen} {ball:?}");
        }
    }
    // Little is to settle: friction alone was not in the equilibrium.
    let (result, _) = finish(&scene, folder.path(), false);
    let z = result.rows.read("bodies/shaft/z_m").unwrap();
    let moved = z
        .iter()
        .map(|z| (z - z_of(&pose)).abs())
        .fold(0.0, f64::max);
    assert!(moved < 0.02 * z_of(&pose), "{moved} of {}", z_of(&pose));
}

fn z_of(pose: &RingPose) -> f64 {
    pose.centre_m.z
}

/// Equilibria and natural frequencies take the balls in equilibrium and say so.
#[test]
fn static_and_eigen_runs_take_balls_in_equilibrium() {
    let folder = folder();
    let moving = SCENE
        .replace("kind = \"transient\"\nend_s = 2e-3", "kind = \"static\"")
        .replace("[solver]\nstep_s = 1e-5\n[output]\ninterval_s = 1e-4\n", "");
    let model = moving.find("[bearing.model]").unwrap();
    let load = moving.find("[[load]]").unwrap();
    let resting = format!(
        "{}model = {{ kind = \"quasi-static\", file = \"balls.toml\", element_loads = true }}\n{}",
        &moving[..model],
        &moving[load..]
    );
    for kind in ["static", "eigen"] {
        let of = |text: &str| {
            let text = text.replace("kind = \"static\"", &format!("kind = \"{kind}\""));
            fs::remove_file(folder.path().join("whole.h5")).ok();
            finish(&text, folder.path(), false).0
        };
        let (a, b) = (of(&moving), of(&resting));
        assert!(
            a.head
                .notes
                .iter()
                .any(|n| n.contains("`front`") && n.contains("quasi-static")),
            "{:?}",
            a.head.notes
        );
        assert_eq!(a.eigen, b.eigen);
        assert_same(&a, &b);
    }
}

/// Four bearings with cages hold one shaft: each begins with a quarter of the load, and all of it is carried on.
#[test]
fn four_bearings_hold_one_shaft() {
    let folder = folder();
    let first = SCENE.find("[[bearing]]").unwrap();
    let load = SCENE.find("[[load]]").unwrap();
    let mut scene =
        SCENE[..first].replace("step_s = 1e-5", "step_s = 1e-5\nstart = \"equilibrium\"");
    for (number, at) in [-30.0, -10.0, 10.0, 30.0].into_iter().enumerate() {
        let one = SCENE[first..load].replace("\"front\"", &format!("\"b{number}\""));
        let one = one.replace("axis =", &format!("at_mm = [0, 0, {at:?}]\naxis ="));
        write!(scene, "{one}").unwrap();
    }
    // Across the axis only: each end of the shaft is the mirror image of the other.
    scene += &changed(&SCENE[load..], "[0.0, 0.6, 0.8]", "[0.0, 1.0, 0.0]");
    let (result, _) = finish(&scene, folder.path(), false);
    let force = |number: usize, axis: &str| {
        let name = format!("elements/b{number}/force_shaft_{axis}_N");
        result.rows.read(&name).unwrap()
    };
    let all: Vec<Vec<f64>> = (0..4).map(|number| force(number, "y")).collect();
    for one in &all {
        assert!((one[0] + 75.0).abs() < 1e-2, "{}", one[0]);
    }
    let mean: f64 = all.iter().flatten().sum::<f64>() / all[0].len() as f64;
    assert!((mean / -300.0 - 1.0).abs() < 0.02, "{mean}");
    let cages = result
        .head
        .scene_toml
        .matches("[bearing.model.cage]")
        .count();
    let columns = result.rows.columns().iter();
    let moving = columns.filter(|c| c.name.ends_with("_cage/x_m")).count();
    assert_eq!((cages, moving), (4, 4));
}

/// What does not go together is refused at its key.
#[test]
fn bad_dynamic_bearings_are_told() {
    let folder = folder();
    let rollers = "name = \"NU\"\nkind = \"cylindrical-roller\"\nrollers = 12\nroller_diameter_mm = 7.5\nroller_length_mm = 9.0\npitch_diameter_mm = 34.0\n";
    fs::write(folder.path().join("rollers.toml"), rollers).unwrap();
    for (from, to, parts) in [
        (
            "balls.toml",
            "rollers.toml",
            ["model", "only ball bearings"],
        ),
        (
            "ball_loads = true",
            "ball_weight = true",
            ["model.ball_weight", "gravity_m_per_s2"],
        ),
        (
            "mass_kg = 0.02",
            "mass_kg = -1.0",
            ["model.cage.mass_kg", "more than 0"],
        ),
        (
            "restitution = 0.9",
            "restitution = 1.5",
            ["model.rebound", "restitution"],
        ),
        (
            "coefficient = 0.06",
            "coefficient = -0.1",
            ["model.traction", "friction"],
        ),
        (
            "ball_loads = true",
            "surface = { kind = \"triangles\", across_um = 0.0, along_um = 50.0 }",
            ["model.surface", "across the groove"],
        ),
        (
            "ball_loads = true",
            "surface = { kind = \"torus\" }",
            ["torus", "triangles"],
        ),
        (
            "clearance_um = 100.0",
            "clearance_um = -1.0",
            ["model.cage.pockets", "clearance"],
        ),
        (
            "ball_loads = true",
            "element_loads = true",
            ["element_loads", "quasi-static"],
        ),
        ("balls.toml", "none.toml", ["model.file", "does not exist"]),
    ] {
        let text = changed(SCENE, from, to);
        let Err(error) = build_in(&text, folder.path()) else {
            panic!("{to} is accepted");
        };
        for part in parts {
            assert!(
                error.to_string().contains(part),
                "`{part}` is not in {error}"
            );
        }
    }
}
