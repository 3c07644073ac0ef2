//! Items of lists that are not in the text but follow from a table of it, as the bodies of a planetary set do: they are
//! read like the text, and complaints about them point at the table that they follow from.

use std::collections::BTreeMap;
use std::sync::Arc;

use toml::de::{DeTable, DeValue};

use super::{InputDocument, InputError};

/// An item of a list of tables, and the table that it follows from.
#[derive(Debug, Clone, PartialEq)]
pub struct DerivedTable {
    /// The list: `body`.
    pub list: &'static str,
    /// The item.
    pub table: toml::Table,
    /// Dotted path of the table from which it follows: `planetary.0`.
    pub from: String,
}

/// All of a document.
#[derive(Debug, Clone)]
pub(super) struct DerivedTables {
    /// The items as a text of their own.
    text: Arc<str>,
    /// For each list the number of items that the document's text has, and where the further ones come from.
    origins: Arc<Origins>,
}

/// By the list: number of items in the document's text, and origin and name of each further one.
type Origins = BTreeMap<&'static str, (usize, Vec<(String, String)>)>;

/// A place in an item that is not in the text.
pub(super) struct Derived<'a> {
    /// Dotted path of the table from which the item follows.
    pub from: &'a str,
    /// The place in words: "mass_kg of [[body]] `set carrier`".
    pub place: String,
}

impl InputDocument {
    /// The document with further items at the ends of its lists. Its text stays.
    ///
    /// # Errors
    /// [`InputError`] for a text that is no TOML.
    pub fn with_derived(self, items: Vec<DerivedTable>) -> Result<Self, InputError> {
        let own = self.table()?;
        let mut lists = Origins::new();
        let mut all = toml::Table::new();
        for item in items {
            let count = || {
                let list = own.get(item.list).and_then(toml::Value::as_array);
                list.map_or(0, Vec::len)
            };
            let (_, origins) = lists
                .entry(item.list)
                .or_insert_with(|| (count(), Vec::new()));
            let name = item.table.get("name").and_then(toml::Value::as_str);
            origins.push((item.from, name.unwrap_or_default().to_owned()));
            let list = all.entry(item.list);
            let list = list.or_insert_with(|| toml::Value::Array(Vec::new()));
            if let toml::Value::Array(list) = list {
                list.push(toml::Value::Table(item.table));
            }
        }
        let derived = DerivedTables {
            text: all.to_string().into(),
            origins: Arc::new(lists),
        };
        Ok(Self {
            derived: Some(derived),
            ..self
        })
    }
}

impl DerivedTables {
    /// Appends the items to the lists of a document.
    pub(super) fn append_to<'a>(&'a self, tree: &mut DeTable<'a>) -> Result<(), toml::de::Error> {
        for (list, items) in DeTable::parse(&self.text)?.into_inner() {
            match (tree.get_mut(list.get_ref().as_ref()), items) {
                (None, items) => {
                    tree.insert(list, items);
                }
                (Some(own), items) => {
                    if let (DeValue::Array(own), DeValue::Array(items)) =
                        (own.get_mut(), items.into_inner())
                    {
                        items.into_iter().for_each(|item| own.push(item));
                    }
                }
            }
        }
        Ok(())
    }

    /// Where a dotted path leads, if that is not in the text.
    pub(super) fn place(&self, path: &str) -> Option<Derived<'_>> {
        let mut parts = path.splitn(3, '.');
        let list = parts.next()?;
        let (own, origins) = self.origins.get(list)?;
        let place: usize = parts.next()?.parse().ok()?;
        let (from, name) = origins.get(place.checked_sub(*own)?)?;
        let item = format!("[[{list}]] `{name}`");
        let place = parts
            .next()
            .map_or_else(|| item.clone(), |key| format!("{key} of {item}"));
        Some(Derived { from, place })
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    /// Items that follow from a table are read behind those of the text; a complaint about one stands at the line of
    /// that table.
    #[test]
    fn complaints_about_derived_items_point_at_their_origin() {
        let text = "[[set]]\nname = 'x'\n[[body]]\nname = 'a'\n";
        let item = |list| DerivedTable {
            list,
            table: "name = 'x b'\nmass_kg = 2.0".parse().unwrap(),
            from: "set.0".to_owned(),
        };
        let document = InputDocument::new("s.toml", text);
        let document = document
            .with_derived(vec![item("body"), item("joint")])
            .unwrap();
        let read = document.table().unwrap();
        let names = |list: &str| -> Vec<String> {
            let items = read[list].as_array().unwrap().iter();
            items
                .map(|item| item["name"].as_str().unwrap().to_owned())
                .collect()
        };
        assert_eq!(names("body"), ["a", "x b"]);
        assert_eq!(names("joint"), ["x b"]);
        assert_eq!(document.text, text);
        for (key, expected) in [
            (
                "body.1.mass_kg",
                "s.toml:1: set.0: in mass_kg of [[body]] `x b`, which follows from it: no",
            ),
            (
                "joint.0",
                "s.toml:1: set.0: in [[joint]] `x b`, which follows from it: no",
            ),
            ("body.0.name", "s.toml:4: body.0.name: no"),
        ] {
            assert_eq!(document.error(key, "no").to_string(), expected);
        }
    }
}
