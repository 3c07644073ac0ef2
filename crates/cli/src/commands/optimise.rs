//! `gearmesh optimise`: keys of a scene that make its objectives least.

use crate::arguments::Printed;
use crate::{console, interrupt};
use gearmesh_operations::Failure;
use gearmesh_operations::optimise::{OptimiseRequest, names};
use gearmesh_report::{column_width, short};
use gearmesh_scene::optimise::{Optimum, Trial};
use gearmesh_specification::optimise::Optimisation;

/// Lines of a front beyond which the printed table leaves some out.
const MOST_LINES: usize = 20;

/// Runs the command.
pub fn run(a: &Printed<OptimiseRequest>) -> Result<(), Failure> {
    let stop = interrupt::on_demand();
    let found = a.request.optimise(&stop.watch())?;
    drop(stop);
    let lines = || table(&found.problem, &found.optimum);
    console::found(a.json, || found.figures(), lines);
    found.demand_ended()
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
        let Trial {
            values, objectives, ..
        } = &found.front[place];
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
