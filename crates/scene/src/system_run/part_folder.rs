//! An unfinished run: a folder beside the result, `RESULT.part`, with the rows so far and the last checkpoint.
//!
//! ```text
//! rows.log        rows of 64-bit floats, appended (RowLog)
//! checkpoint.h5   state of the run and the number of rows that belong to it, replaced atomically
//! *.tmp           the result or a checkpoint, while it is written
//! ```
//!
//! Who has rows.log open and locked owns the folder. A run that ends removes the files while it holds the lock; another
//! that has opened rows.log meanwhile sees that its file has no name any more and begins again.
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

const CHECKPOINT_FILE: &str = "checkpoint.h5";
const ROWS_FILE: &str = "rows.log";

/// How often a folder is opened that others remove meanwhile.
const MOST_ATTEMPTS: usize = 20;

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
        let folder = Self::beside(output);
        // Better told now than after the run.
        for path in [output, &folder] {
            let path = path.to_owned();
            match path.symlink_metadata() {
                Ok(found) if found.is_symlink() => {
                    return Err(FileError::OutputIsALink { path }.into());
                }
                Ok(found) if path == output && !found.is_file() => {
                    return Err(FileError::NotARegularFile { path }.into());
                }
                _ => {}
            }
        }
        let mut attempts = 0;
        loop {
            attempts += 1;
            std::fs::create_dir_all(&folder).map_err(failed(&folder, "make the folder"))?;
            let opened = Self::open_folder(&folder, identity, columns, restart);
            let is_last = attempts == MOST_ATTEMPTS;
            match opened {
                Ok((part, saved)) if part.log.has_its_name() => return Ok((part, saved)),
                Err(error) if !is_gone(&error) || is_last && has_lost_its_rows(&folder) => {
                    return Err(error);
                }
                // Others come and go all the time.
                _ if is_last => {
                    let path = folder.join(ROWS_FILE);
                    return Err(FileError::InUse { path }.into());
                }
                _ => std::thread::yield_now(),
            }
        }
    }

    fn open_folder(
        folder: &Path,
        identity: &str,
        columns: usize,
        restart: bool,
    ) -> Result<(Self, Option<DataTree>), SystemRunError> {
        let (checkpoint, rows) = (folder.join(CHECKPOINT_FILE), folder.join(ROWS_FILE));
        let make = |log| Self {
            folder: folder.to_owned(),
            identity: identity.to_owned(),
            log,
        };
        if restart || !checkpoint.exists() {
            let part = make(RowLog::create(&rows, columns)?);
            if part.log.has_its_name() {
                remove_file(&checkpoint)?;
                part.clear()?;
            }
            return Ok((part, None));
        }
        let damaged = |source| SystemRunError::Checkpoint { source };
        let mut tree = DataTree::read(&checkpoint, &FORMAT).map_err(damaged)?;
        if tree.attributes.get(IDENTITY).map(String::as_str) != Some(identity) {
            let path = folder.to_owned();
            return Err(SystemRunError::OtherRun { path });
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
        tree.write(&self.folder.join(CHECKPOINT_FILE), &FORMAT)
    }

    /// Removes the folder: the result is written.
    ///
    /// # Errors
    /// [`SystemRunError::Folder`].
    pub fn finish(self) -> Result<(), SystemRunError> {
        // First, so that a process killed meanwhile leaves no checkpoint without its rows.
        remove_file(&self.folder.join(CHECKPOINT_FILE))?;
        self.clear()?;
        // Still locked: who opens it now waits for nobody and finds it gone.
        remove_file(&self.folder.join(ROWS_FILE))?;
        match std::fs::remove_dir(&self.folder) {
            // The next run has begun already, or something else was put there.
            Err(error)
                if !matches!(
                    error.kind(),
                    ErrorKind::DirectoryNotEmpty | ErrorKind::NotFound
                ) =>
            {
                Err(failed(&self.folder, "remove the folder")(error))
            }
            _ => Ok(()),
        }
    }

    /// Removes what a killed write has left in the folder; nobody else writes there.
    fn clear(&self) -> Result<(), SystemRunError> {
        let entries = std::fs::read_dir(&self.folder);
        let entries = entries.map_err(failed(&self.folder, "list the folder"))?;
        for entry in entries.flatten() {
            let path = entry.path();
            if path.extension().is_some_and(|ending| ending == "tmp") {
                remove_file(&path)?;
            }
        }
        Ok(())
    }
}

