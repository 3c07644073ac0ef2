//! What comes from the system: the shared libraries that gmsh's wheel links to and does not bring (OpenGL and X11, even
//! without a window), CalculiX for the tests that compute with exported decks, Chromium for those of pages.

use std::process::{Command, Stdio};

use crate::console;
use crate::error::XtaskError;
use crate::steps::run_checked;
use crate::venv::Venv;

/// Debian's and Ubuntu's packages with the libraries that `import gmsh` loads.
const PACKAGES: [&str; 6] = [
    "libglu1-mesa",
    "libgl1",
    "libxcursor1",
    "libxft2",
    "libxinerama1",
    "libgomp1",
];

/// Makes sure that gmsh can be imported: installs its libraries as root, else names the line that does.
///
/// # Errors
/// [`XtaskError::Missing`] without root or apt-get, [`XtaskError::Failed`] where apt-get fails,
/// [`XtaskError::GmshUnusable`] where the import fails for another reason.
pub fn ensure(venv: &Venv) -> Result<(), XtaskError> {
    let Err(message) = import_gmsh(venv)? else {
        return Ok(());
    };
    if !is_missing_library(&message) {
        return Err(XtaskError::GmshUnusable { message });
    }
    if !(is_root() && has_apt()) {
        return Err(XtaskError::Missing {
            what: format!("gmsh lacks a shared library: {message}"),
            install: format!("apt-get install -y {}", PACKAGES.join(" ")),
        });
    }
    console::say(&format!("installing gmsh's shared libraries ({message})"));
    run_checked(apt().args(["update", "-qq"]))?;
    run_checked(
        apt()
            .args(["install", "-y", "-qq", "--no-install-recommends"])
            .args(PACKAGES),
    )?;
    import_gmsh(venv)?.map_err(|message| XtaskError::GmshUnusable { message })
}

/// A program that some tests need.
struct Needed {
    name: &'static str,
    /// Its names on different systems, and an argument with which it ends by itself.
    commands: &'static [&'static str],
    argument: &'static str,
    /// Debian's package.
    package: &'static str,
    tests: &'static str,
}

const NEEDED: [Needed; 2] = [
    Needed {
        name: "CalculiX",
        commands: &["ccx"],
        argument: "-v",
        package: "calculix-ccx",
        tests: "exported decks",
    },
    Needed {
        name: "Chromium",
        commands: &["chromium", "chromium-browser", "google-chrome"],
        argument: "--version",
        package: "chromium",
        tests: "pages in a browser",
    },
];

/// Installs the programs that some tests need, as root; without root, apt-get or a network says which tests are left
/// out.
pub fn offer_programs() {
    NEEDED.iter().for_each(offer);
}

fn offer(needed: &Needed) {
    let Needed {
        name,
        package,
        tests,
        ..
    } = needed;
    let answers = |command: &&str| Command::new(command).arg(needed.argument).output().is_ok();
    let there = || needed.commands.iter().any(answers);
    if there() {
        return;
    }
    if is_root() && has_apt() {
        console::say(&format!("installing {name} for the tests of {tests}"));
        let install = ["install", "-y", "-qq", "--no-install-recommends", package];
        let done = run_checked(apt().args(["update", "-qq"]))
            .and_then(|()| run_checked(apt().args(install)));
        if done.is_ok() && there() {
            return;
        }
    }
    console::say(&format!(
        "{name} is not there: the tests of {tests} are left out; `apt-get install -y {package}` installs it"
    ));
}

/// Tries the import; the inner error is the last line that Python printed.
fn import_gmsh(venv: &Venv) -> Result<Result<(), String>, XtaskError> {
    let output = Command::new(venv.python())
        .args(["-I", "-c", "import gmsh"])
        .output()
        .map_err(XtaskError::io(|| {
            format!("starting {}", venv.python().display())
        }))?;
    if output.status.success() {
        return Ok(Ok(()));
    }
    let printed = String::from_utf8_lossy(&output.stderr).into_owned();
    let last = printed.lines().rfind(|line| !line.trim().is_empty());
    Ok(Err(last.map_or_else(
        || format!("Python ended with {}", output.status),
        str::to_owned,
    )))
}

/// The dynamic loader's wording for a library that is not installed.
fn is_missing_library(message: &str) -> bool {
    message.contains("cannot open shared object file")
}

/// apt-get without questions; what it prints goes to stderr, because stdout belongs to the demo.
fn apt() -> Command {
    let mut command = Command::new("apt-get");
    command
        .env("DEBIAN_FRONTEND", "noninteractive")
        .stdin(Stdio::null())
        .stdout(std::io::stderr());
    command
}

fn is_root() -> bool {
    Command::new("id")
        .arg("-u")
        .output()
        .is_ok_and(|output| output.stdout.trim_ascii() == b"0")
}

fn has_apt() -> bool {
    Command::new("apt-get")
        .arg("--version")
        .output()
        .is_ok_and(|output| output.status.success())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_missing_library_leads_to_an_installation() {
        assert!(is_missing_library(
            "OSError: libGLU.so.1: cannot open shared object file: No such file or directory"
        ));
        assert!(!is_missing_library(
            "ModuleNotFoundError: No module named 'gmsh'"
        ));
    }
}
