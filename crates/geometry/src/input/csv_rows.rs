//! Rows of comma separated text, with their lines.

/// The rows of a table: fields between commas without the blanks around them, quotes as spreadsheet programs write
/// them. Blank lines and lines that begin with `#` are passed over. A row may have any number of fields.
pub struct CsvRows {
    reader: csv::Reader<std::io::Cursor<Vec<u8>>>,
}

impl CsvRows {
    /// The rows of a text.
    pub fn new(text: &str) -> Self {
        // Spreadsheet programs put a byte order mark in front. The reader counts a line where it reads the line feed,
        // so that each row has to end in one, and in nothing else.
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let text = text.replace("\r\n", "\n") + "\n";
        let reader = csv::ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .trim(csv::Trim::All)
            .from_reader(std::io::Cursor::new(text.into_bytes()));
        Self { reader }
    }
}

impl Iterator for CsvRows {
    /// Line from 1, and the fields.
    type Item = (usize, csv::StringRecord);

    fn next(&mut self) -> Option<Self::Item> {
        let mut fields = csv::StringRecord::new();
        // No error is possible: the text is UTF-8 in memory, and rows may be of any length.
        while self.reader.read_record(&mut fields).is_ok_and(|more| more) {
            let first = &fields[0];
            if !(first.starts_with('#') || fields.len() == 1 && first.is_empty()) {
                let line = self.reader.position().line() as usize - 1;
                return Some((line, fields));
            }
        }
        None
    }
}

/// A field as a message shows it: the first characters only, in case the file is no table.
pub fn shown_field(field: &str) -> String {
    const MOST: usize = 24;
    let mut shown: String = field.chars().take(MOST).collect();
    if shown.len() < field.len() {
        shown.push_str("...");
    }
    shown
}

/// What a complaint about a row adds where its fields stand between other signs than commas, as decimal commas go with
/// them; nothing where they do not.
pub fn separator_hint(fields: &csv::StringRecord) -> &'static str {
    let has = |sign: char| fields.iter().any(|field| field.contains(sign));
    if has(';') {
        "; this line has semicolons: fields stand between commas, and the decimal sign is a point"
    } else if has('\t') {
        "; this line has tabs: fields stand between commas, and the decimal sign is a point"
    } else {
        ""
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(text: &str) -> Vec<(usize, Vec<String>)> {
        CsvRows::new(text)
            .map(|(line, row)| (line, row.iter().map(str::to_owned).collect()))
            .collect()
    }

    #[test]
    fn lines_are_counted_over_comments_blank_lines_and_either_line_end() {
        for end in ["\n", "\r\n"] {
            let text = [" a , b", "# note, more", "", "  ", "1,\"2,5\"", "3,4"].join(end);
            let found = rows(&format!("\u{feff}{text}"));
            let fields = |a: &str, b: &str| vec![a.to_owned(), b.to_owned()];
            assert_eq!(
                found,
                [
                    (1, fields("a", "b")),
                    (5, fields("1", "2,5")),
                    (6, fields("3", "4"))
                ],
                "{text:?}"
            );
        }
        assert!(rows("").is_empty() && rows("# x\n\n").is_empty());
    }

    #[test]
    fn a_long_field_is_cut() {
        assert_eq!(shown_field("1.5x"), "1.5x");
        assert_eq!(
            shown_field(&"é".repeat(30)),
            format!("{}...", "é".repeat(24))
        );
    }
}
