//! `gearmesh study --scheduler`: the cases run on a Dask cluster, through the Python package.

use crate::arguments::StudyArguments;
use crate::console;
use crate::interrupt;
use gearmesh_operations::Failure;
use std::collections::BTreeMap;
use std::path::Path;

/// Runs all cases; why cases have failed, by the names of their files.
///
/// # Errors
/// A [`Failure`] where the cluster cannot be used; what is wrong has been said by the Python side.
pub fn run(
    arguments: &StudyArguments,
    scheduler: &str,
) -> Result<BTreeMap<String, String>, Failure> {
    let python = console::watch().python()?;
    let folder = tempfile::tempdir().map_err(Failure::work)?;
    let list = folder.path().join("failures.json");
    let mut command = python.command();
    command
        .args(["-m", "gearmesh.cluster"])
        .arg(&arguments.study)
        .arg("-o")
        .arg(&arguments.output)
        .args(["--scheduler", scheduler])
        .args(["--most-result-GB", &arguments.most_result_gb.to_string()])
        .arg("--failures")
        .arg(&list);
    // Ctrl-C reaches the child, too, which says what becomes of the study.
    let stop = interrupt::on_demand();
    let status = command.status().map_err(Failure::work)?;
    drop(stop);
    match status.code() {
        Some(0) => failures(&list),
        Some(code) if code == i32::from(interrupt::EXIT_CODE) => {
            let words = "interrupted; the same command goes on from here";
            Err(Failure::stopped(words))
        }
        Some(2) => Err(Failure::input(
            "the study was not run on the cluster, see above",
        )),
        _ => Err(Failure::work(
            "the study did not end on the cluster, see above; the same command goes on from there",
        )),
    }
}

/// The list that the Python side has written.
///
/// # Errors
/// A [`Failure`] for a file that is none.
pub fn failures(list: &Path) -> Result<BTreeMap<String, String>, Failure> {
    let text = std::fs::read_to_string(list);
    let text = text.map_err(|cause| Failure::input(format!("{}: {cause}", list.display())))?;
    serde_json::from_str(&text)
        .map_err(|cause| Failure::input(format!("{}: {cause}", list.display())))
}
