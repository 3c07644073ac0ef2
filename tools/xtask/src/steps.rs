//! The commands themselves: each a list of child processes with xtask's environment.

use std::ffi::OsString;
use std::path::PathBuf;
use std::process::{Command, ExitCode, Stdio};
use std::time::Instant;

use crate::console::{readable, say};
use crate::error::XtaskError;
use crate::machine;
use crate::python_module;
use crate::rust_tests;
use crate::system_libs;
use crate::venv::Venv;
use crate::watched::{self, SILENCE};
use crate::workspace::Workspace;

/// How much `cargo xtask test` runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Extent {
    /// Everything, the tests marked `#[ignore]` (minutes each) too.
    Full,
    /// Without those.
    Fast,
}

/// Everything that CI runs. Each step names the whole workspace: another choice of packages would unite other features,
/// and what several steps need would be compiled for each. Formatting and the build of the tests come first and end it
/// where they fail. Then the Rust tests run, and beside them, one after another, what waits for a single core most of
/// its time; all of these run, whatever fails. The time that is printed at the end counts from `start`, before the
/// preparation.
///
/// # Errors
/// [`XtaskError::Failed`] names the command that failed, [`XtaskError::TestsFailed`] the tests.
pub fn test(
    workspace: &Workspace,
    venv: &Venv,
    extent: Extent,
    start: Instant,
) -> Result<ExitCode, XtaskError> {
    system_libs::offer_programs();
    say(&format!("prepared in {}", readable(start.elapsed())));
    let mut formatting = cargo(workspace, venv);
    formatting.args(["fmt", "--all", "--check"]);
    timed("formatting", || run_checked(&mut formatting))?;
    let built = timed("build of the tests", || {
        rust_tests::built(tests_build(workspace, venv))
    })?;
    let beside = beside_the_tests(workspace, venv)?;
    let (tests, others) = std::thread::scope(|scope| {
        let run = |(name, mut command): (&str, Command)| timed(name, || run_silent(&mut command));
        let others = scope.spawn(move || beside.map(run));
        let tests = timed("Rust tests", || rust_tests::run(built, venv, extent, &[]));
        let others = others.join();
        (
            tests,
            others.unwrap_or_else(|panic| std::panic::resume_unwind(panic)),
        )
    });
    tests?;
    others.into_iter().collect::<Result<(), XtaskError>>()?;
    say(&format!(
        "\nall passed in {}, the preparation included",
        readable(start.elapsed())
    ));
    Ok(ExitCode::SUCCESS)
}

/// What runs beside the Rust tests, in order.
fn beside_the_tests(
    workspace: &Workspace,
    venv: &Venv,
) -> Result<[(&'static str, Command); 5], XtaskError> {
    let cargo = |arguments: &[&str]| {
        let mut command = cargo(workspace, venv);
        // One compiler beside the tests, which have all cores: with more processes than cores the same work takes more
        // processor time (docs/decisions/0017-development-builds.md).
        command.args(arguments).env("CARGO_BUILD_JOBS", "1");
        command
    };
    // Program and Python module are both called gearmesh, so their pages would be written to one place at once.
    let driver = clippy_driver()?;
    let pages = |targets: &str| {
        let mut command = cargo(&["doc", "--workspace", targets, "--no-deps", "--quiet"]);
        command.env("RUSTDOCFLAGS", "-D warnings");
        // What clippy has checked is read, not checked again: its driver with the arguments that it is given below.
        // With others each crate would be checked once more, and the pages would be the same.
        command.env("RUSTC_WORKSPACE_WRAPPER", &driver);
        let arguments = LINT_ARGUMENTS.map(|argument| format!("{argument}__CLIPPY_HACKERY__"));
        command.env("CLIPPY_ARGS", arguments.concat());
        command
    };
    let mut python_tests = Command::new(venv.python());
    python_tests
        .current_dir(workspace.root())
        .args(["-m", "pytest", "-v", "-p", "no:cacheprovider"])
        // A test that does not end says where each of its threads stands; it is killed later.
        .args(["-o", "faulthandler_timeout=300", "tests/python"]);
    set_environment(&mut python_tests, venv);
    // Built with the tests.
    python_tests.env("GEARMESH_PROGRAM", program()?);
    // Not `--all-targets`, which checks libraries without tests of their own as tests, too.
    let targets = "clippy --workspace --lib --bins --tests --benches --examples --";
    let lints: Vec<&str> = targets.split(' ').chain(LINT_ARGUMENTS).collect();
    Ok([
        ("lints", cargo(&lints)),
        ("documentation of the libraries", pages("--lib")),
        ("documentation of the programs", pages("--bins")),
        (
            "documentation tests",
            cargo(&["test", "--workspace", "--doc"]),
        ),
        ("Python tests", python_tests),
    ])
}

/// What clippy is given: warnings end it.
const LINT_ARGUMENTS: [&str; 2] = ["-D", "warnings"];

/// Clippy's compiler, which is beside cargo's.
fn clippy_driver() -> Result<PathBuf, XtaskError> {
    let mut command = Command::new(std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()));
    command.args(["--print", "sysroot"]);
    let output = command
        .output()
        .map_err(XtaskError::io(|| format!("starting {}", shown(&command))))?;
    if !output.status.success() {
        return Err(XtaskError::Failed {
            command: shown(&command),
            status: output.status.to_string(),
        });
    }
    let sysroot = String::from_utf8_lossy(&output.stdout);
    let driver = format!("clippy-driver{}", std::env::consts::EXE_SUFFIX);
    Ok(PathBuf::from(sysroot.trim()).join("bin").join(driver))
}

