//! A result as a table of another program.

use super::ExportRequest;
use crate::answer::Answer;
use crate::failure::{Failure, Result};
use crate::watch::Watch;
use gearmesh_geometry::input::InputDocument;
use gearmesh_model::write_streamed;
use gearmesh_report::export::{
    ExportError, Table, pair_tables, study_table, system_tables, write_csv, write_mat,
    write_parquet, write_universal,
};
use gearmesh_scene::ResultFile;
use serde_json::json;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Writes the table that was asked for, or all in a .mat file.
pub(super) fn write(a: &ExportRequest, ending: &str, watch: &Watch<'_>) -> Result<Answer> {
    let opened = Opened::open(&a.result)?;
    let tables = opened.tables()?;
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
    let stream = |fill: &dyn Fn(&mut (dyn Write + Send)) -> Result<(), ExportError>| {
        write_streamed(&a.output, |out| fill(out)).map_err(|error| blame(error, &a.output))
    };
    watch.go_on()?;
    match ending {
        ".csv" => stream(&|out| write_csv(first, out))?,
        ".parquet" => stream(&|out| write_parquet(first, out))?,
        ".mat" => {
            let all = chosen.map_or(&tables[..], |place| &tables[place..=place]);
            stream(&|out| write_mat(all, out))?;
        }
        _ => stream(&|out| write_functions(a, first, out))?,
    }
    let written: Vec<&Table<'_>> = match (ending, chosen) {
        (".mat", None) => tables.iter().collect(),
        _ => vec![first],
    };
    let told = written.iter().map(|table| {
        let heads: Vec<&str> = table.columns.iter().map(|c| &c.0[..]).collect();
        json!({ "name": table.name, "rows": table.rows(), "columns": heads })
    });
    let figures = json!({ "file": a.output, "tables": told.collect::<Vec<_>>() });
    for table in &written {
        let columns = table.columns.len();
        watch.note(format!(
            "table `{}`: {} rows of {columns} columns",
            table.name,
            table.rows()
        ));
    }
    if written.len() < tables.len() && chosen.is_none() {
        watch.note(format!(
            "a {ending} file holds one table; --table takes another: {}",
            names[1..].join(" ")
        ));
    }
    Ok(figures.into())
}

/// Writes a table as functions over its axis; what has none is refused, and nothing written.
fn write_functions(
    a: &ExportRequest,
    table: &Table<'_>,
    out: &mut dyn Write,
) -> Result<(), ExportError> {
    let title = a.result.file_stem().unwrap_or_default().to_string_lossy();
    let program = format!("gearmesh {}", env!("CARGO_PKG_VERSION"));
    match write_universal(table, (&title, &program), out)? {
        0 => Err(ExportError::NoFunctions {
            table: table.name.clone(),
        }),
        _ => Ok(()),
    }
}

/// What tables are made of.
enum Opened {
    /// The table of a study, and where it stands.
    Study(String, PathBuf),
    Result(ResultFile),
}

impl Opened {
    /// A result, or the folder of a study.
    fn open(path: &Path) -> Result<Self> {
        if path.is_dir() || path.extension().is_some_and(|ending| ending == "csv") {
            let file = if path.is_dir() {
                path.join("study.csv")
            } else {
                path.to_owned()
            };
            return Ok(Self::Study(InputDocument::read(&file)?.text, file));
        }
        let result = ResultFile::open(path).map_err(Failure::input)?;
        Ok(Self::Result(result))
    }

    /// All tables; the most wanted one first.
    fn tables(&self) -> Result<Vec<Table<'_>>> {
        match self {
            Self::Study(text, file) => match study_table(text) {
                Ok(table) => Ok(vec![table]),
                Err(error) => Err(Failure::input(format!("{}: {error}", file.display()))),
            },
            Self::Result(ResultFile::System(result)) => Ok(system_tables(result)),
            Self::Result(ResultFile::Pair(result)) => Ok(pair_tables(result)),
        }
    }
}

/// What cannot be written is not the input's fault.
fn blame(error: ExportError, output: &Path) -> Failure {
    match error {
        ExportError::File(error) => Failure::work(error),
        ExportError::TooLarge { .. } | ExportError::NoFunctions { .. } => Failure::input(error),
        ExportError::Csv(_) | ExportError::Write(_) | ExportError::Parquet(_) => {
            Failure::work(format!("cannot write {}: {error}", output.display()))
        }
    }
}
