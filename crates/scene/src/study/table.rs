//! `study.csv`: what a study found, for other programs.

use std::path::Path;

use gearmesh_model::csv_cell;
use gearmesh_specification::study::Study;

use super::cases::{CaseResult, Selected, SelectedValue};

/// A line for each case, of gear pairs for each case and torque, with the columns side by side where each is a single
/// number; otherwise a line for each case and column.
pub(super) fn table(study: &Study, results: &[CaseResult]) -> String {
    let found = results
        .iter()
        .find_map(|result| result.figures.as_ref().ok());
    let any = |is: &dyn Fn(&Selected) -> bool| found.is_some_and(|all| all.iter().any(is));
    let is_pair = any(&|c| c.torque_nm.is_some());
    let is_wide = !any(&|c| matches!(c.value, SelectedValue::Series(_)));
    let columns: Vec<&str> = if is_wide && found.is_some() {
        let own = study.tables.columns.iter().map(String::as_str);
        is_pair
            .then_some("torque_Nm")
            .into_iter()
            .chain(own)
            .collect()
    } else {
        vec!["column", "mean", "deviation", "least", "largest"]
    };
    let parameters = study.tables.parameter.iter().map(|p| &p.name[..]);
    let head = parameters
        .chain(columns.iter().copied())
        .chain(["file", "failure"]);
    let mut text = head.map(csv_cell).collect::<Vec<_>>().join(",") + "\n";
    for result in results {
        let settings = settings(study, result);
        let file = result.file.as_deref().and_then(Path::file_name);
        let file = file.map_or_else(String::new, |name| {
            csv_cell(&name.to_string_lossy()).into_owned()
        });
        match &result.figures {
            Ok(selected) if is_wide => {
                for row in selected.chunks(study.tables.columns.len().max(1)) {
                    let torque = row[0].torque_nm.filter(|_| is_pair);
                    let torque = torque.map_or_else(String::new, |t| format!("{t},"));
                    let values: String = row.iter().map(|c| number(c) + ",").collect();
                    text += &format!("{settings}{torque}{values}{file},\n");
                }
            }
            Ok(selected) => {
                for one in selected {
                    let column = csv_cell(&one.column);
                    // A number beside series stands in the place of the mean.
                    let rest = match one.value {
                        SelectedValue::Single(_) => ",,,",
                        SelectedValue::Series(_) => "",
                    };
                    text += &format!("{settings}{column},{}{rest},{file},\n", number(one));
                }
            }
            Err(problem) => {
                let empty = ",".repeat(columns.len());
                text += &format!("{settings}{empty}{file},{}\n", csv_cell(problem));
            }
        }
    }
    text
}

fn number(selected: &Selected) -> String {
    match selected.value {
        SelectedValue::Single(value) => format!("{value:e}"),
        SelectedValue::Series(f) => {
            format!(
                "{:e},{:e},{:e},{:e}",
                f.mean, f.deviation, f.least, f.largest
            )
        }
    }
}

/// The value of each parameter, empty where the case leaves it as it is, each with a comma behind it.
fn settings(study: &Study, result: &CaseResult) -> String {
    let of = |name: &str| {
        let mut settings = result.case.settings.iter();
        let found = settings.find(|setting| setting.parameter == name);
        found.map_or_else(String::new, |setting| match &setting.value {
            toml::Value::String(word) => csv_cell(word).into_owned(),
            value => value.to_string(),
        })
    };
    let parameters = study.tables.parameter.iter();
    parameters
        .map(|parameter| of(&parameter.name) + ",")
        .collect()
}
