//! What can go wrong, as sentences that say what to do.

use std::fmt;
use std::io;
use std::path::PathBuf;

/// Why xtask stopped.
#[derive(Debug)]
pub enum XtaskError {
    /// A program that the machine must have is missing or unsuitable.
    Missing {
        /// What was looked for and what was found instead.
        what: String,
        /// One shell line that installs it.
        install: String,
    },
    /// A child process ran and failed; its own output was shown.
    Failed {
        /// The command as one could type it.
        command: String,
        /// Its exit status in words.
        status: String,
    },
    /// Rust tests failed; what they printed was shown.
    TestsFailed {
        /// Package, program and name of each.
        names: Vec<String>,
    },
    /// `import gmsh` fails for a reason that installing libraries does not mend.
    GmshUnusable {
        /// The last line that Python printed.
        message: String,
    },
    /// A file or process operation failed.
    Io {
        /// What was being done, with the path.
        action: String,
        /// The system's reason.
        source: io::Error,
    },
    /// The workspace's root was not found.
    NoWorkspace {
        /// Where the search began.
        from: PathBuf,
    },
}

impl XtaskError {
    /// Wraps an I/O error: `.map_err(XtaskError::io(|| "…"))`.
    pub fn io<A: FnOnce() -> String>(action: A) -> impl FnOnce(io::Error) -> Self {
        move |source| Self::Io {
            action: action(),
            source,
        }
    }
}

impl fmt::Display for XtaskError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing { what, install } => write!(f, "{what}\nInstall it with:\n  {install}"),
            Self::Failed { command, status } => {
                write!(f, "this command failed ({status}):\n  {command}")
            }
            Self::TestsFailed { names } => {
                write!(f, "{} failed:\n  {}", names.len(), names.join("\n  "))
            }
            Self::GmshUnusable { message } => {
                write!(
                    f,
                    "gmsh cannot be imported in .venv: {message}\nRemove .venv and run the command again."
                )
            }
            Self::Io { action, source } => write!(f, "{action}: {source}"),
            Self::NoWorkspace { from } => write!(
                f,
                "no tools/python/requirements.txt in {} or above; run `cargo xtask` inside the project",
                from.display()
            ),
        }
    }
}

impl std::error::Error for XtaskError {}
