//! An import runs what it wrote: figures at rest first, and what is lost or wrong before everything else.

use crate::common::{Desk, argument, changed, gearmesh, refused, succeeds};
use std::path::Path;

const GEARBOX: &str = include_str!("../../../../fe_models/gearbox_three_stage.rexs");

/// The shipped gearbox with changes, and where it shall go.
fn imported(desk: &Desk, text: &str, further: &[&str]) -> crate::common::Answer {
    let model = desk.file("box.rexs", text);
    let folder = desk.path("out");
    let words = ["import", argument(&model), "-o", argument(&folder)];
    gearmesh(&[&words, further].concat())
}

/// A line of the file.
fn line(start: &str) -> &'static str {
    let found = GEARBOX.lines().find(|l| l.trim_start().starts_with(start));
    found.unwrap_or_else(|| panic!("no line {start}"))
}

#[test]
fn the_first_screen_has_power_shafts_bearings_and_meshes() {
    let desk = Desk::new();
    let answer = imported(&desk, GEARBOX, &[]);
    assert_eq!(answer.code, Some(0), "{answer:#?}");
    let said: Vec<&str> = answer.stdout.lines().collect();
    assert!(said[0].contains("at rest under its loads"), "{said:#?}");
    for words in [
        ["power in 4431 W", "out 4431 W"],
        ["output shaft", "1200"],
        ["bearing 4B", "6583"],
        ["third stage", "1.04"],
    ] {
        let told = said.iter().any(|l| words.iter().all(|w| l.contains(w)));
        assert!(told, "{words:?} is not in {said:#?}");
    }
    let remarks: Vec<&str> = answer.stderr.lines().collect();
    assert!(!answer.stderr.contains("warning"), "{remarks:#?}");
    // One of 21 assumptions weighs; the others are counted.
    assert!(
        remarks[0].contains("more than 1 %: 1") && remarks.len() < 6,
        "{remarks:#?}"
    );
    assert!(
        remarks.last().unwrap().starts_with("next: gearmesh run "),
        "{remarks:#?}"
    );
}

#[test]
fn figures_for_machines_are_those_of_the_run() {
    let desk = Desk::new();
    let told = imported(&desk, GEARBOX, &["--json"]).json();
    let scenes = told["at_rest"]["scenes"].as_array().unwrap();
    assert_eq!(scenes.len(), 2);
    for (scene, share) in scenes.iter().zip([1.0, 0.5]) {
        let near = |value: &serde_json::Value, wanted: f64| {
            let value = value.as_f64().unwrap();
            assert!(
                (value - share * wanted).abs() < 1e-3 * share * wanted.abs(),
                "{value} {wanted}"
            );
        };
        // 28.2067720372 N m at 1500 1/min.
        let power = 28.206_772_037_2 * 1500.0 * std::f64::consts::PI / 30.0;
        near(&scene["power_in_W"], power);
        near(&scene["power_out_W"], power);
        // Ratios 59/17, 67/19, 73/21.
        let second = 28.206_772_037_2 * 59.0 / 17.0;
        for (shaft, torque) in [(1, second), (2, second * 67.0 / 19.0), (3, 1200.0)] {
            near(&scene["shafts"][shaft]["torque_Nm"], torque);
        }
    }
    assert_eq!(told["warnings"].as_array().unwrap().len(), 0);
}

#[test]
fn a_lost_load_is_told_first() {
    let desk = Desk::new();
    let stage = line("<relation id=\"70\"");
    for text in [
        changed(GEARBOX, stage, ""),
        changed(
            GEARBOX,
            "<ref id=\"23\" role=\"gear_2\"",
            "<ref id=\"999\" role=\"gear_2\"",
        ),
    ] {
        let answer = imported(&desk, &text, &[]);
        let first: Vec<&str> = answer.stderr.lines().take(4).collect();
        assert!(
            first.iter().all(|l| l.starts_with("warning: ")),
            "{first:#?}"
        );
        assert!(
            first
                .iter()
                .any(|l| l.contains("motor") && l.contains("does not act")),
            "{first:#?}"
        );
        assert!(!answer.stderr.contains("gearmesh run"), "{answer:#?}");
        assert!(
            answer
                .stderr
                .contains("no power goes through its 2 gear meshes"),
            "{answer:#?}"
        );
    }
}

#[test]
fn a_scene_that_is_refused_or_finds_no_equilibrium_is_an_error() {
    let desk = Desk::new();
    // A gear 60 mm off its mate.
    let gear = GEARBOX.find("name=\"wheel 59\"").unwrap();
    let place = gear + GEARBOX[gear..].find("u_coordinate_on_shaft").unwrap();
    let value = place + GEARBOX[place..].find('>').unwrap() + 1;
    let end = value + GEARBOX[value..].find('<').unwrap();
    let apart = format!("{}-29{}", &GEARBOX[..value], &GEARBOX[end..]);
    let answer = imported(&desk, &apart, &[]);
    refused(
        &answer,
        2,
        &[
            "warning: cylindrical_stage 30",
            "the scene will refuse this mesh",
            "box.toml",
            "cannot be used",
        ],
    );
    // Its files are there to look at.
    assert!(desk.path("out").join("box.toml").is_file());
    let written = imported(&desk, &apart, &["--no-run"]);
    assert_eq!(written.code, Some(0), "{written:#?}");
    // A bearing at 9 m.
    let bearing = "<attribute id=\"u_coordinate_on_shaft_inner_side\" unit=\"mm\">90<";
    let far = changed(GEARBOX, bearing, &bearing.replace("90<", "9000<"));
    let answer = imported(&desk, &far, &[]);
    let first = answer.stderr.lines().next().unwrap();
    assert!(
        first.contains("warning: shaft 10 `input shaft`") && first.contains("8910"),
        "{answer:#?}"
    );
}

/// Numbers that stand for rigid, and bearings without radial support, are no slips of units.
#[test]
fn what_the_import_writes_is_no_slip_of_units() {
    let desk = Desk::new();
    let text = GEARBOX.replace(
        "\"elastic_modulus\" unit=\"N / mm^2\">210000<",
        "\"elastic_modulus\" unit=\"N / mm^2\">1e9<",
    );
    assert!(text.contains(">1e9<"));
    let answer = imported(&desk, &text, &[]);
    assert!(!answer.stderr.contains("slip"), "{answer:#?}");
    let scene = desk.path("out").join("box.toml");
    assert!(
        std::fs::read_to_string(&scene)
            .unwrap()
            .contains("young_GPa = 20000.0")
    );
    let checked = succeeds(&["check", argument(Path::new(&scene))]);
    assert!(!checked.stderr.contains("slip"), "{checked:#?}");
}

/// The gears are not reduced yet: the loads are those of the springs.
#[test]
fn an_import_for_reduced_gears_runs_with_springs() {
    let desk = Desk::new();
    let answer = imported(&desk, GEARBOX, &["--reduced"]);
    assert_eq!(answer.code, Some(0), "{answer:#?}");
    assert!(
        answer.stdout.contains("power in 4431 W, out 4431 W"),
        "{answer:#?}"
    );
    assert!(
        answer
            .stdout
            .contains("springs of ISO 6336 for the reduced gears"),
        "{answer:#?}"
    );
    assert!(
        answer.stderr.contains("helix_slope") && answer.stderr.contains("next: gearmesh reduce "),
        "{answer:#?}"
    );
}
