//! The page of an optimisation: what was found, the front, what was tried.

use gearmesh_scene::optimise::{Optimisation, Optimum, Trial};

use crate::page::{Align, Axis, KeyFigures, Page, PointSeries, ScatterChart, Section, Table, Text};
use crate::short;

/// The page of an outcome.
#[must_use]
pub fn optimise_page(problem: &Optimisation, found: &Optimum) -> Page {
    let tables = &problem.tables;
    let mut figures = KeyFigures::new();
    for (k, objective) in tables.objective.iter().enumerate() {
        let least = found.front.iter().map(|trial| trial.objectives[k]);
        let least = least.fold(f64::INFINITY, f64::min);
        let before = found.before.as_ref();
        let before = before.map_or(String::new(), |before| {
            format!("as it is {}", short(before[k]))
        });
        figures = figures.figure(format!("least {}", objective.name), short(least), before);
    }
    let scatter = match problem.samples() {
        1 => String::new(),
        samples => format!(" Each is the result of {samples} pairs that scatter makes of it."),
    };
    let variables = match tables.variable.len() {
        1 => "1 variable".to_owned(),
        count => format!("{count} variables"),
    };
    let told = format!(
        "{} choices of {variables} were tried.{scatter}",
        found.tried.len()
    );
    let mut section = Section::new("What was found")
        .push(figures)
        .push(Text::paragraph(told));
    let names: Vec<&str> = tables.objective.iter().map(|o| &o.name[..]).collect();
    // Every pair of objectives is a picture.
    for a in 0..names.len() {
        for b in a + 1..names.len() {
            section = section.push(picture(problem, found, [a, b]));
        }
    }
    if names.len() == 1 {
        for (k, variable) in tables.variable.iter().enumerate() {
            let points = |trials: &[Trial]| {
                trials
                    .iter()
                    .map(|t| [t.values[k], t.objectives[0]])
                    .collect()
            };
            let title = format!("{} over {}", names[0], variable.name);
            section = section.push(
                ScatterChart::new(
                    title,
                    Axis::new(variable.name.clone(), ""),
                    Axis::new(names[0], ""),
                )
                .series(PointSeries::new("tried", points(&found.tried)))
                .series(PointSeries::new("best", points(&found.front)).joined()),
            );
        }
    }
    section = section.push(front_table(problem, found));
    Page::new(tables.title.clone())
        .subtitle("Optimisation")
        .section(section)
        .footer(format!("by gearmesh {}", env!("CARGO_PKG_VERSION")))
}

fn picture(problem: &Optimisation, found: &Optimum, [a, b]: [usize; 2]) -> ScatterChart {
    let objectives = &problem.tables.objective;
    let point = |trial: &Trial| [trial.objectives[a], trial.objectives[b]];
    let label = |trial: &Trial| {
        let pairs = problem.tables.variable.iter().zip(&trial.values);
        let words = pairs.map(|(variable, value)| format!("{} {}", variable.name, short(*value)));
        words.collect::<Vec<_>>().join(", ")
    };
    // What is far beyond the front would press it into a corner.
    let most = |k: usize| {
        let of_front = || found.front.iter().map(move |trial| trial.objectives[k]);
        let (low, high) = (
            of_front().fold(f64::INFINITY, f64::min),
            of_front().fold(f64::NEG_INFINITY, f64::max),
        );
        high + (high - low)
    };
    let (most_a, most_b) = (most(a), most(b));
    let near = |trial: &&Trial| trial.objectives[a] <= most_a && trial.objectives[b] <= most_b;
    let tried: Vec<&Trial> = found.tried.iter().filter(near).collect();
    let mut chart = ScatterChart::new(
        format!("{} against {}", objectives[b].name, objectives[a].name),
        Axis::new(objectives[a].name.clone(), ""),
        Axis::new(objectives[b].name.clone(), ""),
    )
    .series(PointSeries::new(
        "tried",
        tried.into_iter().map(point).collect(),
    ))
    .series({
        let front = PointSeries::new("front", found.front.iter().map(point).collect());
        let front = if objectives.len() == 2 {
            front.joined()
        } else {
            front
        };
        front.labels(found.front.iter().map(label).collect())
    });
    if let Some(before) = &found.before
        && before[a] <= most_a
        && before[b] <= most_b
    {
        chart = chart.series(PointSeries::new(
            "scene as it is",
            vec![[before[a], before[b]]],
        ));
    }
    chart
}

fn front_table(problem: &Optimisation, found: &Optimum) -> Table {
    let tables = &problem.tables;
    let mut table = Table::new(if tables.objective.len() == 1 {
        "Best choice"
    } else {
        "Pareto front"
    });
    let heads = tables
        .variable
        .iter()
        .map(|v| &v.name)
        .chain(tables.objective.iter().map(|o| &o.name));
    for head in heads {
        table = table.column(head.clone(), Align::Right);
    }
    for trial in &found.front {
        table.push_row(
            trial
                .values
                .iter()
                .chain(&trial.objectives)
                .map(|value| short(*value)),
        );
    }
    table
}
