//! Reduced gears that many scenes share: each file is read once.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

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

    /// How many files were read.
    pub fn count(&self) -> usize {
        let read = self.read.lock().unwrap_or_else(PoisonError::into_inner);
        read.len()
    }
}
