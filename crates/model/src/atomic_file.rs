//! Writing beside and renaming: a killed run or a full disk leaves the old file or none. Outputs are never links: what
//! a link points to is not overwritten.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{BufWriter, Write};
use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::file_error::{FileError, io_error};

/// Writes a text file.
///
/// # Errors
/// [`FileError::NotARegularFile`], [`FileError::OutputIsALink`], [`FileError::Io`]; `path` is then as it was.
pub fn write_text(path: &Path, text: &str) -> Result<(), FileError> {
    write_bytes(path, text.as_bytes())
}

/// Writes a file of bytes.
///
/// # Errors
/// [`FileError::NotARegularFile`], [`FileError::OutputIsALink`], [`FileError::Io`]; `path` is then as it was.
pub fn write_bytes(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    write_atomically(path, |_, file| {
        file.write_all(bytes).map_err(io_error(path, "write"))
    })
}

/// Writes a file part by part, so that it need not be held in memory.
///
/// # Errors
/// Those of `fill`, [`FileError::NotARegularFile`], [`FileError::OutputIsALink`], [`FileError::Io`]; `path` is then as
/// it was.
pub fn write_streamed<E: From<FileError>>(
    path: &Path,
    fill: impl FnOnce(&mut BufWriter<&mut File>) -> Result<(), E>,
) -> Result<(), E> {
    let staging = (folder_of(path), TEMPORARY_SUFFIX);
    write_atomically_from(staging, path, |_, file| {
        let mut out = BufWriter::with_capacity(1 << 20, file);
        fill(&mut out)?;
        Ok(out.flush().map_err(io_error(path, "write"))?)
    })
}

/// What names of temporary files end in, where nothing else is asked for.
pub(crate) const TEMPORARY_SUFFIX: &str = ".tmp";

/// Held while a file is being written and renamed.
static WRITING: Mutex<()> = Mutex::new(());

/// Waits until no file is being written, and keeps others from being begun while the guard lives: who wants to end
/// the program from another thread calls this first.
pub fn wait_for_writes() -> MutexGuard<'static, ()> {
    WRITING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Refuses an output that is there and is no plain file: a link, whose target would be written, a device, a folder.
///
/// # Errors
/// [`FileError::OutputIsALink`], [`FileError::NotARegularFile`].
pub fn demand_output(path: &Path) -> Result<(), FileError> {
    // A rename would replace a device such as /dev/null by a file, and a link by a file beside what it points to.
    match path.symlink_metadata() {
        Ok(found) if found.is_symlink() => Err(FileError::OutputIsALink {
            path: path.to_owned(),
        }),
        Ok(found) if !found.is_file() => Err(FileError::NotARegularFile {
            path: path.to_owned(),
        }),
        _ => Ok(()),
    }
}

/// Opens a file that grows by being appended to, such as a log of rows; makes an empty one where there is none.
///
/// # Errors
/// Those of [`demand_output`], [`FileError::Io`].
pub(crate) fn open_growing(path: &Path) -> Result<File, FileError> {
    demand_output(path)?;
    let mut options = OpenOptions::new();
    let file = options.read(true).write(true).create(true).truncate(false);
    file.open(path).map_err(io_error(path, "open"))
}

/// Folder of a file; the current one for a bare name.
pub(crate) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// Lets `fill` write a temporary file in the folder of `path`, forces it to the disk and gives it its name.
///
/// `fill` gets the temporary file's path and an open handle to it. When it fails, the temporary file is removed and
/// `path` is as it was.
///
/// # Errors
/// Those of `fill`, [`FileError::NotARegularFile`], [`FileError::OutputIsALink`], [`FileError::Io`].
pub(crate) fn write_atomically(
    path: &Path,
    fill: impl FnOnce(&Path, &mut File) -> Result<(), FileError>,
) -> Result<(), FileError> {
    write_atomically_from((folder_of(path), TEMPORARY_SUFFIX), path, fill)
}

/// Lets something else write a file, under a temporary name in the folder of `path` that has the same ending, and gives
/// it its name when it is whole. The temporary file is there already, empty.
///
/// # Errors
/// Those of `fill`, [`FileError::NotARegularFile`], [`FileError::OutputIsALink`], [`FileError::Io`]; `path` is then as
/// it was.
pub fn write_by<E: From<FileError>>(
    path: &Path,
    fill: impl FnOnce(&Path) -> Result<(), E>,
) -> Result<(), E> {
    let ending = path.extension().unwrap_or_default();
    let suffix = format!(".{}", ending.to_string_lossy());
    write_atomically_from((folder_of(path), &suffix), path, |temporary, _| {
        fill(temporary)
    })
}

