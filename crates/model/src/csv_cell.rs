//! Texts as cells of a comma separated file.

use std::borrow::Cow;

/// What a spreadsheet takes for the beginning of a formula. A text that begins so gets an apostrophe before it, which
/// spreadsheets hide: a name in a file must not run anything in the program that opens the table.
const BEGINS_FORMULA: [char; 6] = ['=', '+', '-', '@', '\t', '\r'];

/// The text, with an apostrophe before it where a spreadsheet would take it for a formula. Numbers stay as they are.
pub fn no_formula(text: &str) -> Cow<'_, str> {
    if text.starts_with(BEGINS_FORMULA) && text.parse::<f64>().is_err() {
        Cow::Owned(format!("'{text}"))
    } else {
        Cow::Borrowed(text)
    }
}

/// The text that [`no_formula`] has made this one of.
pub fn without_apostrophe(cell: &str) -> &str {
    match cell.strip_prefix('\'') {
        Some(text) if text.starts_with(BEGINS_FORMULA) => text,
        _ => cell,
    }
}

/// A text as a cell: [`no_formula`], in quotes where it holds a comma, quotes or line breaks (RFC 4180, section 2).
pub fn csv_cell(text: &str) -> Cow<'_, str> {
    let text = no_formula(text);
    if text.contains([',', '"', '\n', '\r']) {
        Cow::Owned(format!("\"{}\"", text.replace('"', "\"\"")))
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_become_texts_and_come_back() {
        for text in ["=1+1", "@SUM(A1)", "-x", "+cmd|' /C calc'!A0", "\tx"] {
            assert_eq!(no_formula(text), format!("'{text}"));
            assert_eq!(without_apostrophe(&no_formula(text)), text);
        }
        for text in ["-1.5e-3", "+2", "a=b", "'quoted", ""] {
            assert_eq!(no_formula(text), text);
            assert_eq!(without_apostrophe(text), text);
        }
    }

    #[test]
    fn cells_are_quoted_where_they_must_be() {
        assert_eq!(csv_cell("a,b"), "\"a,b\"");
        assert_eq!(csv_cell("=\"x\""), "\"'=\"\"x\"\"\"");
        assert_eq!(csv_cell("plain"), "plain");
    }
}
