//! `gearmesh accuracy`: what accuracy costs in time, for a scene of the user's own.

use crate::arguments::AccuracyArguments;
use crate::console::{self, RunBar};
use crate::failure::Failure;
use crate::interrupt::{self, Scratch};
use crate::output_name;
use crate::page_file;
use gearmesh_report::accuracy_page::{accuracy_page, goal_in_words};
use gearmesh_report::short;
use gearmesh_scene::accuracy::{Accuracy, Advice, Bench, Goal, Tried, Wanted, accuracy, words};
use gearmesh_scene::study::StudyError;
use serde_json::{Value, json};

/// Runs the command.
pub fn run(arguments: &AccuracyArguments) -> Result<(), Failure> {
    if let Some(path) = &arguments.output {
        output_name::demand_page(path)?;
    }
    let scratch = Scratch::new(tempfile::tempdir().map_err(Failure::work)?.keep());
    let stop = interrupt::on_demand();
    let wanted = arguments
        .columns
        .iter()
        .map(|text| Wanted::of(text))
        .collect();
    let bench = Bench::new(
        &arguments.scene,
        wanted,
        (arguments.from_s, scratch.path(), &stop.asked),
    )?;
    let bar = RunBar::new("settings");
    let found = accuracy(&bench, &|done, count| {
        bar.advance(done as f64, count as f64)
    });
    bar.finish();
    let found = match found {
        Err(StudyError::Stopped) => {
            console::error("interrupted; nothing is written");
            drop(scratch);
            std::process::exit(interrupt::EXIT_CODE);
        }
        found => found?,
    };
    drop(stop);
    if let Some(path) = &arguments.output {
        let scene = arguments.scene.display().to_string();
        page_file::write(&accuracy_page(&scene, &found), path)?;
    }
    if arguments.json {
        console::json(&figures(&found));
    } else {
        table(&found).into_iter().for_each(console::data);
    }
    demand_kept(&found)
}

/// What was advised was run once more: it must keep its word.
fn demand_kept(found: &Accuracy) -> Result<(), Failure> {
    for Advice { goal, tried, .. } in &found.advice {
        if let Goal::Within(most) = goal
            && tried.error() > *most
        {
            let (error, most) = (short(100.0 * tried.error()), 100.0 * most);
            return Err(Failure::work(format!(
                "the setting for {most} %, run once more, has an error of {error} %"
            )));
        }
    }
    Ok(())
}

fn percent(error: f64) -> String {
    short(100.0 * error)
}

/// Advice first, then all settings.
fn table(found: &Accuracy) -> Vec<String> {
    let reference = &found.tried[0];
    let mut lines = vec![format!(
        "reference: every knob at its top, {} s; {} settings run",
        short(reference.seconds),
        found.tried.len()
    )];
    for Advice { goal, tried, toml } in &found.advice {
        lines.push(format!(
            "# {}: error {} %, {} s, {} times faster than the reference (run once more)",
            goal_in_words(*goal),
            percent(tried.error()),
            short(tried.seconds),
            short(reference.seconds / tried.seconds)
        ));
        lines.extend(toml.iter().cloned());
    }
    let heads: String = found
        .columns
        .iter()
        .map(|column| format!("  {column} %"))
        .collect();
    lines.push(format!(
        "{:>11} {:>11}{heads}  setting",
        "wall time s", "iterations"
    ));
    for Tried {
        rungs,
        seconds,
        iterations,
        errors,
        ..
    } in &found.tried
    {
        let cells = errors.iter().zip(&found.columns);
        let cells = cells.map(|(error, column)| {
            format!("  {:>1$}", percent(*error), column.chars().count() + 2)
        });
        lines.push(format!(
            "{:>11} {:>11}{}  {}",
            short(*seconds),
            short(*iterations),
            cells.collect::<String>(),
            words(&found.knobs, rungs)
        ));
    }
    lines.extend(
        found
            .left_out
            .iter()
            .map(|told| format!("not varied: {told}")),
    );
    lines.extend(found.failed.iter().map(|told| format!("failed: {told}")));
    lines
}

fn figures(found: &Accuracy) -> Value {
    let setting = |one: &Tried| {
        let errors = found.columns.iter().zip(&one.errors);
        json!({
            "setting": words(&found.knobs, &one.rungs), "wall_s": one.seconds, "iterations": one.iterations,
            "errors": errors.map(|(c, e)| (c.clone(), json!(e))).collect::<serde_json::Map<_, _>>(),
        })
    };
    let advice = |one: &Advice| json!({"goal": goal_in_words(one.goal), "toml": one.toml, "run_again": setting(&one.tried)});
    json!({
        "tried": found.tried.iter().map(setting).collect::<Vec<_>>(),
        "advice": found.advice.iter().map(advice).collect::<Vec<_>>(),
        "not_varied": found.left_out, "failed": found.failed,
    })
}
