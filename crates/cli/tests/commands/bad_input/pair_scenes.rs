//! Scenes of a gear pair.

use crate::bad_input::gear_files::gear_refused;
use crate::common::{
    Desk, SOLID, argument, changed, gearmesh, line_of, number, refused, run_scene, succeeds,
    workshop,
};

/// `gearmesh check`, `plan` and `run` refuse a scene in which `from` became `to`, at the line of `at`.
fn scene_refused((from, to): (&str, &str), at: &str, parts: &[&str]) {
    let desk = Desk::new();
    let text = changed(&workshop().scene(""), from, to);
    let file = desk.file("scene.toml", &text);
    let place = format!("{}:{}: ", file.display(), line_of(&text, at));
    for command in ["check", "plan"] {
        refused(&gearmesh(&[command, argument(&file)]), 2, parts);
    }
    let answer = gearmesh(&[
        "run",
        argument(&file),
        "-o",
        argument(&desk.path("result.h5")),
    ]);
    refused(&answer, 2, parts);
    assert!(
        answer.stderr.contains(&place),
        "`{place}` is not in {answer:#?}"
    );
    assert_eq!(desk.names(), ["scene.toml"]);
}

#[test]
fn a_torque_of_zero_is_refused() {
    scene_refused(
        ("[20.0, 60.0]", "[20.0, 0.0]"),
        "torques_Nm",
        &["run.torques_Nm.1", "found 0", "more than 0"],
    );
}

#[test]
fn an_unknown_gauge_is_answered_with_the_known_ones() {
    scene_refused(
        ("gear_2 = [\"tension\"]", "gear_2 = [\"tesnion\"]"),
        "tesnion\"",
        &[
            "gauges.gear_2.0",
            "no gauge `tesnion`",
            "it has: tension, compression",
        ],
    );
    scene_refused(
        ("gear_2 = [\"tension\"]", "gear_1 = [\"tension\"]"),
        "[\"tension\"]",
        &["gauges.gear_1.0", "it has: none"],
    );
}

#[test]
fn an_unknown_mesh_model_is_answered_with_the_known_ones() {
    scene_refused(
        ("\"hybrid\"", "\"hybird\""),
        "hybird",
        &["`hybird`", "expected `hybrid`"],
    );
}

/// Base pitches agree, but the base circles already touch: 2 r_b = 50.74 mm.
#[test]
fn a_pair_that_cannot_run_is_refused() {
    let centre = "centre_distance_mm = 54.7";
    scene_refused(
        (centre, "centre_distance_mm = 50.0"),
        "[pair]",
        &[
            "pair",
            "50.0000 mm",
            "sum of the base radii",
            ", 50.7434 mm: no line of action",
        ],
    );
    scene_refused(
        (centre, "centre_distance_mm = 53.9"),
        "[pair]",
        &["pair", "the teeth do not fit", "backlash -"],
    );
    scene_refused(
        (centre, "centre_distance_mm = 60.0"),
        "[pair]",
        &["pair", "contact ratio", "below 1"],
    );
    // The solid gear has been reduced for loads on its right flanks only.
    scene_refused(
        (centre, "centre_distance_mm = 54.7\nflank = \"left\""),
        "gear_1",
        &["pair.gear_1", "left"],
    );
}

#[test]
fn a_missing_model_is_answered_with_the_command_that_makes_it() {
    let thin = argument(&workshop().thin);
    scene_refused(
        (thin, "missing.h5"),
        "gear_2",
        &[
            "pair.gear_2",
            "missing.h5 does not exist",
            "gearmesh reduce GEAR.toml -o",
        ],
    );
}

