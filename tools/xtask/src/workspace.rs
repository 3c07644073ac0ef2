//! Where things are in the project.

use std::path::{Path, PathBuf};

use crate::error::XtaskError;

/// The paths that xtask works with.
#[derive(Debug, Clone)]
pub struct Workspace {
    root: PathBuf,
}

impl Workspace {
    /// Finds the project's root: the directory with `tools/python/requirements.txt`, upwards from the package that
    /// cargo runs, else from the working directory.
    ///
    /// # Errors
    /// [`XtaskError::NoWorkspace`] outside the project.
    pub fn find() -> Result<Self, XtaskError> {
        let from = match std::env::var_os("CARGO_MANIFEST_DIR") {
            Some(package) => PathBuf::from(package),
            None => std::env::current_dir()
                .map_err(XtaskError::io(|| "reading the working directory".into()))?,
        };
        let root = from
            .ancestors()
            .find(|dir| dir.join("tools/python/requirements.txt").is_file());
        match root {
            Some(root) => Ok(Self {
                root: root.to_owned(),
            }),
            None => Err(XtaskError::NoWorkspace { from }),
        }
    }

    /// The project's root.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// The hash-locked Python requirements.
    pub fn requirements(&self) -> PathBuf {
        self.root.join("tools/python/requirements.txt")
    }

    /// The Python files of the package `gearmesh`.
    pub fn python_package(&self) -> PathBuf {
        self.root.join("crates/python/gearmesh")
    }

    /// The Python environment.
    pub fn venv_dir(&self) -> PathBuf {
        self.root.join(".venv")
    }

    /// The file whose lock lets one preparation run at a time. Not inside `.venv`, which is removed when stale.
    pub fn lock_file(&self) -> PathBuf {
        self.root.join("target/xtask.lock")
    }
}
