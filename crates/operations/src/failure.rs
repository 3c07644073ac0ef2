//! What an operation ends with when it does not succeed: a message and whose fault it was.

use std::io::ErrorKind;
use std::path::Path;

use gearmesh_fe::FeError;
use gearmesh_geometry::InputError;
use gearmesh_model::FileError;
use gearmesh_reduction::ReductionError;
use gearmesh_scene::RunError;
use gearmesh_scene::study::StudyError;
use gearmesh_scene::system_run::SystemRunError;

/// Said of an operation that was stopped before it wrote anything.
pub(crate) const NOTHING_WRITTEN: &str = "interrupted; nothing is written";

/// Whose fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fault {
    /// The work failed.
    Work,
    /// The input is wrong.
    Input,
    /// No fault: the operation was asked to stop.
    Stopped,
}

/// What is known of the cause beside the message, for doors that tell causes apart.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Cause {
    /// No more than the message says.
    Other,
    /// A place in a file or text.
    Place(Box<InputError>),
    /// A file is not there.
    NotFound,
    /// The system has refused to read or write.
    System,
    /// Something does not fit into the memory.
    Memory,
}

/// What an operation gives.
pub type Result<T, E = Failure> = std::result::Result<T, E>;

/// A failed operation.
#[derive(Debug, Clone, thiserror::Error)]
#[error("{message}")]
pub struct Failure {
    /// Whose fault it was.
    pub fault: Fault,
    /// What to tell the user.
    pub message: String,
    /// What else is known.
    pub cause: Cause,
}

impl Failure {
    /// The input is wrong.
    pub fn input(cause: impl std::fmt::Display) -> Self {
        Self {
            fault: Fault::Input,
            message: cause.to_string(),
            cause: Cause::Other,
        }
    }

    /// The work failed.
    pub fn work(cause: impl std::fmt::Display) -> Self {
        Self {
            fault: Fault::Work,
            message: cause.to_string(),
            cause: Cause::Other,
        }
    }

    /// The operation was asked to stop; `words` say what of its work is kept.
    pub fn stopped(words: impl std::fmt::Display) -> Self {
        Self {
            fault: Fault::Stopped,
            ..Self::work(words)
        }
    }

    /// A file that is read, which is the input's fault.
    pub fn of_input(error: &FileError) -> Self {
        Self {
            cause: Cause::of_file(error),
            ..Self::input(error)
        }
    }

    fn blamed(is_input: bool, error: &dyn std::fmt::Display) -> Self {
        match is_input {
            true => Self::input(error),
            false => Self::work(error),
        }
    }

    /// With the name of the file that it is about, where the message does not have it.
    #[must_use]
    pub fn about(self, file: &Path) -> Self {
        let file = file.display().to_string();
        if self.message.contains(&file) {
            return self;
        }
        Self {
            message: format!("{file}: {}", self.message),
            ..self
        }
    }
}

impl Cause {
    fn of_file(error: &FileError) -> Self {
        match error {
            FileError::Io { source, .. } if source.kind() == ErrorKind::NotFound => Self::NotFound,
            FileError::Io { .. } | FileError::Hdf5 { .. } => Self::System,
            _ => Self::Other,
        }
    }
}

impl From<InputError> for Failure {
    fn from(error: InputError) -> Self {
        Self {
            cause: Cause::Place(Box::new(error.clone())),
            ..Self::input(error)
        }
    }
}

/// Of a file that is being written; see [`Failure::of_input`] for those that are read.
impl From<FileError> for Failure {
    fn from(error: FileError) -> Self {
        Self {
            cause: Cause::of_file(&error),
            ..Self::blamed(matches!(error, FileError::OutputIsALink { .. }), &error)
        }
    }
}

impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        match error {
            RunError::Input(complaint) => complaint.into(),
            RunError::File(error) => Self::of_input(&error),
            RunError::Stopped => Self::stopped(NOTHING_WRITTEN),
            error => Self::blamed(error.is_input(), &error),
        }
    }
}

impl From<SystemRunError> for Failure {
    fn from(error: SystemRunError) -> Self {
        match error {
            SystemRunError::Input(complaint) => complaint.into(),
            SystemRunError::File(error) => Self {
                cause: Cause::of_file(&error),
                ..Self::work(error)
            },
            error => Self::blamed(error.is_input(), &error),
        }
    }
}

impl From<StudyError> for Failure {
    fn from(error: StudyError) -> Self {
        match error {
            StudyError::Input(complaint) => complaint.into(),
            StudyError::Run(error) => error.into(),
            StudyError::Pair(error) => error.into(),
            StudyError::Stopped => Self::stopped(NOTHING_WRITTEN),
            StudyError::File(error) => error.into(),
            StudyError::Folder { .. } => Self {
                cause: Cause::System,
                ..Self::work(error)
            },
            error => Self::blamed(error.is_input(), &error),
        }
    }
}

impl From<ReductionError> for Failure {
    fn from(error: ReductionError) -> Self {
        let cause = match &error {
            ReductionError::Fe(FeError::OutOfMemory { .. }) => Cause::Memory,
            _ => Cause::Other,
        };
        Self {
            cause,
            ..Self::blamed(error.is_input(), &error)
        }
    }
}
