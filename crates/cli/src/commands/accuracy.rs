//! `gearmesh accuracy`: what accuracy costs in time, for a scene of the user's own.

use crate::arguments::Printed;
use crate::{console, interrupt};
use gearmesh_operations::Failure;
use gearmesh_operations::accuracy::{AccuracyRequest, accuracy, demand_kept, figures};
use gearmesh_report::accuracy_page::{doubts_in_words, goal_in_words};
use gearmesh_report::short;
use gearmesh_scene::accuracy::{Accuracy, Advice, EffectFound, JudgedTime, words};
use gearmesh_scene::study::Effort;

/// Runs the command.
pub fn run(a: &Printed<AccuracyRequest>) -> Result<(), Failure> {
    let stop = interrupt::on_demand();
    let found = accuracy(&a.request, &stop.watch())?;
    drop(stop);
    console::found(a.json, || figures(&found), || table(&found));
    demand_kept(&found)
}

fn percent(error: f64) -> String {
    short(100.0 * error)
}

/// Advice first, then all settings, then what effects change.
fn table(found: &Accuracy) -> Vec<String> {
    let reference = &found.tried[0];
    let mut lines = vec![format!(
        "reference: every knob at its top, {} s of {}; {} settings run",
        short(reference.seconds),
        found.time.words(),
        found.tried.len()
    )];
    lines.extend(doubts_in_words(found));
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
    settings(found, &mut lines);
    if !found.effects.is_empty() {
        effects(found, &mut lines);
    }
    let left_out = found.left_out.iter();
    lines.extend(left_out.map(|told| format!("not varied: {told}")));
    lines.extend(found.failed.iter().map(|told| format!("failed: {told}")));
    lines
}

fn heads(found: &Accuracy) -> String {
    let columns = found.columns.iter();
    columns.map(|column| format!("  {column} %")).collect()
}

/// An error of each column, below its head.
fn cells(found: &Accuracy, errors: &[f64]) -> String {
    let cells = errors.iter().zip(&found.columns);
    let cells = cells
        .map(|(error, column)| format!("  {:>1$}", percent(*error), column.chars().count() + 2));
    cells.collect()
}

fn time_head(found: &Accuracy) -> &'static str {
    match found.time {
        JudgedTime::Wall => "wall time s",
        JudgedTime::Processor => "processor s",
    }
}

fn settings(found: &Accuracy, lines: &mut Vec<String>) {
    let (time, heads) = (time_head(found), heads(found));
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
            cells(found, &one.errors),
            words(&found.knobs, &one.rungs)
        ));
    }
}

fn effects(found: &Accuracy, lines: &mut Vec<String>) {
    lines.push(
        "effects: what each changes, in the scene as it is, and what it takes (with / without)"
            .to_owned(),
    );
    lines.push(format!(
        "{:>15} {:>15} {:>19}{}  effect",
        "states",
        "calls",
        time_head(found),
        heads(found)
    ));
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
        let has = match effect.present {
            true => "which the scene has",
            false => "which it has not",
        };
        lines.push(format!(
            "{:>15} {:>15} {:>19}{}  {}, {has}",
            both(&|e| e.states),
            both(&|e| e.calls),
            times.join(" / "),
            cells(found, changes),
            effect.name
        ));
    }
}

/// A whole number, or a dash where nothing was counted.
fn count(number: f64) -> String {
    if number == 0.0 {
        "-".to_owned()
    } else {
        format!("{number}")
    }
}
