//! `cargo xtask docs`: the documentation as one site that opens without a network.

use std::process::{Command, ExitCode};

use crate::error::XtaskError;
use crate::machine;
use crate::steps::{build_program, run_checked};
use crate::venv::Venv;
use crate::workspace::Workspace;

/// Makes the site in `target/docs/site`. What makes it has an environment of its own: tests and demo do not need it.
///
/// # Errors
/// [`XtaskError::Failed`] where the build, pip or the site fails: a link that leads nowhere is among it.
pub fn docs(workspace: &Workspace, venv: &Venv) -> Result<ExitCode, XtaskError> {
    let program = build_program(workspace, venv)?;
    let folder = workspace.root().join("target/docs");
    let tools = workspace.root().join("tools/docs");
    let own = Venv::in_folder(
        folder.join("env"),
        &tools.join("requirements.txt"),
        &machine::find_python()?,
    )?;
    run_checked(
        Command::new(own.python())
            .arg(tools.join("site.py"))
            .arg(program)
            .arg(folder.join("site")),
    )?;
    Ok(ExitCode::SUCCESS)
}
