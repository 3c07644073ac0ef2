//! A table as CSV: one line of names, commas, points; texts in quotes where they need them.

use gearmesh_model::{no_formula, without_apostrophe};

use super::{Cells, ExportError, Table};

/// The table as text. A number has as many digits as tell it from its neighbours.
///
/// # Errors
/// [`ExportError::Csv`].
pub fn csv_text(table: &Table) -> Result<String, ExportError> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    writer.write_record(
        table
            .columns
            .iter()
            .map(|(name, _)| no_formula(name).into_owned()),
    )?;
    for row in 0..table.rows() {
        for (_, cells) in &table.columns {
            match cells {
                Cells::Numbers(values) => writer.write_field(number(values[row]))?,
                Cells::Texts(values) => writer.write_field(no_formula(&values[row]).as_ref())?,
            }
        }
        writer.write_record(None::<&[u8]>)?;
    }
    let bytes = writer
        .into_inner()
        .map_err(|error| csv::Error::from(error.into_error()))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// Nothing for what is not there.
fn number(value: f64) -> String {
    if value.is_nan() {
        String::new()
    } else if value == 0.0 || (1e-4..1e6).contains(&value.abs()) {
        value.to_string()
    } else {
        format!("{value:e}")
    }
}

/// The table of a study from its `study.csv`: columns in which every cell is a number are numbers.
///
/// # Errors
/// [`ExportError::Csv`] if lines are of different lengths.
pub fn study_table(text: &str) -> Result<Table, ExportError> {
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
