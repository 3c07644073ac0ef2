//! What a request ends with when it does not succeed: the program's own words, and a word that the page acts on.

use axum::Json;
use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};
use gearmesh_geometry::InputError;
use gearmesh_model::FileError;
use gearmesh_operations::{Failure, Fault};
use serde_json::{Value, json};

/// A request or a start that failed.
#[derive(Debug, thiserror::Error)]
pub enum Problem {
    /// The input is wrong.
    #[error("{0}")]
    Input(String),
    /// The work failed.
    #[error("{0}")]
    Work(String),
    /// A newer request has taken its place.
    #[error("a newer request has taken the place of this one")]
    Overtaken,
    /// Bodies of gears were changed, and are not reduced yet.
    #[error("{0}: the body has changed and is not reduced yet")]
    Unreduced(String),
    /// It was asked to stop.
    #[error("stopped; nothing is kept")]
    Stopped,
    /// It does not come from the page.
    #[error("{0}")]
    Forbidden(&'static str),
    /// There is no such thing.
    #[error("there is nothing at this address")]
    Absent,
}

impl Problem {
    /// The word for the page.
    fn kind(&self) -> &'static str {
        match self {
            Self::Input(_) => "input",
            Self::Work(_) => "work",
            Self::Overtaken => "overtaken",
            Self::Unreduced(_) => "unreduced",
            Self::Stopped => "stopped",
            Self::Forbidden(_) => "forbidden",
            Self::Absent => "absent",
        }
    }

    /// What the page hears.
    pub(crate) fn body(&self) -> Value {
        json!({"kind": self.kind(), "error": self.to_string()})
    }

    /// A file of the studio's own that was not written: the input is not to blame.
    pub(crate) fn not_written(error: FileError) -> Self {
        Self::Work(error.to_string())
    }

    /// Whether the input is to blame.
    #[must_use]
    pub fn is_input(&self) -> bool {
        matches!(self, Self::Input(_))
    }
}

impl IntoResponse for Problem {
    fn into_response(self) -> Response {
        let status = match self {
            Self::Input(_) => StatusCode::UNPROCESSABLE_ENTITY,
            Self::Work(_) => StatusCode::INTERNAL_SERVER_ERROR,
            Self::Overtaken | Self::Unreduced(_) | Self::Stopped => StatusCode::CONFLICT,
            Self::Forbidden(_) => StatusCode::FORBIDDEN,
            Self::Absent => StatusCode::NOT_FOUND,
        };
        (status, Json(self.body())).into_response()
    }
}

impl From<Failure> for Problem {
    fn from(failure: Failure) -> Self {
        match failure.fault {
            Fault::Input => Self::Input(failure.message),
            Fault::Work => Self::Work(failure.message),
            Fault::Stopped => Self::Stopped,
        }
    }
}

impl From<InputError> for Problem {
    fn from(error: InputError) -> Self {
        Self::Input(error.to_string())
    }
}

impl From<FileError> for Problem {
    fn from(error: FileError) -> Self {
        Self::Input(error.to_string())
    }
}
