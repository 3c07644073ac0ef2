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
    origins: Arc<BTreeMap<&'static str, (usize, Vec<String>)>>,
}

impl InputDocument {
    /// The document with further items at the ends of its lists. Its text stays.
    ///
    /// # Errors
    /// [`InputError`] for a text that is no TOML.
    pub fn with_derived(self, items: Vec<DerivedTable>) -> Result<Self, InputError> {
        let own: toml::Table = self.glance()?;
        let mut lists: BTreeMap<&'static str, (usize, Vec<String>)> = BTreeMap::new();
        let mut all = toml::Table::new();
        for item in items {
            let count = || {
                let list = own.get(item.list).and_then(toml::Value::as_array);
                list.map_or(0, Vec::len)
            };
            let (_, origins) = lists
                .entry(item.list)
                .or_insert_with(|| (count(), Vec::new()));
            origins.push(item.from);
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

    /// The items that follow from other tables, as a text that could stand in the file; empty without any.
    #[must_use]
    pub fn derived_text(&self) -> &str {
        self.derived.as_ref().map_or("", |derived| &derived.text)
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

    /// The table from which the item at a dotted path follows, where it is not in the text.
    pub(super) fn origin(&self, path: &str) -> Option<&str> {
        let mut parts = path.split('.');
        let (own, origins) = self.origins.get(parts.next()?)?;
        let place: usize = parts.next()?.parse().ok()?;
        origins.get(place.checked_sub(*own)?).map(String::as_str)
    }
}
