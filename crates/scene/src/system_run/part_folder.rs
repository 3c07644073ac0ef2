//! An unfinished run: a folder beside the result, `RESULT.part`, with the rows so far and the last checkpoint.
//!
//! ```text
//! rows.log        rows of 64-bit floats, appended (RowLog)
//! checkpoint.h5   state of the run and the number of rows that belong to it, replaced atomically
//! *.tmp           the result or a checkpoint, while it is written
//! ```
//!
//! Rows are forced to the disk before the checkpoint that counts them. Whenever the process is killed, the newest whole
//! checkpoint finds its rows; later ones are cut off and computed again, to the same bits. Decision:
//! docs/decisions/0006-unfinished-runs.md.

use std::ffi::OsString;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use gearmesh_model::{DataArray, DataTree, FileError, FileFormat, RowLog};

use super::error::SystemRunError;

const FORMAT: FileFormat = FileFormat {
    name: "gearmesh-checkpoint",
    version: 1,
};

const IDENTITY: &str = "run";
const ROWS: &str = "rows";

/// Digest of these rows.
const DIGEST: &str = "rows_digest";

/// The folder, opened.
pub struct PartFolder {
    folder: PathBuf,
    identity: String,
    log: RowLog,
}

impl PartFolder {
    /// Where the unfinished run of a result is kept.
    pub fn beside(output: &Path) -> PathBuf {
        let mut name = output
            .file_name()
            .map_or_else(OsString::new, OsString::from);
        name.push(".part");
        output.with_file_name(name)
    }

    /// Opens or makes the folder of a run with this identity; gives the checkpoint if there is one to go on from.
    ///
    /// # Errors
    /// [`SystemRunError::OtherRun`], [`SystemRunError::Checkpoint`], [`SystemRunError::Folder`], or a [`FileError`].
    pub fn open(
        output: &Path,
        identity: &str,
        columns: usize,
        restart: bool,
    ) -> Result<(Self, Option<DataTree>), SystemRunError> {
        // Better told now than after the run.
        if output.metadata().is_ok_and(|found| !found.is_file()) {
            let path = output.to_owned();
            return Err(FileError::NotARegularFile { path }.into());
        }
        let folder = Self::beside(output);
        std::fs::create_dir_all(&folder).map_err(failed(&folder, "make the folder"))?;
        let (checkpoint, rows) = (folder.join("checkpoint.h5"), folder.join("rows.log"));
        let make = |log| Self {
            folder: folder.clone(),
            identity: identity.to_owned(),
            log,
        };
        if restart || !checkpoint.exists() {
            let part = make(RowLog::create(&rows, columns)?);
            remove_file(&checkpoint)?;
            return Ok((part, None));
        }
        let damaged = |source| SystemRunError::Checkpoint { source };
        let mut tree = DataTree::read(&checkpoint, &FORMAT).map_err(damaged)?;
        if tree.attributes.get(IDENTITY).map(String::as_str) != Some(identity) {
            return Err(SystemRunError::OtherRun { path: folder });
        }
        let count = tree.take_scalar(&checkpoint, ROWS).map_err(damaged)? as u64;
        let digest = tree.attributes.remove(DIGEST).unwrap_or_default();
        let log = RowLog::resume(&rows, columns, count, &digest).map_err(|error| match error {
            FileError::InUse { .. } => error.into(),
            _ => damaged(error),
        })?;
        Ok((make(log), Some(tree)))
    }

    /// The rows.
    pub fn log(&mut self) -> &mut RowLog {
        &mut self.log
    }

    /// Keeps a state of the run with all rows so far.
    ///
    /// # Errors
    /// [`FileError`].
    pub fn save(&mut self, mut tree: DataTree) -> Result<(), FileError> {
        self.log.sync()?;
        let rows = DataArray::scalar(
            self.log.rows() as f64,
            "1",
            "rows that belong to this state",
        );
        tree.put(ROWS, rows);
        tree.attributes
            .insert(DIGEST.to_owned(), self.log.digest()?);
        tree.attributes
            .insert(IDENTITY.to_owned(), self.identity.clone());
        tree.write(&self.folder.join("checkpoint.h5"), &FORMAT)
    }

    /// Removes the folder: the result is written.
    ///
    /// # Errors
    /// [`SystemRunError::Folder`].
    pub fn finish(self) -> Result<(), SystemRunError> {
        let folder = self.folder.clone();
        drop(self);
        // First, so that a process killed meanwhile leaves no checkpoint without its rows.
        remove_file(&folder.join("checkpoint.h5"))?;
        std::fs::remove_dir_all(&folder).map_err(failed(&folder, "remove the folder"))
    }
}

/// Removes a file if it is there.
fn remove_file(path: &Path) -> Result<(), SystemRunError> {
    match std::fs::remove_file(path) {
        Err(error) if error.kind() != ErrorKind::NotFound => Err(failed(path, "remove")(error)),
        _ => Ok(()),
    }
}

fn failed(
    path: &Path,
    action: &'static str,
) -> impl FnOnce(std::io::Error) -> SystemRunError + use<> {
    let path = path.to_owned();
    move |source| SystemRunError::Folder {
        path,
        action,
        source,
    }
}
