//! Errors of the Rust side as Python exceptions.

use std::io::ErrorKind;

use gearmesh_fe::FeError;
use gearmesh_model::FileError;
use pyo3::PyErr;
use pyo3::exceptions::{PyFileNotFoundError, PyMemoryError, PyOSError, PyValueError};

/// `FileNotFoundError` or `OSError` where the system refused, `ValueError` where the content is wrong.
pub(crate) fn file_error(error: FileError) -> PyErr {
    let message = error.to_string();
    match error {
        FileError::Io { source, .. } if source.kind() == ErrorKind::NotFound => {
            PyFileNotFoundError::new_err(message)
        }
        FileError::Io { .. } | FileError::Hdf5 { .. } => PyOSError::new_err(message),
        _ => PyValueError::new_err(message),
    }
}

/// `MemoryError` where the factor does not fit, `ValueError` for all else: the mesh, the material or the supports.
pub(crate) fn fe_error(error: FeError) -> PyErr {
    let message = error.to_string();
    match error {
        FeError::OutOfMemory { .. } => PyMemoryError::new_err(message),
        _ => PyValueError::new_err(message),
    }
}
