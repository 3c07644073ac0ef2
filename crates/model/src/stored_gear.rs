//! The gear that a model or a result is about: what its gear file said, typed, and that file's text.
//!
//! The text is provenance. Files that hold the typed definition are read without it, so that keys of gear files may be
//! renamed. Only files older than that are read by their text, here and nowhere else.

use std::fmt::Display;

use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{GearDefinition, InputError};

use crate::definition_record::DefinitionParts;
use crate::file_error::FileError;
use crate::record::{Fields, Record};

/// A gear as a file holds it.
#[derive(Debug, Clone, PartialEq)]
pub struct StoredGear {
    /// The gear file, word for word: where the definition comes from.
    pub text: String,
    /// What it says; where that is not known, why.
    definition: Result<GearDefinition, InputError>,
}

impl StoredGear {
    /// The gear of a gear file.
    pub fn new(mut definition: GearDefinition) -> Self {
        // A note for the moment in which the gear is read; files do not hold it.
        definition.mesh.chosen_because = None;
        Self {
            text: definition.source.clone(),
            definition: Ok(definition),
        }
    }

    /// The gear of a file from before definitions were stored: what its text says to this version.
    pub fn of_older_file(text: String) -> Self {
        let document = InputDocument::new("gear file of an older file", text.clone());
        match GearDefinition::from_document(&document) {
            Ok(definition) => Self::new(definition),
            Err(problem) => Self {
                text,
                definition: Err(problem),
            },
        }
    }

    /// A gear of which nothing but a text is known: made up by a program.
    pub fn without_definition(text: String) -> Self {
        let problem = "there is no definition of the gear; reduce the gear again";
        Self {
            text,
            definition: Err(InputError {
                file: String::new(),
                line: None,
                key: String::new(),
                problem: problem.to_owned(),
            }),
        }
    }

    /// The definition; `file` names the file that holds it.
    ///
    /// # Errors
    /// [`InputError`] for an older file whose text this version does not understand, and for a gear without definition.
    pub fn definition_in(&self, file: impl Display) -> Result<&GearDefinition, InputError> {
        self.definition.as_ref().map_err(|problem| InputError {
            file: format!("gear file inside {file}"),
            ..problem.clone()
        })
    }

    /// The definition, where it is known.
    pub fn definition(&self) -> Option<&GearDefinition> {
        self.definition.as_ref().ok()
    }

    /// Visits the text under its name and the definition in its group. Files that are not `typed` have the text only.
    ///
    /// # Errors
    /// [`FileError`] for a part that is missing or means nothing.
    pub fn fields(
        &mut self,
        f: &mut Fields<'_>,
        (text, group): (&str, &str),
        typed: bool,
    ) -> Result<(), FileError> {
        f.text(text, &mut self.text, "the gear file, word for word")?;
        if !typed {
            *self = Self::of_older_file(std::mem::take(&mut self.text));
            return Ok(());
        }
        let mut parts = self.definition().map(DefinitionParts::of);
        f.optional(group, &mut parts, DefinitionParts::fields)?;
        if f.is_reading() {
            let text = std::mem::take(&mut self.text);
            *self = match parts {
                None => Self::without_definition(text),
                Some(parts) => {
                    let definition = parts.into_definition(text);
                    Self::new(definition.map_err(|e| f.contradiction(group, &e.to_string()))?)
                }
            };
        }
        Ok(())
    }
}

impl Default for StoredGear {
    fn default() -> Self {
        Self::without_definition(String::new())
    }
}
