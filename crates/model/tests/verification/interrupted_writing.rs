//! A full disk or a killed run leaves the old file or none.
//!
//! Each test starts its own executable again as the process that fails: a limit on the size of files stands for the
//! full disk (writes fail in the same way, with EFBIG instead of ENOSPC).

#![cfg(unix)]

use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use crate::made_up_models::small_reduced_gear;
use gearmesh_model::{
    Column, ColumnFile, DataTree, FileError, FileFormat, ReducedGear, RowLog, StoredGear,
    read_reduced_gear, write_columns, write_reduced_gear,
};

const CHILD_PATH: &str = "GEARMESH_TEST_CHILD_PATH";

/// The synthetic gear with a long input text: large enough that each limit strikes at another stage of writing.
fn large_gear() -> ReducedGear {
    let mut gear = small_reduced_gear();
    gear.input = StoredGear::without_definition("# a long comment\n".repeat(20_000));
    gear
}

#[test]
fn full_disk_leaves_the_old_file() {
    if let Some(path) = std::env::var_os(CHILD_PATH) {
        let error = write_reduced_gear(Path::new(&path), &large_gear()).unwrap_err();
        assert!(
            matches!(error, FileError::Hdf5 { .. } | FileError::Io { .. }),
            "{error}"
        );
        assert!(error.to_string().contains("File too large"), "{error}");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let old = small_reduced_gear();
    for blocks in [0, 1, 4, 40, 200, 400] {
        let (kept, none) = (folder.path().join("gear.h5"), folder.path().join("none.h5"));
        write_reduced_gear(&kept, &old).unwrap();
        for path in [&kept, &none] {
            // The signal is ignored so that the write itself fails, as it does on a full disk.
            let limited = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" \"$@\"");
            let output = Command::new("bash")
                .args(["-c", &limited])
                .arg(std::env::current_exe().unwrap())
                .args([
                    "--exact",
                    "interrupted_writing::full_disk_leaves_the_old_file",
                    "--nocapture",
                ])
                .env(CHILD_PATH, path)
                .stdin(Stdio::null())
                .output()
                .unwrap();
            let said = String::from_utf8_lossy(&output.stderr).into_owned();
            assert!(
                output.status.success(),
                "limit {blocks} KiB: {}\n{said}",
                String::from_utf8_lossy(&output.stdout)
            );
            assert!(
                !said.contains("HDF5-DIAG"),
                "libhdf5 prints to stderr: {said}"
            );
        }
        assert_eq!(read_reduced_gear(&kept).unwrap(), old, "limit {blocks} KiB");
        assert!(!none.exists());
        assert_eq!(
            std::fs::read_dir(folder.path()).unwrap().count(),
            1,
            "temporary files are left"
        );
    }
}

#[test]
fn killed_run_leaves_a_whole_file() {
    if let Some(path) = std::env::var_os(CHILD_PATH) {
        loop {
            write_reduced_gear(Path::new(&path), &large_gear()).unwrap();
        }
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("gear.h5");
    let old = small_reduced_gear();
    write_reduced_gear(&path, &old).unwrap();
    for milliseconds in [20, 35, 50, 65, 80, 95] {
        let mut child = this_test("killed_run_leaves_a_whole_file", &path);
        std::thread::sleep(Duration::from_millis(milliseconds));
        child.kill().unwrap();
        child.wait().unwrap();
        let found = read_reduced_gear(&path).unwrap();
        assert!(found == old || found == large_gear());
    }
}

/// A result is written where its log is: whenever the process is killed, nothing but the result stands beside it.
#[test]
fn killed_run_leaves_nothing_beside_its_result() {
    const FORMAT: FileFormat = FileFormat {
        name: "interrupted-result",
        version: 1,
    };
    let columns = ["a_m", "b_m"].map(|name| Column {
        name: name.to_owned(),
        unit: "m".to_owned(),
        description: "a column".to_owned(),
    });
    if let Some(path) = std::env::var_os(CHILD_PATH) {
        let path = Path::new(&path);
        let mut log = RowLog::create(&path.with_extension("part").join("rows.log"), 2).unwrap();
        (0..20_000).for_each(|i| log.append(&[f64::from(i), 1.0]).unwrap());
        let tree = DataTree::default();
        loop {
            write_columns(path, &FORMAT, &tree, ("time", &columns), &mut log).unwrap();
        }
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("result.h5");
    let part = path.with_extension("part");
    std::fs::create_dir(&part).unwrap();
    let mut half_written = 0;
    // A kill falls into a write or between two; most of the time is spent in one.
    for milliseconds in (60..140).step_by(15).chain(0..60) {
        let mut child = this_test("killed_run_leaves_nothing_beside_its_result", &path);
        while !path.exists() {
            std::thread::sleep(Duration::from_millis(2));
        }
        std::thread::sleep(Duration::from_millis(milliseconds));
        child.kill().unwrap();
        child.wait().unwrap();
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2);
        half_written += std::fs::read_dir(&part).unwrap().count() - 1;
        let (file, _) = ColumnFile::open(&path, &FORMAT).unwrap();
        assert_eq!(file.rows(), 20_000);
        if milliseconds < 60 && half_written > 0 {
            break;
        }
    }
    assert!(half_written > 0, "no kill fell into a write");
}

/// Starts one test of this executable as the process that is to be killed.
fn this_test(name: &str, path: &Path) -> Child {
    Command::new(std::env::current_exe().unwrap())
        .args([
            "--exact",
            &format!("interrupted_writing::{name}"),
            "--nocapture",
        ])
        .env(CHILD_PATH, path)
        .stdout(Stdio::null())
        .spawn()
        .unwrap()
}

#[test]
fn devices_and_missing_folders_are_refused() {
    let gear = small_reduced_gear();
    assert!(matches!(
        write_reduced_gear(Path::new("/dev/null"), &gear),
        Err(FileError::NotARegularFile { .. })
    ));
    let folder = tempfile::tempdir().unwrap();
    assert!(matches!(
        write_reduced_gear(folder.path(), &gear),
        Err(FileError::NotARegularFile { .. })
    ));
    let error = write_reduced_gear(&folder.path().join("missing/gear.h5"), &gear).unwrap_err();
    assert!(error.to_string().contains("missing/gear.h5"), "{error}");
}
