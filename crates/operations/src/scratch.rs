//! Temporary files and folders, which are gone when their owner is, and when the program is ended.

use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use crate::failure::{Failure, Result};

static ALL: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// A temporary folder that goes with this value.
#[derive(Debug)]
pub struct Scratch(PathBuf);

impl Scratch {
    /// Makes an empty folder.
    ///
    /// # Errors
    /// [`Failure`] where the system refuses it.
    pub fn new() -> Result<Self> {
        let path = tempfile::tempdir().map_err(Failure::work)?.keep();
        let mut all = ALL.lock().unwrap_or_else(PoisonError::into_inner);
        all.push(path.clone());
        Ok(Self(path))
    }

    /// The path.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.0
    }

    /// Removes all that are left, for a program that ends without dropping its values.
    pub fn remove_all() {
        let all = ALL.lock().unwrap_or_else(PoisonError::into_inner);
        all.iter().for_each(|path| remove(path));
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let mut all = ALL.lock().unwrap_or_else(PoisonError::into_inner);
        all.retain(|path| *path != self.0);
        remove(&self.0);
    }
}

/// Removes what is there; what is not there needs no removing.
fn remove(path: &Path) {
    let _ = std::fs::remove_dir_all(path);
}
