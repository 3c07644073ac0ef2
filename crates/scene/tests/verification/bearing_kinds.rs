//! `[[bearing]]` of the kinds `rigid` and `linear`, and bearings in a housing.

use std::fs;
use std::path::Path;

use gearmesh_dynamics::{Equilibrium, StaticParams, equilibrium, natural_modes};
use gearmesh_scene::system::BuiltSystem;
use nalgebra::{Matrix5, Vector5};

use crate::assert_labelled;
use crate::common::{Outputs, build_in, changed, load};
use crate::rolling_bearings::PAIR;

/// A shaft of 1 kg whose turn is held by a soft spring, with bearings to be stated, under 300 N across and 400 N along.
const SHAFT: &str = r#"title = "a shaft"
[[body]]
name = "shaft"
mass_kg = 1.0
inertia_kg_m2 = [2e-3, 2e-3, 1e-3]
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

fn scene(bearings: &[(&str, &str)]) -> String {
    let mut text = SHAFT.to_owned();
    for (number, (at_mm, model)) in bearings.iter().enumerate() {
        text += &format!(
            "[[bearing]]\nname = \"b{number}\"\nbody_2 = \"shaft\"\naxis = [0, 0, 1]\nat_mm = [0, 0, {at_mm}]\n{model}\n"
        );
    }
    text
}

fn rest(text: &str, folder: &Path) -> (BuiltSystem, Equilibrium) {
    let mut built = build_in(text, folder).unwrap_or_else(|e| panic!("{e}"));
    assert_labelled(&built);
    let start = built.system.start().clone();
    let found = equilibrium(&mut built.system, &start, &StaticParams::default());
    (built, found.unwrap_or_else(|e| panic!("{e}")))
}

/// What a rigid bearing holds and what it leaves free: equations of its joint, and motions of the shaft that remain.
#[test]
fn rigid_bearings_hold_what_they_say() {
    let folder = tempfile::tempdir().unwrap();
    for (keys, equations) in [
        ("", 5),
        (", axial = \"held\", tilt = \"held\"", 5),
        (", axial = \"free\"", 4),
        (", tilt = \"free\"", 3),
        (", axial = \"free\", tilt = \"free\"", 2),
    ] {
        let text = scene(&[("0.0", &format!("model = {{ kind = \"rigid\"{keys} }}"))]);
        let built = build_in(&text, folder.path()).unwrap();
        assert_eq!(built.system.equations(), equations, "{keys}");
        assert_eq!(built.joints[0].kind, "rigid bearing");
    }
    // A fixed and a floating bearing hold a shaft without redundancy: reactions are those of statics.
    let text = scene(&[
        ("-20.0", "model = { kind = \"rigid\", tilt = \"free\" }"),
        (
            "60.0",
            "model = { kind = \"rigid\", axial = \"free\", tilt = \"free\" }",
        ),
    ]);
    let (built, found) = rest(&text, folder.path());
    assert!(built.system.redundant().is_empty());
    let reactions: Vec<f64> = found.lambda.iter().map(|force| force.abs()).collect();
    for (seen, expected) in reactions.iter().zip([225.0, 0.0, 400.0, 75.0, 0.0]) {
        assert!((seen - expected).abs() < 1e-9, "{reactions:?}");
    }
}

