//! The extension module `gearmesh`: built by cargo, copied into `.venv` when it has changed.
//!
//! It follows Python's stable ABI (`abi3`), so one file serves every Python of the lock and needs no packing here.

use std::fs;
use std::path::PathBuf;
use std::process::Command;

use crate::console;
use crate::error::XtaskError;
use crate::steps::{cargo, run_checked};
use crate::venv::Venv;
use crate::workspace::Workspace;

/// Builds the module and installs it. The caller holds the preparation lock.
///
/// # Errors
/// [`XtaskError::Failed`] where the build fails, [`XtaskError::Io`] where the file cannot be copied.
pub fn ensure(workspace: &Workspace, venv: &Venv) -> Result<(), XtaskError> {
    let built = build_dir()?.join("libgearmesh.so");
    if !built.exists() {
        console::say(
            "building the libraries and the Python module; the first build takes about 10 minutes",
        );
    }
    // The whole workspace, not the module's package: cargo unites features over what is named, and libraries built with
    // others would be compiled again by the next step.
    run_checked(cargo(workspace, venv).args(["build", "--workspace", "--lib"]))?;

    let installed = site_packages(venv)?.join("gearmesh.abi3.so");
    let content =
        fs::read(&built).map_err(XtaskError::io(|| format!("reading {}", built.display())))?;
    if fs::read(&installed).is_ok_and(|old| old == content) {
        return Ok(());
    }
    // Written beside and renamed: a Python that has the old file loaded keeps it.
    let beside = installed.with_extension("so.tmp");
    fs::write(&beside, &content)
        .and_then(|()| fs::rename(&beside, &installed))
        .map_err(XtaskError::io(|| {
            format!("writing {}", installed.display())
        }))
}

/// The directory in which cargo put this program and will put the others: same target directory, same profile.
///
/// # Errors
/// [`XtaskError::Io`] where the system does not tell.
pub fn build_dir() -> Result<PathBuf, XtaskError> {
    let mut program =
        std::env::current_exe().map_err(XtaskError::io(|| "finding xtask's own file".into()))?;
    program.pop();
    Ok(program)
}

/// The environment's directory for compiled modules.
fn site_packages(venv: &Venv) -> Result<PathBuf, XtaskError> {
    let output = Command::new(venv.python())
        .args([
            "-I",
            "-c",
            "import sysconfig; print(sysconfig.get_path('platlib'))",
        ])
        .output()
        .map_err(XtaskError::io(|| {
            format!("starting {}", venv.python().display())
        }))?;
    Ok(PathBuf::from(
        String::from_utf8_lossy(&output.stdout).trim(),
    ))
}