/// Whether a file of the folder was removed while it was being opened.
fn is_gone(error: &SystemRunError) -> bool {
    match error {
        SystemRunError::File(FileError::Io { source, .. })
        | SystemRunError::Checkpoint {
            source: FileError::Io { source, .. },
        } => source.kind() == ErrorKind::NotFound,
        _ => false,
    }
}

/// A run that ends removes its checkpoint before its rows: one without rows was left by somebody else.
fn has_lost_its_rows(folder: &Path) -> bool {
    folder.join(CHECKPOINT_FILE).exists() && !folder.join(ROWS_FILE).exists()
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

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    /// Runs that start as others end: each gets the folder for itself or is told that it is in use, and nothing is
    /// left.
    #[test]
    fn runs_that_begin_as_others_end_are_clean() {
        let desk = tempfile::tempdir().unwrap();
        let output = desk.path().join("result.h5");
        let (owners, finished) = (AtomicUsize::new(0), AtomicUsize::new(0));
        let one_run = || match PartFolder::open(&output, "same", 1, false) {
            Ok((mut part, _)) => {
                assert_eq!(owners.fetch_add(1, Ordering::SeqCst), 0, "two owners");
                part.log().append(&[1.0]).unwrap();
                part.save(DataTree::default()).unwrap();
                owners.fetch_sub(1, Ordering::SeqCst);
                part.finish().unwrap();
                finished.fetch_add(1, Ordering::SeqCst);
            }
            Err(SystemRunError::File(FileError::InUse { .. })) => {}
            Err(error) => panic!("{error}"),
        };
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| (0..40).for_each(|_| one_run()));
            }
        });
        assert!(finished.load(Ordering::SeqCst) >= 40);
        assert_eq!(std::fs::read_dir(desk.path()).unwrap().count(), 0);
    }

    #[test]
    fn a_checkpoint_without_rows_is_told() {
        let desk = tempfile::tempdir().unwrap();
        let output = desk.path().join("result.h5");
        let (mut part, _) = PartFolder::open(&output, "same", 1, false).unwrap();
        part.log().append(&[1.0]).unwrap();
        part.save(DataTree::default()).unwrap();
        drop(part);
        std::fs::remove_file(PartFolder::beside(&output).join(ROWS_FILE)).unwrap();
        let error = PartFolder::open(&output, "same", 1, false).err().unwrap();
        assert!(
            matches!(error, SystemRunError::Checkpoint { .. }),
            "{error}"
        );
    }

    #[test]
    fn what_a_killed_write_left_goes() {
        let desk = tempfile::tempdir().unwrap();
        let output = desk.path().join("result.h5");
        let folder = PartFolder::beside(&output);
        std::fs::create_dir(&folder).unwrap();
        std::fs::write(folder.join(".gearmesh-x.tmp"), "half").unwrap();
        let (part, _) = PartFolder::open(&output, "same", 1, false).unwrap();
        assert!(!folder.join(".gearmesh-x.tmp").exists());
        std::fs::write(folder.join("notes.txt"), "mine").unwrap();
        part.finish().unwrap();
        let left: Vec<_> = std::fs::read_dir(&folder).unwrap().collect();
        assert_eq!(left.len(), 1, "what is not gearmesh's stays");
    }

    #[cfg(unix)]
    #[test]
    fn a_folder_behind_a_link_is_refused() {
        let (desk, other) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        let output = desk.path().join("result.h5");
        std::os::unix::fs::symlink(other.path(), PartFolder::beside(&output)).unwrap();
        let refused = PartFolder::open(&output, "same", 1, false);
        assert!(matches!(
            refused.err(),
            Some(SystemRunError::File(FileError::OutputIsALink { .. }))
        ));
        assert_eq!(std::fs::read_dir(other.path()).unwrap().count(), 0);
    }
}
