//! What a request ends with when it does not succeed: the program's own words, and a word that the page acts on.

use axum::Json;
use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};
use gearmesh_geometry::InputError;
use gearmesh_model::FileError;
use gearmesh_scene::RunError;
use serde_json::json;

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
            Self::Stopped => "stopped",
            Self::Forbidden(_) => "forbidden",
            Self::Absent => "absent",
        }
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
            Self::Overtaken | Self::Stopped => StatusCode::CONFLICT,
            Self::Forbidden(_) => StatusCode::FORBIDDEN,
            Self::Absent => StatusCode::NOT_FOUND,
        };
        let body = json!({"kind": self.kind(), "error": self.to_string()});
        (status, Json(body)).into_response()
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

impl From<RunError> for Problem {
    fn from(error: RunError) -> Self {
        match error {
            RunError::Stopped => Self::Stopped,
            error if error.is_input() => Self::Input(error.to_string()),
            error => Self::Work(error.to_string()),
        }
    }
}
