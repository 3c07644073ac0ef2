//! A table as CSV: one line of names, commas, points; texts in quotes where they need them.

use std::fmt::Write as _;
use std::io::Write;

use gearmesh_model::{no_formula, without_apostrophe};

use super::{Cells, ExportError, Table};

/// Writes the table as text. A number has as many digits as tell it from its neighbours.
///
/// # Errors
/// [`ExportError::Csv`]; [`ExportError::File`] if a column cannot be read.
pub fn write_csv(table: &Table<'_>, out: &mut dyn Write) -> Result<(), ExportError> {
    let mut writer = csv::Writer::from_writer(out);
    writer.write_record(
        table
            .columns
            .iter()
            .map(|(name, _)| no_formula(name).into_owned()),
    )?;
    let mut cell = String::new();
    for rows in table.blocks() {
        let numbers = table.columns.iter();
        let numbers = numbers.map(|(_, cells)| cells.numbers(rows.clone()));
        let numbers = numbers.collect::<Result<Vec<_>, _>>()?;
        for row in rows.clone() {
            for ((_, cells), numbers) in table.columns.iter().zip(&numbers) {
                if let Some(numbers) = numbers {
                    write_number(&mut cell, numbers[row - rows.start]);
                    writer.write_field(&cell)?;
                } else if let Cells::Texts(texts) = cells {
                    writer.write_field(no_formula(&texts[row]).as_ref())?;
                }
            }
            writer.write_record(None::<&[u8]>)?;
        }
    }
    writer.flush()?;
    Ok(())
}

/// Nothing for what is not there.
fn write_number(cell: &mut String, value: f64) {
    cell.clear();
    // Memory is all that can be wanting.
    let _ = if value.is_nan() {
        Ok(())
    } else if value == 0.0 || (1e-4..1e6).contains(&value.abs()) {
        write!(cell, "{value}")
    } else {
        write!(cell, "{value:e}")
    };
}

/// The table of a study from its `study.csv`: columns in which every cell is a number are numbers.
///
/// # Errors
/// [`ExportError::Csv`] if lines are of different lengths.
pub fn study_table(text: &str) -> Result<Table<'static>, ExportError> {
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let names: Vec<String> = reader
        .headers()?
        .iter()
        .map(|name| without_apostrophe(name).to_owned())
        .collect();
    let mut cells: Vec<Vec<String>> = vec![Vec::new(); names.len()];
    for record in reader.records() {
        let record = record?;
        let each = cells.iter_mut().zip(&record);
        each.for_each(|(column, cell)| column.push(without_apostrophe(cell).to_owned()));
    }
    let mut table = Table::new("study");
    for (name, cells) in names.into_iter().zip(cells) {
        let numbers: Result<Vec<f64>, _> = cells.iter().map(|cell| cell.trim().parse()).collect();
        match numbers {
            Ok(numbers) => table.numbers(name, numbers),
            Err(_) => table.texts(name, cells),
        }
    }
    Ok(table)
}
