//! What a document is read into: its values, a structure, or its keys alone.

use std::collections::BTreeSet;

use serde::de::DeserializeOwned;

use super::{InputDocument, InputError, number_ranges, reader, wording};

impl InputDocument {
    /// The values in the present form.
    ///
    /// # Errors
    /// [`InputError`] with the line of a syntax error, or of a number that no processor holds.
    pub fn table(&self) -> Result<toml::Table, InputError> {
        let tree = self.tree().map_err(|e| self.no_toml(&e))?;
        reader::table_of(tree.get_ref()).map_err(|problem| self.refusal(&problem))
    }

    /// Parses the document into a structure whose keys are all checked by serde; every number is finite and within the
    /// [`NumberRange`](super::NumberRange) of its key.
    ///
    /// # Errors
    /// [`InputError`] with the line of a syntax error, or with line and key of an unknown key, a missing key, a wrong
    /// type, an unknown name or a number out of its range. An unknown key that differs from a known one by its unit
    /// only is answered with the right key.
    pub fn parse<T: DeserializeOwned>(&self) -> Result<T, InputError> {
        let table = self.table()?;
        match number_ranges::first_problem(&table) {
            None => self.read_table(table),
            Some((key, problem)) => Err(self.error(&key, problem)),
        }
    }

    /// As [`InputDocument::parse`] without a look at the numbers: for structures that hold some of the keys only.
    ///
    /// # Errors
    /// As [`InputDocument::parse`].
    pub fn glance<T: DeserializeOwned>(&self) -> Result<T, InputError> {
        self.read_table(self.table()?)
    }

    fn read_table<T: DeserializeOwned>(&self, table: toml::Table) -> Result<T, InputError> {
        let read = reader::read(&toml::Value::Table(table));
        read.map_err(|problem| self.refusal(&problem))
    }

    /// The keys at the top: they tell what a document is meant as.
    ///
    /// # Errors
    /// [`InputError`] for a text that is no TOML.
    pub fn top_keys(&self) -> Result<BTreeSet<String>, InputError> {
        Ok(self.table()?.into_iter().map(|(key, _)| key).collect())
    }

    /// A complaint about a text that is no TOML.
    pub(super) fn no_toml(&self, error: &toml::de::Error) -> InputError {
        InputError {
            file: self.file.clone(),
            line: error.span().and_then(|span| self.line_of(span.start)),
            key: String::new(),
            problem: error.message().trim().to_owned(),
        }
    }

    /// A complaint about what serde refuses.
    fn refusal(&self, refusal: &reader::Refusal) -> InputError {
        let path = refusal.path();
        let place = path.join(".");
        let (key, problem) = wording::in_plain_words(path, refusal.message.trim());
        let told = self.error(&key, problem);
        match self.derived_place(&place) {
            Some(_) => told,
            // That of the key itself, also where the complaint names its table; the first of a file that lacks a key.
            None => InputError {
                line: self.locate(&place).or_else(|| self.line_of(0)),
                ..told
            },
        }
    }
}
