//! What to change in a scene whose `run.kind` was turned from "static" to "transient", or the other way round, and
//! whose other keys were left: said all at once, beside the first complaint.

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::InputDocument;
use toml::{Table, Value};

/// Keys that equilibria have and a motion in time has not.
const OF_STATIC: [&str; 3] = ["run.load_factors", "run.motion", "run.angles_deg"];

/// Keys that a motion in time has and equilibria have not; one of those of a group in a motion that needs them.
const OF_TIME: [&[&str]; 7] = [
    &["run.end_s"],
    &["solver.step_s", "solver.adaptive"],
    &["output.interval_s"],
    &["output.statistics_from_s"],
    &["solver.rho_infinity"],
    &["solver.newton_tolerance", "solver.most_iterations"],
    &["solver.start"],
];

/// Groups of [`OF_TIME`] that a motion in time needs.
const NEEDED: usize = 3;

/// Adds to a complaint what else the kind of run asks for, where keys of the other kind are left or its own missing.
pub(super) fn explained(mut error: InputError, document: &InputDocument) -> InputError {
    let is_of_run = ["run", "solver", "output"]
        .iter()
        .any(|table| error.key.split('.').next() == Some(*table));
    if let Some(advice) = is_of_run.then(|| advice(&document.text)).flatten() {
        error.problem = format!("{}. {advice}", error.problem);
    }
    error
}

fn advice(text: &str) -> Option<String> {
    let file: Table = toml::from_str(text).ok()?;
    let has = |path: &&str| {
        let (table, key) = path.split_once('.').unwrap_or((path, ""));
        let table = file.get(table).and_then(Value::as_table);
        table.is_some_and(|table| table.contains_key(key))
    };
    let quoted = |paths: Vec<&str>| {
        let paths = paths.iter().map(|path| format!("`{path}`"));
        paths.collect::<Vec<_>>().join(", ")
    };
    let kind = file.get("run")?.as_table()?.get("kind")?.as_str()?;
    match kind {
        "transient" => {
            let missing: Vec<&[&str]> = OF_TIME[..NEEDED]
                .iter()
                .filter(|group| !group.iter().any(has))
                .copied()
                .collect();
            let left: Vec<&str> = OF_STATIC.into_iter().filter(|path| has(path)).collect();
            if left.is_empty() && missing.len() < NEEDED {
                return None;
            }
            let mut steps = Vec::new();
            if !left.is_empty() {
                steps.push(format!("remove {}", quoted(left)));
            }
            if !missing.is_empty() {
                let groups = missing.iter().map(|group| {
                    let names = group.iter().map(|path| format!("`{path}`"));
                    names.collect::<Vec<_>>().join(" or ")
                });
                steps.push(format!("give {}", groups.collect::<Vec<_>>().join(", ")));
            }
            steps.push(
                "let a [[motion]] drive at `speed_rpm` what a spring or a motion by angle holds"
                    .to_owned(),
            );
            steps.push(
                "`solver.start = \"equilibrium\"` begins where the static run ends".to_owned(),
            );
            Some(format!(
                "To make a static scene one in time: {} (`gearmesh import --transient` does so for imported gearboxes)",
                steps.join("; ")
            ))
        }
        "static" => {
            let left: Vec<&str> = OF_TIME
                .iter()
                .copied()
                .flatten()
                .copied()
                .filter(|path| has(path))
                .collect();
            (!left.is_empty()).then(|| {
                format!(
                    "To make a scene in time a static one: remove {}; `run.load_factors` are shares of the loads, `run.motion` with `run.angles_deg` turns a \
                     [[motion]] from place to place, and something must hold the train: a [[motion]] at `angle_deg`, or a [[torsion_spring]]",
                    quoted(left)
                )
            })
        }
        _ => None,
    }
}