/// An elastic, linear program must not keep quiet where steel would long have yielded.
#[test]
fn a_torque_that_breaks_the_assumptions_is_warned_about() {
    let desk = Desk::new();
    let scene = changed(&workshop().scene(""), "[20.0, 60.0]", "[20.0, 20000.0]");
    let file = desk.file("scene.toml", scene);
    let result = desk.path("result.h5");
    let answer = succeeds(&["run", argument(&file), "-o", argument(&result), "--json"]);
    for assumption in ["narrow contact", "elastic material", "small deflection"] {
        let warning = format!("warning: at 20000 N m: {assumption}");
        assert!(
            answer.stderr.contains(&warning),
            "`{warning}` is not in {answer:#?}"
        );
    }
    assert!(answer.json()["warnings"].as_array().unwrap().len() >= 3);
    // The warnings stay with the result.
    let report = desk.path("report.html");
    succeeds(&["report", argument(&result), "-o", argument(&report)]);
    assert!(
        std::fs::read_to_string(report)
            .unwrap()
            .contains("elastic material")
    );
    // A moderate load is not warned about.
    let file = desk.file("scene.toml", workshop().scene(""));
    let answer = succeeds(&["run", argument(&file), "-o", argument(&result), "--json"]);
    assert!(!answer.stderr.contains("warning"), "{answer:#?}");
}

#[test]
fn an_edge_radius_that_is_not_used_or_not_possible_is_refused() {
    scene_refused(
        (
            "model.kind = \"hybrid\"",
            "model.kind = \"hybrid\"\nteeth.edge_radius_um = 50",
        ),
        "edge_radius_um",
        &["mesh.teeth.edge_radius_um", "path = \"extended\""],
    );
    scene_refused(
        (
            "teeth.path = \"line-of-action\"",
            "teeth.path = \"extended\"\nteeth.edge_radius_um = 0",
        ),
        "edge_radius_um",
        &["found 0", "1 to 1000"],
    );
}

#[test]
fn a_value_of_the_wrong_type_is_named_by_its_key() {
    gear_refused(
        SOLID,
        ("teeth = 18", "teeth = \"18\""),
        "teeth",
        &["tooth.teeth: "],
    );
    scene_refused(
        ("\"hybrid\"", "\"hybird\""),
        "hybird",
        &["mesh.model.kind: "],
    );
}

#[test]
fn numbers_that_are_none_are_refused() {
    let centre = "centre_distance_mm = 54.7";
    scene_refused(
        (centre, "centre_distance_mm = inf"),
        "centre_distance_mm",
        &["pair.centre_distance_mm: found inf, allowed is a finite number from -1e6 to 1e6 mm"],
    );
    scene_refused(
        ("[20.0, 60.0]", "[20.0, nan]"),
        "torques_Nm",
        &["run.torques_Nm.1: found NaN, allowed is a finite number from -1e12 to 1e12 Nm"],
    );
}

/// The former form is read with a note and means the same; keys of gear meshes are refused.
#[test]
fn friction_has_the_names_of_gear_meshes() {
    let desk = Desk::new();
    let scene = |key: &str| {
        let friction = format!("{key} = 0.1 }}\n");
        desk.file("scene.toml", workshop().scene(&friction))
    };
    let result = desk.path("result.h5");
    let mean = |key: &str| {
        let file = scene(key);
        let answer = succeeds(&["run", argument(&file), "-o", argument(&result), "--json"]);
        (
            number(&answer.json()["rows"][0]["te_mean_m"]),
            answer.stderr,
        )
    };
    let (now, told) = mean("teeth.friction = { model = \"coulomb\", dynamic_coefficient");
    assert!(!told.contains("dynamic_coefficient"), "{told}");
    let (formerly, told) = mean("friction = { model = \"coulomb\", coefficient");
    assert_eq!(now, formerly);
    assert!(
        told.contains("teeth = { path = \"line-of-action\", friction = { model = \"coulomb\", dynamic_coefficient = 0.1 } }"),
        "{told}"
    );
    let none = run_scene(&desk, "").1;
    assert!((now / number(&none["rows"][0]["te_mean_m"]) - 1.0).abs() > 1e-4);
    let friction = "[mesh]\nteeth.friction = { model = \"coulomb\", dynamic_coefficient = 0.1, static_speed_mm_per_s = 5.0 }";
    scene_refused(
        ("[mesh]", friction),
        "static_speed",
        &["mesh.teeth.friction: unknown field `static_speed_mm_per_s`"],
    );
}
