//! The Python environment with gmsh and meshio. Both run as child processes, never inside this program.

use std::io::Write;
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Environment variable that names the Python interpreter.
pub const PYTHON_VARIABLE: &str = "GEARMESH_PYTHON";

/// Processor time that a script is given \[s\]; so that no mesh runs without end. Of the processor,
/// so that a busy machine refuses nothing that a quiet one does.
pub const LIMIT_S: u32 = 600;
/// What ends a process at its limit of processor time.
const SIGXCPU: i32 = 24;

/// Why the Python side did not answer.
#[derive(Debug, thiserror::Error)]
pub enum PythonError {
    /// No interpreter found.
    #[error(
        "no Python environment: no folder above the program {searched} has `.venv/bin/python`, and there is no `python` beside it; beside the unpacked archive run `python3 -m venv .venv` and `.venv/bin/pip install ./gearmesh-*.whl`, in the sources `cargo xtask prepare`, or set {PYTHON_VARIABLE} to a Python that has gmsh and meshio"
    )]
    NotFound {
        /// Where the search began.
        searched: String,
    },
    /// The interpreter could not be started or talked to.
    #[error("cannot run {python}: {cause}")]
    Start {
        /// The interpreter.
        python: String,
        /// What the system said.
        cause: std::io::Error,
    },
    /// The script took too long.
    #[error("{task} did not end within {limit_s} s of processor time")]
    TooLong {
        /// What was being done.
        task: String,
        /// What it is given.
        limit_s: u32,
    },
    /// The script ended with an error.
    #[error("{task} failed in Python:\n{message}")]
    Failed {
        /// What was being done.
        task: String,
        /// Its exit code; none where a signal ended it.
        code: Option<i32>,
        /// The last lines of its error output.
        message: String,
    },
}

/// A Python interpreter that has the project's packages.
#[derive(Debug, Clone)]
pub struct PythonEnvironment {
    interpreter: PathBuf,
}

/// Exit code of a script that cannot make the mesh that it was asked for.
pub(crate) const NO_MESH: i32 = 3;

impl PythonEnvironment {
    /// Finds the interpreter: `GEARMESH_PYTHON`, else the `.venv/bin/python` nearest above the program's own file, else
    /// `python` beside the program, where a wheel has put both.
    ///
    /// Never one in or above the working directory: work in a downloaded folder must not run what that folder brings.
    ///
    /// # Errors
    /// [`PythonError::NotFound`] with the way to make one.
    pub fn find() -> Result<Self, PythonError> {
        if let Some(path) = std::env::var_os(PYTHON_VARIABLE) {
            return Ok(Self {
                interpreter: path.into(),
            });
        }
        let program = std::env::current_exe().unwrap_or_default();
        program
            .ancestors()
            .map(|dir| dir.join(".venv/bin/python"))
            .chain([program.with_file_name("python")])
            .find(|path| path.exists())
            .map(|interpreter| Self { interpreter })
            .ok_or_else(|| PythonError::NotFound {
                searched: program.display().to_string(),
            })
    }

    /// The interpreter at a path.
    #[must_use]
    pub fn at(interpreter: PathBuf) -> Self {
        Self { interpreter }
    }

    /// The interpreter's path.
    pub fn interpreter(&self) -> &Path {
        &self.interpreter
    }

    /// The interpreter, isolated: neither the working folder nor `PYTHONPATH` nor the user's own packages are searched
    /// for modules, so that no file of a downloaded folder runs. All Python children begin with this.
    #[must_use]
    pub fn command(&self) -> Command {
        let mut command = Command::new(&self.interpreter);
        command.arg("-I");
        command
    }

    /// Runs a script text in an isolated interpreter with `input` on its standard input; returns its standard output.
    ///
    /// # Errors
    /// [`PythonError`] when it cannot be started, takes longer than [`LIMIT_S`] or ends with an error; the message
    /// holds the end of its output.
    pub fn run(
        &self,
        task: &str,
        script: &str,
        arguments: &[&str],
        input: &[u8],
    ) -> Result<Vec<u8>, PythonError> {
        let start = |cause| PythonError::Start {
            python: self.interpreter.display().to_string(),
            cause,
        };
        let limited = format!(
            "import resource\nresource.setrlimit(resource.RLIMIT_CPU, ({LIMIT_S}, {LIMIT_S} + 5))\n{script}"
        );
        let mut child = self
            .command()
            .args(["-c", &limited])
            .args(arguments)
            // Threads of the linear algebra that comes with numpy spin, and no script computes with it.
            .env("OPENBLAS_NUM_THREADS", "1")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(start)?;
        // The scripts read all their input before they write, so this cannot block for ever. A child that dies
        // early closes the pipe; its own message, read below, tells why.
        if let Some(mut pipe) = child.stdin.take() {
            let _ = pipe.write_all(input);
        }
        let output = child.wait_with_output().map_err(start)?;
        if output.status.success() {
            return Ok(output.stdout);
        }
        if output.status.signal() == Some(SIGXCPU) {
            return Err(PythonError::TooLong {
                task: task.to_string(),
                limit_s: LIMIT_S,
            });
        }
        let text = String::from_utf8_lossy(&output.stderr);
        let lines: Vec<&str> = text.lines().collect();
        Err(PythonError::Failed {
            task: task.to_string(),
            code: output.status.code(),
            message: lines[lines.len().saturating_sub(8)..].join("\n"),
        })
    }
}
