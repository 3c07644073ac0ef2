//! `gearmesh study`: a scene again and again with some of its keys changed.

use super::study_elsewhere as elsewhere;
use crate::arguments::StudyArguments;
use crate::{console, interrupt};
use gearmesh_operations::Failure;
use gearmesh_operations::study::{gather, refuse_overwriting, study as run_study};
use gearmesh_report::{column_width, short, study_figures, usual_unit};
use gearmesh_scene::study::{CaseResult, Selected, SelectedValue, SeriesOver, StudyOutcome};
use gearmesh_scene::system_run::{Figures, stem};
use gearmesh_specification::study::Study;

/// Cases beyond which the table tells the extremes only.
const MOST_LINES: usize = 50;

/// Runs the command.
pub fn run(a: &StudyArguments) -> Result<(), Failure> {
    let mut study = Study::read(&a.study)?;
    study.most_result_bytes = 1e9 * a.most_result_gb;
    let failures = match (&a.scheduler, &a.gather) {
        (None, None) => None,
        (None, Some(failures)) => Some(elsewhere::failures(failures)?),
        (Some(scheduler), _) => {
            // Before the cluster computes; `gather` looks only afterwards.
            refuse_overwriting(&study, &a.output)?;
            Some(elsewhere::run(a, scheduler)?)
        }
    };
    let outcome = match failures {
        Some(failures) => gather(&study, &a.output, &failures, &console::watch())?,
        None => {
            let stop = interrupt::on_demand();
            run_study(&study, &a.output, &stop.watch())?
        }
    };
    let figures = || study_figures(&study, &outcome.cases);
    console::found(a.json, figures, || table(&study, &outcome));
    let failed = outcome.cases.iter().filter(|case| case.figures.is_err());
    match failed.count() {
        0 => Ok(()),
        failed => Err(Failure::work(format!(
            "{failed} of {} cases failed; the table says why",
            outcome.cases.len()
        ))),
    }
}

/// The figures for people.
fn table(study: &Study, outcome: &StudyOutcome) -> Vec<String> {
    let cases = &outcome.cases[..];
    let names: Vec<String> = cases.iter().map(|result| result.case.name()).collect();
    let width = column_width(&names, 4);
    let found = cases.iter().find_map(|case| case.figures.as_ref().ok());
    // Of runs in time it is reported whether it is stated or not.
    let has_series = found.is_some_and(|all| {
        all.iter()
            .any(|c| matches!(c.value, SelectedValue::Series(_)))
    });
    let from = match outcome.series_over {
        _ if !has_series && study.tables.from_s == 0.0 => String::new(),
        SeriesOver::Time => format!(", from {} s on", study.tables.from_s),
        SeriesOver::Equilibria => ", over all equilibria".to_owned(),
        SeriesOver::OperatingPoints => ", over all operating points".to_owned(),
        SeriesOver::Speeds => ", over all speeds".to_owned(),
        SeriesOver::Nothing => String::new(),
    };
    let mut lines = vec![format!("{}{from}", study.tables.title)];
    if let (None, Some(first), true) = (found, cases.first(), cases.len() > MOST_LINES) {
        let problem = first.figures.as_ref().err();
        let problem = problem.map_or("", String::as_str);
        lines.push(format!("{} failed: {problem}", first.case.name()));
        lines.push("no other case has figures either; study.csv has them all".to_owned());
        return lines;
    }
    for (k, column) in study.tables.columns.iter().enumerate() {
        let is_series = found.is_some_and(|columns| {
            let one = columns.get(k);
            one.is_some_and(|one| matches!(one.value, SelectedValue::Series(_)))
        });
        if is_series || found.is_none() {
            series_column(cases, (column, k), (&names, width), &mut lines);
        } else if cases.len() > MOST_LINES {
            extremes(study, cases, (column, k), &mut lines);
        } else {
            number_column(study, cases, (column, k), (&names, width), &mut lines);
        }
    }
    lines
}

