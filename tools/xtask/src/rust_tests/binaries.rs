//! The test programs of the workspace, as cargo names them.

use std::io::Read;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use serde_json::Value;

use crate::error::XtaskError;
use crate::steps::shown;

/// A test program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Binary {
    /// Name of its target: the file or folder in `tests/`, or the library or program whose own tests it holds.
    pub name: String,
    /// The package's folder; cargo starts tests there.
    pub folder: PathBuf,
    /// The program.
    pub program: PathBuf,
}

impl Binary {
    /// Package and target.
    pub fn label(&self) -> String {
        let package = self.folder.file_name().unwrap_or_default();
        format!("{} {}", package.to_string_lossy(), self.name)
    }
}

/// Builds the test programs by `build`, a call of `cargo test`. Compiler messages go to the console, the list is read
/// from cargo's JSON lines.
///
/// # Errors
/// [`XtaskError::Failed`] where something does not build, [`XtaskError::Io`] where cargo does not start.
pub fn built(mut build: Command) -> Result<Vec<Binary>, XtaskError> {
    build.args(["--no-run", "--message-format=json-render-diagnostics"]);
    build.stdin(Stdio::null()).stdout(Stdio::piped());
    let command = shown(&build);
    let mut cargo = build
        .spawn()
        .map_err(XtaskError::io(|| format!("starting {command}")))?;
    let mut messages = String::new();
    if let Some(stdout) = &mut cargo.stdout {
        stdout
            .read_to_string(&mut messages)
            .map_err(XtaskError::io(|| format!("reading from {command}")))?;
    }
    let status = cargo
        .wait()
        .map_err(XtaskError::io(|| format!("waiting for {command}")))?;
    if !status.success() {
        let status = status.to_string();
        return Err(XtaskError::Failed { command, status });
    }
    Ok(messages.lines().filter_map(read_message).collect())
}

/// The test program that a message of cargo tells of, if it does.
fn read_message(line: &str) -> Option<Binary> {
    let message: Value = serde_json::from_str(line).ok()?;
    if message["reason"] != "compiler-artifact" || message["profile"]["test"] != true {
        return None;
    }
    let mut folder = PathBuf::from(message["manifest_path"].as_str()?);
    folder.pop();
    Some(Binary {
        name: message["target"]["name"].as_str()?.to_owned(),
        folder,
        program: message["executable"].as_str()?.into(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_test_programs_are_taken_from_cargos_messages() {
        let message = |reason: &str, test: bool, executable: &str| {
            format!(
                r#"{{"reason":"{reason}","manifest_path":"/w/crates/fe/Cargo.toml","target":{{"name":"modes"}},
                "profile":{{"test":{test}}},"executable":{executable}}}"#
            )
        };
        let program = r#""/w/target/modes-1""#;
        let found = read_message(&message("compiler-artifact", true, program));
        let expected = Binary {
            name: "modes".into(),
            folder: "/w/crates/fe".into(),
            program: "/w/target/modes-1".into(),
        };
        assert_eq!(found, Some(expected));
        for other in [
            message("compiler-artifact", false, program),
            message("compiler-artifact", true, "null"),
            message("build-finished", true, program),
            "no JSON".to_owned(),
        ] {
            assert_eq!(read_message(&other), None, "{other}");
        }
    }
}
