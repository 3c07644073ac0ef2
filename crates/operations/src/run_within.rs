//! A scene is run in the cheapest setting that is found to be exact enough.

use crate::accuracy::{AccuracyRequest, bench_of, by_column};
use crate::failure::{Failure, Result};
use crate::reduce::reduced_for_study;
use crate::run::{Ran, RunHow, run};
use crate::scratch::Scratch;
use crate::watch::Watch;
use gearmesh_report::short;
use gearmesh_scene::SceneFile;
use gearmesh_scene::accuracy::{Chosen, choose};
use gearmesh_scene::study::Subject;
use serde_json::{Value, json};

/// Looks for the setting in which the relative error of the columns is `goal` at most, then runs the scene with it. A
/// goal that cannot be met is a warning; the result is that of the most exact setting then.
///
/// # Errors
/// [`Failure`] for a scene or column that is wrong, a scene that is none, and as [`run`].
pub fn run_within(
    a: &AccuracyRequest,
    goal: f64,
    how: &RunHow<'_>,
    watch: &Watch<'_>,
) -> Result<(Ran, Chosen)> {
    // A file that is no scene is refused before any setting is run.
    SceneFile::read(&a.scene)?;
    let scratch = Scratch::new()?;
    let reduce = |gear: &_| reduced_for_study(gear, watch);
    let bench = bench_of(a, &scratch, &reduce, watch)?;
    let task = watch.listener.begin("settings");
    let found = choose(&bench, goal, &|done, count| {
        task.advance(done as f64, count as f64)
    });
    drop(task);
    watch.go_on()?;
    let found = found?;
    let scene = match found.subject.clone() {
        Subject::Pair(scene) => SceneFile::Pair(scene),
        Subject::System(scene) => SceneFile::System(scene),
        Subject::Bevel(scene) => SceneFile::Bevel(scene),
        Subject::Bearing(_) => {
            let file = a.scene.display();
            return Err(Failure::input(format!("{file}: is no scene")));
        }
    };
    if !found.is_within() {
        let (column, error) = found.worst();
        let off = match error.is_finite() {
            true => format!("{column} may be off by {} %", percent(error)),
            false => format!("there is nothing to judge {column} by"),
        };
        watch.warning(format!(
            "no setting of this scene is known to be within {} %: {off} in the most exact one, which was run",
            percent(goal)
        ));
    }
    Ok((run(scene, how, watch)?, found))
}

/// The setting and its error, for people.
#[must_use]
pub fn lines(found: &Chosen) -> Vec<String> {
    let (column, error) = found.worst();
    let within = if found.is_within() {
        "within"
    } else {
        "not within"
    };
    let mut lines = vec![format!(
        "{within} {} %: largest error {} %, of {column}; {} settings run, from {}",
        percent(found.goal),
        percent(error),
        found.runs,
        found.begun
    )];
    let errors = found.columns.iter().zip(&found.errors);
    lines.extend(errors.map(|(column, error)| format!("  {column}: error {} %", percent(*error))));
    lines.extend(found.failed.iter().map(|told| format!("  failed: {told}")));
    lines.push("the setting, to paste into the scene:".to_owned());
    lines.extend(found.toml.iter().map(|line| format!("  {line}")));
    lines
}

/// The same for other programs.
#[must_use]
pub fn figures(found: &Chosen) -> Value {
    json!({
        "goal": found.goal, "is_within": found.is_within(),
        "errors": by_column(&found.columns, &found.errors),
        "settings_run": found.runs, "begun": found.begun, "toml": found.toml,
        "failed": found.failed,
    })
}

fn percent(share: f64) -> String {
    match share.is_finite() {
        true => short(100.0 * share),
        false => "?".to_owned(),
    }
}
