//! The Python environment `.venv`, made from the hash-locked requirements and stamped with what it was made from.
//!
//! The stamp is written last. An environment without it, or with another one, is stale: half made by a killed run,
//! made from an older lock or by another Python, or moved (its scripts name their interpreter by absolute path).
//! A stale environment is removed and made again.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use sha2::{Digest, Sha256};

use crate::console;
use crate::error::XtaskError;
use crate::machine::{self, BasePython};
use crate::steps::run_checked;
use crate::workspace::Workspace;

const STAMP_NAME: &str = ".gearmesh-stamp";

/// A finished environment.
#[derive(Debug, Clone)]
pub struct Venv {
    dir: PathBuf,
}

impl Venv {
    /// Returns `.venv`, making it first where it is absent or stale. The caller holds the preparation lock.
    ///
    /// # Errors
    /// [`XtaskError::Io`] for files that cannot be read or written, [`XtaskError::Failed`] where pip fails.
    pub fn ensure(workspace: &Workspace, python: &BasePython) -> Result<Self, XtaskError> {
        Self::in_folder(workspace.venv_dir(), &workspace.requirements(), python)
    }

    /// The same of an environment in another folder, from another lock.
    ///
    /// # Errors
    /// As [`Venv::ensure`].
    pub fn in_folder(
        dir: PathBuf,
        requirements: &Path,
        python: &BasePython,
    ) -> Result<Self, XtaskError> {
        let lock = fs::read(requirements).map_err(XtaskError::io(|| {
            format!("reading {}", requirements.display())
        }))?;
        let venv = Self { dir };
        let stamp = stamp_of(&lock, &python.version, &venv.dir);
        if venv.is_current(&stamp, &python.version) {
            return Ok(venv);
        }
        venv.make(requirements, python, &stamp)?;
        Ok(venv)
    }

    /// An environment in a folder, as it is.
    #[cfg(test)]
    pub fn at(dir: PathBuf) -> Self {
        Self { dir }
    }

    /// The environment's interpreter.
    pub fn python(&self) -> PathBuf {
        self.dir.join("bin/python")
    }

    /// Where its programs are; cmake is one of them.
    pub fn bin_dir(&self) -> PathBuf {
        self.dir.join("bin")
    }

    /// Current means: the stamp agrees and the interpreter behind the links still exists in that version.
    fn is_current(&self, stamp: &str, version: &str) -> bool {
        let written = fs::read_to_string(self.dir.join(STAMP_NAME)).unwrap_or_default();
        written.trim() == stamp && machine::version_of(&self.python()).as_deref() == Some(version)
    }

    fn make(
        &self,
        requirements: &Path,
        python: &BasePython,
        stamp: &str,
    ) -> Result<(), XtaskError> {
        console::say(&format!(
            "making {} with Python {} (.venv downloads about 200 MB)",
            self.dir.display(),
            python.version
        ));
        if self.dir.symlink_metadata().is_ok() {
            fs::remove_dir_all(&self.dir).map_err(XtaskError::io(|| {
                format!("removing the stale {}", self.dir.display())
            }))?;
        }
        run_checked(
            Command::new(&python.program)
                .args(["-m", "venv"])
                .arg(&self.dir),
        )?;
        run_checked(
            Command::new(self.python())
                .args([
                    "-m",
                    "pip",
                    "install",
                    "--quiet",
                    "--no-input",
                    "--disable-pip-version-check",
                    // Python compiles what is imported, a small part of it.
                    "--no-compile",
                ])
                // Wheels only: a source build would need tools that nobody asked for.
                .args(["--require-hashes", "--only-binary=:all:", "-r"])
                .arg(requirements),
        )?;
        let stamp_path = self.dir.join(STAMP_NAME);
        fs::write(&stamp_path, format!("{stamp}\n")).map_err(XtaskError::io(|| {
            format!("writing {}", stamp_path.display())
        }))
    }
}

/// SHA-256 over the lock's content, the Python version and the environment's place, in hexadecimal.
///
/// Each part is preceded by its length, so that no two different triples give the same bytes.
fn stamp_of(lock: &[u8], python_version: &str, dir: &Path) -> String {
    let mut hasher = Sha256::new();
    for part in [
        lock,
        python_version.as_bytes(),
        dir.as_os_str().as_encoded_bytes(),
    ] {
        hasher.update((part.len() as u64).to_le_bytes());
        hasher.update(part);
    }
    hasher
        .finalize()
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use std::os::unix::fs::symlink;

    #[test]
    fn the_stamp_depends_on_every_part() {
        let stamp = stamp_of(b"numpy==1", "3.11.7", Path::new("/a/.venv"));
        assert_eq!(
            stamp,
            stamp_of(b"numpy==1", "3.11.7", Path::new("/a/.venv"))
        );
        assert_eq!(stamp.len(), 64);
        let others = [
            stamp_of(b"numpy==2", "3.11.7", Path::new("/a/.venv")),
            stamp_of(b"numpy==1", "3.12.1", Path::new("/a/.venv")),
            stamp_of(b"numpy==1", "3.11.7", Path::new("/b/.venv")),
            stamp_of(b"numpy==13", ".11.7", Path::new("/a/.venv")),
        ];
        for other in others {
            assert_ne!(stamp, other);
        }
    }

    #[test]
    fn an_environment_is_current_only_with_its_stamp_and_a_living_interpreter() {
        let python = machine::find_python().unwrap();
        let version = python.version.as_str();
        let dir = std::env::temp_dir().join(format!("gearmesh-xtask-{}", std::process::id()));
        fs::create_dir_all(dir.join("bin")).unwrap();
        let venv = Venv { dir: dir.clone() };
        let stamp = stamp_of(b"lock", version, &dir);

        let printed = Command::new(&python.program)
            .args(["-c", "import sys; print(sys.executable)"])
            .output()
            .unwrap();
        let interpreter = String::from_utf8(printed.stdout).unwrap();
        symlink(interpreter.trim(), venv.python()).unwrap();
        assert!(!venv.is_current(&stamp, version), "no stamp: half made");

        fs::write(dir.join(STAMP_NAME), format!("{stamp}\n")).unwrap();
        assert!(venv.is_current(&stamp, version));
        assert!(
            !venv.is_current(&stamp_of(b"newer lock", version, &dir), version),
            "the lock has changed"
        );
        assert!(
            !venv.is_current(&stamp, "3.0.0"),
            "the interpreter is another version"
        );

        fs::remove_file(venv.python()).unwrap();
        symlink(dir.join("removed-python"), venv.python()).unwrap();
        assert!(!venv.is_current(&stamp, version), "the interpreter is gone");
        fs::remove_dir_all(&dir).unwrap();
    }
}