/// Runs a step and says how it ended, after how long.
fn timed<T>(name: &str, step: impl FnOnce() -> Result<T, XtaskError>) -> Result<T, XtaskError> {
    let start = Instant::now();
    let outcome = step();
    let verdict = if outcome.is_ok() { "passed" } else { "FAILED" };
    say(&format!(
        "== {name} {verdict} in {}\n",
        readable(start.elapsed())
    ));
    outcome
}

/// The build of all test programs.
fn tests_build(workspace: &Workspace, venv: &Venv) -> Command {
    let mut build = cargo(workspace, venv);
    build.args(["test", "--workspace", "--tests"]);
    build
}

/// The Rust tests of the packages, programs and modules named, all where none is.
///
/// # Errors
/// As [`rust_tests::built`] and [`rust_tests::run`].
pub fn rust_tests(
    workspace: &Workspace,
    venv: &Venv,
    extent: Extent,
    only: &[String],
) -> Result<(), XtaskError> {
    let built = rust_tests::built(tests_build(workspace, venv))?;
    rust_tests::run(built, venv, extent, only)
}

/// Gear pair A from definition to report: `gearmesh demo -o out/demo` and the user's further arguments. The exit
/// code is that of `gearmesh demo`.
///
/// # Errors
/// [`XtaskError::Failed`] where the program does not build, [`XtaskError::Io`] where it does not start.
pub fn demo(
    workspace: &Workspace,
    venv: &Venv,
    arguments: &[String],
) -> Result<ExitCode, XtaskError> {
    let mut command = Command::new(build_program(workspace, venv)?);
    set_environment(&mut command, venv);
    command.current_dir(workspace.root()).arg("demo");
    command.args(demo_arguments(arguments));
    let status = command
        .status()
        .map_err(XtaskError::io(|| format!("starting {}", shown(&command))))?;
    Ok(status
        .code()
        .and_then(|code| u8::try_from(code).ok())
        .map_or(ExitCode::FAILURE, ExitCode::from))
}

/// Builds the program `gearmesh` and returns its path.
///
/// # Errors
/// [`XtaskError::Failed`] where it does not build.
pub fn build_program(workspace: &Workspace, venv: &Venv) -> Result<PathBuf, XtaskError> {
    run_checked(cargo(workspace, venv).args(BUILD))?;
    program()
}

/// Builds libraries and program together. The whole workspace, not one package, and the libraries with the program:
/// cargo unites features over what is named, and shares what build scripts and libraries both use; by itself the
/// program had HDF5 and all that stands on it compiled again.
pub const BUILD: [&str; 5] = ["build", "--workspace", "--lib", "--bin", "gearmesh"];

/// Where the program `gearmesh` is, once built.
fn program() -> Result<PathBuf, XtaskError> {
    Ok(python_module::build_dir()?.join("gearmesh"))
}

