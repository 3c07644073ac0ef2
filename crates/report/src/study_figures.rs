//! The figures of a study for machines: what `gearmesh study --json` prints and Python gets.

use gearmesh_scene::study::{CaseResult, Selected, SelectedValue};
use gearmesh_specification::study::Study;
use serde_json::{Value, json};

/// Title, `from_s` and the cases: parameters, file, columns with their figures, or why there are none.
#[must_use]
pub fn study_figures(study: &Study, cases: &[CaseResult]) -> Value {
    let cases: Vec<Value> = cases.iter().map(figures).collect();
    json!({"title": study.tables.title, "from_s": study.tables.from_s, "cases": cases})
}

/// The figures of a case.
fn figures(result: &CaseResult) -> Value {
    let settings = result.case.settings.iter();
    let settings = settings.map(|setting| (setting.parameter.clone(), json!(setting.value)));
    let columns = |columns: &Vec<Selected>| {
        let figures = columns.iter().map(|one| {
            let mut cell = json!({"name": one.column, "unit": one.unit});
            if let Some(torque) = one.torque_nm {
                cell["torque_Nm"] = json!(torque);
            }
            match one.value {
                SelectedValue::Single(value) => cell["value"] = json!(value),
                SelectedValue::Series(figures) => {
                    cell["mean"] = json!(figures.mean);
                    cell["deviation"] = json!(figures.deviation);
                    cell["least"] = json!(figures.least);
                    cell["largest"] = json!(figures.largest);
                }
            }
            cell
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