/// A matrix on the diagonal is the diagonal; one with coupling moves the shaft by K⁻¹ F.
#[test]
fn a_stated_matrix_is_the_bearings_stiffness() {
    let folder = tempfile::tempdir().unwrap();
    let diagonal = "model = { kind = \"linear\", radial_stiffness_N_per_mm = 1e5, axial_stiffness_N_per_mm = 5e4, tilt_stiffness_Nm_per_rad = 3e4 }";
    let five = "model = { kind = \"linear\", stiffness_matrix_SI = [[1e8, 0, 0, 0, 0], [0, 1e8, 0, 0, 0], [0, 0, 5e7, 0, 0], [0, 0, 0, 3e4, 0], [0, 0, 0, 0, 3e4]] }";
    let six = "model = { kind = \"linear\", stiffness_matrix_SI = [[1e8, 0, 0, 0, 0, 0], [0, 1e8, 0, 0, 0, 0], [0, 0, 5e7, 0, 0, 0], [0, 0, 0, 3e4, 0, 0], [0, 0, 0, 0, 3e4, 0], [0, 0, 0, 0, 0, 0]] }";
    let place = |model: &str| {
        let (_, found) = rest(&scene(&[("10.0", model)]), folder.path());
        let state = found.state;
        (state.positions_m[0], state.orientations[0])
    };
    let expected = place(diagonal);
    for model in [five, six] {
        let found = place(model);
        assert!(
            (found.0 - expected.0).norm() < 1e-15,
            "{found:?} {expected:?}"
        );
        assert!(found.1.angle_to(&expected.1) < 1e-12);
    }
    let coupled = "model = { kind = \"linear\", stiffness_matrix_SI = [[1e8, 0, 0, 0, -4e5], [0, 1e8, 0, 4e5, 0], [0, 0, 5e7, 0, 0], [0, 4e5, 0, 3e4, 0], [-4e5, 0, 0, 0, 3e4]] }";
    let (_, found) = rest(&scene(&[("0.0", coupled)]), folder.path());
    let mut k = Matrix5::from_diagonal(&Vector5::new(1e8, 1e8, 5e7, 3e4, 3e4));
    for (i, j, value) in [(0, 4, -4e5), (1, 3, 4e5)] {
        k[(i, j)] = value;
        k[(j, i)] = value;
    }
    let moved = k
        .lu()
        .solve(&Vector5::new(300.0, 0.0, 400.0, 0.0, 0.0))
        .unwrap();
    let state = &found.state;
    let tilt = state.orientations[0].scaled_axis();
    for (seen, expected) in [
        (state.positions_m[0].x, moved[0]),
        (state.positions_m[0].z, moved[2]),
        (tilt.y, moved[4]),
    ] {
        assert!((seen / expected - 1.0).abs() < 1e-7, "{seen} {expected}");
    }
}

/// The tangent of a bearing file: the shaft rests where it does on the balls themselves, vibrates as it does there, and
/// the notes say how often the tangent was taken.
#[test]
fn a_tangent_is_that_of_the_operating_point() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("pair.toml"), PAIR).unwrap();
    let of = |model: &str| {
        let (mut built, found) = rest(&scene(&[("10.0", model)]), folder.path());
        let modes = natural_modes(&mut built.system, &found.state).unwrap();
        let frequencies: Vec<f64> = modes.iter().map(|mode| mode.frequency_hz()).collect();
        let outputs = Outputs::at(&mut built.system, &found.state);
        let moment = outputs.value("b0", "moment_shaft_y_Nm");
        (found.state, frequencies, moment, built.notes)
    };
    let balls = of("model = { kind = \"quasi-static\", file = \"pair.toml\" }");
    let tangent = of("model = { kind = \"linear\", tangent_of = \"pair.toml\" }");
    let away = (balls.0.positions_m[0] - tangent.0.positions_m[0]).norm();
    assert!(away < 1e-9 * balls.0.positions_m[0].norm(), "{away}");
    assert!((balls.2 - tangent.2).abs() < 1e-6 * (1.0 + balls.2.abs()));
    assert_eq!(balls.1.len(), tangent.1.len());
    for (a, b) in balls.1.iter().zip(&tangent.1) {
        assert!((a - b).abs() < 1e-5 * a, "{a} {b}");
    }
    let note = tangent.3.iter().find(|note| note.contains("tangent"));
    assert!(
        note.unwrap().contains("unchanged after 1 turns"),
        "{note:?}"
    );
    // Twice the load: another operating point, another stiffness.
    let twice = changed(SHAFT, "force_N = 500.0", "force_N = 1000.0");
    let text = scene(&[(
        "10.0",
        "model = { kind = \"linear\", tangent_of = \"pair.toml\" }",
    )])
    .replace(SHAFT, &twice);
    let (mut built, found) = rest(&text, folder.path());
    let modes = natural_modes(&mut built.system, &found.state).unwrap();
    let highest = |all: &mut dyn Iterator<Item = f64>| all.fold(0.0, f64::max);
    let stiffer = highest(&mut modes.iter().map(|mode| mode.frequency_hz()));
    let before = highest(&mut tangent.1.iter().copied());
    assert!(stiffer > 1.002 * before, "{stiffer} {before}");
}

