//! `[[bearing]]` with a bearing file.

use std::fs;

use gearmesh_bearings::bearing_file::BearingFromFile;
use gearmesh_bearings::{AppliedBearingLoad, Operation, QuasiStaticBearing, TiltCondition};
use gearmesh_dynamics::{StaticParams, equilibrium};
use gearmesh_geometry::input::InputDocument;
use gearmesh_scene::system_run::RunJob;

use crate::common::{Outputs, build_in, changed, line_of, load};
use crate::system_runs::Desk;

/// Two angular-contact bearings back to back.
pub const PAIR: &str = r#"name = "7010 C pair"
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

const FOUR_POINT: &str = r#"name = "QJ"
kind = "four-point"
balls = 15
ball_diameter_mm = 12.7
pitch_diameter_mm = 70.0
inner_conformity = 0.52
outer_conformity = 0.53
contact_angle_deg = 35.0
"#;

const THRUST: &str = r#"name = "thrust"
kind = "thrust-ball"
balls = 14
ball_diameter_mm = 7.938
pitch_diameter_mm = 36.0
inner_conformity = 0.54
outer_conformity = 0.54
"#;

/// The shaft comes to rest where `gearmesh bearing` has the ring, and balls carry what they do there; whatever the
/// bearing.
#[test]
fn a_shaft_rests_where_its_bearing_file_says() {
    for (text, push) in [
        (PAIR, [0.6, 0.8]),
        (FOUR_POINT, [0.6, 0.8]),
        (THRUST, [0.03, 0.9]),
    ] {
        rests(text, push);
    }
}

fn rests(text: &str, [across, along]: [f64; 2]) {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("pair.toml"), text).unwrap();
    let size = across.hypot(along);
    let scene = changed(
        SCENE,
        "[0.6, 0.0, 0.8]",
        &format!("[{across}, 0.0, {along}]"),
    );
    let mut built = build_in(&scene, folder.path()).unwrap();
    let start = built.system.start().clone();
    let found = equilibrium(&mut built.system, &start, &StaticParams::default()).unwrap();
    let document = InputDocument::new("pair.toml", text);
    let definition = BearingFromFile::from_document(&document)
        .unwrap()
        .definition;
    let bearing = QuasiStaticBearing::new(&definition).unwrap();
    let force_n = [500.0 * across / size, 0.0, 500.0 * along / size];
    let load = AppliedBearingLoad {
        force_n,
        tilt: TiltCondition::Moments([0.0; 2]),
    };
    let rest = Operation::default();
    let pose = bearing.equilibrium(&load, &rest).unwrap();
    let moved = found.state.positions_m[0] - start.positions_m[0];
    let apart = (moved - pose.centre_m).norm() / pose.centre_m.norm();
    assert!(apart < 1e-7, "{apart:e}: {text}");
    let (_, loads) = bearing.loads(&pose, &rest).unwrap();
    let values = Outputs::at(&mut built.system, &found.state);
    assert!((values.value("pair", "force_shaft_x_N") + force_n[0]).abs() < 1e-4);
    for (number, ball) in loads.elements.iter().flatten().enumerate() {
        let seen = values.value("pair", &format!("element_{}_inner_N", number + 1));
        assert!((seen - ball.inner_load_n).abs() < 1e-4, "{seen} {ball:?}");
    }
}

/// A static series of angles has the speeds that the scene states: balls press on the outer race with what carries them
/// round, as at the one equilibrium of a scene without a series.
#[test]
fn a_series_of_angles_has_the_speed_of_its_motion() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("pair.toml"), PAIR).unwrap();
    let driven = "[[joint]]\nname = \"axis\"\nkind = \"planar\"\nbody_2 = \"shaft\"\n\
                  [[motion]]\nname = \"spin\"\njoint = \"axis\"\nspeed_rpm = 12000.0\n";
    let without_spring = SCENE.split("[[torsion_spring]]").next().unwrap();
    let load = SCENE.split_once("[[load]]").unwrap().1;
    let scene = format!("{without_spring}{driven}[[load]]{load}");
    let outer_n = |text: &str| {
        let loaded = crate::common::load(text, folder.path()).unwrap();
        let result = Desk::new().run(RunJob::from_scene(loaded).unwrap());
        let columns = (1..=19).map(|ball| format!("elements/pair/element_{ball}_outer_N"));
        let read = |column: String| *result.rows.read(&column).unwrap().last().unwrap();
        columns.map(read).collect::<Vec<f64>>()
    };
    let [still, once, series] = [
        outer_n(&changed(&scene, "12000.0", "0.0")),
        outer_n(&scene),
        outer_n(&format!("{scene}motion = \"spin\"\nangles_deg = [0.0]\n")),
    ];
    let largest = |values: &[f64], other: &[f64]| {
        let gaps = values.iter().zip(other).map(|(a, b)| (a - b).abs());
        gaps.fold(0.0, f64::max)
    };
    assert!(largest(&still, &once) > 20.0, "{still:?} {once:?}");
    assert!(largest(&series, &once) < 1e-3, "{series:?} {once:?}");
    // Balls go round with the rings, however the way is cut.
    let [at_once, in_steps] = ["[90.0]", "[10.0, 15.0, 90.0]"].map(|angles| {
        outer_n(&format!(
            "{scene}motion = \"spin\"\nangles_deg = {angles}\n"
        ))
    });
    assert!(largest(&at_once, &once) > 1.0, "{at_once:?}");
    assert!(
        largest(&at_once, &in_steps) < 1e-3,
        "{at_once:?} {in_steps:?}"
    );
}