/// The least and the largest number of a column, of gear pairs at each torque, and where they were found.
fn extremes(
    study: &Study,
    cases: &[CaseResult],
    (column, place): (&str, usize),
    lines: &mut Vec<String>,
) {
    let count = study.tables.columns.len();
    let sound = || {
        cases
            .iter()
            .filter_map(|case| Some((case, case.figures.as_ref().ok()?)))
    };
    let rows = sound().map(|(_, columns)| columns.len() / count).max();
    lines.push(format!(
        "{column}, {} cases; each is in study.csv",
        cases.len()
    ));
    for row in 0..rows.unwrap_or(0) {
        let values = sound().filter_map(|(case, columns)| {
            let one = columns.get(row * count + place)?;
            let SelectedValue::Single(value) = one.value else {
                return None;
            };
            let torque = one
                .torque_nm
                .map_or_else(String::new, |t| format!("{t} N m"));
            Some((value, torque, case.case.name()))
        });
        let mut values: Vec<_> = values.collect();
        values.sort_by(|a, b| a.0.total_cmp(&b.0));
        if let (Some(least), Some(largest)) = (values.first(), values.last()) {
            for (word, (value, torque, name)) in [("least", least), ("largest", largest)] {
                let value = short(*value);
                lines.push(format!("{torque:>11} {word:7} {value:>11}  {name}"));
            }
        }
    }
}

/// A column of single numbers: a line for each case, of gear pairs a number for each torque.
fn number_column(
    study: &Study,
    cases: &[CaseResult],
    (column, place): (&str, usize),
    (names, width): (&[String], usize),
    lines: &mut Vec<String>,
) {
    let count = study.tables.columns.len();
    let of_column = |columns: &[Selected]| -> Vec<Selected> {
        columns.iter().skip(place).step_by(count).cloned().collect()
    };
    let is_one = |result: &CaseResult| {
        result.figures.as_ref().map_or(true, |columns| {
            let all = of_column(columns);
            all.iter().all(|one| one.value == all[0].value)
        })
    };
    let most_torques = |result: &CaseResult| {
        let columns = result.figures.as_ref();
        columns.map_or(0, |columns| of_column(columns).len())
    };
    // What is without load stands there once.
    let once = cases.iter().any(|result| most_torques(result) > 1) && cases.iter().all(is_one);
    let mut torques: Vec<f64> = Vec::new();
    lines.push(match once {
        true => format!("{column}, the same at every torque"),
        false => column.to_owned(),
    });
    for (name, result) in names.iter().zip(cases) {
        let mut columns = match &result.figures {
            Ok(columns) => of_column(columns),
            Err(problem) => {
                lines.push(format!("{name:width$} failed: {problem}"));
                continue;
            }
        };
        if once {
            columns.truncate(1);
            columns.iter_mut().for_each(|one| one.torque_nm = None);
        }
        let own: Vec<f64> = columns.iter().filter_map(|c| c.torque_nm).collect();
        // Told again where a case has other torques.
        if own != torques {
            let heads = own
                .iter()
                .map(|torque| format!(" {:>11}", format!("{torque} N m")));
            lines.push(format!("{:width$}{}", "case", heads.collect::<String>()));
            torques = own;
        }
        let cells = columns.iter().map(|one| match one.value {
            SelectedValue::Single(value) => format!(" {:>11}", short(value)),
            SelectedValue::Series(figures) => format!(" {:>11}", short(figures.mean)),
        });
        lines.push(format!("{name:width$}{}", cells.collect::<String>()));
    }
}

/// A column of a multibody run: a line of figures for each case.
fn series_column(
    cases: &[CaseResult],
    (column, place): (&str, usize),
    (names, width): (&[String], usize),
    lines: &mut Vec<String>,
) {
    let figures_of = |columns: &[Selected]| match columns[place].value {
        SelectedValue::Series(figures) => figures,
        SelectedValue::Single(value) => Figures::of(&[value]),
    };
    let found = cases.iter();
    let found = found.filter_map(|result| result.figures.as_ref().ok());
    // Of no case where all have failed.
    let unit = found
        .clone()
        .next()
        .map_or("", |columns| &columns[place].unit);
    let stem = stem(column, unit);
    let largest = found.fold(0.0_f64, |most, columns| {
        most.max(figures_of(columns).magnitude())
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
                let figures = figures_of(columns);
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