/// An axial support that carries one way lets the shaft go the other.
#[test]
fn an_axial_support_bears_one_way() {
    let folder = tempfile::tempdir().unwrap();
    let ends = |way: &str| {
        scene(&[
            (
                "0.0",
                &format!(
                    "model = {{ kind = \"linear\", radial_stiffness_N_per_mm = 1e5, axial_stiffness_N_per_mm = 1e5, tilt_stiffness_Nm_per_rad = 1e4, axial_support = \"{way}\" }}"
                ),
            ),
            (
                "30.0",
                "model = { kind = \"linear\", radial_stiffness_N_per_mm = 1e5, axial_stiffness_N_per_mm = 100.0 }",
            ),
        ])
    };
    let place = |way: &str| rest(&ends(way), folder.path()).1.state.positions_m[0].z;
    // 400 N along +z, carried by 1e8 + 1e5 N/m or by 1e5 N/m alone.
    for (way, stiffness) in [("both", 1.001e8), ("positive", 1.001e8), ("negative", 1e5)] {
        let expected = 400.0 / stiffness;
        let found = place(way);
        // The force acts where the shaft stands: second order in the displacements.
        assert!((found / expected - 1.0).abs() < 1e-6, "{way}: {found}");
    }
}

/// A bearing in a housing: both deflect one after the other, and the ring is a body between them.
#[test]
fn a_housing_deflects_behind_its_bearing() {
    let folder = tempfile::tempdir().unwrap();
    let model = "model = { kind = \"linear\", radial_stiffness_N_per_mm = 1e5, axial_stiffness_N_per_mm = 5e4, tilt_stiffness_Nm_per_rad = 3e4 }\n\
                 housing = { ring_mass_kg = 0.1, ring_inertia_kg_m2 = [1e-5, 1e-5, 2e-5], stiffness_N_per_mm = [2e4, 3e4, 1e4], stiffness_Nm_per_rad = [1e3, 1e3, 1e3] }";
    let (built, found) = rest(&scene(&[("0.0", model)]), folder.path());
    let names: Vec<&str> = built.bodies.iter().map(|body| &*body.name).collect();
    assert_eq!(names, ["shaft", "b0/ring"]);
    let place = |body: usize| found.state.positions_m[body];
    // The forces act where the shaft stands: second order in the displacements.
    for (seen, expected) in [
        (place(1).x, 300.0 / 2e7),
        (place(0).x, 300.0 / 2e7 + 300.0 / 1e8),
        (place(0).z, 400.0 / 1e7 + 400.0 / 5e7),
    ] {
        assert!((seen / expected - 1.0).abs() < 1e-6, "{seen} {expected}");
    }
    // Symmetric, so that rows and columns are the same.
    let rows: Vec<String> = [2e7, 3e7, 1e7, 1e3, 1e3, 1e3]
        .iter()
        .enumerate()
        .map(|(i, k)| {
            let row: Vec<String> = (0..6)
                .map(|j| {
                    if i == j {
                        format!("{k:e}")
                    } else {
                        "0".to_owned()
                    }
                })
                .collect();
            format!("[{}]", row.join(", "))
        })
        .collect();
    let by_matrix = model.replace(
        "stiffness_N_per_mm = [2e4, 3e4, 1e4], stiffness_Nm_per_rad = [1e3, 1e3, 1e3]",
        &format!("stiffness_matrix_SI = [{}]", rows.join(", ")),
    );
    let (_, other) = rest(&scene(&[("0.0", &by_matrix)]), folder.path());
    assert!((other.state.positions_m[0] - place(0)).norm() < 1e-15);
    // A rigid bearing in it leaves the housing's own stiffness.
    let rigid = format!(
        "model = {{ kind = \"rigid\" }}\n{}",
        &model[model.find("housing").unwrap()..]
    );
    let (_, rigid) = rest(&scene(&[("0.0", &rigid)]), folder.path());
    let x = rigid.state.positions_m[0].x;
    assert!((x / (300.0 / 2e7) - 1.0).abs() < 1e-6, "{x}");
}

