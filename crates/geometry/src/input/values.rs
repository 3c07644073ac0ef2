//! Values of a document that never was a text: those of a program, which reads them as it reads a file.

use std::borrow::Cow;
use std::path::Path;

use serde::Serialize;
use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};
use toml::value::Datetime;

use super::{InputDocument, InputError};

/// A value. A number is its digits, which the reader's own values borrow; Rust's are exact.
#[derive(Debug, Clone)]
pub(super) enum Held {
    Text(String),
    Number(String),
    Truth(bool),
    Date(Datetime),
    List(Vec<Held>),
    Table(Vec<(String, Held)>),
}

impl From<toml::Value> for Held {
    fn from(value: toml::Value) -> Self {
        use toml::Value::{Array, Boolean, Datetime, Float, Integer, String, Table};
        match value {
            String(text) => Self::Text(text),
            Integer(_) | Float(_) => Self::Number(value.to_string()),
            Boolean(truth) => Self::Truth(truth),
            Datetime(date) => Self::Date(date),
            Array(items) => Self::List(items.into_iter().map(Self::from).collect()),
            Table(table) => {
                let entries = table.into_iter();
                Self::Table(entries.map(|(key, value)| (key, value.into())).collect())
            }
        }
    }
}

impl Held {
    /// The value as the reader takes it, at no place of a text.
    fn value(&self) -> Result<Spanned<DeValue<'_>>, toml::de::Error> {
        Ok(Spanned::new(
            0..0,
            match self {
                Self::Text(text) => DeValue::String(Cow::Borrowed(text)),
                Self::Number(digits) => return DeValue::parse(digits),
                Self::Truth(truth) => DeValue::Boolean(*truth),
                Self::Date(date) => DeValue::Datetime(*date),
                Self::List(items) => {
                    let mut list = DeArray::new();
                    for item in items {
                        list.push(item.value()?);
                    }
                    DeValue::Array(list)
                }
                Self::Table(entries) => DeValue::Table(table(entries)?),
            },
        ))
    }
}

/// The table of these entries.
pub(super) fn table(entries: &[(String, Held)]) -> Result<DeTable<'_>, toml::de::Error> {
    let mut table = DeTable::new();
    for (key, value) in entries {
        table.insert(Spanned::new(0..0, Cow::Borrowed(&**key)), value.value()?);
    }
    Ok(table)
}

impl InputDocument {
    /// A document without a file, of tables in memory: complaints about it name the path of the key alone. Files that
    /// it names are relative to `folder`. [`InputDocument::text`] is what a file of these tables would be, for results
    /// to keep.
    ///
    /// # Errors
    /// [`InputError`] for what TOML cannot hold.
    pub fn of_values(tables: &impl Serialize, folder: &Path) -> Result<Self, InputError> {
        let refused = |error: toml::ser::Error| Self::new("", "").error("", error);
        let table = toml::Table::try_from(tables).map_err(refused)?;
        let text = toml::to_string(&table).map_err(refused)?;
        let entries = table.into_iter();
        Ok(Self {
            values: Some(entries.map(|(key, value)| (key, value.into())).collect()),
            ..Self::new("", text).in_folder(folder)
        })
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::input::{Bounded, Positive};
    use serde::Deserialize;

    #[derive(Debug, PartialEq, Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Gears {
        gear: Vec<Gear>,
        note: Option<String>,
    }

    #[derive(Debug, PartialEq, Serialize, Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Gear {
        teeth: usize,
        module_mm: Bounded<Positive>,
        ground: bool,
    }

    fn gears(module_mm: f64) -> Gears {
        let gear = |module_mm: f64| Gear {
            teeth: 17,
            module_mm: module_mm.into(),
            ground: true,
        };
        Gears {
            gear: vec![gear(3.0), gear(module_mm)],
            note: None,
        }
    }

    /// Numbers come back to the last digit, and what is out of its range is named by its path.
    #[test]
    fn values_are_read_as_a_file_is() {
        let tables = gears(0.1 + 0.2);
        let document = InputDocument::of_values(&tables, Path::new("")).unwrap();
        assert_eq!(document.parse::<Gears>().unwrap(), tables);
        let text = InputDocument::new("g.toml", &*document.text);
        assert_eq!(text.parse::<Gears>().unwrap(), tables);
        assert!(document.has("gear.1.teeth") && !document.has("note"));

        let document = InputDocument::of_values(&gears(-1.0), Path::new("")).unwrap();
        let problem = document.parse::<Gears>().unwrap_err();
        assert_eq!(
            problem.to_string(),
            "gear.1.module_mm: found -1, allowed is more than 0"
        );
        assert_eq!(document.error("gear.0", "no").line, None);
        let unknown = toml::toml! { colour = 1 };
        let document = InputDocument::of_values(&unknown, Path::new("")).unwrap();
        assert_eq!(
            document.parse::<Gears>().unwrap_err().to_string(),
            "unknown field `colour`, expected `gear` or `note`"
        );
    }
}