/// A missing file is named at its key; a fault in it is reported with its own file and line.
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

/// A shaft between two single rows that turns freely rests as one that a torsion spring holds: nothing that is rounding
/// resists its turn.
#[test]
fn a_free_shaft_between_two_rows_comes_to_rest() {
    let tapered = "name = \"tapered\"\nkind = \"tapered-roller\"\nrollers = 17\nroller_diameter_mm = 10.0\nroller_length_mm = 15.0\n\
                   pitch_diameter_mm = 60.0\ncontact_angle_deg = 15.0\n";
    let balls = "name = \"balls\"\nkind = \"angular-contact\"\nballs = 14\nball_diameter_mm = 12.7\npitch_diameter_mm = 70.0\n\
                 inner_conformity = 0.52\nouter_conformity = 0.52\ncontact_angle_deg = 25.0\n";
    let held =
        "[[torsion_spring]]\nname = \"hold\"\nbody_2 = \"shaft\"\nstiffness_Nm_per_rad = 100.0\n";
    for (text, speed_rpm, first_axis) in [
        (tapered, 0.0, -1.0),
        (tapered, 1000.0, 1.0),
        (balls, 0.0, 1.0),
        (balls, 1000.0, -1.0),
    ] {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("row.toml"), text).unwrap();
        let bearing = |name: &str, z_mm: f64, axis: f64| {
            format!(
                "[[bearing]]\nname = \"{name}\"\nbody_2 = \"shaft\"\nat_mm = [0.0, 0.0, {z_mm:?}]\naxis = [0.0, 0.0, {axis:?}]\n\
                 model = {{ kind = \"quasi-static\", file = \"row.toml\" }}\n"
            )
        };
        let at_rest = |hold: &str| {
            let text = format!(
                "title = \"shaft\"\n[run]\nkind = \"static\"\n\
                 [[body]]\nname = \"shaft\"\nmass_kg = 20.0\ninertia_kg_m2 = [0.1, 0.1, 0.1]\nspeed_rpm = {speed_rpm:?}\n{}{}\
                 [[load]]\nname = \"across\"\nbody = \"shaft\"\nforce_N = 5000.0\nalong = [1.0, 0.0, 0.0]\nat_mm = [0.0, 0.0, 20.0]\n\
                 [[load]]\nname = \"thrust\"\nbody = \"shaft\"\nforce_N = 800.0\nalong = [0.0, 0.0, 1.0]\n{hold}",
                bearing("a", -100.0, first_axis),
                bearing("b", 100.0, -first_axis),
            );
            let job = RunJob::from_scene(load(&text, folder.path()).unwrap()).unwrap();
            let result = Desk::new().run(job);
            let of = |column: &str| result.rows.read(column).unwrap()[0];
            ["a", "b"].map(|bearing| {
                ["x", "y", "z"].map(|axis| of(&format!("elements/{bearing}/force_world_{axis}_N")))
            })
        };
        let (free, held) = (at_rest(""), at_rest(held));
        for (free, held) in free.iter().flatten().zip(held.iter().flatten()) {
            assert!((free - held).abs() < 1e-3, "{free} {held}");
        }
        assert!(
            (free[0][0] + free[1][0] + 5000.0).abs() < 1e-3
                && (free[0][2] + free[1][2] + 800.0).abs() < 1e-3
        );
    }
}

/// Numbers of a bearing file that look like those of another unit are reported with those of the scene, once for a
/// file.
#[test]
fn slips_of_units_in_bearing_files_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let slipped = format!("{PAIR}[ratings]\ndynamic_N = 14.0\n");
    fs::write(folder.path().join("pair.toml"), slipped).unwrap();
    let loaded = load(SCENE, folder.path()).unwrap();
    let told: Vec<String> = (loaded.unit_slips().iter())
        .map(ToString::to_string)
        .collect();
    assert_eq!(told.len(), 1, "{told:?}");
    assert!(told[0].contains("pair.toml") && told[0].contains("ratings.dynamic_N: 14 is unusual"));
}
