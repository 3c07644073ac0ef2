//! The one preparation that `test` and `demo` share.

use std::fs::{self, File};

use crate::console;
use crate::error::XtaskError;
use crate::venv::{Unfinished, Venv};
use crate::workspace::Workspace;
use crate::{machine, python_module, system_libs};

/// Makes whatever is absent or stale and returns the environment. Two runs at once take turns: the second waits and
/// then finds everything made. The lock is the system's, so a killed run leaves none behind.
///
/// # Errors
/// Whatever the parts report: [`machine`], [`crate::venv`], [`system_libs`], [`python_module`].
pub fn prepare(workspace: &Workspace) -> Result<Venv, XtaskError> {
    machine::require_c_compiler()?;
    let python = machine::find_python()?;

    let path = workspace.lock_file();
    let lock = open_lock_file(&path)?;
    if lock.try_lock().is_err() {
        console::say("waiting for another `cargo xtask` to finish its preparation");
        lock.lock()
            .map_err(XtaskError::io(|| format!("locking {}", path.display())))?;
    }
    let (venv, left) = Venv::begin(workspace, &python)?;
    let (finished, built) = std::thread::scope(|scope| {
        let finished = scope.spawn(|| left.map_or(Ok(()), Unfinished::finish));
        let built = python_module::build(workspace, &venv);
        let finished = finished.join();
        (
            finished.unwrap_or_else(|panic| std::panic::resume_unwind(panic)),
            built,
        )
    });
    finished?;
    system_libs::ensure(&venv)?;
    python_module::install(workspace, &venv, &built?)?;
    Ok(venv)
}

fn open_lock_file(path: &std::path::Path) -> Result<File, XtaskError> {
    if let Some(dir) = path.parent() {
        fs::create_dir_all(dir).map_err(XtaskError::io(|| format!("making {}", dir.display())))?;
    }
    File::create(path).map_err(XtaskError::io(|| format!("opening {}", path.display())))
}
