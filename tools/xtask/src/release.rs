//! `cargo xtask release`: the wheel, and an archive with it, the program and what a user of both reads.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};

use crate::console::say;
use crate::error::XtaskError;
use crate::steps::{run_checked, shown};
use crate::venv::Venv;
use crate::wheel::{self, Build};
use crate::workspace::Workspace;

/// What goes into the archive as it is, as far as git knows it: results that lie beside stay here.
const FILES: [&str; 10] = [
    "README.md",
    "CHANGELOG.md",
    "CITATION.cff",
    "CONTRIBUTING.md",
    "SECURITY.md",
    "LICENSE-APACHE",
    "LICENSE-MIT",
    "docs",
    "fe_models",
    "reference",
];

/// Completions and their usual names.
const COMPLETIONS: [(&str, &str); 3] = [
    ("bash", "gearmesh.bash"),
    ("zsh", "_gearmesh"),
    ("fish", "gearmesh.fish"),
];

/// Makes wheel and archive in `target/wheel` and `target/archive`.
///
/// # Errors
/// [`XtaskError::Failed`] where a build, git or tar fails, [`XtaskError::Io`] where a file cannot be copied.
pub fn release(workspace: &Workspace, venv: &Venv, build: Build) -> Result<ExitCode, XtaskError> {
    let wheel = wheel::wheel(workspace, venv, build)?;
    let target = workspace.root().join("target");
    // Where the wheel takes it from.
    let program = target.join("wheel/gearmesh.data/scripts/gearmesh");
    let name = format!(
        "gearmesh-{}-{}-{}",
        env!("CARGO_PKG_VERSION"),
        std::env::consts::ARCH,
        std::env::consts::OS
    );
    let archives = target.join("archive");
    let folder = archives.join(&name);
    let io = |action: &str, path: &Path| {
        let text = format!("{action} {}", path.display());
        XtaskError::io(move || text)
    };
    if folder.exists() {
        fs::remove_dir_all(&folder).map_err(io("removing", &folder))?;
    }
    for part in ["bin", "completions", "man/man1"] {
        let part = folder.join(part);
        fs::create_dir_all(&part).map_err(io("making", &part))?;
    }
    let packed = folder.join("bin/gearmesh");
    fs::copy(&program, &packed).map_err(io("copying", &program))?;
    let wheel_name = wheel.file_name().unwrap_or_default();
    fs::copy(&wheel, folder.join(wheel_name)).map_err(io("copying", &wheel))?;
    for file in tracked(workspace)? {
        let (from, to) = (workspace.root().join(&file), folder.join(&file));
        fs::create_dir_all(to.parent().unwrap_or(&folder))
            .and_then(|()| fs::copy(&from, &to))
            .map_err(io("copying", &from))?;
    }
    for (shell, file) in COMPLETIONS {
        let path = folder.join("completions").join(file);
        let out = fs::File::create(&path).map_err(io("writing", &path))?;
        let mut command = Command::new(&packed);
        command
            .args(["completions", shell])
            .stdout(Stdio::from(out));
        run_checked(&mut command)?;
    }
    let mut pages = Command::new(&packed);
    pages.args([
        OsStr::new("man"),
        OsStr::new("-o"),
        folder.join("man/man1").as_os_str(),
    ]);
    run_checked(pages.stdout(Stdio::null()))?;
    let archive = format!("{name}.tar.gz");
    run_checked(
        Command::new("tar")
            .current_dir(&archives)
            .args(["-czf", &archive, &name]),
    )?;
    let size = fs::metadata(&packed).map_err(io("reading", &packed))?.len();
    say(&format!(
        "the archive is {}; its program has {:.1} MB",
        archives.join(archive).display(),
        1e-6 * size as f64
    ));
    Ok(ExitCode::SUCCESS)
}

/// Paths of [`FILES`] that git keeps, from the root.
fn tracked(workspace: &Workspace) -> Result<Vec<PathBuf>, XtaskError> {
    let mut git = Command::new("git");
    git.current_dir(workspace.root())
        .args(["ls-files", "-z", "--"])
        .args(FILES)
        .stderr(Stdio::inherit());
    let listed = git
        .output()
        .map_err(XtaskError::io(|| format!("starting {}", shown(&git))))?;
    let files = paths(&listed.stdout);
    if !listed.status.success() || files.is_empty() {
        return Err(XtaskError::Failed {
            command: shown(&git),
            status: format!("{}, {} files", listed.status, files.len()),
        });
    }
    Ok(files)
}

/// The paths of a list that git has ended with zeros.
fn paths(listed: &[u8]) -> Vec<PathBuf> {
    let names = listed.split(|byte| *byte == 0);
    let names = names.filter(|name| !name.is_empty());
    names
        .map(|name| PathBuf::from(String::from_utf8_lossy(name).into_owned()))
        .collect()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn all_that_is_packed_is_tracked() {
        assert_eq!(
            paths(b"README.md\0docs/a b.md\0"),
            ["README.md", "docs/a b.md"].map(PathBuf::from)
        );
        // Nothing that the archive names is missing in git.
        let files = tracked(&Workspace::find().unwrap()).unwrap();
        for name in FILES {
            assert!(files.iter().any(|file| file.starts_with(name)), "{name}");
        }
    }
}
