//! Missing and damaged files, arguments that do not fit a model.

use std::path::Path;

use crate::common::{Answer, Desk, argument, changed, gearmesh, refused, workshop};

#[test]
fn a_missing_file_is_named() {
    let desk = Desk::new();
    let missing = desk.path("missing");
    let name = argument(&missing);
    for (command, output) in [
        ("mesh", "output.vtu"),
        ("reduce", "output.h5"),
        ("run", "output.h5"),
        ("recover", "output.h5"),
        ("report", "output.html"),
    ] {
        let output = desk.path(output);
        refused(
            &gearmesh(&[command, name, "-o", argument(&output)]),
            2,
            &[name, "No such file"],
        );
    }
    for command in ["check", "plan"] {
        refused(&gearmesh(&[command, name]), 2, &[name, "No such file"]);
    }
    refused(&compliance(&missing), 2, &[name, "No such file"]);
    assert!(desk.names().is_empty());
}

fn compliance(model: &Path) -> Answer {
    let load = [
        "--tooth",
        "0",
        "--radius-mm",
        "27",
        "--line-load-N-per-mm",
        "100",
        "--half-width-mm",
        "0.1",
    ];
    gearmesh(&[&["compliance", argument(model)], load.as_slice()].concat())
}

/// A model that no command accepts; `parts` is what each says.
fn model_refused(content: &[u8], parts: &[&str]) {
    let desk = Desk::new();
    let model = desk.file("model.h5", content);
    let named = [parts, &[argument(&model)]].concat();
    refused(&gearmesh(&["check", argument(&model)]), 2, &named);
    refused(&compliance(&model), 2, &named);
    let scene = changed(
        &workshop().scene(""),
        argument(&workshop().thin),
        argument(&model),
    );
    refused(
        &gearmesh(&["plan", argument(&desk.file("scene.toml", scene))]),
        2,
        &named,
    );
}

#[test]
fn a_model_cut_in_half_is_refused() {
    let sound = std::fs::read(&workshop().thin).unwrap();
    let (half, whole) = (sound.len() / 2, sound.len());
    model_refused(
        &sound[..half],
        &[
            "is truncated",
            &format!("{half} bytes, {whole} when it was written"),
        ],
    );
}

#[test]
fn a_model_with_a_flipped_byte_is_refused() {
    let mut bytes = std::fs::read(&workshop().thin).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 0x10;
    model_refused(&bytes, &["was altered or damaged after it was written"]);
}

#[test]
fn a_file_that_is_no_model_is_refused() {
    model_refused(b"time,strain\n0,1\n", &["was not written by gearmesh"]);
    model_refused(b"", &["was not written by gearmesh"]);
}

#[test]
fn a_model_is_no_result() {
    let output = Desk::new();
    let report = output.path("report.html");
    let answer = gearmesh(&[
        "report",
        argument(&workshop().thin),
        "-o",
        argument(&report),
    ]);
    refused(&answer, 2, &[argument(&workshop().thin), "gearmesh-result"]);
    assert!(output.names().is_empty());
}

#[test]
fn arguments_out_of_range_are_answered_with_the_range() {
    let model = argument(&workshop().thin);
    let with = |tooth: &str, radius: &str, load: &str| {
        gearmesh(&[
            "compliance",
            model,
            "--tooth",
            tooth,
            "--radius-mm",
            radius,
            "--line-load-N-per-mm",
            load,
            "--half-width-mm",
            "0.1",
        ])
    };
    refused(
        &with("18", "27", "100"),
        2,
        &["--tooth", "found 18", "0 to 17"],
    );
    refused(
        &with("0", "31", "100"),
        2,
        &["--radius-mm", "found 31", "allowed is"],
    );
    refused(
        &with("0", "27", "0"),
        2,
        &["--line-load-N-per-mm", "found 0", "more than 0"],
    );
}
