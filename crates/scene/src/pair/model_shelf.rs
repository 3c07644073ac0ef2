//! Reduced gears that many scenes share: each file is read once, and condensed once to the slices of a contact.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use gearmesh_contact::{ContactError, SliceContact};
use gearmesh_model::{FileError, ReducedGear, file_digest, read_reduced_gear};

/// A model and the digest of its file.
#[derive(Debug, Clone)]
pub struct ShelvedModel {
    /// The model.
    pub model: Arc<ReducedGear>,
    /// Digest of its file, 64 hexadecimal digits.
    pub digest: String,
}

/// The models that were read so far, by path. Threads may share it.
#[derive(Debug, Default)]
pub struct ModelShelf {
    read: Mutex<BTreeMap<PathBuf, ShelvedModel>>,
    condensed: CondensedPairs,
}

/// Pairs of models condensed to slices, by all that this depends on: microgeometry, load and friction are not among it. Clones share it.
#[derive(Debug, Clone, Default)]
pub struct CondensedPairs(Arc<Mutex<BTreeMap<String, Condensed>>>);

/// A condensed pair; each waits for its own alone.
type Condensed = Arc<Mutex<Option<Arc<SliceContact>>>>;

/// Condensed pairs that are kept: some megabytes each. What varies the slices themselves would fill the memory.
const MOST_CONDENSED: usize = 32;

impl CondensedPairs {
    /// The pair of this key, which is condensed if it was not before.
    ///
    /// # Errors
    /// Those of `condense`.
    pub(super) fn of(
        &self,
        key: String,
        condense: impl FnOnce() -> Result<SliceContact, ContactError>,
    ) -> Result<SliceContact, ContactError> {
        let place = {
            let mut all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            if all.len() >= MOST_CONDENSED && !all.contains_key(&key) {
                all.clear();
            }
            Arc::clone(all.entry(key).or_default())
        };
        let mut found = place.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = &*found {
            return Ok(SliceContact::clone(known));
        }
        let made = condense()?;
        *found = Some(Arc::new(made.clone()));
        Ok(made)
    }

    /// How many are kept.
    fn count(&self) -> usize {
        let all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        all.len()
    }
}

impl ModelShelf {
    /// The model of a file, which is read if it was not before.
    ///
    /// # Errors
    /// [`FileError`] for a file that is no model.
    pub fn model(&self, path: &Path) -> Result<ShelvedModel, FileError> {
        // Held while the file is read: a second thread that wants it waits and reads nothing.
        let mut read = self.read.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(found) = read.get(path) {
            return Ok(found.clone());
        }
        let found = ShelvedModel {
            digest: file_digest(path)?,
            model: Arc::new(read_reduced_gear(path)?),
        };
        read.insert(path.to_owned(), found.clone());
        Ok(found)
    }

    /// Where contacts of these models find what was condensed before.
    pub(super) fn condensed(&self) -> CondensedPairs {
        self.condensed.clone()
    }

    /// How many condensed pairs are kept.
    pub fn condensed_count(&self) -> usize {
        self.condensed.count()
    }

    /// How many files were read.
    pub fn count(&self) -> usize {
        let read = self.read.lock().unwrap_or_else(PoisonError::into_inner);
        read.len()
    }
}
