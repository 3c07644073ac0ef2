//! Work that fails or is killed while it writes: exit code 1, and what it leaves behind.

use crate::common;

use common::{
    Answer, Desk, SOLID, argument, changed, gearmesh, names_in, program, refused, send, succeeds,
    workshop,
};
use std::path::PathBuf;
use std::process::Command;
use std::time::Duration;

const OLD: &[u8] = b"the old file";

/// Runs the program with files limited to 4 blocks of 512 or 1024 bytes; `signal` says what happens at the limit.
fn with_short_files(signal: &str, arguments: &[&str]) -> Answer {
    with_files_of(4, signal, arguments)
}

fn with_files_of(blocks: usize, signal: &str, arguments: &[&str]) -> Answer {
    let limited = format!("{signal} ulimit -f {blocks}; exec \"$0\" \"$@\"");
    let program = env!("CARGO_BIN_EXE_gearmesh");
    Command::new("sh")
        .args(["-c", &limited, program])
        .args(arguments)
        .output()
        .unwrap()
        .into()
}

/// A command that writes, and the name of its output.
const OUTPUTS: [(&str, &str); 3] = [
    ("run", "old.h5"),
    ("recover", "old.h5"),
    ("report", "old.html"),
];

/// With `trap '' XFSZ` the write ends with an error code, as on a full disk.
#[test]
fn a_failed_write_leaves_the_old_file_and_nothing_else() {
    let (desk, outputs) = (Desk::new(), Desk::new());
    let scene = desk.file("scene.toml", workshop().scene(""));
    let result = desk.path("result.h5");
    succeeds(&["run", argument(&scene), "-o", argument(&result)]);
    for (command, name) in OUTPUTS {
        let input = if command == "run" { &scene } else { &result };
        let old = outputs.file(name, OLD);
        let arguments = [command, argument(input), "-o", argument(&old)];
        refused(
            &with_short_files("trap '' XFSZ;", &arguments),
            1,
            &[argument(&old)],
        );
        assert_eq!(std::fs::read(&old).unwrap(), OLD);
        std::fs::remove_file(&old).unwrap();
        assert!(outputs.names().is_empty(), "left by {arguments:?}");
    }
}

/// Without the trap the system kills the program in the midst of the write. It cannot tidy up then, but what it leaves
/// is hidden and has another name.
#[test]
fn a_killed_write_leaves_the_old_file() {
    let (desk, outputs) = (Desk::new(), Desk::new());
    let scene = desk.file("scene.toml", workshop().scene(""));
    let result = desk.path("result.h5");
    succeeds(&["run", argument(&scene), "-o", argument(&result)]);
    for (command, name) in OUTPUTS {
        let input = if command == "run" { &scene } else { &result };
        let old = outputs.file(name, OLD);
        let arguments = [command, argument(input), "-o", argument(&old)];
        let answer = with_short_files("", &arguments);
        assert_eq!(answer.code, None, "no signal: {answer:#?}");
        assert_eq!(std::fs::read(&old).unwrap(), OLD);
    }
    assert!(
        outputs
            .names()
            .iter()
            .all(|name| name == "old.h5" || name == "old.html" || name.starts_with('.')),
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
fn on_a_full_disk(disk: &SmallDisk, name: &str, command: impl FnOnce(&str) -> Answer) -> Answer {
    let old = disk.folder.join(name);
    std::fs::write(&old, OLD).unwrap();
    std::fs::write(disk.folder.join("full"), vec![1; 52 << 10]).unwrap();
    let answer = command(argument(&old));
    assert_eq!(std::fs::read(&old).unwrap(), OLD);
    assert_eq!(
        names_in(&disk.folder),
        ["full", name],
        "something half written is left: {answer:#?}"
    );
    refused(&answer, 1, &[argument(&old)]);
    std::fs::remove_file(&old).unwrap();
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
        let name = if command == "report" {
            "old.html"
        } else {
            "old.h5"
        };
        let answer = on_a_full_disk(&disk, name, |old| {
            gearmesh(&[command, argument(input), "-o", old])
        });
        assert!(answer.stderr.contains("No space left"), "{answer:#?}");
    }
}

#[test]
fn a_mesh_that_does_not_fit_the_disk_is_no_fault_of_the_input() {
    let Some(disk) = SmallDisk::mount() else {
        return;
    };
    let desk = Desk::new();
    let gear = desk.file("gear.toml", SOLID);
    on_a_full_disk(&disk, "old.vtu", |old| {
        gearmesh(&["mesh", argument(&gear), "-o", old])
    });
}

/// Ctrl-C in the midst of a reduction: no output, no scratch files, the shell's exit code.
#[test]
fn an_interrupted_reduction_leaves_nothing() {
    let (desk, outputs, scratch) = (Desk::new(), Desk::new(), Desk::new());
    // Fine enough to take longer than the time it is given.
    let fine = "fillet_mm = 0.12\nbody_mm = 2.0\naxial_mm = 0.8";
    let gear = changed(
        SOLID,
        "fillet_mm = 0.6\nbody_mm = 4.0\naxial_mm = 3.0",
        fine,
    );
    // The whole factorisation takes many times as long as one by symmetry.
    let gear = changed(&gear, "[reduction]", "[reduction]\nsymmetry = \"off\"");
    let gear = desk.file("gear.toml", gear);
    let output = outputs.path("gear.h5");
    let child = program(&["reduce", argument(&gear), "-o", argument(&output)])
        .env("TMPDIR", scratch.path(""))
        .spawn()
        .unwrap();
    std::thread::sleep(Duration::from_millis(1500));
    send("-INT", child.id());
    let answer = Answer::from(child.wait_with_output().unwrap());
    refused(&answer, 130, &["interrupted"]);
    assert!(outputs.names().is_empty(), "{:?}", outputs.names());
    assert!(scratch.names().is_empty(), "{:?}", scratch.names());
}

/// A multibody run that finds the disk full keeps its last checkpoint and the rows before it. The same command goes on
/// from there and ends with the rows of a run that nothing stopped.
#[test]
fn a_run_goes_on_where_the_disk_was_full() {
    let desk = Desk::new();
    let scene = include_str!("../../../../tests/support/wheel.toml");
    let scene = desk.file(
        "scene.toml",
        changed(scene, "interval_s = 1e-2", "interval_s = 1e-4"),
    );
    let [whole, cut] = ["whole.h5", "cut.h5"].map(|name| desk.path(name));
    succeeds(&["run", argument(&scene), "-o", argument(&whole)]);
    let words = ["run", argument(&scene), "-o", argument(&cut)];
    // A checkpoint after each step: the rows' file is the first that becomes too long.
    let words = [&words[..], &["--checkpoint-s", "1e-9"]].concat();
    refused(
        &with_files_of(500, "trap '' XFSZ;", &words),
        1,
        &["cut.h5.part/rows.log", "too large"],
    );
    assert!(!cut.exists());
    assert!(desk.path("cut.h5.part/checkpoint.h5").is_file());
    let told = succeeds(&words).stderr;
    assert!(told.contains("goes on from the checkpoint at"), "{told}");
    let table = |result: &PathBuf| {
        let csv = result.with_extension("csv");
        succeeds(&["export", argument(result), "-o", argument(&csv)]);
        std::fs::read_to_string(csv).unwrap()
    };
    assert_eq!(table(&cut), table(&whole));
    assert_eq!(
        desk.names()
            .iter()
            .filter(|name| name.contains("part"))
            .count(),
        0
    );
}
