//! What writing and reading a [`DataTree`](crate::DataTree) as an HDF5 file have in common. The files `data_tree_write`
//! and `data_tree_read` are the only ones that call libhdf5.
//!
//! Arrays are stored contiguous and uncompressed: the low bits of compliance coefficients are close to random and
//! compress badly, reading is one copy, and an uncompressed array can never be larger than its file, so that its size
//! is checked before memory is asked for.
//!
//! libhdf5's file locks are off. A named file never changes, so there is nothing to lock; and a child process that was
//! started while a file was open would hold the lock (libhdf5 opens files without close-on-exec) and keep others out.

use std::path::Path;

use crate::file_error::FileError;

/// Root attributes that the writer sets itself.
pub(crate) const OWN_ATTRIBUTES: [&str; 5] = [
    "format",
    "formatVersion",
    "software",
    "softwareVersion",
    "date",
];

/// Deeper groups are refused: no gearmesh file has them, and HDF5 links may run in circles.
pub(crate) const DEEPEST_GROUP: usize = 8;

pub(crate) fn missing(path: &Path, kind: &str, name: &str) -> FileError {
    FileError::Missing {
        path: path.to_owned(),
        item: format!("{kind} \"{name}\""),
    }
}

pub(crate) fn wrong_type(
    path: &Path,
    name: &str,
    found: &str,
    expected: &'static str,
) -> FileError {
    FileError::WrongType {
        path: path.to_owned(),
        item: format!("\"{name}\""),
        found: found.to_owned(),
        expected,
    }
}

/// libhdf5's error with its innermost reason, which names the system's own (a full disk, no permission).
pub(crate) fn hdf5_error(path: &Path, action: &str) -> impl Fn(hdf5::Error) -> FileError {
    move |error| {
        let innermost = error
            .stack()
            .and_then(|stack| stack.last().map(|frame| frame.desc().to_owned()));
        let reason = innermost.unwrap_or_else(|| error.to_string());
        // "file write failed: time = ..., errno = 28, error message = 'No space left on device', buf = ..."
        let system = reason
            .split("error message = '")
            .nth(1)
            .and_then(|rest| rest.split('\'').next());
        let reason = system.map_or(reason.clone(), str::to_owned);
        FileError::Hdf5 {
            path: path.to_owned(),
            action: action.to_owned(),
            reason,
        }
    }
}
