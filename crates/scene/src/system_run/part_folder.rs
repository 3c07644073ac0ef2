//! An unfinished run: a folder beside the result, `RESULT.part`, with the rows so far and the last checkpoint.
//!
//! ```text
//! rows.log        rows of 64-bit floats, appended (RowLog)
//! checkpoint.h5   state of the run and the number of rows that belong to it, replaced atomically
//! *.tmp           the result or a checkpoint, while it is written
//! ```
//!
//! Who has rows.log locked owns the folder: the checkpoint is read, written and removed only under the lock. A run that
//! ends removes the files, rows.log last; another that has opened rows.log meanwhile sees that its file has no name any
//! more and begins again.
//!
//! Rows are forced to the disk before the checkpoint that counts them. Whenever the process is killed, the newest whole
//! checkpoint finds its rows; later ones are cut off and computed again, to the same bits. Decision:
//! docs/decisions/0006-unfinished-runs.md.

use std::ffi::OsString;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use gearmesh_model::{
    DataArray, DataTree, FileError, FileFormat, LockedLog, RowLog, demand_output,
};

use super::error::SystemRunError;

const FORMAT: FileFormat = FileFormat {
    name: "gearmesh-checkpoint",
    version: 1,
};

const CHECKPOINT_FILE: &str = "checkpoint.h5";
const ROWS_FILE: &str = "rows.log";

/// How often a folder is made again that others remove meanwhile.
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
        demand_output(output)?;
        if folder.is_symlink() {
            return Err(FileError::OutputIsALink { path: folder }.into());
        }
        let locked = lock(&folder)?;
        let checkpoint = folder.join(CHECKPOINT_FILE);
        let identity = identity.to_owned();
        if restart || !checkpoint.exists() {
            // First, so that a process killed meanwhile leaves no checkpoint without its rows.
            remove_file(&checkpoint)?;
            let log = locked.create(columns)?;
            let part = Self {
                folder,
                identity,
                log,
            };
            part.clear()?;
            return Ok((part, None));
        }
        let damaged = |source| SystemRunError::Checkpoint { source };
        let mut tree = DataTree::read(&checkpoint, &FORMAT).map_err(damaged)?;
        if tree.attributes.get(IDENTITY) != Some(&identity) {
            return Err(SystemRunError::OtherRun { path: folder });
        }
        let count = tree.take_scalar(&checkpoint, ROWS).map_err(damaged)? as u64;
        let digest = tree.attributes.remove(DIGEST).unwrap_or_default();
        let log = locked.resume(columns, count, &digest).map_err(damaged)?;
        let part = Self {
            folder,
            identity,
            log,
        };
        Ok((part, Some(tree)))
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

    /// Removes the folder of a result that is written, where a process was killed between the two; another one that is
    /// about to do so is left alone.
    ///
    /// # Errors
    /// As [`Self::open`] and [`Self::finish`].
    pub fn remove_left(output: &Path) -> Result<(), SystemRunError> {
        if !Self::beside(output).exists() {
            return Ok(());
        }
        match Self::open(output, "", 1, true) {
            Ok((part, _)) => part.finish(),
            Err(SystemRunError::File(FileError::InUse { .. })) => Ok(()),
            Err(error) => Err(error),
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

/// Makes the folder if it is not there, and locks its rows. Runs that end remove both meanwhile.
fn lock(folder: &Path) -> Result<LockedLog, SystemRunError> {
    let rows = folder.join(ROWS_FILE);
    for _ in 0..MOST_ATTEMPTS {
        match std::fs::create_dir_all(folder) {
            // It was there when it was to be made, and was removed before it was looked at.
            Err(error)
                if error.kind() == ErrorKind::AlreadyExists
                    && !folder.metadata().is_ok_and(|found| !found.is_dir()) => {}
            made => made.map_err(failed(folder, "make the folder"))?,
        }
        match LockedLog::open(&rows) {
            Ok(locked) if locked.has_its_name() => return Ok(locked),
            Ok(_) => {}
            Err(FileError::Io { source, .. }) if source.kind() == ErrorKind::NotFound => {}
            Err(error) => return Err(error.into()),
        }
        std::thread::yield_now();
    }
    // Others come and go all the time.
    Err(FileError::InUse { path: rows }.into())
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

    /// Runs that start as others end: each gets the folder for itself or hears that it is in use, and nothing is
    /// left.
    #[test]
    fn runs_that_begin_as_others_end_are_clean() {
        let desk = tempfile::tempdir().unwrap();
        let output = desk.path().join("result.h5");
        let owners = AtomicUsize::new(0);
        let has_run = || match PartFolder::open(&output, "same", 1, false) {
            Ok((mut part, _)) => {
                assert_eq!(owners.fetch_add(1, Ordering::SeqCst), 0, "two owners");
                part.log().append(&[1.0]).unwrap();
                part.save(DataTree::default()).unwrap();
                owners.fetch_sub(1, Ordering::SeqCst);
                part.finish().unwrap();
                true
            }
            Err(SystemRunError::File(FileError::InUse { .. })) => false,
            Err(error) => panic!("{error}"),
        };
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| {
                    for _ in 0..20 {
                        while !has_run() {
                            std::thread::yield_now();
                        }
                    }
                });
            }
        });
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
    fn what_a_process_left_that_was_killed_after_its_result_goes() {
        let desk = tempfile::tempdir().unwrap();
        let output = desk.path().join("result.h5");
        let (mut part, _) = PartFolder::open(&output, "same", 3, false).unwrap();
        part.log().append(&[1.0, 2.0, 3.0]).unwrap();
        PartFolder::remove_left(&output).unwrap();
        assert!(PartFolder::beside(&output).exists(), "it is in use");
        drop(part);
        PartFolder::remove_left(&output).unwrap();
        assert_eq!(std::fs::read_dir(desk.path()).unwrap().count(), 0);
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
