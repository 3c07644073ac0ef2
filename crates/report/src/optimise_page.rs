//! The page of an optimisation: what was found, the front, what was tried, what was asked.

use gearmesh_scene::optimise::{Optimum, Trial};
use gearmesh_specification::optimise::{Judged, Optimisation};

use crate::column_words::{axis, head, parameter, words_and_unit};
use crate::min_max::ends;
use crate::page::{Align, KeyFigures, Page, PointSeries, ScatterChart, Section, Table, Text};
use crate::short;

/// Choices of the front that differ by less than this share of its extent in every objective are one row.
const ALIKE: f64 = 0.02;

/// A variable this near to a bound, as a share of its range, stands at it.
const AT_BOUND: f64 = 1e-3;

/// The page of an outcome.
#[must_use]
pub fn optimise_page(problem: &Optimisation, found: &Optimum) -> Page {
    let tables = &problem.tables;
    let mut figures = KeyFigures::new();
    for (k, objective) in tables.objective.iter().enumerate() {
        let least = found.front.iter().map(|trial| trial.objectives[k]);
        let least = least.fold(f64::INFINITY, f64::min);
        let (words, unit) = words_and_unit(&objective.name);
        let before = found.before.as_ref().map_or(String::new(), |before| {
            format!("; as it is {}", short(before[k]))
        });
        let behind = format!("{unit}{before}");
        let behind = behind.trim_start_matches("; ").to_owned();
        figures = figures.figure(format!("least {words}"), short(least), behind);
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
    // Every pair of objectives is a picture.
    for a in 0..tables.objective.len() {
        for b in a + 1..tables.objective.len() {
            section = section.push(picture(problem, found, [a, b]));
        }
    }
    if let [objective] = &tables.objective[..] {
        for (k, variable) in tables.variable.iter().enumerate() {
            let points = |trials: &[Trial]| {
                let points = trials.iter().map(|t| [t.values[k], t.objectives[0]]);
                points.collect()
            };
            let (what, over) = (
                words_and_unit(&objective.name).0,
                words_and_unit(&variable.name).0,
            );
            section = section.push(
                ScatterChart::new(
                    format!("{what} over {over}"),
                    axis(parameter(&variable.name, &variable.keys)),
                    axis(words_and_unit(&objective.name)),
                )
                .series(PointSeries::new("tried", points(&found.tried)))
                .series(PointSeries::new("best", points(&found.front)).marked()),
            );
        }
    }
    let section = section.push(front_table(problem, found));
    Page::new(tables.title.clone())
        .subtitle("Optimisation")
        .section(section)
        .section(question(problem, found))
        .footer(format!("by gearmesh {}", env!("CARGO_PKG_VERSION")))
}

fn picture(problem: &Optimisation, found: &Optimum, [a, b]: [usize; 2]) -> ScatterChart {
    let objectives = &problem.tables.objective;
    let point = |trial: &Trial| [trial.objectives[a], trial.objectives[b]];
    let label = |trial: &Trial| {
        let pairs = problem.tables.variable.iter().zip(&trial.values);
        let words = pairs.map(|(variable, value)| {
            let (words, unit) = parameter(&variable.name, &variable.keys);
            format!("{words} {} {unit}", short(*value))
                .trim_end()
                .to_owned()
        });
        words.collect::<Vec<_>>().join(", ")
    };
    // What is far beyond the front would press it into a corner.
    let most = |k: usize| {
        let [low, high] = ends(found.front.iter().map(|trial| trial.objectives[k]));
        high + (high - low)
    };
    let (most_a, most_b) = (most(a), most(b));
    let near = |trial: &&Trial| trial.objectives[a] <= most_a && trial.objectives[b] <= most_b;
    let tried: Vec<&Trial> = found.tried.iter().filter(near).collect();
    let [name_a, name_b] = [a, b].map(|k| words_and_unit(&objectives[k].name).0);
    let mut chart = ScatterChart::new(
        format!("{name_b} against {name_a}"),
        axis(words_and_unit(&objectives[a].name)),
        axis(words_and_unit(&objectives[b].name)),
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
    if let Some(before) = &found.before {
        chart = match before[a] <= most_a && before[b] <= most_b {
            true => chart
                .series(PointSeries::new("scene as it is", vec![[before[a], before[b]]]).marked()),
            false => chart.told(format!(
                "the scene as it is, at {} and {}, is outside",
                short(before[a]),
                short(before[b])
            )),
        };
    }
    chart
}

/// Choices of the front without those that are almost one that stands there already.
fn distinct(front: &[Trial]) -> Vec<&Trial> {
    let objectives = front.first().map_or(0, |trial| trial.objectives.len());
    let extents: Vec<f64> = (0..objectives)
        .map(|k| {
            let [low, high] = ends(front.iter().map(|trial| trial.objectives[k]));
            high - low
        })
        .collect();
    let mut kept: Vec<&Trial> = Vec::new();
    for trial in front {
        let is_alike = |other: &&Trial| {
            let pairs = trial.objectives.iter().zip(&other.objectives).zip(&extents);
            pairs
                .into_iter()
                .all(|((a, b), extent)| (a - b).abs() <= ALIKE * extent)
        };
        // The least of an objective is always there.
        let is_end = (0..objectives).any(|k| {
            let least = ends(front.iter().map(|trial| trial.objectives[k]))[0];
            trial.objectives[k] == least
        });
        if is_end || !kept.iter().any(is_alike) {
            kept.push(trial);
        }
    }
    kept
}

fn front_table(problem: &Optimisation, found: &Optimum) -> Table {
    let tables = &problem.tables;
    let rows = distinct(&found.front);
    let all = found.front.len();
    let mut table = Table::new(match tables.objective.len() {
        1 => "Best choice".to_owned(),
        _ if rows.len() < all => format!(
            "Pareto front, {} of {all} choices: the others differ from one of these by at most {} % of the front's extent in every objective (all are in front.csv)",
            rows.len(),
            100.0 * ALIKE
        ),
        _ => "Pareto front".to_owned(),
    });
    let variables = tables.variable.iter();
    let variables = variables.map(|v| parameter(&v.name, &v.keys));
    let objectives = tables.objective.iter().map(|o| words_and_unit(&o.name));
    table = table.columns(Align::Right, variables.chain(objectives).map(head));
    for trial in rows {
        let cells = trial.values.iter().chain(&trial.objectives);
        table.push_row(cells.map(|value| short(*value)));
    }
    table
}

/// What was asked: variables with their bounds, objectives, scatter.
fn question(problem: &Optimisation, found: &Optimum) -> Section {
    let section = Section::new("What was asked")
        .push(variables(problem, found))
        .push(objectives(problem));
    match problem.tables.scatter.is_empty() {
        true => section,
        false => section.push(scatter(problem)),
    }
}

fn variables(problem: &Optimisation, found: &Optimum) -> Table {
    let mut table = Table::new("Variables, their bounds, and what the front has of them")
        .column("variable", Align::Left)
        .columns(Align::Right, ["from", "to", "front"])
        .column("at a bound", Align::Left)
        .column("keys", Align::Phrase);
    for (k, variable) in problem.tables.variable.iter().enumerate() {
        let values = || found.front.iter().map(|trial| trial.values[k]);
        let [low, high] = ends(values());
        let near = AT_BOUND * (variable.to - variable.from);
        let count = |bound: f64| values().filter(|v| (v - bound).abs() <= near).count();
        let at = match [count(variable.from), count(variable.to)] {
            [0, 0] => "none".to_owned(),
            [lower, 0] => format!("{lower} at the lower"),
            [0, upper] => format!("{upper} at the upper"),
            [lower, upper] => format!("{lower} at the lower, {upper} at the upper"),
        };
        table.push_row([
            head(parameter(&variable.name, &variable.keys)),
            short(variable.from),
            short(variable.to),
            match low == high {
                true => short(low),
                false => format!("{} to {}", short(low), short(high)),
            },
            at,
            code(&variable.keys),
        ]);
    }
    table
}

fn objectives(problem: &Optimisation) -> Table {
    let mut table = Table::new("Objectives, sums of what is to be small")
        .columns(Align::Left, ["objective", "column"])
        .columns(Align::Right, ["torque N m", "weight"]);
    for objective in &problem.tables.objective {
        for term in &objective.term {
            table.push_row([
                head(words_and_unit(&objective.name)),
                format!("`{}`", term.column),
                term.torque_Nm
                    .map_or_else(|| "mean of all".to_owned(), |torque| torque.to_string()),
                term.weight.to_string(),
            ]);
        }
    }
    table
}

fn scatter(problem: &Optimisation) -> Table {
    let judged = match problem.tables.judged_by.unwrap_or_default() {
        Judged::Mean => "their mean counts",
        Judged::Worst => "the worst of them counts",
    };
    let mut table = Table::new(format!(
        "Scatter: every choice is tried on {} pairs, {judged}",
        problem.samples()
    ))
    .columns(Align::Left, ["what scatters", "by"])
    .column("keys", Align::Phrase);
    for one in &problem.tables.scatter {
        let by = match (&one.normal, &one.uniform) {
            (Some(normal), _) => format!(
                "normal, mean {}, standard deviation {}",
                short(normal.mean),
                short(normal.deviation)
            ),
            (None, Some(range)) => format!("even, {} to {}", short(range.from), short(range.to)),
            (None, None) => String::new(),
        };
        table.push_row([head(parameter(&one.name, &one.keys)), by, code(&one.keys)]);
    }
    table
}

fn code(keys: &[String]) -> String {
    let keys = keys.iter().map(|key| format!("`{key}`"));
    keys.collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 116 rows that read the same say less than a few that differ.
    #[test]
    fn a_front_has_no_rows_that_read_the_same() {
        let trial = |a: f64, b: f64| Trial {
            values: vec![a],
            objectives: vec![a, b],
            yielding: None,
        };
        let near = |at: f64| (0..50).map(move |k| at + 1e-5 * f64::from(k));
        let front: Vec<Trial> = [0.0, 0.5, 1.0]
            .into_iter()
            .flat_map(near)
            .map(|a| trial(a, 1.0 - a))
            .collect();
        let kept = distinct(&front);
        assert!((3..=4).contains(&kept.len()), "{}", kept.len());
        // The least of both objectives.
        assert_eq!(kept[0].objectives[0], 0.0);
        assert_eq!(kept[kept.len() - 1], &front[front.len() - 1]);
        let apart = [trial(0.0, 1.0), trial(0.5, 0.4), trial(1.0, 0.0)];
        assert_eq!(distinct(&apart).len(), 3);
    }
}
