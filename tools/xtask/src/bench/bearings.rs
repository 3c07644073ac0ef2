//! `cargo xtask bench bearings`: time and error of bearings, beside Exudyn.

use std::process::{Command, ExitCode};

use serde_json::Value;

use super::bearings_page::{Beside, Page, page};
use super::host::Host;
use super::{Bench, Options, TIMEOUT_S, measure, write_whole};
use crate::console::say;
use crate::error::XtaskError;
use crate::workspace::Workspace;

/// What the throw-away environment installs.
const EXUDYN: &str = "exudyn==1.13.6";

/// Newton and linear solver of Exudyn: the fastest of the four here.
const SOLVER: &str = "modified-sparse";

/// Measures and writes docs/benchmarks/bearings.md.
///
/// # Errors
/// [`XtaskError`] where the bench does not build or the page cannot be written.
pub fn bearings(workspace: &Workspace, options: &Options) -> Result<ExitCode, XtaskError> {
    let bench = Bench::prepare(workspace, options)?;
    say("== our own");
    let ours = bench.own("bearings")?;
    let lines = json_lines(&ours);
    say("== Exudyn");
    let (peer, theirs) = match exudyn(&bench, &lines) {
        Ok(theirs) => (EXUDYN.replace("==", " "), theirs),
        Err(reason) => (
            format!("not measured: {}", bench.without_place(&reason)),
            Vec::new(),
        ),
    };
    let of = |case: &str| -> Vec<Value> {
        let wanted = |line: &&Value| line["case"].as_str() == Some(case);
        lines.iter().filter(wanted).cloned().collect()
    };
    let besides = |lines: &[Value]| lines.iter().filter_map(Beside::read).collect();
    let text = page(&Page {
        host: Host::find(workspace.root()),
        peer,
        evaluations: of("evaluation"),
        cages: of("cage"),
        shafts: of("shaft"),
        surfaces: of("surface"),
        ours: besides(&of("beside")),
        theirs: besides(&theirs),
    });
    let path = workspace.root().join("docs/benchmarks/bearings.md");
    write_whole(&path, &text)?;
    Ok(ExitCode::SUCCESS)
}

/// Runs of Exudyn from our start at our steps.
fn exudyn(bench: &Bench, lines: &[Value]) -> Result<Vec<Value>, String> {
    let mut command = bench.python_script("solver_venv.py");
    command
        .arg(bench.scratch.join("exudyn-venv"))
        .args([EXUDYN, "exudyn"]);
    let made = measure(&bench.python, &bench.scripts, TIMEOUT_S, &command)?;
    let start = lines
        .iter()
        .find(|line| line["case"] == "start")
        .ok_or("our own bench told no start")?;
    let file = bench.scratch.join("bearing-start.json");
    std::fs::write(&file, start.to_string()).map_err(|error| error.to_string())?;
    let mut found = Vec::new();
    for step in start["steps_s"].as_array().into_iter().flatten() {
        let mut command = Command::new(made.stdout.trim());
        command
            .arg(bench.scripts.join("bearing_exudyn.py"))
            .arg(&file)
            .args([step.to_string(), SOLVER.to_owned()]);
        let run = measure(&bench.python, &bench.scripts, TIMEOUT_S, &command)?;
        found.extend(json_lines(&run.stdout));
    }
    Ok(found)
}

fn json_lines(stdout: &str) -> Vec<Value> {
    let read = |line| serde_json::from_str::<Value>(line).ok();
    let lines = stdout.lines().filter_map(read);
    lines.filter(Value::is_object).collect()
}
