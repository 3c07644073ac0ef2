//! The page of `gearmesh accuracy`: error against time, what to take, every setting that was run.

use gearmesh_scene::accuracy::{Accuracy, EffectFound, Goal, Tried, words};

use crate::column_words::words_and_unit;
use crate::page::{Align, Axis, Page, PointSeries, ScatterChart, Section, Table, Text};
use crate::short;

/// A goal in words.
#[must_use]
pub fn goal_in_words(goal: Goal) -> String {
    match goal {
        Goal::Within(error) => format!("{} %", short(100.0 * error)),
        Goal::Interactive(seconds) => format!("interactive, {seconds} s"),
    }
}

/// How far the reference itself may be off, and what therefore cannot be said, in sentences.
#[must_use]
pub fn doubts_in_words(found: &Accuracy) -> Vec<String> {
    let mut told = Vec::new();
    if let Some((knob, error)) = found.unsettled() {
        told.push(format!(
            "The reference itself: the last step of {} still changes the columns by up to {} %.",
            knob.name,
            percent(error)
        ));
    }
    if !found.spread.is_empty() {
        let spreads = found.columns.iter().zip(&found.spread);
        let spreads = spreads.map(|(column, spread)| format!("{column} by {} %", percent(*spread)));
        let spreads: Vec<String> = spreads.collect();
        told.push(format!(
            "The run is chaotic: runs that begin next to each other part. The reference is the mean of five of them, which spread (standard deviation): {}. A longer run, or figures from later on, spread less.",
            spreads.join(", ")
        ));
    }
    let doubts = found.doubts();
    let worst = found.columns.iter().zip(&doubts);
    let worst = worst.max_by(|a, b| a.1.total_cmp(b.1));
    for (goal, (column, doubt)) in found.open.iter().zip(worst.into_iter().cycle()) {
        told.push(format!(
            "{}: of no setting can it be said, for the reference itself may be off by {} % in {column}.",
            goal_in_words(*goal),
            percent(*doubt)
        ));
    }
    told
}

/// The page of an outcome; `scene` names it.
#[must_use]
pub fn accuracy_page(scene: &str, found: &Accuracy) -> Page {
    let times = Times::of(found);
    let point = |one: &Tried| [times.factor * one.seconds, 100.0 * one.error()];
    let of = |alone: bool| -> Vec<&Tried> {
        let others = found.tried.iter().filter(|one| is_drawn(one));
        others.filter(|one| one.alone.is_some() == alone).collect()
    };
    let labels = |tried: &[&Tried]| {
        tried
            .iter()
            .map(|one| words(&found.knobs, &one.rungs))
            .collect()
    };
    let series = |name: &str, tried: Vec<&Tried>| {
        PointSeries::new(name, tried.iter().map(|one| point(one)).collect()).labels(labels(&tried))
    };
    let chart = ScatterChart::new(
        format!(
            "Largest error of the columns against {}",
            found.time.words()
        ),
        Axis::new(found.time.words(), times.unit),
        Axis::new("largest error", "%"),
    )
    .logarithmic(true, true)
    .series(series("one knob lowered", of(true)))
    .series(series("knobs together", of(false)))
    .series(series("not beaten", unbeaten(found)).joined());
    let reference = &found.tried[0];
    let told = format!(
        "Errors are those against the reference, every knob at its top, which takes {} of {}. {} settings were run. What no knob changes is in none of the errors.",
        times.words(reference.seconds),
        found.time.words(),
        found.tried.len()
    );
    let mut section = Section::new("What accuracy costs").push(Text::paragraph(told));
    let doubts = doubts_in_words(found).into_iter();
    section = section.push_all(doubts.map(Text::paragraph));
    if found.tried.iter().any(is_drawn) {
        section = section.push(chart);
    }
    for advice in &found.advice {
        let text = format!(
            "# {}: error {} %, {}, {} times faster than the reference\n{}",
            goal_in_words(advice.goal),
            short(100.0 * advice.tried.error()),
            times.words(advice.tried.seconds),
            short(reference.seconds / advice.tried.seconds),
            advice.toml.join("\n")
        );
        section = section.push(Text::preformatted(text));
    }
    let mut page = Page::new(format!("What accuracy costs: {scene}"))
        .section(section)
        .section(Section::new("Every setting").push(table(found, &times)));
    if !found.effects.is_empty() {
        page = page.section(Section::new("Effects").push(effects(found, &times)));
    }
    if !found.left_out.is_empty() || !found.failed.is_empty() {
        let mut section = Section::new("What was not varied");
        let lines = found.left_out.iter().chain(&found.failed);
        section = section.push_all(lines.map(|line| Text::paragraph(line.clone())));
        page = page.section(section);
    }
    page.footer(format!("by gearmesh {}", env!("CARGO_PKG_VERSION")))
}

