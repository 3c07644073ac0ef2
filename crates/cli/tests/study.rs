//! `gearmesh study`: cases, figures, what is wrong with a study.
#![allow(clippy::unwrap_used, clippy::expect_used, missing_docs)]

mod common;

use common::{Desk, argument, changed, gearmesh, number, refused, succeeds};

/// A wheel of 0.5 kg m² that a torque turns for a second: ω(1) = T/J.
const SCENE: &str = include_str!("../../../tests/support/wheel.toml");

const STUDY: &str = r#"title = "Torque"
scene = "scene.toml"
columns = ["bodies/wheel/angular_velocity_z_rad_per_s"]
[[parameter]]
name = "torque"
keys = ["load.0.torque_Nm"]
values = [4.0]
"#;

#[test]
fn a_study_prints_its_cases_and_keeps_its_results() {
    let desk = Desk::new();
    desk.file("scene.toml", SCENE);
    let study = desk.file("study.toml", STUDY);
    let out = desk.path("out");
    let command = ["study", argument(&study), "-o", argument(&out)];
    let told = succeeds(&command).stdout;
    assert!(told.starts_with("Torque, from 0 s on\n"), "{told}");
    let line = |name: &str| told.lines().find(|line| line.starts_with(name)).unwrap();
    for (name, last) in [("as it is", "4.000"), ("torque = 4.0", "8.000")] {
        assert!(line(name).ends_with(last), "{told}");
    }
    let names = common::names_in(&out);
    let files = succeeds(&[&command[..], &["--json"]].concat()).json();
    assert_eq!(common::names_in(&out), names);
    assert!(
        names.contains(&"study.csv".to_owned()) && names.len() == 3,
        "{names:?}"
    );
    let case = &files["cases"][1];
    assert_eq!(number(&case["parameters"]["torque"]), 4.0);
    assert!((number(&case["columns"][0]["largest"]) - 8.0).abs() < 1e-9);
}

#[test]
fn a_wrong_study_is_refused_and_a_failed_case_is_told() {
    let desk = Desk::new();
    desk.file("scene.toml", SCENE);
    let out = desk.path("out");
    let run = |name: &str, text: String| {
        let study = desk.file(name, text);
        gearmesh(&["study", argument(&study), "-o", argument(&out)])
    };
    let answer = run("key.toml", changed(STUDY, "load.0", "load.1"));
    refused(
        &answer,
        2,
        &["key.toml:6", "`load.1.torque_Nm`", "items 0 to 0"],
    );
    assert!(!out.exists());
    let answer = run(
        "column.toml",
        changed(STUDY, "angular_velocity_z", "speed_z"),
    );
    assert_eq!(answer.code, Some(1));
    assert!(answer.stderr.contains("2 of 2 cases failed"), "{answer:#?}");
    assert!(
        answer.stdout.contains("no column `bodies/wheel/speed_z"),
        "{}",
        answer.stdout
    );
}
