//! The Python package `gearmesh`: its compiled module is built by cargo, it and the Python files are copied into
//! `.venv` where they have changed.
//!
//! The module follows Python's stable ABI (`abi3`), so one file serves every Python of the lock and needs no packing
//! here. `wheel.rs` packs it for others.

use std::ffi::{OsStr, OsString};
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::console;
use crate::error::XtaskError;
use crate::steps::{BUILD, cargo, run_checked};
use crate::venv::Venv;
use crate::workspace::Workspace;

/// Builds the module and all libraries; returns its file. The caller holds the preparation lock.
///
/// # Errors
/// [`XtaskError::Failed`] where the build fails.
pub fn build(workspace: &Workspace, venv: &Venv) -> Result<PathBuf, XtaskError> {
    let built = build_dir()?.join("libgearmesh_native.so");
    if !built.exists() {
        console::say(
            "building the libraries, the Python module and the program; the first build takes about 6 minutes",
        );
    }
    run_checked(cargo(workspace, venv).args(BUILD))?;
    Ok(built)
}

/// Installs the module that was built into the environment. The caller holds the preparation lock.
///
/// # Errors
/// [`XtaskError::Io`] where a file cannot be copied.
pub fn install(workspace: &Workspace, venv: &Venv, built: &Path) -> Result<(), XtaskError> {
    let site = site_packages(venv)?;
    let package = site.join("gearmesh");
    fs::create_dir_all(&package)
        .map_err(XtaskError::io(|| format!("making {}", package.display())))?;
    let mut files = sources(workspace)?;
    files.push((built.to_owned(), OsString::from("_native.abi3.so")));
    for (from, name) in &files {
        replace(from, &package.join(name))?;
    }
    // A file that the package has no more would still be found; so would the module of former times.
    let kept = |name: &OsStr| files.iter().any(|(_, file)| file == name) || name == "__pycache__";
    for entry in entries(&package)? {
        if !kept(&entry.file_name()) {
            remove(&entry.path())?;
        }
    }
    remove(&site.join("gearmesh.abi3.so"))
}

/// The Python files of the package and their names.
fn sources(workspace: &Workspace) -> Result<Vec<(PathBuf, OsString)>, XtaskError> {
    let files = entries(&workspace.python_package())?.into_iter();
    let of_package = |name: &OsStr| {
        let ending = Path::new(name).extension();
        ending.is_some_and(|e| e == "py" || e == "pyi" || e == "typed")
    };
    let files = files.map(|entry| (entry.path(), entry.file_name()));
    Ok(files.filter(|(_, name)| of_package(name)).collect())
}

fn entries(folder: &Path) -> Result<Vec<fs::DirEntry>, XtaskError> {
    fs::read_dir(folder)
        .and_then(Iterator::collect)
        .map_err(XtaskError::io(|| format!("reading {}", folder.display())))
}

/// Copies a file where the other one has not the same content. Written beside and renamed: a Python that has the old
/// file loaded keeps it.
fn replace(from: &Path, to: &Path) -> Result<(), XtaskError> {
    let content =
        fs::read(from).map_err(XtaskError::io(|| format!("reading {}", from.display())))?;
    if fs::read(to).is_ok_and(|old| old == content) {
        return Ok(());
    }
    let beside = to.with_extension("new");
    fs::write(&beside, &content)
        .and_then(|()| fs::rename(&beside, to))
        .map_err(XtaskError::io(|| format!("writing {}", to.display())))
}

/// Removes a file that need not be there.
fn remove(file: &Path) -> Result<(), XtaskError> {
    match fs::remove_file(file) {
        Err(error) if error.kind() != ErrorKind::NotFound => {
            Err(error).map_err(XtaskError::io(|| format!("removing {}", file.display())))
        }
        _ => Ok(()),
    }
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
