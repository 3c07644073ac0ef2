//! The data sets of an HDF5 file as a page of Markdown and as JSON: `gearmesh schema model`.

use std::fmt::Write as _;

use gearmesh_model::ListedField;
use serde_json::{Value, json};

/// Makes the page.
pub fn page(list: &[ListedField], kind: &str) -> String {
    let mut text = format!(
        "# Data sets of {kind} files\n\nMade by `gearmesh schema {kind} --markdown` from the list by which the program writes and reads them. `I` and `NNNN` \
         are numbers from 0. An array names its axes in brackets. Units and meanings stand in the file, too, as attributes.\n\n\
         | Data set | Form | Unit | Meaning |\n| --- | --- | --- | --- |\n"
    );
    for field in list {
        let unit = match field.unit.as_str() {
            "1" => "",
            unit => unit,
        };
        let (name, form, what) = (&field.name, &field.form, &field.description);
        let _ = writeln!(text, "| `{name}` | {form} | {unit} | {what} |");
    }
    text
}

/// The same as a list of objects.
pub fn json(list: &[ListedField]) -> Value {
    let one = |field: &ListedField| {
        json!({
            "name": field.name, "form": field.form, "unit": field.unit, "description": field.description,
        })
    };
    list.iter().map(one).collect()
}
