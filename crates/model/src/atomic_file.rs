//! Writing beside and renaming: a killed run or a full disk leaves the old file or none.

use std::fs::File;
use std::io::Write;
use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};

use crate::file_error::FileError;

/// Writes a text file.
///
/// # Errors
/// [`FileError::NotARegularFile`], [`FileError::Io`]; `path` is then as it was.
pub fn write_text(path: &Path, text: &str) -> Result<(), FileError> {
    write_bytes(path, text.as_bytes())
}

/// Writes a file of bytes.
///
/// # Errors
/// [`FileError::NotARegularFile`], [`FileError::Io`]; `path` is then as it was.
pub fn write_bytes(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    write_atomically(path, |_, file| {
        file.write_all(bytes).map_err(|source| FileError::Io {
            path: path.to_owned(),
            action: "write",
            source,
        })
    })
}

/// Held while a file is being written and renamed.
static WRITING: Mutex<()> = Mutex::new(());

/// Waits until no file is being written, and keeps others from being begun while the guard lives: who wants to end
/// the program from another thread calls this first.
pub fn wait_for_writes() -> MutexGuard<'static, ()> {
    WRITING.lock().unwrap_or_else(PoisonError::into_inner)
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
/// Those of `fill`, [`FileError::NotARegularFile`], [`FileError::Io`].
pub(crate) fn write_atomically(
    path: &Path,
    fill: impl FnOnce(&Path, &mut File) -> Result<(), FileError>,
) -> Result<(), FileError> {
    write_atomically_from(folder_of(path), path, fill)
}

/// [`write_atomically`] with the temporary file in another folder of the same file system: one killed while writing
/// leaves it there.
///
/// # Errors
/// Those of [`write_atomically`].
pub(crate) fn write_atomically_from(
    staging: &Path,
    path: &Path,
    fill: impl FnOnce(&Path, &mut File) -> Result<(), FileError>,
) -> Result<(), FileError> {
    let io = |action| {
        move |source| FileError::Io {
            path: path.to_owned(),
            action,
            source,
        }
    };
    let _held = wait_for_writes();
    // A rename would replace a device such as /dev/null by a file.
    if path.metadata().is_ok_and(|found| !found.is_file()) {
        return Err(FileError::NotARegularFile {
            path: path.to_owned(),
        });
    }
    let mut builder = tempfile::Builder::new();
    builder.prefix(".gearmesh-").suffix(".tmp");
    #[cfg(unix)]
    {
        // The usual rights under the user's umask instead of a temporary file's 0600.
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let mut temporary = builder
        .tempfile_in(staging)
        .map_err(io("create a temporary file for"))?;
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
