//! Wrong input and failing work: what the program says, and what it leaves behind.
//!
//! Exit code 2 means that the input is wrong, 1 that the work failed. The message goes to standard error, standard
//! output stays empty; a message about a TOML file names file, line, key, what was found and what is allowed.
#![allow(clippy::unwrap_used, clippy::expect_used, missing_docs)]

mod common;

use common::{
    Answer, Desk, SOLID, THIN, argument, changed, gearmesh, line_of, names_in, succeeds, workshop,
};
use std::path::{Path, PathBuf};
use std::process::Command;

/// The answer is an error with this exit code and all of these parts.
fn refused(answer: &Answer, code: i32, parts: &[&str]) {
    assert_eq!(answer.code, Some(code), "{answer:#?}");
    assert_eq!(answer.stdout, "", "data in spite of an error");
    assert!(
        answer
            .stderr
            .lines()
            .any(|line| line.starts_with("error: ")),
        "{answer:#?}"
    );
    for part in parts {
        assert!(
            answer.stderr.contains(part),
            "`{part}` is not in {answer:#?}"
        );
    }
}

/// `gearmesh check` refuses a gear file in which `from` became `to`, at the line of `at`.
fn gear_refused(text: &str, (from, to): (&str, &str), at: &str, parts: &[&str]) {
    let desk = Desk::new();
    let text = changed(text, from, to);
    let file = desk.file("gear.toml", &text);
    let answer = gearmesh(&["check", argument(&file)]);
    refused(&answer, 2, parts);
    let place = format!("{}:{}: ", file.display(), line_of(&text, at));
    assert!(
        answer.stderr.contains(&place),
        "`{place}` is not in {answer:#?}"
    );
    // The commands that work with a gear refuse it before anything is written.
    for command in ["mesh", "reduce"] {
        let output = desk.path("output.vtu");
        let same = gearmesh(&[command, argument(&file), "-o", argument(&output)]);
        refused(&same, 2, &[&place]);
        assert_eq!(desk.names(), ["gear.toml"]);
    }
}

