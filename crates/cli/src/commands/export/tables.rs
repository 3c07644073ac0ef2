//! A result as a table of another program.

use crate::arguments::ExportArguments;
use crate::failure::Failure;
use crate::{console, uff};
use gearmesh_geometry::input::InputDocument;
use gearmesh_model::write_bytes;
use gearmesh_report::export::{
    ExportError, Table, csv_text, functions, mat_bytes, pair_tables, parquet_bytes, study_table,
    system_tables,
};
use gearmesh_scene::ResultFile;
use serde_json::json;
use std::path::Path;

/// Writes the table that was asked for, or all in a .mat file.
pub fn run(a: &ExportArguments, ending: &str) -> Result<(), Failure> {
    let tables = tables_of(&a.result)?;
    let names: Vec<&str> = tables.iter().map(|table| &*table.name).collect();
    let chosen = match &a.table {
        None => None,
        Some(wanted) => {
            let place = names.iter().position(|name| name == wanted);
            let place = place.ok_or_else(|| {
                Failure::input(format!(
                    "--table: {} has no table `{wanted}`; allowed are {}",
                    a.result.display(),
                    names.join(" ")
                ))
            })?;
            Some(place)
        }
    };
    let first = &tables[chosen.unwrap_or(0)];
    let bytes = match ending {
        ".csv" => Some(csv_text(first).map(String::into_bytes)),
        ".parquet" => Some(parquet_bytes(first)),
        ".mat" => Some(mat_bytes(
            chosen.map_or(&tables[..], |place| &tables[place..=place]),
        )),
        _ => None,
    };
    match bytes {
        Some(bytes) => write_bytes(&a.output, &bytes.map_err(blame)?).map_err(Failure::work)?,
        None => write_functions(a, first)?,
    }
    let written: Vec<&Table> = match (ending, chosen) {
        (".mat", None) => tables.iter().collect(),
        _ => vec![first],
    };
    if a.json {
        let tables: Vec<_> = (written.iter())
            .map(|table| {
                let heads: Vec<&str> = table.columns.iter().map(|c| &c.0[..]).collect();
                json!({ "name": table.name, "rows": table.rows(), "columns": heads })
            })
            .collect();
        console::json(&json!({ "file": a.output, "tables": tables }));
    }
    for table in &written {
        let columns = table.columns.len();
        console::note(format!(
            "table `{}`: {} rows of {columns} columns",
            table.name,
            table.rows()
        ));
    }
    if written.len() < tables.len() && chosen.is_none() {
        console::note(format!(
            "a {ending} file holds one table; --table takes another: {}",
            names[1..].join(" ")
        ));
    }
    Ok(())
}

/// A table as functions over its axis.
fn write_functions(a: &ExportArguments, table: &Table) -> Result<(), Failure> {
    let functions = functions(table);
    if functions.is_empty() {
        return Err(Failure::input(format!(
            "{}: table `{}` holds no functions over an axis; a universal file takes the curves of a pair, the rows of a run in time and the windows of a sweep",
            a.result.display(),
            table.name
        )));
    }
    let title = a.result.file_stem().unwrap_or_default();
    uff::write(&a.output, &title.to_string_lossy(), &functions)
}

/// All tables of a result, or of the folder of a study; the most wanted one first.
fn tables_of(path: &Path) -> Result<Vec<Table>, Failure> {
    if path.is_dir() || path.extension().is_some_and(|ending| ending == "csv") {
        let file = if path.is_dir() {
            path.join("study.csv")
        } else {
            path.to_owned()
        };
        let text = InputDocument::read(&file)?.text;
        let table = study_table(&text)
            .map_err(|error| Failure::input(format!("{}: {error}", file.display())))?;
        return Ok(vec![table]);
    }
    match ResultFile::open(path).map_err(Failure::input)? {
        ResultFile::System(result) => system_tables(&result).map_err(blame),
        ResultFile::Pair(result) => Ok(pair_tables(&result)),
    }
}

fn blame(error: ExportError) -> Failure {
    match error {
        ExportError::Parquet(_) => Failure::work(error),
        _ => Failure::input(error),
    }
}
