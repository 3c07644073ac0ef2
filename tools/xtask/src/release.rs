//! `cargo xtask release`: the wheel, and an archive with the program and what a user of it reads.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};

use crate::console::say;
use crate::error::XtaskError;
use crate::steps::run_checked;
use crate::venv::Venv;
use crate::wheel::{self, Build};
use crate::workspace::Workspace;

/// What goes into the archive as it is.
const FILES: [&str; 7] = [
    "README.md",
    "CHANGELOG.md",
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
/// [`XtaskError::Failed`] where a build or tar fails, [`XtaskError::Io`] where a file cannot be copied.
pub fn release(workspace: &Workspace, venv: &Venv, build: Build) -> Result<ExitCode, XtaskError> {
    wheel::wheel(workspace, venv, build)?;
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
    for part in ["bin", "completions", "man"] {
        let part = folder.join(part);
        fs::create_dir_all(&part).map_err(io("making", &part))?;
    }
    let packed = folder.join("bin/gearmesh");
    fs::copy(&program, &packed).map_err(io("copying", &program))?;
    for file in FILES {
        copy_all(&workspace.root().join(file), &folder.join(file))?;
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
        folder.join("man").as_os_str(),
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

/// Copies a file, or a folder with all that is in it.
fn copy_all(from: &Path, to: &Path) -> Result<(), XtaskError> {
    let failed = || XtaskError::io(|| format!("copying {} to {}", from.display(), to.display()));
    if !from.is_dir() {
        return fs::copy(from, to).map(|_| ()).map_err(failed());
    }
    fs::create_dir_all(to).map_err(failed())?;
    let entries: Vec<PathBuf> = fs::read_dir(from)
        .and_then(|entries| entries.map(|entry| entry.map(|e| e.path())).collect())
        .map_err(failed())?;
    for entry in entries {
        copy_all(&entry, &to.join(entry.file_name().unwrap_or_default()))?;
    }
    Ok(())
}