/// `gearmesh plan` and `run` refuse a scene in which `from` became `to`, at the line of `at`.
fn scene_refused((from, to): (&str, &str), at: &str, parts: &[&str]) {
    let desk = Desk::new();
    let text = changed(&workshop().scene(""), from, to);
    let file = desk.file("scene.toml", &text);
    let place = format!("{}:{}: ", file.display(), line_of(&text, at));
    refused(&gearmesh(&["plan", argument(&file)]), 2, parts);
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
fn an_unknown_key_is_answered_with_the_known_ones() {
    gear_refused(
        SOLID,
        ("poisson = 0.3", "poisson = 0.3\ndensity = 7850"),
        "density",
        &["unknown field `density`", "young_GPa", "poisson"],
    );
}

#[test]
fn a_wrong_unit_is_answered_with_the_right_key() {
    gear_refused(
        THIN,
        ("web_thickness_mm = 4.0", "web_thickness_m = 0.004"),
        "web_thickness_m ",
        &[
            "`web_thickness_m`",
            "did you mean `web_thickness_mm`? The unit is part of the key",
        ],
    );
}

#[test]
fn a_web_of_negative_thickness_is_refused() {
    gear_refused(
        THIN,
        ("web_thickness_mm = 4.0", "web_thickness_mm = -4.0"),
        "web_thickness_mm",
        &[
            "blank.web_thickness_mm",
            "found -4",
            "more than 0 and at most the face width, 12",
        ],
    );
}

/// Root diameter 3 (18 + 0.2 − 2.5) = 47.1 mm; one module less is allowed.
#[test]
fn a_rim_without_material_below_the_root_is_refused() {
    gear_refused(
        THIN,
        (
            "rim_inner_diameter_mm = 38.0",
            "rim_inner_diameter_mm = 46.0",
        ),
        "rim_inner_diameter_mm",
        &[
            "blank.rim_inner_diameter_mm",
            "found 46",
            "less than 44.1",
            "root diameter 47.1",
        ],
    );
}

#[test]
fn a_bore_larger_than_the_root_is_refused() {
    gear_refused(
        SOLID,
        ("bore_diameter_mm = 14.0", "bore_diameter_mm = 50.0"),
        "bore_diameter_mm",
        &[
            "blank.bore_diameter_mm",
            "found 50",
            "less than 44.1",
            "root diameter 47.1",
        ],
    );
}

fn slotted(count: usize, width_deg: f64) -> String {
    format!(
        "web_thickness_mm = 4.0\n[blank.slots]\ncount = {count}\ninner_radius_mm = 12.0\nouter_radius_mm = 17.0\n\
         width_deg = {width_deg}\nphase_deg = 10.0\ncorner_radius_mm = 0.8"
    )
}

#[test]
fn slots_that_meet_are_refused() {
    gear_refused(
        THIN,
        ("web_thickness_mm = 4.0", &slotted(3, 119.0)),
        "[blank.slots]",
        &[
            "blank.slots",
            "3 openings of 119.000 deg meet",
            "1.000 deg are left",
            "at least 14.324 deg",
        ],
    );
}

#[test]
fn slots_that_do_not_divide_the_teeth_work_with_a_warning() {
    let desk = Desk::new();
    let file = desk.file(
        "gear.toml",
        changed(THIN, "web_thickness_mm = 4.0", &slotted(5, 30.0)),
    );
    let answer = succeeds(&["check", argument(&file)]);
    assert!(answer.stdout.contains("sound"), "{answer:#?}");
    assert!(
        answer.stderr.contains("warning: ") && answer.stderr.contains("do not divide the teeth"),
        "{answer:#?}"
    );
    // Three slots repeat with the teeth: no warning.
    let file = desk.file(
        "gear.toml",
        changed(THIN, "web_thickness_mm = 4.0", &slotted(3, 30.0)),
    );
    assert_eq!(succeeds(&["check", argument(&file)]).stderr, "");
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

#[test]
fn a_value_of_the_wrong_type_is_named_by_its_key() {
    gear_refused(
        SOLID,
        ("teeth = 18", "teeth = \"18\""),
        "teeth",
        &["tooth.teeth: "],
    );
    scene_refused(("\"hybrid\"", "\"hybird\""), "hybird", &["mesh.model: "]);
}

/// Base pitches agree, but the base circles already touch: 2 r_b = 50.74 mm.
#[test]
fn a_pair_that_cannot_run_is_refused() {
    let centre = "centre_distance_mm = 54.7";
    scene_refused(
        (centre, "centre_distance_mm = 50.0"),
        "[pair]",
        &["pair", "50.0000 mm", "sum of the base radii, 50.74"],
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
fn a_missing_file_is_named() {
    let desk = Desk::new();
    let missing = desk.path("missing");
    let (name, output) = (argument(&missing), desk.path("output.h5"));
    for command in ["mesh", "reduce", "run", "recover", "report"] {
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

const OLD: &[u8] = b"the old file";

/// Runs the program with files limited to 4 blocks of 512 or 1024 bytes; `signal` says what happens at the limit.
fn with_short_files(signal: &str, arguments: &[&str]) -> Answer {
    let limited = format!("{signal} ulimit -f 4; exec \"$0\" \"$@\"");
    let program = env!("CARGO_BIN_EXE_gearmesh");
    Command::new("sh")
        .args(["-c", &limited, program])
        .args(arguments)
        .output()
        .unwrap()
        .into()
}

/// The outputs of a small run, each named with the command that writes it.
fn writing<'a>(scene: &'a str, result: &'a str, output: &'a str) -> [[&'a str; 4]; 3] {
    [
        ["run", scene, "-o", output],
        ["recover", result, "-o", output],
        ["report", result, "-o", output],
    ]
}

/// With `trap '' XFSZ` the write ends with an error code, as on a full disk.
#[test]
fn a_failed_write_leaves_the_old_file_and_nothing_else() {
    let (desk, outputs) = (Desk::new(), Desk::new());
    let scene = desk.file("scene.toml", workshop().scene(""));
    let result = desk.path("result.h5");
    succeeds(&["run", argument(&scene), "-o", argument(&result)]);
    let old = outputs.file("old", OLD);
    for arguments in writing(argument(&scene), argument(&result), argument(&old)) {
        refused(
            &with_short_files("trap '' XFSZ;", &arguments),
            1,
            &[argument(&old)],
        );
        assert_eq!(std::fs::read(&old).unwrap(), OLD);
        assert_eq!(outputs.names(), ["old"], "left by {arguments:?}");
    }
}

/// Without the trap the system kills the program in the midst of the write. It cannot tidy up then, but what it leaves
/// is hidden and bears another name.
#[test]
fn a_killed_write_leaves_the_old_file() {
    let (desk, outputs) = (Desk::new(), Desk::new());
    let scene = desk.file("scene.toml", workshop().scene(""));
    let result = desk.path("result.h5");
    succeeds(&["run", argument(&scene), "-o", argument(&result)]);
    let old = outputs.file("old", OLD);
    for arguments in writing(argument(&scene), argument(&result), argument(&old)) {
        let answer = with_short_files("", &arguments);
        assert_eq!(answer.code, None, "no signal: {answer:#?}");
        assert_eq!(std::fs::read(&old).unwrap(), OLD);
    }
    assert!(
        outputs
            .names()
            .iter()
            .all(|name| name == "old" || name.starts_with('.')),
        "{:?}",
        outputs.names()
    );
}

/// A file system of 64 kB, unmounted when it goes.
struct SmallDisk {
    folder: PathBuf,
    _parent: tempfile::TempDir,
}

impl SmallDisk {
    /// `None` where mounting is not allowed.
    fn mount() -> Option<Self> {
        let parent = tempfile::tempdir().unwrap();
        let folder = parent.path().join("disk");
        std::fs::create_dir(&folder).unwrap();
        let mount = Command::new("mount")
            .args(["-t", "tmpfs", "-o", "size=64k", "tmpfs"])
            .arg(&folder)
            .output();
        mount
            .is_ok_and(|output| output.status.success())
            .then_some(Self {
                folder,
                _parent: parent,
            })
    }
}

impl Drop for SmallDisk {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(&self.folder).status();
    }
}

/// A full disk with an old file, and what a command left on it after it failed.
fn on_a_full_disk(disk: &SmallDisk, command: impl FnOnce(&str) -> Answer) -> Answer {
    let old = disk.folder.join("old.vtu");
    std::fs::write(&old, OLD).unwrap();
    std::fs::write(disk.folder.join("full"), vec![1; 52 << 10]).unwrap();
    let answer = command(argument(&old));
    assert_eq!(std::fs::read(&old).unwrap(), OLD);
    assert_eq!(
        names_in(&disk.folder),
        ["full", "old.vtu"],
        "something half written is left: {answer:#?}"
    );
    refused(&answer, 1, &[argument(&old)]);
    answer
}

/// Needs the right to mount; elsewhere `a_failed_write_leaves_the_old_file_and_nothing_else` alone stands for it.
#[test]
fn a_full_disk_leaves_the_old_file_and_nothing_else() {
    let Some(disk) = SmallDisk::mount() else {
        return;
    };
    let desk = Desk::new();
    let (scene, gear) = (
        desk.file("scene.toml", workshop().scene("")),
        desk.file("gear.toml", SOLID),
    );
    let result = desk.path("result.h5");
    succeeds(&["run", argument(&scene), "-o", argument(&result)]);
    for command in ["run", "recover", "report", "reduce"] {
        let input = match command {
            "run" => &scene,
            "reduce" => &gear,
            _ => &result,
        };
        let answer = on_a_full_disk(&disk, |old| {
            gearmesh(&[command, argument(input), "-o", old])
        });
        assert!(answer.stderr.contains("No space left"), "{answer:#?}");
    }
}

#[test]
#[ignore = "export_mesh blames the input, exit code 2, whatever fails in Python"]
fn a_mesh_that_does_not_fit_the_disk_is_no_fault_of_the_input() {
    let Some(disk) = SmallDisk::mount() else {
        return;
    };
    let desk = Desk::new();
    let gear = desk.file("gear.toml", SOLID);
    on_a_full_disk(&disk, |old| gearmesh(&["mesh", argument(&gear), "-o", old]));
}
