//! Reduced gears that many scenes share: each file is read once, and condensed once to the slices of a contact. Models
//! in memory stand there under the names that scenes have for them.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use gearmesh_contact::{ContactError, SliceContact};
use gearmesh_model::{FileError, ReducedGear, file_digest, read_reduced_gear};

/// A model and the digest of its file.
#[derive(Debug, Clone)]
pub struct ShelvedModel {
    /// The model.
    pub model: Arc<ReducedGear>,
    /// Digest of its file, 64 hexadecimal digits; of a model in memory what tells it from others.
    pub digest: String,
}

/// The models that were read so far, by path. Threads may share it.
#[derive(Debug, Default)]
pub struct ModelShelf {
    read: Mutex<BTreeMap<PathBuf, ShelvedModel>>,
    condensed: CondensedPairs,
}

/// Pairs of models condensed to slices, by all that this depends on: microgeometry, load and friction are not among it.
/// Clones share it.
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
    pub(crate) fn of(
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

/// Models that were ever put in memory, which tells them apart.
static KEPT: AtomicU64 = AtomicU64::new(0);

impl ModelShelf {
    /// Puts a model under the name that scenes have for it, joined to their folder, instead of a file's. What reads a
    /// result's models again, such as the recovery of strain, needs them in files.
    pub fn keep(&self, name: impl Into<PathBuf>, model: impl Into<Arc<ReducedGear>>) {
        let number = KEPT.fetch_add(1, Ordering::Relaxed);
        let kept = ShelvedModel {
            model: model.into(),
            digest: format!("model {number} in memory"),
        };
        let mut read = self.read.lock().unwrap_or_else(PoisonError::into_inner);
        read.insert(name.into(), kept);
    }

    /// Whether there is a model under this name, or may be one in a file.
    pub fn knows(&self, path: &Path) -> bool {
        let read = self.read.lock().unwrap_or_else(PoisonError::into_inner);
        read.contains_key(path) || path.exists()
    }

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
    pub(crate) fn condensed(&self) -> CondensedPairs {
        self.condensed.clone()
    }

    /// How many condensed pairs are kept.
    pub fn condensed_count(&self) -> usize {
        self.condensed.count()
    }

    /// How many models are here.
    pub fn count(&self) -> usize {
        let read = self.read.lock().unwrap_or_else(PoisonError::into_inner);
        read.len()
    }
}
