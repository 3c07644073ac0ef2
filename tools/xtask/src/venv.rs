//! The Python environment `.venv`, made from the hash-locked requirements and stamped with what it was made from.
//!
//! It is made in two steps, so that cargo need not wait for it: first what C sources are built with, then the rest.
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

/// What C sources are built with.
const BUILD_TOOLS: [&str; 2] = ["cmake", "ninja"];

/// An environment.
#[derive(Debug, Clone)]
pub struct Venv {
    dir: PathBuf,
}

/// What is left to do in an environment.
pub struct Unfinished {
    venv: Venv,
    requirements: PathBuf,
    stamp: String,
}

impl Venv {
    /// Returns `.venv` with what C sources are built with, and what is left to do; none where it is finished. One that
    /// is stale is made anew. The caller holds the preparation lock.
    ///
    /// # Errors
    /// [`XtaskError::Io`] for files that cannot be read or written, [`XtaskError::Failed`] where pip fails.
    pub fn begin(
        workspace: &Workspace,
        python: &BasePython,
    ) -> Result<(Self, Option<Unfinished>), XtaskError> {
        Self::begin_in(workspace.venv_dir(), &workspace.requirements(), python)
    }

    /// A finished environment in another folder, from another lock.
    ///
    /// # Errors
    /// As [`Venv::begin`].
    pub fn in_folder(
        dir: PathBuf,
        requirements: &Path,
        python: &BasePython,
    ) -> Result<Self, XtaskError> {
        let (venv, left) = Self::begin_in(dir, requirements, python)?;
        left.map_or(Ok(()), Unfinished::finish)?;
        Ok(venv)
    }

    fn begin_in(
        dir: PathBuf,
        requirements: &Path,
        python: &BasePython,
    ) -> Result<(Self, Option<Unfinished>), XtaskError> {
        let lock = fs::read_to_string(requirements).map_err(XtaskError::io(|| {
            format!("reading {}", requirements.display())
        }))?;
        let venv = Self { dir };
        let stamp = stamp_of(lock.as_bytes(), &python.version, &venv.dir);
        if venv.is_current(&stamp, &python.version) {
            return Ok((venv, None));
        }
        venv.make(python)?;
        let tools = build_tools(&lock);
        if !tools.is_empty() {
            let path = venv.dir.join("build-tools.txt");
            write(&path, &tools)?;
            venv.install(&path)?;
        }
        let left = Unfinished {
            venv: venv.clone(),
            requirements: requirements.to_owned(),
            stamp,
        };
        Ok((venv, Some(left)))
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

    /// Makes an environment without packages in place of what is there.
    fn make(&self, python: &BasePython) -> Result<(), XtaskError> {
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
        )
    }

    /// Installs what a file lists.
    fn install(&self, requirements: &Path) -> Result<(), XtaskError> {
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
        )
    }
}

impl Unfinished {
    /// Installs all that is missing and stamps the environment.
    ///
    /// # Errors
    /// As [`Venv::begin`].
    pub fn finish(self) -> Result<(), XtaskError> {
        self.venv.install(&self.requirements)?;
        write(
            &self.venv.dir.join(STAMP_NAME),
            &format!("{}\n", self.stamp),
        )
    }
}

fn write(path: &Path, text: &str) -> Result<(), XtaskError> {
    fs::write(path, text).map_err(XtaskError::io(|| format!("writing {}", path.display())))
}

/// The entries of a lock for [`BUILD_TOOLS`]: a line `name==version \`, then its hashes, indented.
fn build_tools(lock: &str) -> String {
    let mut is_tool = false;
    let of_tools = lock.lines().filter(|line| {
        if !line.starts_with([' ', '#']) {
            let name = line.split("==").next().unwrap_or_default();
            is_tool = BUILD_TOOLS.contains(&name);
        }
        is_tool && !line.trim_start().starts_with('#')
    });
    of_tools.map(|line| format!("{line}\n")).collect()
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
    fn the_lock_names_the_tools_that_c_sources_are_built_with() {
        let lock = "cmake-format==1 \\\n    --hash=a\ncmake==2 \\\n    --hash=b \\\n    --hash=c\n    # via x\nnumpy==3 \\\n    --hash=d\n";
        let tools = "cmake==2 \\\n    --hash=b \\\n    --hash=c\n";
        assert_eq!(build_tools(lock), tools);
        let own = include_str!("../../python/requirements.txt");
        for tool in BUILD_TOOLS {
            assert!(build_tools(own).contains(&format!("{tool}==")), "{tool}");
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