/// Errors that are no more than rounding, as a share.
const ROUNDING: f64 = 1e-9;

/// A logarithmic axis has no zero: the reference, and what differs from it by rounding only, are not drawn.
fn is_drawn(one: &Tried) -> bool {
    one.error() > ROUNDING
}

/// Settings that no other one beats in error and time, by time.
fn unbeaten(found: &Accuracy) -> Vec<&Tried> {
    let mut tried: Vec<&Tried> = found.tried.iter().filter(|one| is_drawn(one)).collect();
    tried.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
    let mut least = f64::INFINITY;
    tried.retain(|one| {
        let better = one.error() < least;
        least = least.min(one.error());
        better
    });
    tried
}

/// The unit in which the times of a page are read: that in which the reference takes at least one.
struct Times {
    unit: &'static str,
    factor: f64,
}

impl Times {
    fn of(found: &Accuracy) -> Self {
        let (unit, factor) = match found.tried[0].seconds {
            s if s >= 1.0 => ("s", 1.0),
            s if s >= 1e-3 => ("ms", 1e3),
            _ => ("µs", 1e6),
        };
        Self { unit, factor }
    }

    fn words(&self, seconds: f64) -> String {
        format!("{} {}", short(self.factor * seconds), self.unit)
    }
}

/// An error or a change in per cent; what is rounding of the whole is none.
fn percent(share: f64) -> String {
    short(if share.abs() > ROUNDING {
        100.0 * share
    } else {
        0.0
    })
}

/// Counts are whole numbers.
fn counted(count: f64) -> String {
    match count == count.round() {
        true => format!("{count:.0}"),
        false => short(count),
    }
}

fn table(found: &Accuracy, times: &Times) -> Table {
    let mut table =
        Table::new("Settings, by what differs from the reference: time, and error of each column")
            .column("setting", Align::Phrase)
            .column(
                format!("{} {}", found.time.words(), times.unit),
                Align::Right,
            )
            .column("iterations", Align::Right);
    let any_reduced = found.tried.iter().any(|one| one.reduction_s > 0.0);
    if any_reduced {
        table = table.column("reduction s", Align::Right);
    }
    for column in &found.columns {
        table = table.column(format!("{} %", words_and_unit(column).0), Align::Right);
    }
    for one in &found.tried {
        let setting = words(&found.knobs, &one.rungs);
        let time = short(times.factor * one.seconds);
        let mut cells = vec![setting, time, counted(one.effort.iterations)];
        if any_reduced {
            cells.push(short(one.reduction_s));
        }
        cells.extend(one.errors.iter().map(|error| percent(*error)));
        table.push_row(cells);
    }
    table
}

/// What each effect changes, in the scene as it is, and takes.
fn effects(found: &Accuracy, times: &Times) -> Table {
    let mut table = Table::new("With each effect against without it, all else as the scene has it")
        .column("effect", Align::Phrase)
        .column("in the scene", Align::Left);
    for head in ["states", "calls", "iterations"] {
        table = table.column(format!("{head} with / without"), Align::Right);
    }
    table = table.column(
        format!("{} with / without {}", found.time.words(), times.unit),
        Align::Right,
    );
    for column in &found.columns {
        let words = words_and_unit(column).0;
        table = table.column(format!("changes {words} by %"), Align::Right);
    }
    for EffectFound {
        effect,
        without,
        with,
        changes,
    } in &found.effects
    {
        let both = |with: f64, without: f64| format!("{} / {}", counted(with), counted(without));
        let time = |effort| short(times.factor * found.time.of(effort));
        let present = if effect.present { "yes" } else { "no" };
        let counts = [
            effect.name.clone(),
            present.to_owned(),
            both(with.states, without.states),
            both(with.calls, without.calls),
            both(with.iterations, without.iterations),
            format!("{} / {}", time(with), time(without)),
        ];
        let changes = changes.iter().map(|change| percent(*change));
        table.push_row(counts.into_iter().chain(changes));
    }
    table
}
