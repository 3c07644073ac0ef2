//! A table of numbers in a file: comma separated, `.` as the decimal sign, first line the heads; lines that begin with
//! `#` and blank lines are passed over. Numbers are within the range of the unit in their head. Complaints name file,
//! line and head.

use std::path::Path;

use super::{CsvRows, InputDocument, InputError, NumberRange, separator_hint, shown_field};

/// Columns of a file.
#[derive(Debug, Clone)]
pub struct NumberTable {
    file: String,
    /// Line of each row, from 1.
    lines: Vec<usize>,
    heads: Vec<String>,
    columns: Vec<Vec<f64>>,
}

impl NumberTable {
    /// The first of `heads` that the file has as a column; the first of them where it has none.
    ///
    /// # Errors
    /// [`InputError`] for a file that cannot be read.
    pub fn head_among<'a>(path: &Path, heads: [&'a str; 2]) -> Result<&'a str, InputError> {
        let document = InputDocument::read(path)?;
        let first_line = CsvRows::new(&document.text).next();
        let has = |wanted: &&str| {
            let found = first_line.as_ref();
            found.is_some_and(|(_, fields)| fields.iter().any(|head| head == *wanted))
        };
        Ok(heads.into_iter().find(has).unwrap_or(heads[0]))
    }

    /// Reads the columns with the given heads.
    ///
    /// # Errors
    /// [`InputError`] with file, line and head.
    pub fn read(path: &Path, heads: &[&str]) -> Result<Self, InputError> {
        let document = InputDocument::read(path)?;
        let complaint = |line: Option<usize>, key: &str, problem: String| InputError {
            file: document.file.clone(),
            line,
            key: key.to_string(),
            problem,
        };
        let mut rows = CsvRows::new(&document.text);
        let (head_line, found) = rows.next().ok_or_else(|| {
            let among = heads.join(", ");
            let problem =
                format!("is empty; the first line must name the columns, among them {among}");
            complaint(None, "", problem)
        })?;
        let known = |wanted: &str| found.iter().position(|head| head == wanted);
        // Without any of the heads it may be any file: nothing of it is printed.
        if heads.iter().all(|wanted| known(wanted).is_none()) {
            let hint = match separator_hint(&found) {
                "" => "; is it another file?",
                hint => hint,
            };
            let problem = format!("the first line names none of the wanted columns{hint}");
            return Err(complaint(Some(head_line), &heads.join(", "), problem));
        }
        let places = heads
            .iter()
            .map(|wanted| {
                known(wanted).ok_or_else(|| {
                    let listed: Vec<String> = found.iter().map(shown_field).collect();
                    let listed = listed.join(", ");
                    let problem = format!("there is no such column; the file has {listed}");
                    complaint(Some(head_line), wanted, problem)
                })
            })
            .collect::<Result<Vec<_>, _>>()?;
        let mut table = Self {
            file: document.file.clone(),
            lines: Vec::new(),
            heads: heads.iter().map(|head| (*head).to_string()).collect(),
            columns: vec![Vec::new(); heads.len()],
        };
        for (line, fields) in rows {
            if fields.len() != found.len() {
                let (count, expected) = (fields.len(), found.len());
                let hint = separator_hint(&fields);
                let problem = format!("{count} fields; the head has {expected}{hint}");
                return Err(complaint(Some(line), "", problem));
            }
            for ((column, &place), head) in table.columns.iter_mut().zip(&places).zip(heads) {
                let value = fields[place].parse::<f64>().map_err(|_| {
                    let found = shown_field(&fields[place]);
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
            let rows = table.lines.len();
            let problem = format!("{rows} rows of numbers; at least 2 are needed");
            return Err(complaint(Some(head_line), "", problem));
        }
        Ok(table)
    }

    /// A column, by its number among the heads that were asked for.
    ///
    /// # Panics
    /// If so many were not asked for.
    #[must_use]
    pub fn column(&self, number: usize) -> &[f64] {
        &self.columns[number]
    }

    /// A complaint about the file as a whole.
    #[must_use]
    pub fn error(&self, problem: impl std::fmt::Display) -> InputError {
        InputError::of_file(&self.file, problem)
    }

    /// A complaint about a value, by the numbers of its row and of its column.
    ///
    /// # Panics
    /// If there is no such row or column.
    #[must_use]
    pub fn error_at(
        &self,
        row: usize,
        number: usize,
        problem: impl std::fmt::Display,
    ) -> InputError {
        InputError {
            file: self.file.clone(),
            line: Some(self.lines[row]),
            key: self.heads[number].clone(),
            problem: problem.to_string(),
        }
    }

    /// Complains unless a column increases from row to row.
    ///
    /// # Errors
    /// [`InputError`] at the first row that does not.
    pub fn require_increasing(&self, number: usize) -> Result<(), InputError> {
        let column = &self.columns[number];
        let Some(row) = column.windows(2).position(|pair| pair[1] <= pair[0]) else {
            return Ok(());
        };
        let problem = format!(
            "found {} after {}; it must increase from row to row",
            column[row + 1],
            column[row]
        );
        Err(self.error_at(row + 1, number, problem))
    }
}