/// The user's arguments after a default output directory, which an output of his own replaces.
fn demo_arguments(given: &[String]) -> Vec<String> {
    let names_output =
        |arg: &String| arg.starts_with("-o") || arg == "--output" || arg.starts_with("--output=");
    let mut arguments = Vec::new();
    if !given.iter().any(names_output) {
        arguments.extend(["-o".to_owned(), "out/demo".to_owned()]);
    }
    arguments.extend_from_slice(given);
    arguments
}

/// A cargo call in the project's root with the environment that the build needs.
pub fn cargo(workspace: &Workspace, venv: &Venv) -> Command {
    let program = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(program);
    command.current_dir(workspace.root());
    set_environment(&mut command, venv);
    command
}

/// `.venv/bin` first on PATH (cmake for HDF5's C sources is there), and the interpreter that meshing starts.
pub fn set_environment(command: &mut Command, venv: &Venv) {
    command.env("PATH", path_with_first(venv.bin_dir()));
    command.env("GEARMESH_PYTHON", venv.python());
    if machine::lacks_make() {
        command.env("CMAKE_GENERATOR", "Ninja");
    }
}

fn path_with_first(dir: PathBuf) -> OsString {
    let rest = std::env::var_os("PATH").unwrap_or_default();
    let mut path = OsString::from(dir);
    if !rest.is_empty() {
        path.push(":");
        path.push(rest);
    }
    path
}

/// Runs a command without standard input and turns failure into an error that shows the command.
///
/// # Errors
/// [`XtaskError::Failed`] for a failure, [`XtaskError::Io`] where the program cannot be started.
pub fn run_checked(command: &mut Command) -> Result<(), XtaskError> {
    let status = command
        .stdin(Stdio::null())
        .status()
        .map_err(|source| XtaskError::Io {
            action: format!("starting {}", shown(command)),
            source,
        })?;
    if status.success() {
        return Ok(());
    }
    Err(XtaskError::Failed {
        command: shown(command),
        status: status.to_string(),
    })
}

/// As [`run_checked`]; what the command prints is shown where it fails, and it is killed where it prints nothing for
/// [`SILENCE`].
///
/// # Errors
/// As [`run_checked`].
fn run_silent(command: &mut Command) -> Result<(), XtaskError> {
    let ended = watched::run(command, SILENCE, |_| {})
        .map_err(XtaskError::io(|| format!("starting {}", shown(command))))?;
    if ended.status.success() {
        return Ok(());
    }
    say(&ended.output);
    Err(XtaskError::Failed {
        command: shown(command),
        status: ended.status.to_string(),
    })
}

/// The command as one could type it in the project's root.
pub fn shown(command: &Command) -> String {
    let words = std::iter::once(command.get_program()).chain(command.get_args());
    words
        .map(|word| word.to_string_lossy().into_owned())
        .collect::<Vec<_>>()
        .join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn demo_line(line: &str) -> String {
        demo_arguments(
            &line
                .split_whitespace()
                .map(str::to_owned)
                .collect::<Vec<_>>(),
        )
        .join(" ")
    }

    #[test]
    fn the_demo_writes_to_out_demo_unless_told_otherwise() {
        assert_eq!(demo_line(""), "-o out/demo");
        assert_eq!(demo_line("--json"), "-o out/demo --json");
        assert_eq!(demo_line("-o elsewhere"), "-o elsewhere");
        assert_eq!(demo_line("--output=elsewhere"), "--output=elsewhere");
    }

    #[test]
    fn a_failing_command_is_named_with_its_status() {
        for run in [run_checked, run_silent] {
            let error = run(Command::new("sh").args(["-c", "exit 3"])).err();
            assert!(
                matches!(&error, Some(XtaskError::Failed { command, status })
                    if command == "sh -c exit 3" && status.contains('3')),
                "{error:?}"
            );
        }
    }

    #[test]
    fn a_command_that_does_not_exist_is_an_io_error() {
        for run in [run_checked, run_silent] {
            assert!(matches!(
                run(&mut Command::new("no-such-program")),
                Err(XtaskError::Io { .. })
            ));
        }
    }
}
