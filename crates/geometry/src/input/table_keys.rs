//! The keys of one table, for complaints about their values.

use std::borrow::Cow;
use std::fmt::Display;

use super::{InputDocument, InputError};

/// A number in a complaint: hundreds of zeros say less than an exponent.
pub(super) fn found_number(value: f64) -> String {
    if value.is_finite() && value != 0.0 && !(1e-9..1e15).contains(&value.abs()) {
        format!("{value:e}")
    } else {
        value.to_string()
    }
}

/// A table of a document.
#[derive(Debug, Clone)]
pub struct TableKeys<'a> {
    document: &'a InputDocument,
    /// Dotted path of the table, empty for the file itself.
    table: Cow<'a, str>,
}

impl<'a> TableKeys<'a> {
    /// The table at a dotted path, items of lists by number: `gauge.0`.
    pub fn new(document: &'a InputDocument, table: impl Into<Cow<'a, str>>) -> Self {
        Self {
            document,
            table: table.into(),
        }
    }

    /// A complaint about the value of `key`; of the table as a whole where `key` is empty.
    pub fn error(&self, key: &str, problem: impl Display) -> InputError {
        let path = match (&*self.table, key) {
            (table, "") => table.to_string(),
            ("", key) => key.to_string(),
            (table, key) => format!("{table}.{key}"),
        };
        self.document.error(&path, problem)
    }

    /// Complains unless `value` is finite and `ok`, that is within the range that `allowed` says.
    ///
    /// # Errors
    /// [`InputError`] with the value and what is allowed.
    pub fn require(
        &self,
        key: &str,
        value: f64,
        ok: bool,
        allowed: &str,
    ) -> Result<(), InputError> {
        if ok && value.is_finite() {
            Ok(())
        } else {
            let found = found_number(value);
            Err(self.error(key, format!("found {found}, allowed is {allowed}")))
        }
    }

    /// `tooth` must be one of so many, counted from 0.
    ///
    /// # Errors
    /// [`InputError`] with the value and what is allowed.
    pub fn require_tooth(&self, tooth: usize, teeth: usize) -> Result<(), InputError> {
        let allowed = format!("0 to {}", teeth - 1);
        self.require("tooth", tooth as f64, tooth < teeth, &allowed)
    }

    /// A key that `needed_by` cannot do without.
    ///
    /// # Errors
    /// [`InputError`] where it is not given.
    pub fn needed<T>(&self, key: &str, value: Option<T>, needed_by: &str) -> Result<T, InputError> {
        value.ok_or_else(|| self.error(key, format!("missing; {needed_by} needs it")))
    }

    /// Complains about keys that are given where they do not belong; see [`given!`](crate::given).
    ///
    /// # Errors
    /// [`InputError`] for the first such key.
    pub fn refuse(&self, given: &[(&str, bool)], problem: impl Display) -> Result<(), InputError> {
        match given.iter().find(|(_, given)| *given) {
            None => Ok(()),
            Some((key, _)) => Err(self.error(key, problem)),
        }
    }

    /// Complains about keys that are given but not used by the chosen kind. Each group of keys with whether they are
    /// given comes with the kinds that use it, between blanks; `word` is the key that chooses the kind, which is empty
    /// where that key is not given.
    ///
    /// # Errors
    /// [`InputError`] for the first such key.
    pub fn refuse_unused(
        &self,
        (word, kind): (&str, &str),
        groups: &[(&[(&str, bool)], &str)],
    ) -> Result<(), InputError> {
        for (given, users) in groups {
            if users.split(' ').all(|user| user != kind) {
                let chosen = match kind {
                    "" => format!("where {word} is not given"),
                    kind => format!("by {word} = \"{kind}\""),
                };
                let others = users.replace(' ', "\", \"");
                let problem = format!("is not used {chosen}, only by \"{others}\"; remove it");
                self.refuse(given, problem)?;
            }
        }
        Ok(())
    }
}
