//! `gearmesh accuracy`: what accuracy costs in time, for a scene of the user's own.

use crate::arguments::{AccuracyArguments, TimeWord};
use crate::console::{self, RunBar};
use crate::failure::Failure;
use crate::interrupt::{self, Scratch};
use crate::offline;
use crate::output_name;
use crate::page_file;
use gearmesh_report::accuracy_page::{accuracy_page, goal_in_words};
use gearmesh_report::short;
use gearmesh_scene::accuracy::{
    Accuracy, Advice, Bench, BenchOptions, EffectFound, Goal, JudgedTime, Tried, accuracy, words,
};
use gearmesh_scene::study::{Effort, StudyError, Wanted};
use serde_json::{Value, json};

/// Short runs are repeated for so long \[s\].
const REPEATED_FOR_S: f64 = 0.2;

/// Runs the command.
pub fn run(arguments: &AccuracyArguments) -> Result<(), Failure> {
    if let Some(path) = &arguments.output {
        output_name::demand_page(path)?;
    }
    let scratch = Scratch::new(tempfile::tempdir().map_err(Failure::work)?.keep());
    let stop = interrupt::on_demand();
    let models = match &arguments.elements {
        Some(folder) => folder.clone(),
        None => scratch.path().to_owned(),
    };
    let options = BenchOptions {
        wanted: arguments.columns.iter().map(|c| Wanted::of(c)).collect(),
        from_s: arguments.from_s,
        time: match arguments.time {
            TimeWord::Wall => JudgedTime::Wall,
            TimeWord::Processor => JudgedTime::Processor,
        },
        repeated_for_s: REPEATED_FOR_S,
        elements: arguments.elements.is_some(),
        scratch: scratch.path(),
        models: &models,
        stop: &stop.asked,
        reduce: &offline::reduced_for_study,
    };
    let bench = Bench::new(&arguments.scene, options)?;
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
        "reference: every knob at its top, {} s of {}; {} settings run",
        short(reference.seconds),
        found.time.words(),
        found.tried.len()
    )];
    if let Some((knob, error)) = found.unsettled() {
        lines.push(format!(
            "the reference itself: the last step of {} still changes the columns by up to {} %",
            knob.name,
            percent(error)
        ));
    }
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
    let time = match found.time {
        JudgedTime::Wall => "wall time s",
        JudgedTime::Processor => "processor s",
    };
    let cells = |errors: &[f64]| {
        let cells = errors.iter().zip(&found.columns);
        let cells = cells.map(|(error, column)| {
            format!("  {:>1$}", percent(*error), column.chars().count() + 2)
        });
        cells.collect::<String>()
    };
    let any_reduced = found.tried.iter().any(|one| one.reduction_s > 0.0);
    let reduced = if any_reduced { "    reduce s" } else { "" };
    lines.push(format!(
        "{time:>11} {:>11}{reduced}{heads}  setting",
        "iterations"
    ));
    for one in &found.tried {
        let reduced = match any_reduced {
            true => format!(" {:>11}", short(one.reduction_s)),
            false => String::new(),
        };
        lines.push(format!(
            "{:>11} {:>11}{reduced}{}  {}",
            short(one.seconds),
            short(one.effort.iterations),
            cells(&one.errors),
            words(&found.knobs, &one.rungs)
        ));
    }
    if !found.effects.is_empty() {
        lines.push(
            "effects: what each changes, in the scene as it is, and what it takes (with / without)"
                .to_owned(),
        );
        lines.push(format!(
            "{:>15} {:>15} {:>19}{heads}  effect",
            "states", "calls", time
        ));
    }
    for EffectFound {
        effect,
        with,
        without,
        changes,
    } in &found.effects
    {
        let both =
            |of: &dyn Fn(&Effort) -> f64| format!("{} / {}", count(of(with)), count(of(without)));
        let times = [with, without].map(|effort| short(found.time.of(effort)));
        lines.push(format!(
            "{:>15} {:>15} {:>19}{}  {}, {}",
            both(&|e| e.states),
            both(&|e| e.calls),
            times.join(" / "),
            cells(changes),
            effect.name,
            if effect.present {
                "which the scene has"
            } else {
                "which it has not"
            }
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

/// A whole number, or a dash where nothing was counted.
fn count(number: f64) -> String {
    if number == 0.0 {
        "-".to_owned()
    } else {
        format!("{number}")
    }
}

fn figures(found: &Accuracy) -> Value {
    let by_column = |errors: &[f64]| {
        let errors = found.columns.iter().zip(errors);
        errors
            .map(|(c, e)| (c.clone(), json!(e)))
            .collect::<serde_json::Map<_, _>>()
    };
    let effort = |effort: &Effort| {
        json!({
            "wall_s": effort.wall_s, "cpu_s": effort.cpu_s, "states": effort.states,
            "calls": effort.calls, "iterations": effort.iterations,
        })
    };
    let setting = |one: &Tried| {
        let mut value = effort(&one.effort);
        value["setting"] = json!(words(&found.knobs, &one.rungs));
        value["one_knob_alone"] = json!(one.alone.is_some());
        value["errors"] = json!(by_column(&one.errors));
        value["reduction_s"] = json!(one.reduction_s);
        value
    };
    let effect = |one: &EffectFound| {
        json!({
            "effect": one.effect.name, "in_scene": one.effect.present, "changes": by_column(&one.changes),
            "with": effort(&one.with), "without": effort(&one.without),
        })
    };
    let advice = |one: &Advice| json!({"goal": goal_in_words(one.goal), "toml": one.toml, "run_again": setting(&one.tried)});
    json!({
        "tried": found.tried.iter().map(setting).collect::<Vec<_>>(),
        "advice": found.advice.iter().map(advice).collect::<Vec<_>>(),
        "effects": found.effects.iter().map(effect).collect::<Vec<_>>(),
        "judged_by": found.time.words(),
        "last_step_of_reference": found.unsettled().map(|(knob, error)| json!({"knob": knob.name, "change": error})),
        "not_varied": found.left_out, "failed": found.failed,
    })
}
