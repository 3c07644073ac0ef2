//! `cargo xtask wheel`: the Python package and the program in one wheel, packed by maturin.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::console::say;
use crate::error::XtaskError;
use crate::steps::{cargo, run_checked, set_environment, shown};
use crate::venv::Venv;
use crate::workspace::Workspace;

/// Which build goes into the wheel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Build {
    /// Stripped, with links across crates: what is given to others.
    Release,
    /// The development build, which is there already: to try the wheel out.
    Quick,
}

impl Build {
    fn profile(self) -> &'static str {
        match self {
            Self::Release => "release",
            Self::Quick => "dev",
        }
    }

    /// Where cargo puts what the profile gives, below `target`.
    fn folder(self) -> &'static str {
        match self {
            Self::Release => "release",
            Self::Quick => "debug",
        }
    }
}

/// Builds the program and the wheel around it, into `target/wheel`; the wheel's path.
///
/// # Errors
/// [`XtaskError::Failed`] where a build fails or leaves no wheel, [`XtaskError::Io`] where a file cannot be copied.
pub fn wheel(workspace: &Workspace, venv: &Venv, build: Build) -> Result<PathBuf, XtaskError> {
    let arguments = ["--workspace", "--bin", "gearmesh"];
    let profile = ["--profile", build.profile()];
    run_checked(
        cargo(workspace, venv)
            .arg("build")
            .args(arguments)
            .args(profile),
    )?;
    let target = workspace.root().join("target");
    let out = target.join("wheel");
    // Where cargo has put it.
    let built = std::env::var_os("CARGO_TARGET_DIR").map_or(target, PathBuf::from);
    let program = built.join(build.folder()).join("gearmesh");
    copy(&program, &out.join("gearmesh.data/scripts"))?;
    // Of former builds, which pip would take for this one.
    for former in wheels(&out)? {
        fs::remove_file(&former)
            .map_err(XtaskError::io(|| format!("removing {}", former.display())))?;
    }

    let mut maturin = Command::new(venv.bin_dir().join("maturin"));
    set_environment(&mut maturin, venv);
    maturin
        .current_dir(workspace.root())
        .args(["build", "--manifest-path", "crates/python/Cargo.toml"])
        .args(profile)
        .arg("--out")
        .arg(&out);
    run_checked(&mut maturin)?;
    let [wheel] = &wheels(&out)?[..] else {
        return Err(XtaskError::Failed {
            command: shown(&maturin),
            status: format!("no wheel in {}", out.display()),
        });
    };
    let size = |path: &Path| fs::metadata(path).map_or(0.0, |found| 1e-6 * found.len() as f64);
    say(&format!(
        "the wheel is {}, {:.1} MB; its program has {:.1} MB",
        wheel.display(),
        size(wheel),
        size(&out.join("gearmesh.data/scripts/gearmesh"))
    ));
    Ok(wheel.clone())
}

/// The wheels in a folder.
fn wheels(folder: &Path) -> Result<Vec<PathBuf>, XtaskError> {
    let failed = || XtaskError::io(|| format!("reading {}", folder.display()));
    let entries: Vec<_> = fs::read_dir(folder)
        .and_then(Iterator::collect)
        .map_err(failed())?;
    let paths = entries.iter().map(fs::DirEntry::path);
    Ok(paths
        .filter(|path| path.extension().is_some_and(|ending| ending == "whl"))
        .collect())
}

/// Copies a file into a folder, which is made.
fn copy(file: &Path, folder: &Path) -> Result<(), XtaskError> {
    let to = folder.join(file.file_name().unwrap_or_default());
    fs::create_dir_all(folder)
        .and_then(|()| fs::copy(file, &to).map(|_| ()))
        .map_err(XtaskError::io(|| {
            format!("copying {} to {}", file.display(), to.display())
        }))
}
