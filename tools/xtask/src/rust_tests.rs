//! The Rust tests, as many processes at a time as there are cores.
//!
//! `cargo test` runs one binary after another, and while the last long test of a binary runs the other cores wait. Here
//! cargo builds the binaries and names them; each is cut into parts, one for each module of tests, which share what
//! they have made in memory; the parts run side by side, one test after another in each. A line of the harness ends
//! with each test: that is how long it took.

mod binaries;
mod part;

use std::process::Command;
use std::sync::Mutex;
use std::time::Duration;

use crate::console::{readable, say};
use crate::error::XtaskError;
use crate::steps::Extent;
use crate::venv::Venv;
pub use binaries::{Binary, built};
use part::{Length, Part, PartResult};

/// Programs that take minutes. They start first, so that none is left alone at the end; the others in cargo's order.
const LONG: [(&str, Length); 8] = [
    // Ten million steps, one after another.
    ("drivetrain allocation", Length::Long),
    ("reduction verification", Length::LongInModules),
    ("tests validation", Length::LongInModules),
    ("scene verification", Length::LongInModules),
    ("drivetrain verification", Length::LongInModules),
    ("cli commands", Length::LongInModules),
    // Its modules share two reduced gears.
    ("cli scene_commands", Length::Long),
    ("cli fuzz", Length::Long),
];

/// Tests listed at the end.
const SLOWEST: usize = 25;

/// Runs the tests of the packages, programs and modules named in `only`, all where it is empty. All parts run, whatever
/// fails.
///
/// # Errors
/// [`XtaskError::TestsFailed`] with the names of what failed or of what is not there.
pub fn run(
    binaries: Vec<Binary>,
    venv: &Venv,
    extent: Extent,
    only: &[String],
) -> Result<(), XtaskError> {
    let mut parts = Vec::new();
    for binary in binaries {
        let known = LONG.iter().find(|(label, _)| *label == binary.label());
        let length = known.map_or(Length::Short, |(_, length)| *length);
        parts.extend(part::parts_of(binary, extent, length)?);
    }
    let missing: Vec<String> = (only.iter())
        .filter(|name| !parts.iter().any(|part| part.has(name)))
        .map(|name| format!("{name}: no package, test program or module of tests has this name"))
        .collect();
    if !missing.is_empty() {
        return Err(XtaskError::TestsFailed { names: missing });
    }
    if !only.is_empty() {
        parts.iter_mut().for_each(|part| part.keep(only));
        parts.retain(|part| !part.tests.is_empty());
    }
    parts.sort_by_key(|part| !part.long);
    summary(&run_side_by_side(parts, venv)?)
}

/// A test that ran by its name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finished {
    /// Folder of its package.
    pub package: String,
    /// Its program.
    pub target: String,
    /// Its full name there.
    pub test: String,
    /// Whether it passed.
    pub passed: bool,
    /// How long it took.
    pub time: Duration,
    /// What it printed, line by line.
    pub printed: Vec<String>,
}

/// Builds with `build` and runs the tests named by package, program and test, with a variable of the environment. Those
/// that no program has are not among the answers.
///
/// # Errors
/// [`XtaskError::Failed`] where something does not build.
pub fn run_named(
    build: Command,
    venv: &Venv,
    named: &[[&str; 3]],
    variable: (&'static str, &'static str),
) -> Result<Vec<Finished>, XtaskError> {
    let mut parts = Vec::new();
    for binary in built(build)? {
        for mut part in part::parts_of(binary, Extent::Full, Length::Short)? {
            let label = part.binary.label();
            part.tests.retain(|test| {
                let is_it = |[package, target, name]: &[&str; 3]| {
                    label == format!("{package} {target}") && test == name
                };
                named.iter().any(is_it)
            });
            part.shows_output = Some(variable);
            if !part.tests.is_empty() {
                parts.push(part);
            }
        }
    }
    let mut finished = Vec::new();
    for result in &run_side_by_side(parts, venv)? {
        let (package, target) = result.label.split_once(' ').unwrap_or_default();
        let failures = result.failures();
        for (test, time) in &result.times {
            finished.push(Finished {
                package: package.to_owned(),
                target: target.to_owned(),
                test: test.clone(),
                passed: !failures.contains(&result.full_name(test)) || result.passed,
                time: *time,
                printed: result.printed_by(test),
            });
        }
    }
    Ok(finished)
}

/// Runs the parts, the first ones first, on as many threads as there are cores.
fn run_side_by_side(parts: Vec<Part>, venv: &Venv) -> Result<Vec<PartResult>, XtaskError> {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let waiting = Mutex::new(parts.into_iter());
    let next = || waiting.lock().ok().and_then(|mut parts| parts.next());
    let outcomes: Vec<Result<Vec<PartResult>, XtaskError>> = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..threads)
            .map(|_| {
                scope.spawn(|| {
                    let mut done = Vec::new();
                    while let Some(part) = next() {
                        let result = part.run(venv)?;
                        say(&result.line());
                        done.push(result);
                    }
                    Ok(done)
                })
            })
            .collect();
        workers
            .into_iter()
            .map(|worker| {
                worker
                    .join()
                    .unwrap_or_else(|panic| std::panic::resume_unwind(panic))
            })
            .collect()
    });
    let mut all = Vec::new();
    for outcome in outcomes {
        all.extend(outcome?);
    }
    Ok(all)
}

/// Prints the number of tests, the slowest, and of what failed all it printed.
fn summary(results: &[PartResult]) -> Result<(), XtaskError> {
    let mut times: Vec<(Duration, String)> = results
        .iter()
        .flat_map(|part| {
            part.times
                .iter()
                .map(|(name, time)| (*time, part.full_name(name)))
        })
        .collect();
    let total: Duration = times.iter().map(|(time, _)| *time).sum();
    say(&format!(
        "{} tests, {} one after another; the slowest:",
        times.len(),
        readable(total)
    ));
    times.sort_by_key(|(time, _)| std::cmp::Reverse(*time));
    for (time, name) in times.iter().take(SLOWEST) {
        say(&format!("  {:>12}  {name}", readable(*time)));
    }
    let failed: Vec<&PartResult> = results.iter().filter(|part| !part.passed).collect();
    for part in &failed {
        say(&format!("\n== {}\n{}", part.label, part.output));
    }
    if failed.is_empty() {
        return Ok(());
    }
    let names = failed.iter().flat_map(|part| part.failures()).collect();
    Err(XtaskError::TestsFailed { names })
}