/// [`write_atomically`] with the temporary file in another folder of the same file system, under a name that ends in
/// `suffix`: one killed while writing leaves it there, until the same file is written again.
///
/// # Errors
/// Those of [`write_atomically`].
pub(crate) fn write_atomically_from<E: From<FileError>>(
    (staging, suffix): (&Path, &str),
    path: &Path,
    fill: impl FnOnce(&Path, &mut File) -> Result<(), E>,
) -> Result<(), E> {
    let io = |action| io_error(path, action);
    let _held = wait_for_writes();
    demand_output(path)?;
    let prefix = temporary_prefix(path);
    remove_abandoned(staging, &prefix, suffix);
    let mut temporary =
        locked_temporary(staging, &prefix, suffix).map_err(io("create a temporary file for"))?;
    let temporary_path = temporary.path().to_owned();
    fill(&temporary_path, temporary.as_file_mut())?;
    temporary
        .as_file()
        .sync_all()
        .map_err(io("force to the disk"))?;
    temporary
        .persist(path)
        .map_err(|failed| failed.error)
        .map_err(io("rename the new file to"))?;
    // The new name is on the disk only when its folder is. Where folders cannot be opened, the rename still holds.
    if let Ok(folder) = File::open(folder_of(path)) {
        folder
            .sync_all()
            .map_err(io("force to the disk the folder of"))?;
    }
    Ok(())
}

/// What names of temporary files begin with: the same for all writes of one file name.
pub(crate) fn temporary_prefix(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default();
    let digest = blake3::hash(name.as_encoded_bytes()).to_hex();
    format!(".gearmesh-{}-", &digest[..16])
}

/// Makes temporary files or folders of these names, with the usual rights under the user's umask instead of 0600
/// and 0700.
pub(crate) fn temporary_builder<'a>(
    prefix: &'a str,
    suffix: &'a str,
    rights: u32,
) -> tempfile::Builder<'a, 'a> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(prefix).suffix(suffix);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(rights));
    }
    #[cfg(not(unix))]
    let _ = rights;
    builder
}

/// A temporary file, locked while it is being written: one without a lock belongs to a process that was killed.
fn locked_temporary(
    staging: &Path,
    prefix: &str,
    suffix: &str,
) -> std::io::Result<tempfile::NamedTempFile> {
    let builder = temporary_builder(prefix, suffix, 0o666);
    loop {
        let temporary = builder.tempfile_in(staging)?;
        // Another process may take it for abandoned before it is locked. Where a file system knows no locks nothing is.
        let taken = match temporary.as_file().try_lock() {
            Ok(()) => !temporary.path().exists(),
            Err(TryLockError::WouldBlock) => true,
            Err(TryLockError::Error(_)) => false,
        };
        if !taken {
            return Ok(temporary);
        }
    }
}

/// Removes what killed writes of the same name have left in a folder: files, and folders with all that is in them.
pub(crate) fn remove_abandoned(folder: &Path, prefix: &str, suffix: &str) {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    for entry in entries {
        #[cfg(test)]
        LOOKS.set(LOOKS.get() + 1);
        let name = entry.file_name();
        let name = name.to_string_lossy();
        if !(name.starts_with(prefix) && name.ends_with(suffix)) {
            continue;
        }
        let is_free = File::open(entry.path()).is_ok_and(|file| file.try_lock().is_ok());
        if is_free {
            let _ = match entry.file_type() {
                Ok(kind) if kind.is_dir() => std::fs::remove_dir_all(entry.path()),
                _ => std::fs::remove_file(entry.path()),
            };
        }
    }
}

#[cfg(test)]
thread_local! {
    /// Entries of folders that were looked at, for tests of the effort.
    pub(crate) static LOOKS: std::cell::Cell<usize> = const { std::cell::Cell::new(0) };
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
pub(crate) mod tests {
    use super::*;

    /// What is in a folder, sorted.
    pub(crate) fn names(folder: &Path) -> Vec<String> {
        let entries = std::fs::read_dir(folder).unwrap();
        let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<String> = names.collect();
        names.sort();
        names
    }

    #[test]
    fn what_a_killed_write_left_goes_with_the_next_one_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let (mine, other) = (folder.path().join("a.txt"), folder.path().join("b.txt"));
        // A killed process keeps its file and loses its lock.
        let left = |path: &Path| {
            let prefix = temporary_prefix(path);
            let file = locked_temporary(folder.path(), &prefix, TEMPORARY_SUFFIX).unwrap();
            file.keep().unwrap().1
        };
        let (abandoned, others) = (left(&mine), left(&other));
        let prefix = temporary_prefix(&mine);
        let at_work = locked_temporary(folder.path(), &prefix, TEMPORARY_SUFFIX).unwrap();
        write_text(&mine, "new").unwrap();
        assert!(!abandoned.exists() && others.exists() && at_work.path().exists());
        drop(at_work);
        write_text(&other, "new").unwrap();
        assert_eq!(names(folder.path()), ["a.txt", "b.txt"]);
    }

    #[cfg(unix)]
    #[test]
    fn nothing_is_written_through_a_link() {
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        std::fs::write(&file, "old").unwrap();
        std::os::unix::fs::symlink(&file, &link).unwrap();
        let refused = write_text(&link, "new");
        assert!(matches!(refused, Err(FileError::OutputIsALink { .. })));
        assert_eq!(std::fs::read(&file).unwrap(), b"old");
        assert_eq!(names(folder.path()), ["file", "link"]);
    }
}
