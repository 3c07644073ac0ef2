//! `gearmesh optimise`: keys of a scene that make its objectives least.

use crate::arguments::OptimiseArguments;
use crate::console::{self, RunBar};
use crate::failure::Failure;
use crate::interrupt::{self, Scratch};
use crate::page_file;
use gearmesh_model::{csv_cell, write_text};
use gearmesh_report::optimise_page::optimise_page;
use gearmesh_report::{column_width, short};
use gearmesh_scene::optimise::{Optimisation, Optimum, Trial, optimise};
use serde_json::{Value, json};
use std::sync::{Mutex, PoisonError};

/// Lines of a front beyond which the printed table leaves some out.
const MOST_LINES: usize = 20;

/// Runs the command.
pub fn run(arguments: &OptimiseArguments) -> Result<(), Failure> {
    let mut problem = Optimisation::read(&arguments.file)?;
    problem.most_result_bytes = 1e9 * arguments.most_result_gb;
    let bar = Mutex::new(RunBar::new("search"));
    let progress = |done: usize, count: usize| {
        let bar = bar.lock().unwrap_or_else(PoisonError::into_inner);
        bar.advance(done as f64, count as f64);
    };
    let scratch = Scratch::new(tempfile::tempdir().map_err(Failure::work)?.keep());
    let stop = interrupt::on_demand();
    let found = optimise(&problem, scratch.path(), &stop.asked, &progress);
    bar.lock().unwrap_or_else(PoisonError::into_inner).finish();
    let found = found?;
    let folder = &arguments.output;
    std::fs::create_dir_all(folder).map_err(|cause| {
        Failure::work(format!(
            "cannot make the folder {}: {cause}",
            folder.display()
        ))
    })?;
    write_text(&folder.join("front.csv"), &csv(&problem, &found.front))?;
    write_text(&folder.join("tried.csv"), &csv(&problem, &found.tried))?;
    if !found.front.is_empty() {
        let page = optimise_page(&problem, &found);
        page_file::write(&page, &folder.join("optimise.html"))?;
    }
    if arguments.json {
        console::json(&figures(&problem, &found));
    } else {
        table(&problem, &found).into_iter().for_each(console::data);
    }
    if found.stopped {
        console::error("interrupted; the files have what was tried until then");
        drop(scratch);
        std::process::exit(interrupt::EXIT_CODE);
    }
    drop(stop);
    Ok(())
}

fn names(problem: &Optimisation) -> Vec<String> {
    let tables = &problem.tables;
    let variables = tables.variable.iter().map(|v| v.name.clone());
    variables
        .chain(tables.objective.iter().map(|o| o.name.clone()))
        .collect()
}

/// The front for people.
fn table(problem: &Optimisation, found: &Optimum) -> Vec<String> {
    let names = names(problem);
    let widths: Vec<usize> = names.iter().map(|name| column_width([name], 10)).collect();
    let row = |cells: Vec<String>| {
        let cells = cells
            .iter()
            .zip(&widths)
            .map(|(cell, width)| format!("{cell:>width$}"));
        cells.collect::<Vec<_>>().join("  ")
    };
    let count = found.front.len();
    let what = if problem.tables.objective.len() == 1 {
        "best choice"
    } else {
        "Pareto front"
    };
    let mut lines = vec![
        format!(
            "{}: {what} of {} tried",
            problem.tables.title,
            found.tried.len()
        ),
        row(names.clone()),
    ];
    let shown = count.min(MOST_LINES);
    for k in 0..shown {
        // Evenly over the front, both ends included.
        let place = if shown < 2 {
            0
        } else {
            k * (count - 1) / (shown - 1)
        };
        let Trial { values, objectives } = &found.front[place];
        lines.push(row(values
            .iter()
            .chain(objectives)
            .map(|value| short(*value))
            .collect()));
    }
    if count > shown {
        lines.push(format!(
            "{shown} of {count} choices of the front; all are in front.csv"
        ));
    }
    if let Some(before) = &found.before {
        let empty = problem
            .tables
            .variable
            .iter()
            .map(|_| "as it is".to_owned());
        lines.push(row(empty
            .chain(before.iter().map(|value| short(*value)))
            .collect()));
    }
    lines
}

/// A line for each choice: variables, objectives.
fn csv(problem: &Optimisation, trials: &[Trial]) -> String {
    let names = names(problem);
    let head: Vec<_> = names.iter().map(|name| csv_cell(name)).collect();
    let line = |trial: &Trial| {
        let numbers = trial.values.iter().chain(&trial.objectives);
        numbers.map(f64::to_string).collect::<Vec<_>>().join(",") + "\n"
    };
    head.join(",") + "\n" + &trials.iter().map(line).collect::<String>()
}

/// The front for machines.
fn figures(problem: &Optimisation, found: &Optimum) -> Value {
    let tables = &problem.tables;
    let trial = |trial: &Trial| {
        let variables = tables.variable.iter().zip(&trial.values);
        let objectives = tables.objective.iter().zip(&trial.objectives);
        json!({
            "variables": variables.map(|(v, x)| (v.name.clone(), json!(x))).collect::<serde_json::Map<_, _>>(),
            "objectives": objectives.map(|(o, f)| (o.name.clone(), json!(f))).collect::<serde_json::Map<_, _>>(),
        })
    };
    json!({
        "title": tables.title,
        "tried": found.tried.len(),
        "as_it_is": found.before,
        "front": found.front.iter().map(trial).collect::<Vec<_>>(),
    })
}
