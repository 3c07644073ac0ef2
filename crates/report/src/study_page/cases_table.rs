//! The table of a study's cases: what each sets, and its columns.

use gearmesh_scene::study::{CaseResult, SelectedValue};
use gearmesh_specification::study::Study;

use super::{Column, is_same_at_every_torque, of_column};
use crate::column_words::{self, head, words_and_unit};
use crate::page::{Align, Table};
use crate::short;

/// Rows; study.csv has all.
const MOST_ROWS: usize = 500;

/// The table, folded where it is long; `shown` are the columns that any case has.
pub(super) fn table(study: &Study, cases: &[CaseResult], shown: &[Column]) -> Table {
    let count = cases.len();
    let caption = match count > MOST_ROWS {
        true => format!("The first {MOST_ROWS} of {count} cases"),
        false => "All cases".to_owned(),
    };
    // Cases that set several parameters have a column for each.
    let parameters: &[_] = match cases.iter().any(|case| case.case.settings.len() > 1) {
        true => &study.tables.parameter,
        false => &[],
    };
    let mut table = Table::new(caption);
    if parameters.is_empty() {
        table = table.column("case", Align::Left);
    }
    for parameter in parameters {
        table = table.column(
            head(column_words::parameter(&parameter.name, &parameter.keys)),
            Align::Right,
        );
    }
    let columns = study.tables.columns.len();
    let mut once = Vec::new();
    let mut factors = Vec::new();
    for (place, name) in study.tables.columns.iter().enumerate() {
        let own: Vec<_> = cases.iter().map(|c| of_column(c, place, columns)).collect();
        once.push(is_same_at_every_torque(&own));
        let known = shown.iter().find(|column| column.name == *name);
        factors.push(known.map_or(1.0, |column| column.factor));
        let mut head = known.map_or_else(
            || head(words_and_unit(name)),
            |column| format!("{} {}", column.words, column.unit),
        );
        let torques = own.iter().find(|own| !own.is_empty());
        let torques = torques
            .into_iter()
            .flatten()
            .filter_map(|one| one.torque_nm);
        let torques: Vec<String> = torques.map(|torque| torque.to_string()).collect();
        if torques.len() > 1 && !once[place] {
            head += &format!(" at {} N m", torques.join(", "));
        }
        table = table.column(head.trim_end(), Align::Right);
    }
    for case in cases.iter().take(MOST_ROWS) {
        let names: Vec<String> = match parameters {
            [] => vec![case.case.name()],
            _ => parameters.iter().map(|p| setting(case, &p.name)).collect(),
        };
        let cells: Vec<String> = match &case.figures {
            Err(problem) => {
                let rest = std::iter::repeat_n(String::new(), columns.saturating_sub(1));
                std::iter::once(format!("failed: {problem}"))
                    .chain(rest)
                    .collect()
            }
            Ok(_) => (0..columns)
                .map(|place| {
                    let own = of_column(case, place, columns);
                    let rows = if once[place] { 1 } else { own.len() };
                    let cells = own.iter().take(rows);
                    let cells = cells.map(|one| cell(&one.value, factors[place]));
                    cells.collect::<Vec<_>>().join(", ")
                })
                .collect(),
        };
        table.push_row(names.into_iter().chain(cells));
    }
    if count > 30 { table.folded() } else { table }
}

/// What a case sets a parameter to.
fn setting(case: &CaseResult, parameter: &str) -> String {
    let mut settings = case.case.settings.iter();
    let own = settings.find(|setting| setting.parameter == parameter);
    match own.map(|setting| &setting.value) {
        None => "as it is".to_owned(),
        Some(toml::Value::Float(value)) => short(*value),
        Some(toml::Value::String(text)) => text.clone(),
        Some(value) => value.to_string(),
    }
}

fn cell(value: &SelectedValue, factor: f64) -> String {
    let shown = |value: f64| short(factor * value);
    match value {
        SelectedValue::Single(value) => shown(*value),
        SelectedValue::Series(f) => format!(
            "{} ({} … {})",
            shown(f.mean),
            shown(f.least),
            shown(f.largest)
        ),
    }
}
