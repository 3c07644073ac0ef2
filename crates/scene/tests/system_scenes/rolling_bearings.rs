//! `[[bearing]]` with a bearing file.

use std::fs;

use gearmesh_bearings::bearing_file::BearingFromFile;
use gearmesh_bearings::{AppliedBearingLoad, Operation, QuasiStaticBearing, TiltCondition};
use gearmesh_dynamics::{StaticParams, equilibrium};
use gearmesh_geometry::input::InputDocument;

use crate::common::{Outputs, build_in, changed, line_of};

const PAIR: &str = r#"name = "7010 C pair"
kind = "angular-contact"
balls = 19
ball_diameter_mm = 8.731
pitch_diameter_mm = 65.0
inner_conformity = 0.52
outer_conformity = 0.53
contact_angle_deg = 15.0
arrangement = "O"
row_distance_mm = 16.0
preload_um = 5.0
"#;

const SCENE: &str = r#"title = "a shaft on a pair of angular-contact bearings"
[[body]]
name = "shaft"
mass_kg = 1.0
inertia_kg_m2 = [1e-3, 1e-3, 1e-3]
[[bearing]]
name = "pair"
body_2 = "shaft"
axis = [0, 0, 1]
model = { kind = "quasi-static", file = "pair.toml", radial_damping_N_s_per_mm = 1.0, element_loads = true }
[[torsion_spring]]
name = "hold"
body_2 = "shaft"
axis = [0, 0, 1]
stiffness_Nm_per_rad = 100.0
[[load]]
name = "push"
body = "shaft"
force_N = 500.0
along = [0.6, 0.0, 0.8]
[run]
kind = "static"
"#;

/// The shaft comes to rest where `gearmesh bearing` has the ring, and balls bear what they do there.
#[test]
fn a_shaft_rests_where_its_bearing_file_says() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("pair.toml"), PAIR).unwrap();
    let mut built = build_in(SCENE, folder.path()).unwrap();
    let start = built.system.start().clone();
    let found = equilibrium(&mut built.system, &start, &StaticParams::default()).unwrap();
    let document = InputDocument::new("pair.toml", PAIR);
    let definition = BearingFromFile::from_document(&document)
        .unwrap()
        .definition;
    let bearing = QuasiStaticBearing::new(&definition).unwrap();
    let load = AppliedBearingLoad {
        force_n: [300.0, 0.0, 400.0],
        tilt: TiltCondition::Moments([0.0; 2]),
    };
    let rest = Operation::default();
    let pose = bearing.equilibrium(&load, &rest).unwrap();
    let moved = found.state.positions_m[0] - start.positions_m[0];
    assert!((moved - pose.centre_m).norm() < 1e-7 * pose.centre_m.norm());
    let (_, loads) = bearing.loads(&pose, &rest).unwrap();
    let values = Outputs::at(&mut built.system, &found.state);
    assert!((values.value("pair", "force_shaft_x_N") + 300.0).abs() < 1e-4);
    for (number, ball) in loads.elements.iter().flatten().enumerate() {
        let seen = values.value("pair", &format!("element_{}_inner_N", number + 1));
        assert!((seen - ball.inner_load_n).abs() < 1e-4, "{seen} {ball:?}");
    }
}

/// A missing file is named at its key; a fault in it is told with its own file and line.
#[test]
fn bad_bearing_files_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let refusal = |text: &str| match build_in(text, folder.path()) {
        Ok(_) => panic!("accepted"),
        Err(error) => error.to_string(),
    };
    let missing = refusal(SCENE);
    assert!(
        missing.contains("pair.toml does not exist") && missing.contains("model.file"),
        "{missing}"
    );
    assert!(
        missing.contains(&format!(":{}", line_of(SCENE, "model = "))),
        "{missing}"
    );
    let bad = PAIR.replace("balls = 19", "balls = 190");
    fs::write(folder.path().join("pair.toml"), bad).unwrap();
    let told = refusal(SCENE);
    assert!(told.contains("pair.toml") && told.contains("190"), "{told}");
    fs::write(folder.path().join("pair.toml"), PAIR).unwrap();
    let negative = changed(
        SCENE,
        "radial_damping_N_s_per_mm = 1.0",
        "radial_damping_N_s_per_mm = -1.0",
    );
    let told = refusal(&negative);
    assert!(
        told.contains("radial damping") && told.contains("zero or positive"),
        "{told}"
    );
    let unknown = changed(
        SCENE,
        "element_loads = true",
        "radial_stiffness_N_per_mm = 1.0",
    );
    let told = refusal(&unknown);
    assert!(told.contains("radial_stiffness_N_per_mm"), "{told}");
}
