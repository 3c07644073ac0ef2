//! What a command ends with when it does not succeed: a message and whose fault it was.

use std::path::Path;
use std::process::ExitCode;

/// Whose fault.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fault {
    /// The work failed: exit code 1.
    Work,
    /// The input is wrong: exit code 2.
    Input,
}

/// A failed command.
#[derive(Debug, Clone)]
pub struct Failure {
    /// Exit code's reason.
    pub fault: Fault,
    /// What to tell the user.
    pub message: String,
}

impl Failure {
    /// The input is wrong.
    pub fn input(cause: impl std::fmt::Display) -> Self {
        Self {
            fault: Fault::Input,
            message: cause.to_string(),
        }
    }

    /// The work failed.
    pub fn work(cause: impl std::fmt::Display) -> Self {
        Self {
            fault: Fault::Work,
            message: cause.to_string(),
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

    /// 1 or 2.
    pub fn exit_code(&self) -> ExitCode {
        ExitCode::from(match self.fault {
            Fault::Work => 1,
            Fault::Input => 2,
        })
    }
}

impl From<gearmesh_geometry::InputError> for Failure {
    fn from(error: gearmesh_geometry::InputError) -> Self {
        Self::input(error)
    }
}

/// Of a file that is being written; files that are read are the input's fault.
impl From<gearmesh_model::FileError> for Failure {
    fn from(error: gearmesh_model::FileError) -> Self {
        Self::work(error)
    }
}

impl From<gearmesh_scene::RunError> for Failure {
    fn from(error: gearmesh_scene::RunError) -> Self {
        if error.is_input() {
            Self::input(error)
        } else {
            Self::work(error)
        }
    }
}

impl From<gearmesh_scene::system_run::SystemRunError> for Failure {
    fn from(error: gearmesh_scene::system_run::SystemRunError) -> Self {
        if error.is_input() {
            Self::input(error)
        } else {
            Self::work(error)
        }
    }
}

impl From<gearmesh_scene::study::StudyError> for Failure {
    fn from(error: gearmesh_scene::study::StudyError) -> Self {
        if error.is_input() {
            Self::input(error)
        } else {
            Self::work(error)
        }
    }
}

impl From<gearmesh_reduction::ReductionError> for Failure {
    fn from(error: gearmesh_reduction::ReductionError) -> Self {
        if error.is_input() {
            Self::input(error)
        } else {
            Self::work(error)
        }
    }
}
