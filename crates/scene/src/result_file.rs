//! A result file of either kind, told apart by what it says it is.

use std::path::Path;

use gearmesh_model::{FileError, format_of};

use crate::pair::{RESULT_FORMAT, SceneResult};
use crate::system_run::{SYSTEM_RESULT_FORMAT, SystemResult};

/// A result that has been opened.
#[derive(Debug)]
pub enum ResultFile {
    /// Of a gear pair.
    Pair(Box<SceneResult>),
    /// Of a multibody scene.
    System(Box<SystemResult>),
}

impl ResultFile {
    /// Opens a result of either kind.
    ///
    /// # Errors
    /// [`FileError`] as the reader of its kind; [`FileError::WrongFormat`] for a file that is no result.
    pub fn open(path: &Path) -> Result<Self, FileError> {
        let found = format_of(path)?;
        if found == SYSTEM_RESULT_FORMAT.name {
            return Ok(Self::System(Box::new(SystemResult::open(path)?)));
        }
        if found == RESULT_FORMAT.name {
            return Ok(Self::Pair(Box::new(SceneResult::read(path)?)));
        }
        Err(FileError::WrongFormat {
            path: path.to_owned(),
            found,
            expected: "gearmesh-result\" or \"gearmesh-system-result",
        })
    }
}
