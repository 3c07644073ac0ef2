//! The pair file: TOML with units in the keys, checked key by key, in SI units from here on.

mod blank_table;

use std::path::Path;

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::InputDocument;
use schemars::JsonSchema;
use serde::Deserialize;

use crate::blank::PairBlank;
use blank_table::BlankTable;

/// JSON Schema (draft 2020-12) of bevel pair files.
pub fn schema() -> schemars::Schema {
    schemars::schema_for!(BevelFile)
}

/// A bevel pair file.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[schemars(title = "gearmesh bevel pair")]
#[serde(deny_unknown_fields)]
struct BevelFile {
    /// Title in prints.
    title: String,
    /// Teeth and blank.
    bevel: BlankTable,
}

/// What a pair file holds.
#[derive(Debug, Clone, PartialEq)]
pub struct PairFile {
    /// Title in prints.
    pub title: String,
    /// Blank of both members.
    pub blank: PairBlank,
}

impl PairFile {
    /// Whether a document is meant as a bevel pair.
    ///
    /// # Errors
    /// [`InputError`] for a document that is no TOML.
    pub fn recognises(document: &InputDocument) -> Result<bool, InputError> {
        #[derive(Deserialize)]
        struct Marks {
            bevel: Option<serde::de::IgnoredAny>,
        }
        let marks: Marks = document.glance()?;
        Ok(marks.bevel.is_some())
    }

    /// Reads and checks a pair file.
    ///
    /// # Errors
    /// [`InputError`] for an unreadable file, or a key or value that is not allowed.
    pub fn read(path: &Path) -> Result<Self, InputError> {
        Self::from_document(&InputDocument::read(path)?)
    }

    /// Checks a pair file that is already in memory.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn from_document(document: &InputDocument) -> Result<Self, InputError> {
        let file: BevelFile = document.parse()?;
        Ok(Self {
            title: file.title,
            blank: file.bevel.blank(document)?,
        })
    }
}
