//! What the machine itself must supply: a C compiler and a suitable Python.

use std::path::Path;
use std::process::{Command, Stdio};

use crate::error::XtaskError;

/// The Python versions (3.x) for which the lock file holds wheels.
const SUPPORTED_MINORS: std::ops::RangeInclusive<u32> = 10..=13;

/// Where a suitable Python may be, in the order of preference.
const PYTHON_NAMES: [&str; 5] = [
    "python3",
    "python3.13",
    "python3.12",
    "python3.11",
    "python3.10",
];

/// A Python interpreter that can make the environment.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct BasePython {
    /// What to call.
    pub program: String,
    /// Full version, such as `3.11.7`.
    pub version: String,
}

/// Checks that C sources (METIS, HDF5) can be compiled and Rust programs linked.
///
/// # Errors
/// [`XtaskError::Missing`] without `cc`.
pub fn require_c_compiler() -> Result<(), XtaskError> {
    if runs("cc", &["--version"]) {
        return Ok(());
    }
    Err(XtaskError::Missing {
        what: "no C compiler: `cc` is not found".into(),
        install: "apt-get install -y gcc libc6-dev".into(),
    })
}

/// Whether cmake must be told to use ninja (from `.venv`) because there is no make.
pub fn lacks_make() -> bool {
    !runs("make", &["--version"])
}

/// Finds a Python from 3.10 to 3.13 that has `venv` and `ensurepip`.
///
/// # Errors
/// [`XtaskError::Missing`] where there is none, or where Debian's separate venv package is not installed.
pub fn find_python() -> Result<BasePython, XtaskError> {
    let mut unsuitable = Vec::new();
    for program in PYTHON_NAMES {
        let Some(version) = version_of(Path::new(program)) else {
            continue;
        };
        if !is_supported(&version) {
            unsuitable.push(format!("{program} is {version}"));
            continue;
        }
        if !runs(program, &["-c", "import venv, ensurepip"]) {
            return Err(XtaskError::Missing {
                what: format!(
                    "{program} ({version}) cannot make an environment: its module venv or ensurepip is missing"
                ),
                install: format!(
                    "apt-get install -y {}-venv",
                    if program == "python3" {
                        "python3"
                    } else {
                        program
                    }
                ),
            });
        }
        return Ok(BasePython {
            program: program.to_owned(),
            version,
        });
    }
    let found = if unsuitable.is_empty() {
        "none is installed".to_owned()
    } else {
        unsuitable.join(", ")
    };
    Err(XtaskError::Missing {
        what: format!("Python 3.10, 3.11, 3.12 or 3.13 is needed; {found}"),
        install: "apt-get install -y python3 python3-venv".into(),
    })
}

/// The version that a Python interpreter reports, or `None` where it does not run.
pub fn version_of(python: &Path) -> Option<String> {
    let output = Command::new(python)
        .args([
            "-I",
            "-c",
            "import platform; print(platform.python_version())",
        ])
        .stderr(Stdio::null())
        .output()
        .ok()?;
    let version = String::from_utf8(output.stdout).ok()?.trim().to_owned();
    (output.status.success() && !version.is_empty()).then_some(version)
}

fn is_supported(version: &str) -> bool {
    let mut parts = version.split('.');
    let major = parts.next();
    let minor = parts.next().and_then(|minor| minor.parse().ok());
    major == Some("3") && minor.is_some_and(|minor: u32| SUPPORTED_MINORS.contains(&minor))
}

fn runs(program: &str, arguments: &[&str]) -> bool {
    Command::new(program)
        .args(arguments)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .is_ok_and(|status| status.success())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn supported_versions_are_those_of_the_lock() {
        for version in ["3.10.13", "3.11.7", "3.12.1", "3.13.0"] {
            assert!(is_supported(version), "{version}");
        }
        for version in ["2.7.18", "3.9.18", "3.14.0", "4.11.0", "", "3"] {
            assert!(!is_supported(version), "{version}");
        }
    }

    #[test]
    fn a_program_that_is_not_there_has_no_version() {
        assert_eq!(version_of(Path::new("no-such-python")), None);
    }
}
