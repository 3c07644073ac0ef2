//! Errors of the Rust side as Python exceptions.

use std::io::ErrorKind;

use gearmesh_fe::FeError;
use gearmesh_geometry::InputError as InputComplaint;
use gearmesh_model::FileError;
use gearmesh_operations::{Cause, Failure, Fault};
use gearmesh_report::printable;
use pyo3::exceptions::{
    PyFileNotFoundError, PyKeyboardInterrupt, PyMemoryError, PyOSError, PyRuntimeError,
    PyValueError,
};
use pyo3::prelude::*;

pyo3::create_exception!(
    gearmesh,
    InputError,
    PyValueError,
    "The input is wrong: the message says what was found, where, and what is allowed.\n\nWhere a file or a text is to \
     blame it has the attributes file (str), line (int or None), key (dotted path, str) and problem (str)."
);
pyo3::create_exception!(
    gearmesh,
    WorkError,
    PyRuntimeError,
    "The input was read, the work failed: no equilibrium, no mesh, a file that cannot be written."
);

/// A message as a terminal may show it: names of files are in it. The attributes of an `InputError` have them as they
/// are.
fn shown(error: &dyn std::fmt::Display) -> String {
    printable(&error.to_string()).into_owned()
}

/// An `InputError` with its place as attributes.
pub(crate) fn input_error(complaint: InputComplaint) -> PyErr {
    let error = InputError::new_err(shown(&complaint));
    Python::attach(|py| {
        let value = error.value(py);
        // An exception takes any attribute; were it not so, the message would still say all.
        let _ = value.setattr("file", complaint.file);
        let _ = value.setattr("line", complaint.line);
        let _ = value.setattr("key", complaint.key);
        let _ = value.setattr("problem", complaint.problem);
    });
    error
}

/// `FileNotFoundError` or `OSError` where the system refused, `ValueError` where the content is wrong.
pub(crate) fn file_error(error: FileError) -> PyErr {
    let message = shown(&error);
    match error {
        FileError::Io { source, .. } if source.kind() == ErrorKind::NotFound => {
            PyFileNotFoundError::new_err(message)
        }
        FileError::Io { .. } | FileError::Hdf5 { .. } => PyOSError::new_err(message),
        _ => InputError::new_err(message),
    }
}

/// `MemoryError` where the factor does not fit, `ValueError` for all else: the mesh, the material or the supports.
pub(crate) fn fe_error(error: FeError) -> PyErr {
    let message = shown(&error);
    match error {
        FeError::OutOfMemory { .. } => PyMemoryError::new_err(message),
        _ => PyValueError::new_err(message),
    }
}

/// Of an operation.
pub(crate) fn raised(failure: Failure) -> PyErr {
    let message = shown(&failure);
    match (failure.fault, failure.cause) {
        (Fault::Stopped, _) => PyKeyboardInterrupt::new_err(message),
        (_, Cause::Place(complaint)) => input_error(*complaint),
        (_, Cause::NotFound) => PyFileNotFoundError::new_err(message),
        (_, Cause::System) => PyOSError::new_err(message),
        (_, Cause::Memory) => PyMemoryError::new_err(message),
        (Fault::Input, Cause::Other) => InputError::new_err(message),
        (Fault::Work, Cause::Other) => WorkError::new_err(message),
    }
}
