//! The stages of a run: a block of lines for the console, figures of the JSON.

use gearmesh_report::short;
use gearmesh_scene::system_run::SystemResult;
use serde_json::{Map, Value, json};

use crate::failure::{Failure, Result};

/// Stages side by side.
const MOST_STAGES: usize = 6;

/// A line a figure, a column a stage; nothing of a scene without gear meshes.
pub fn lines(result: &SystemResult) -> Result<Vec<String>> {
    let Some(table) = result.stages().map_err(Failure::work)? else {
        return Ok(Vec::new());
    };
    let figures = table.lines();
    let mut lines = vec![format!("stages, loads {}:", table.over)];
    let names: Vec<&str> = table
        .rows
        .iter()
        .map(|row| row.mesh.name.as_str())
        .collect();
    for first in (0..names.len()).step_by(MOST_STAGES) {
        let shown = first..names.len().min(first + MOST_STAGES);
        let width = names[shown.clone()].iter().map(|n| n.chars().count());
        let width = width.max().unwrap_or(0).max(11);
        let row = |label: &str, unit: &str, cells: Vec<String>| {
            let cells = cells.iter().map(|cell| format!(" {cell:>width$}"));
            format!("{label:<24} {unit:<10}{}", cells.collect::<String>())
        };
        let heads = names[shown.clone()].iter().map(|name| (*name).to_owned());
        lines.push(row("stage", "unit", heads.collect()));
        for line in &figures {
            let cells = line.values[shown.clone()].iter();
            let cells = cells.map(|value| value.map_or_else(|| "-".to_owned(), short));
            lines.push(row(line.label, line.unit, cells.collect()));
        }
    }
    Ok(lines)
}

/// For `--json`: the figures of each stage by the name of its mesh; null of a scene without gear meshes.
pub fn json(result: &SystemResult) -> Result<Value> {
    let Some(table) = result.stages().map_err(Failure::work)? else {
        return Ok(Value::Null);
    };
    let figures = table.lines();
    let of_stage = |i: usize| -> Map<String, Value> {
        let of_line = figures.iter();
        of_line
            .map(|line| (line.key.to_owned(), json!(line.values[i])))
            .collect()
    };
    let meshes = table.rows.iter().enumerate();
    let meshes: Map<String, Value> = meshes
        .map(|(i, row)| (row.mesh.name.clone(), Value::Object(of_stage(i))))
        .collect();
    Ok(json!({"over": table.over, "meshes": meshes}))
}
