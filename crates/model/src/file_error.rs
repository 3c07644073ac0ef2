//! What can go wrong with a gearmesh file.

use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::mesh_data::MeshDataError;
use crate::reduced_gear_error::ReducedGearError;

/// The error of an operation on a file that the system refuses, `action` as a verb phrase. Owns the path only when
/// something failed.
pub(crate) fn io_error(
    path: &Path,
    action: &'static str,
) -> impl FnOnce(std::io::Error) -> FileError {
    move |source| FileError::Io {
        path: path.to_owned(),
        action,
        source,
    }
}

/// A file that cannot be written, or that is not what it should be.
#[derive(Debug, Error)]
pub enum FileError {
    /// The operating system refused an operation.
    #[error("cannot {action} {}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What was attempted, as a verb phrase.
        action: &'static str,
        /// The system's reason.
        source: std::io::Error,
    },
    /// libhdf5 refused an operation.
    #[error("cannot {action} {}: {reason}", path.display())]
    Hdf5 {
        /// The file.
        path: PathBuf,
        /// What was attempted, as a verb phrase.
        action: String,
        /// libhdf5's reason.
        reason: String,
    },
    /// The output path names a directory or a device.
    #[error("{} is not a regular file and is left as it is; name another output file", path.display())]
    NotARegularFile {
        /// The output path.
        path: PathBuf,
    },
    /// The input path names a folder, a device or a pipe.
    #[error("{} is no regular file; give a file made by gearmesh", path.display())]
    NotReadable {
        /// The input path.
        path: PathBuf,
    },
    /// The output path is a symbolic link.
    #[error("{} is a symbolic link, and nothing is written through links; name the file itself", path.display())]
    OutputIsALink {
        /// The output path.
        path: PathBuf,
    },
    /// The file does not begin with the seal that every gearmesh file has.
    #[error("{} was not written by gearmesh ({found}); give a file made by gearmesh", path.display())]
    NotAGearmeshFile {
        /// The file.
        path: PathBuf,
        /// What the file looks like.
        found: &'static str,
    },
    /// The file is shorter than its seal says.
    #[error("{} is truncated: {found_bytes} bytes, {} when it was written; make or copy it again",
        path.display(), expected_bytes.map_or("more".to_owned(), |bytes| bytes.to_string()))]
    Truncated {
        /// The file.
        path: PathBuf,
        /// Its length.
        found_bytes: u64,
        /// Its length when written, if the seal itself is still readable.
        expected_bytes: Option<u64>,
    },
    /// The bytes differ from those that were sealed.
    #[error("{} was altered or damaged after it was written ({difference}); make or copy it again", path.display())]
    Altered {
        /// The file.
        path: PathBuf,
        /// What differs.
        difference: String,
    },
    /// The lengths of texts in the file lead nowhere: libhdf5 would read for ever.
    #[error("{} has a table of texts at byte {place} whose lengths do not lead to its end; make the file again", path.display())]
    BrokenTexts {
        /// The file.
        path: PathBuf,
        /// Where the table begins.
        place: u64,
    },
    /// A gearmesh file of another kind.
    #[error("{} is a \"{found}\" file, but a \"{expected}\" file is needed here", path.display())]
    WrongFormat {
        /// The file.
        path: PathBuf,
        /// Its `format` attribute.
        found: String,
        /// The needed one.
        expected: &'static str,
    },
    /// Written by a newer program, or with a version number that never existed.
    #[error("{} has \"{format}\" version {found}, this program reads versions 1 to {newest}; \
        use the program that wrote it or make the file again", path.display())]
    UnknownVersion {
        /// The file.
        path: PathBuf,
        /// Its format.
        format: &'static str,
        /// Its version.
        found: u32,
        /// The newest version this program knows.
        newest: u32,
    },
    /// An array, text or attribute is not there.
    #[error("{} has no {item}; make the file again", path.display())]
    Missing {
        /// The file.
        path: PathBuf,
        /// Kind and name of what is missing.
        item: String,
    },
    /// An array or text has another type than it must have.
    #[error("{item} of {} holds {found}, but {expected} is needed", path.display())]
    WrongType {
        /// The file.
        path: PathBuf,
        /// The array or text.
        item: String,
        /// The stored type.
        found: String,
        /// The needed type.
        expected: &'static str,
    },
    /// A text is none of the names that may stand there.
    #[error("\"{item}\" of {} is \"{found}\"; known are {known}: use the program that wrote it, or make the file again",
        path.display())]
    UnknownName {
        /// The file.
        path: PathBuf,
        /// The text.
        item: String,
        /// What it says.
        found: String,
        /// The names that are known.
        known: String,
    },
    /// Parts of a file that do not go together.
    #[error("\"{item}\" of {}: {problem}; make the file again", path.display())]
    Contradiction {
        /// The file.
        path: PathBuf,
        /// The part.
        item: String,
        /// What is wrong with it.
        problem: String,
    },
    /// An array has other dimensions than it must have.
    #[error("{item} of {} has shape {found:?}, but {expected:?} is needed", path.display())]
    WrongShape {
        /// The file.
        path: PathBuf,
        /// The array.
        item: String,
        /// Its shape.
        found: Vec<usize>,
        /// The needed shape.
        expected: Vec<usize>,
    },
    /// The arrays claim more data than the file holds; nothing was allocated.
    #[error("{item} of {} claims shape {shape:?}, with {before_bytes} bytes claimed before it more than the {file_bytes} bytes \
        of the file; make the file again", path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// The array.
        item: String,
        /// Its shape.
        shape: Vec<usize>,
        /// What the arrays before it claim.
        before_bytes: u64,
        /// The length of the file.
        file_bytes: u64,
    },
    /// A link, or an array whose numbers are not in the file itself.
    #[error("\"{name}\" of {} {how}; gearmesh reads only what is in the file itself: make the file again, or write a copy \
        without links", path.display())]
    StoredElsewhere {
        /// The file.
        path: PathBuf,
        /// The dataset or link.
        name: String,
        /// What it is, as a verb phrase.
        how: &'static str,
    },
    /// A text that says it is UTF-8 and is not.
    #[error("{item} of {} is no UTF-8 text from its byte {byte} on; make the file again", path.display())]
    NotUtf8 {
        /// The file.
        path: PathBuf,
        /// The text or attribute.
        item: String,
        /// The first byte that is wrong, counted from 0.
        byte: usize,
    },
    /// A name that HDF5 or this format cannot hold.
    #[error("\"{name}\" cannot be stored as the name of {item} in {}: {allowed}", path.display())]
    InvalidName {
        /// The file.
        path: PathBuf,
        /// What is to be named.
        item: &'static str,
        /// The name.
        name: String,
        /// What is allowed.
        allowed: &'static str,
    },
    /// An array that is to be written holds something that is no number.
    #[error("entry {index} of `{item}` is not a number: {} was not written", path.display())]
    NotANumber {
        /// The file.
        path: PathBuf,
        /// The array.
        item: String,
        /// Place in it.
        index: usize,
    },
    /// A text that HDF5 cannot hold.
    #[error("the text \"{item}\" of {} contains a NUL character; remove it", path.display())]
    NulInText {
        /// The file.
        path: PathBuf,
        /// The name of the text.
        item: String,
    },
    /// Another process has the log of a run open.
    #[error("{} is in use: another run writes there; wait for it or name another output file", path.display())]
    InUse {
        /// The log.
        path: PathBuf,
    },
    /// The log of a run has fewer rows than its checkpoint counts.
    #[error("{} has {found_bytes} bytes, its checkpoint counts on {expected_bytes}; begin the run anew", path.display())]
    ShortLog {
        /// The log.
        path: PathBuf,
        /// Its length.
        found_bytes: u64,
        /// The length needed.
        expected_bytes: u64,
    },
    /// The arrays are there, but they do not make a reduced gear.
    #[error("{}: {source}", path.display())]
    ReducedGear {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: ReducedGearError,
    },
    /// The arrays are there, but they do not make a mesh.
    #[error("{}: {source}", path.display())]
    Mesh {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: MeshDataError,
    },
}