/// What does not go together is refused at its key.
#[test]
fn bad_bearings_are_told() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("pair.toml"), PAIR).unwrap();
    let identity =
        "[[1, 0, 0, 0, 0], [0, 1, 0, 0, 0], [0, 0, 1, 0, 0], [0, 0, 0, 1, 0], [0, 0, 0, 0, 1]]";
    let skew = identity.replace("[1, 0, 0, 0, 0]", "[1, 0.5, 0, 0, 0]");
    let negative = identity.replace("[0, 0, 1, 0, 0]", "[0, 0, -1, 0, 0]");
    for (model, parts) in [
        (
            "{ kind = \"linear\" }".to_owned(),
            ["model.radial_stiffness_N_per_mm", "missing"],
        ),
        (
            format!("{{ kind = \"linear\", radial_stiffness_N_per_mm = 1.0, stiffness_matrix_SI = {identity} }}"),
            ["model.radial_stiffness_N_per_mm", "stiffness_matrix_SI"],
        ),
        (
            "{ kind = \"linear\", tangent_of = \"pair.toml\", axial_stiffness_N_per_mm = 1.0 }".to_owned(),
            ["model.axial_stiffness_N_per_mm", "tangent_of"],
        ),
        (
            "{ kind = \"linear\", radial_stiffness_N_per_mm = 1.0, control = \"least-spin\" }".to_owned(),
            ["model.control", "radial_stiffness_N_per_mm"],
        ),
        (
            "{ kind = \"linear\", radial_stiffness_N_per_mm = 1.0, axial_support = \"positive\" }".to_owned(),
            ["model.axial_support", "missing"],
        ),
        (
            "{ kind = \"linear\", stiffness_matrix_SI = [[1, 0], [0, 1]] }".to_owned(),
            ["model.stiffness_matrix_SI", "5 rows of 5 or 6 of 6"],
        ),
        (
            format!("{{ kind = \"linear\", stiffness_matrix_SI = {skew} }}"),
            ["model.stiffness_matrix_SI.0.1", "symmetric"],
        ),
        (
            format!("{{ kind = \"linear\", stiffness_matrix_SI = {negative} }}"),
            ["model.stiffness_matrix_SI", "eigenvalue"],
        ),
        (
            "{ kind = \"linear\", tangent_of = \"none.toml\" }".to_owned(),
            ["model.tangent_of", "does not exist"],
        ),
        (
            "{ kind = \"rigid\", radial_stiffness_N_per_mm = 1.0 }".to_owned(),
            ["radial_stiffness_N_per_mm", "linear"],
        ),
        (
            "{ kind = \"rigid\" }\nhousing = { ring_mass_kg = 0.1, ring_inertia_kg_m2 = [1e-5, 1e-5, 2e-5] }".to_owned(),
            ["housing", "stiffness"],
        ),
        (
            "{ kind = \"rigid\" }\nhousing = { ring_mass_kg = -0.1, ring_inertia_kg_m2 = [1e-5, 1e-5, 2e-5], stiffness_N_per_mm = [1, 1, 1] }".to_owned(),
            ["housing", "mass"],
        ),
    ] {
        let text = scene(&[("0.0", &format!("model = {model}"))]);
        let refused = load(&text, folder.path()).and_then(|loaded| loaded.build());
        let Err(error) = refused else {
            panic!("{model} is accepted");
        };
        for part in parts {
            assert!(error.to_string().contains(part), "`{part}` is not in {error}");
        }
    }
}
