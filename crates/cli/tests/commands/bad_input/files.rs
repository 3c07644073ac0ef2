//! What is given as a file: devices, pipes, folders, huge files, files that are no tables; outputs that are inputs.

use crate::common::{Answer, Desk, argument, changed, program, refused, succeeds, workshop};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

/// Time after which a command counts as one that never ends.
const FOREVER: Duration = Duration::from_secs(30);

/// Starts the program in a folder; it must end by itself.
fn ends_in(folder: &Path, arguments: &[&str]) -> Answer {
    let mut command = program(arguments);
    command.current_dir(folder);
    crate::common::ends(command, FOREVER)
}

fn ends(arguments: &[&str]) -> Answer {
    ends_in(Path::new("."), arguments)
}

fn pipe(desk: &Desk, name: &str) -> PathBuf {
    let path = desk.path(name);
    assert!(
        Command::new("mkfifo")
            .arg(&path)
            .status()
            .unwrap()
            .success()
    );
    path
}

const WHEEL: &str = include_str!("../../../../../tests/support/wheel.toml");

/// A scene whose torque is a table in a file.
fn with_table(file: &str) -> String {
    let table = format!(r#"torque_Nm = {{ table = {{ file = "{file}", column = "torque_Nm" }} }}"#);
    changed(WHEEL, "torque_Nm = 2.0", &table)
}

#[test]
fn devices_pipes_and_folders_are_refused_unread() {
    let desk = Desk::new();
    let toml = pipe(&desk, "pipe.toml");
    let h5 = pipe(&desk, "pipe.h5");
    std::fs::create_dir(desk.path("folder.toml")).unwrap();
    let folder = desk.path("folder.toml");
    let device = "is a device, pipe or socket; give a regular file";
    for command in ["check", "plan"] {
        refused(&ends(&[command, "/dev/zero"]), 2, &["/dev/zero: ", device]);
        refused(
            &ends(&[command, argument(&toml)]),
            2,
            &["pipe.toml: ", device],
        );
        refused(&ends(&[command, argument(&folder)]), 2, &["is a folder"]);
    }
    let output = desk.path("out.h5");
    for command in ["run", "reduce"] {
        let answer = ends(&[command, argument(&toml), "-o", argument(&output)]);
        refused(&answer, 2, &["pipe.toml: ", device]);
    }
    let study = ends(&["study", argument(&toml), "-o", argument(&desk.path("out"))]);
    refused(&study, 2, &["pipe.toml: ", device]);
    refused(
        &ends(&["check", argument(&h5)]),
        2,
        &["pipe.h5 is no regular file"],
    );

    // Named by a scene or a gear file.
    for name in ["pipe.toml", "/dev/zero"] {
        let scene = desk.file("scene.toml", with_table(name));
        refused(&ends(&["plan", argument(&scene)]), 2, &[name, device]);
    }
    let text = workshop().scene("");
    let pair = changed(&text, argument(&workshop().solid), argument(&h5));
    let pair = desk.file("pair.toml", pair);
    refused(
        &ends(&["check", argument(&pair)]),
        2,
        &["pipe.h5 is no regular file"],
    );
    let gear = r#"name = "imported"
[tooth]
teeth = 18
module_mm = 3.0
face_width_mm = 12.0
[blank]
kind = "mesh"
bore_diameter_mm = 14.0
file = "pipe.toml"
length_unit = "mm"
[material]
young_GPa = 210.0
poisson = 0.3
"#;
    let gear = desk.file("gear.toml", gear);
    refused(
        &ends(&["check", argument(&gear)]),
        2,
        &["blank.file: ", "pipe.toml ", device],
    );
    // A record.
    std::fs::create_dir(desk.path("record")).unwrap();
    desk.file(
        "record/record.toml",
        "title = 't'\nkind = 'measured'\nsource = 's'\nangle_origin = 'o'\n",
    );
    pipe(&desk, "record/data.csv");
    let answer = ends(&["check", argument(&desk.path("record"))]);
    refused(&answer, 2, &["data.csv: ", device]);
}

#[test]
fn files_of_many_megabytes_are_refused_unread() {
    let desk = Desk::new();
    for name in ["big.toml", "big.csv"] {
        let file = std::fs::File::create(desk.path(name)).unwrap();
        file.set_len(65 << 20).unwrap();
    }
    let answer = ends(&["check", argument(&desk.path("big.toml"))]);
    refused(&answer, 2, &["big.toml: has 65 MB, more than the 64 MB"]);
    let scene = desk.file("scene.toml", with_table("big.csv"));
    refused(
        &ends(&["plan", argument(&scene)]),
        2,
        &["big.csv: has 65 MB"],
    );
}

/// A message shows names and numbers of a table, and nothing of a file that is none: a scene could name any file of the
/// machine.
#[test]
fn no_line_of_another_file_is_printed() {
    let secret = "hunter2";
    let desk = Desk::new();
    desk.file(
        "private.txt",
        format!("root:{secret}:0:0\n{secret},{secret}\n"),
    );
    let scene = desk.file("scene.toml", with_table("private.txt"));
    std::fs::create_dir(desk.path("record")).unwrap();
    desk.file(
        "record/record.toml",
        "title = 't'\nkind = 'measured'\nsource = 's'\nangle_origin = 'o'\n",
    );
    desk.file("record/data.csv", format!("{secret},{secret}\n"));
    for path in [scene, desk.path("private.txt"), desk.path("record")] {
        let answer = ends(&["check", argument(&path)]);
        refused(&answer, 2, &["error: "]);
        assert!(!answer.stderr.contains(secret), "{answer:#?}");
    }
}

#[test]
fn an_output_that_is_an_input_is_refused() {
    let desk = Desk::new();
    let solid = desk.path("solid.h5");
    std::fs::copy(&workshop().solid, &solid).unwrap();
    let before = std::fs::read(&solid).unwrap();
    let text = changed(
        &workshop().scene(""),
        argument(&workshop().solid),
        "solid.h5",
    );
    desk.file("scene.toml", text);
    std::fs::hard_link(&solid, desk.path("other.h5")).unwrap();
    std::os::unix::fs::symlink(&solid, desk.path("link.h5")).unwrap();
    std::fs::create_dir(desk.path("below")).unwrap();
    let here = desk.path("");
    // A model that the scene uses: by its name, spelled differently, and under another name.
    for output in ["solid.h5", "below/../solid.h5", "other.h5"] {
        let answer = ends_in(&here, &["run", "scene.toml", "-o", output]);
        refused(&answer, 2, &[output, "is read by this command", "solid.h5"]);
    }
    let answer = ends_in(&here, &["run", "scene.toml", "-o", "link.h5"]);
    refused(&answer, 2, &["link.h5 is a symbolic link"]);
    assert_eq!(std::fs::read(&solid).unwrap(), before);

    // Results, and models behind them.
    let result = desk.path("result.h5");
    succeeds(&[
        "run",
        argument(&desk.path("scene.toml")),
        "-o",
        argument(&result),
    ]);
    let before = std::fs::read(&result).unwrap();
    std::fs::hard_link(&result, desk.path("result.csv")).unwrap();
    std::fs::hard_link(&result, desk.path("result.html")).unwrap();
    for words in [
        ["recover", "result.h5", "-o", "result.h5"],
        ["recover", "result.h5", "-o", "solid.h5"],
        ["export", "result.h5", "-o", "result.csv"],
        ["report", "result.h5", "-o", "result.html"],
    ] {
        refused(
            &ends_in(&here, &words),
            2,
            &[words[3], "is read by this command"],
        );
    }
    assert_eq!(std::fs::read(&result).unwrap(), before);
    let gear = desk.file("gear.h5", crate::common::SOLID);
    let answer = ends(&["reduce", argument(&gear), "-o", argument(&gear)]);
    refused(&answer, 2, &["is read by this command"]);
}

#[test]
fn a_name_that_is_a_path_is_refused_before_the_run() {
    let desk = Desk::new();
    for name in ["..", ".", "a/b", r"a\u0000b"] {
        let text = WHEEL.replace("\"wheel\"", &format!("\"{name}\""));
        let scene = desk.file("scene.toml", &text);
        let output = desk.path("out.h5");
        for words in [
            &["check", argument(&scene)][..],
            &["plan", argument(&scene)],
            &["run", argument(&scene), "-o", argument(&output)],
        ] {
            refused(&ends(words), 2, &["body.0.name: found"]);
        }
        assert_eq!(desk.names(), ["scene.toml"]);
    }
}

/// What would fill the memory is reported before the first position is solved.
#[test]
fn a_run_of_too_many_positions_is_refused_by_plan_and_run() {
    let desk = Desk::new();
    let text = changed(
        &workshop().scene(""),
        "pitches = 3\npoints_per_pitch = 8",
        "pitches = 100000\npoints_per_pitch = 100000",
    );
    let scene = desk.file("scene.toml", text);
    let output = desk.path("out.h5");
    let found = ["run.pitches: ", "are 20000000000 positions"];
    refused(&ends(&["plan", argument(&scene)]), 2, &found);
    refused(&ends(&["check", argument(&scene)]), 2, &found);
    let answer = ends(&["run", argument(&scene), "-o", argument(&output)]);
    refused(&answer, 2, &found);
}

/// Plan and run say how large the result will be; one that is larger than allowed is refused before it is begun.
#[test]
fn a_large_result_is_refused_until_it_is_allowed() {
    let desk = Desk::new();
    let text = changed(WHEEL, "interval_s = 1e-2", "interval_s = 1e-5");
    let scene = desk.file("scene.toml", text);
    let output = desk.path("out.h5");
    let plan = succeeds(&["plan", argument(&scene)]).stdout;
    // 100 001 rows of eight bytes a column.
    assert!(
        plan.contains("result     100001 rows of 38 columns, 30.4 MB"),
        "{plan}"
    );
    let run = ["run", argument(&scene), "-o", argument(&output)];
    let least = [&run[..], &["--most-result-GB", "0.03"]].concat();
    refused(
        &ends(&least),
        2,
        &[
            "output.interval_s: the result will have 30.4 MB, allowed are 0.03 GB",
            "--most-result-GB 1 ",
        ],
    );
    assert_eq!(desk.names(), ["scene.toml"]);
    let enough = [&run[..], &["--most-result-GB", "0.04"]].concat();
    assert_eq!(ends(&enough).code, Some(0));
    assert!(output.exists());
}

#[test]
fn check_knows_studies_tables_and_records() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let says = |path: &str, parts: &[&str]| {
        let answer = succeeds(&["check", argument(&root.join(path))]);
        for part in parts {
            assert!(
                answer.stdout.contains(part),
                "`{part}` is not in {answer:#?}"
            );
        }
    };
    says(
        "fe_models/study_17_25.toml",
        &["study `", "sound: ", " cases, ", "dynamics_17_25.toml"],
    );
    says(
        "fe_models/sn_example.toml",
        &["S-N table, sound: ", " MPa at "],
    );
    says(
        "reference/pair_a",
        &["record `", "sound: computed, ", "te_um_"],
    );
    says("reference/pair_a/record.toml", &["record `"]);
    let desk = Desk::new();
    let table = desk.file(
        "sn.toml",
        "cycles = [1e3]\nstress_amplitude_MPa = [5, 4]\nbelow = 'haibach'\n",
    );
    refused(
        &ends(&["check", argument(&table)]),
        2,
        &["sn.toml:1: cycles: "],
    );
    desk.file("scene.toml", WHEEL);
    let study = "title = 's'\nscene = 'scene.toml'\ncolumns = ['x']\n[[parameter]]\nname = 'a'\nkeys = ['load.7.torque_Nm']\nvalues = [1.0]\n";
    let study = desk.file("study.toml", study);
    refused(&ends(&["check", argument(&study)]), 2, &["load.7"]);
}
