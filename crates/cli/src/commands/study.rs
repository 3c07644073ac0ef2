//! `gearmesh study`: a multibody scene again and again with some of its keys changed.

use crate::arguments::StudyArguments;
use crate::console::{self, RunBar};
use crate::failure::Failure;
use crate::interrupt;
use gearmesh_report::{short, usual_unit};
use gearmesh_scene::study::{CaseResult, Selected, Study, run_study};
use gearmesh_scene::system_run::stem;
use serde_json::{Value, json};
use std::sync::{Mutex, PoisonError};

/// Runs the command.
pub fn run(arguments: &StudyArguments) -> Result<(), Failure> {
    let study = Study::read(&arguments.study)?;
    let bar = Mutex::new(RunBar::new("study"));
    let progress = |done: usize, count: usize| {
        let bar = bar.lock().unwrap_or_else(PoisonError::into_inner);
        bar.advance(done as f64, count as f64);
    };
    let stop = interrupt::on_demand();
    let outcome = run_study(&study, &arguments.output, &stop.asked, &progress);
    bar.lock().unwrap_or_else(PoisonError::into_inner).finish();
    let outcome = outcome?;
    if outcome.stopped {
        console::error("interrupted; the same command goes on from here");
        std::process::exit(interrupt::EXIT_CODE);
    }
    drop(stop);
    let failed = outcome
        .cases
        .iter()
        .filter(|case| case.figures.is_err())
        .count();
    if arguments.json {
        let cases: Vec<Value> = outcome.cases.iter().map(figures).collect();
        console::json(
            &json!({"title": study.tables.title, "from_s": study.tables.from_s, "cases": cases}),
        );
    } else {
        table(&study, &outcome.cases)
            .into_iter()
            .for_each(console::data);
    }
    if failed > 0 {
        let count = outcome.cases.len();
        return Err(Failure::work(format!(
            "{failed} of {count} cases failed; the table says why"
        )));
    }
    Ok(())
}

/// The figures for people.
fn table(study: &Study, cases: &[CaseResult]) -> Vec<String> {
    let names: Vec<String> = cases.iter().map(|result| result.case.name()).collect();
    let width = names
        .iter()
        .map(|name| name.chars().count())
        .max()
        .unwrap_or(0)
        .max(4);
    let mut lines = vec![format!(
        "{}, from {} s on",
        study.tables.title, study.tables.from_s
    )];
    for (k, column) in study.tables.columns.iter().enumerate() {
        let found = cases.iter();
        let found = found.filter_map(|result| result.figures.as_ref().ok());
        // Of no case where all have failed.
        let unit = found.clone().next().map_or("", |columns| &columns[k].unit);
        let stem = stem(column, unit);
        let largest = found.fold(0.0_f64, |most, columns| {
            let figures = columns[k].figures;
            most.max(figures.least.abs()).max(figures.largest.abs())
        });
        let (factor, unit) = usual_unit(unit, largest);
        lines.push(format!("{stem} {unit}").trim_end().to_owned());
        lines.push(format!(
            "{:width$} {:>11} {:>11} {:>11} {:>11}",
            "case", "mean", "deviation", "pk-pk", "largest"
        ));
        for (name, result) in names.iter().zip(cases) {
            lines.push(match &result.figures {
                Ok(columns) => {
                    let figures = columns[k].figures;
                    format!(
                        "{name:width$} {:>11} {:>11} {:>11} {:>11}",
                        short(factor * figures.mean),
                        short(factor * figures.deviation),
                        short(factor * figures.peak_to_peak()),
                        short(factor * figures.largest)
                    )
                }
                Err(problem) => format!("{name:width$} failed: {problem}"),
            });
        }
    }
    lines
}

/// The figures of a case for machines.
fn figures(result: &CaseResult) -> Value {
    let settings = result.case.settings.iter();
    let settings = settings.map(|setting| (setting.parameter.clone(), json!(setting.value)));
    let columns = |columns: &Vec<Selected>| {
        let figures = columns.iter().map(|Selected { column, unit, figures }| {
            json!({
                "name": column, "unit": unit, "mean": figures.mean, "deviation": figures.deviation, "least": figures.least,
                "largest": figures.largest,
            })
        });
        figures.collect::<Vec<_>>()
    };
    json!({
        "parameters": settings.collect::<serde_json::Map<_, _>>(),
        "file": result.file,
        "columns": result.figures.as_ref().ok().map(columns),
        "failure": result.figures.as_ref().err(),
    })
}
