//! A table of numbers in a file: comma separated, `.` as the decimal sign, first line the heads; lines that begin with
//! `#` and blank lines are passed over. Numbers are within the range of the unit in their head. Complaints name file,
//! line and head.

use std::path::Path;

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{InputDocument, NumberRange};

/// Columns of a file.
#[derive(Debug, Clone)]
pub(crate) struct NumberTable {
    file: String,
    /// Line of each row, from 1.
    lines: Vec<usize>,
    heads: Vec<String>,
    columns: Vec<Vec<f64>>,
}

impl NumberTable {
    /// Reads the columns with the given heads.
    pub(crate) fn read(path: &Path, heads: &[&str]) -> Result<Self, InputError> {
        let document = InputDocument::read(path)?;
        let complaint = |line: Option<usize>, key: &str, problem: String| InputError {
            file: document.file.clone(),
            line,
            key: key.to_string(),
            problem,
        };
        let mut rows = (document.text.lines().zip(1..))
            .map(|(text, line)| (text.trim(), line))
            .filter(|(text, _)| !text.is_empty() && !text.starts_with('#'));
        let (head, head_line) = rows.next().ok_or_else(|| {
            complaint(
                None,
                "",
                format!(
                    "is empty; the first line must name the columns, among them {}",
                    heads.join(", ")
                ),
            )
        })?;
        let found: Vec<&str> = head.split(',').map(str::trim).collect();
        let places = heads
            .iter()
            .map(|wanted| {
                found.iter().position(|head| head == wanted).ok_or_else(|| {
                    complaint(
                        Some(head_line),
                        wanted,
                        format!("there is no such column; the file has {}", found.join(", ")),
                    )
                })
            })
            .collect::<Result<Vec<_>, _>>()?;
        let mut table = Self {
            file: document.file.clone(),
            lines: Vec::new(),
            heads: heads.iter().map(|head| (*head).to_string()).collect(),
            columns: vec![Vec::new(); heads.len()],
        };
        for (text, line) in rows {
            let fields: Vec<&str> = text.split(',').map(str::trim).collect();
            if fields.len() != found.len() {
                return Err(complaint(
                    Some(line),
                    "",
                    format!("{} fields; the head has {}", fields.len(), found.len()),
                ));
            }
            for ((column, &place), head) in table.columns.iter_mut().zip(&places).zip(heads) {
                let value = fields[place].parse::<f64>().map_err(|_| {
                    let found = fields[place];
                    let problem =
                        format!("found '{found}', allowed is a number such as -12.5 or 3e-2");
                    complaint(Some(line), head, problem)
                })?;
                if let Some(problem) = NumberRange::of(head).problem(value) {
                    return Err(complaint(Some(line), head, problem));
                }
                column.push(value);
            }
            table.lines.push(line);
        }
        if table.lines.len() < 2 {
            return Err(complaint(
                Some(head_line),
                "",
                format!(
                    "{} rows of numbers; at least 2 are needed",
                    table.lines.len()
                ),
            ));
        }
        Ok(table)
    }

    /// A column.
    pub(crate) fn column(&self, number: usize) -> &[f64] {
        &self.columns[number]
    }

    /// Complains unless a column increases from row to row.
    pub(crate) fn require_increasing(&self, number: usize) -> Result<(), InputError> {
        let column = &self.columns[number];
        let Some(row) = column.windows(2).position(|pair| pair[1] <= pair[0]) else {
            return Ok(());
        };
        Err(InputError {
            file: self.file.clone(),
            line: Some(self.lines[row + 1]),
            key: self.heads[number].clone(),
            problem: format!(
                "found {} after {}; it must increase from row to row",
                column[row + 1],
                column[row]
            ),
        })
    }
}
