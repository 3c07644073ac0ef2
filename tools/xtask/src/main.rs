//! The project's own commands: `cargo xtask test`, `demo`, `docs`, `bench`, `accuracy-cost`, `figures` and
//! `hard-cases`.
//!
//! All begin with the same preparation ([`prepare::prepare`]), so that each works on a clean clone: the Python
//! environment `.venv` from the locked requirements, the shared libraries that gmsh needs, the Python module.
//! A machine needs rustup, a C compiler and Python 3.10 to 3.13 with venv; whatever is missing is named together
//! with the one line that installs it.

mod bench;
mod console;
mod docs;
mod error;
mod figures;
mod hard_cases;
mod machine;
mod prepare;
mod python_module;
mod release;
mod rust_tests;
mod steps;
mod system_libs;
mod venv;
mod watched;
mod wheel;
mod workspace;

use std::process::ExitCode;

use error::XtaskError;
use workspace::Workspace;

const HELP: &str = "\
The project's own commands. All make what they need first (.venv, gmsh's shared libraries, the Python module).

Usage: cargo xtask <COMMAND>

  test [--fast]   everything that CI runs: formatting, lints, documentation, Rust tests, Python tests
                  --fast   leaves out the tests marked #[ignore], which take minutes
  rust-tests [NAME...]
                  the Rust tests alone, or those of the packages, programs and modules named (such as `scene`,
                  `validation`, `speed_sweep`), with the slowest
  demo [ARGS]     gear pair A from definition to report, into out/demo; ARGS go to `gearmesh demo`
  bench offline [--quick] [--program PATH]
                  time and memory of the offline stage beside other programs, into docs/benchmarks/offline.md
                  --quick     the two smallest meshes only, into out/offline-quick.md
                  --program   measures this program, with the Python in GEARMESH_PYTHON, and builds nothing
  bench chain     time of a step over the number of bodies beside Exudyn, into docs/benchmarks/chain.md
  bench bearings  time and error of bearings in equilibrium and of balls that move, beside Exudyn, into docs/benchmarks/bearings.md
  accuracy-cost [--quick] [--program PATH]
                  what accuracy costs in time: `gearmesh accuracy` on pairs at rest and through resonance, a gearbox, a
                  bearing, a bevel pair, into docs/accuracy-cost.md (half an hour); options as above, --quick: the pairs at
                  rest only, into out/accuracy-cost-quick.md
  accuracy-cost elements [--quick] [--program PATH]
                  error and cost of every element, mesh size and local term, into docs/benchmarks/elements.md
  accuracy-cost bearings
                  the models of a bearing beside each other, into docs/benchmarks/bearing-models.md
  accuracy-cost bevel-machines
                  seed 000's machines with each model of their bearings, into docs/benchmarks/bevel-machines.md
  accuracy-cost whole-machines
                  scenes with everything in them, whole, with half the step and without one part at a time, into
                  docs/benchmarks/whole-machines.md
  figures [--made | PAGE...]
                  lists the pages above with commit, day and processor, and which of them are stale
                  --made      makes the stale ones again that take minutes; PAGE: those named, such as `accuracy-cost`
  hard-cases      runs every hard case of every crate, a million problems of the contact solver among them, into
                  docs/hard-cases.md
  wheel [--quick] the Python package and the program in one wheel, into target/wheel: stripped, with links across crates
                  --quick     the development build instead, to try the wheel out
  release [--quick]
                  the wheel, and an archive of it, program, documentation, examples, completions and manual pages in target/archive
  docs            the documentation as one site with search, which opens without a network, into target/docs/site
  prepare         only makes what the others need
  help            this text

Exit code: 0 done, 1 the work failed, 2 the command line is wrong; `demo` ends with the code of `gearmesh demo`.";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let command = match Command::parse(&arguments) {
        Ok(command) => command,
        Err(complaint) => {
            console::say(&format!("error: {complaint}\n\n{HELP}"));
            return ExitCode::from(2);
        }
    };
    match run(command) {
        Ok(code) => code,
        Err(error) => {
            console::say(&format!("\nerror: {error}"));
            ExitCode::from(1)
        }
    }
}

/// What the command line asks for.
#[derive(Debug, PartialEq, Eq)]
enum Command {
    Test(steps::Extent),
    RustTests(Vec<String>),
    Demo(Vec<String>),
    /// A page of the documentation that measures.
    Page(&'static figures::Page, bench::Options),
    Figures(figures::Which),
    Wheel(wheel::Build),
    Release(wheel::Build),
    Docs,
    Prepare,
    Help,
}

impl Command {
    /// Reads the command line; the error is a sentence for the user.
    fn parse(arguments: &[String]) -> Result<Self, String> {
        let Some((name, rest)) = arguments.split_first() else {
            return Err("no command given".to_owned());
        };
        let rest: Vec<&str> = rest.iter().map(String::as_str).collect();
        let owned = |words: &[&str]| words.iter().map(|&word| word.to_owned()).collect();
        match (name.as_str(), rest.as_slice()) {
            ("demo", rest) => Ok(Self::Demo(owned(rest))),
            ("test", []) => Ok(Self::Test(steps::Extent::Full)),
            ("test", ["--fast"]) => Ok(Self::Test(steps::Extent::Fast)),
            ("rust-tests", rest) if !rest.iter().any(|word| word.starts_with('-')) => {
                Ok(Self::RustTests(owned(rest)))
            }
            ("wheel", []) => Ok(Self::Wheel(wheel::Build::Release)),
            ("wheel", ["--quick"]) => Ok(Self::Wheel(wheel::Build::Quick)),
            ("release", []) => Ok(Self::Release(wheel::Build::Release)),
            ("release", ["--quick"]) => Ok(Self::Release(wheel::Build::Quick)),
            ("docs", []) => Ok(Self::Docs),
            ("prepare", []) => Ok(Self::Prepare),
            ("help" | "--help" | "-h", _)
            | (
                "test" | "rust-tests" | "docs" | "prepare" | "wheel" | "release" | "bench"
                | "accuracy-cost" | "figures" | "hard-cases",
                ["--help" | "-h"],
            ) => Ok(Self::Help),
            ("figures", rest) => figures::Which::parse(rest).map(Self::Figures),
            ("test" | "rust-tests" | "docs" | "prepare" | "wheel" | "release", rest) => {
                Err(format!("unknown argument `{}` of `{name}`", rest.join(" ")))
            }
            ("bench" | "accuracy-cost" | "hard-cases", _) => {
                let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
                let Some((page, rest)) = figures::Page::named(&words) else {
                    return Err(
                        "`bench` needs what to measure: `bench offline`, `bench chain` or `bench bearings`"
                            .into(),
                    );
                };
                bench_options(page, rest).map(|options| Self::Page(page, options))
            }
            (other, _) => Err(format!("unknown command `{other}`")),
        }
    }
}

/// Reads what follows a command that measures.
fn bench_options(page: &figures::Page, arguments: &[&str]) -> Result<bench::Options, String> {
    let mut options = bench::Options::default();
    let mut rest = arguments.iter();
    while let Some(&argument) = rest.next() {
        match argument {
            "--quick" if page.has_options => options.quick = true,
            "--program" if page.has_options => {
                let path = rest.next().ok_or("`--program` needs a path")?;
                options.program = Some(path.into());
            }
            other => {
                return Err(format!(
                    "unknown argument `{other}` of `{}`",
                    page.command()
                ));
            }
        }
    }
    Ok(options)
}

fn run(command: Command) -> Result<ExitCode, XtaskError> {
    if command == Command::Help {
        console::say(HELP);
        return Ok(ExitCode::SUCCESS);
    }
    let workspace = Workspace::find()?;
    match &command {
        Command::Page(page, options) => return (page.make)(&workspace, options),
        Command::Figures(which) => return figures::figures(&workspace, which),
        _ => {}
    }
    let start = std::time::Instant::now();
    let venv = prepare::prepare(&workspace)?;
    match command {
        Command::Test(extent) => steps::test(&workspace, &venv, extent, start),
        Command::RustTests(names) => {
            steps::rust_tests(&workspace, &venv, steps::Extent::Full, &names)?;
            Ok(ExitCode::SUCCESS)
        }
        Command::Wheel(build) => wheel::wheel(&workspace, &venv, build).map(|_| ExitCode::SUCCESS),
        Command::Release(build) => release::release(&workspace, &venv, build),
        Command::Docs => docs::docs(&workspace, &venv),
        Command::Demo(arguments) => steps::demo(&workspace, &venv, &arguments),
        Command::Prepare | Command::Help | Command::Page(..) | Command::Figures(_) => {
            Ok(ExitCode::SUCCESS)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(line: &str) -> Result<Command, String> {
        let arguments: Vec<String> = line.split_whitespace().map(str::to_owned).collect();
        Command::parse(&arguments)
    }

    #[test]
    fn test_runs_everything_unless_told_to_be_fast() {
        assert_eq!(parse("test"), Ok(Command::Test(steps::Extent::Full)));
        assert_eq!(parse("test --fast"), Ok(Command::Test(steps::Extent::Fast)));
    }

    #[test]
    fn a_wheel_is_a_release_unless_it_is_to_be_quick() {
        let quick = Ok(Command::Wheel(wheel::Build::Quick));
        assert_eq!(parse("wheel"), Ok(Command::Wheel(wheel::Build::Release)));
        assert_eq!(parse("wheel --quick"), quick);
        assert!(parse("wheel --slow").is_err());
        assert_eq!(
            parse("release"),
            Ok(Command::Release(wheel::Build::Release))
        );
        assert!(parse("release --slow").is_err());
    }

    #[test]
    fn rust_tests_takes_names_of_programs() {
        assert_eq!(parse("rust-tests"), Ok(Command::RustTests(Vec::new())));
        let names = vec!["modes".to_owned(), "study".to_owned()];
        assert_eq!(
            parse("rust-tests modes study"),
            Ok(Command::RustTests(names))
        );
        assert_eq!(parse("rust-tests --help"), Ok(Command::Help));
        assert_eq!(
            parse("rust-tests --fast"),
            Err("unknown argument `--fast` of `rust-tests`".into())
        );
    }

    #[test]
    fn demo_passes_its_arguments_on() {
        assert_eq!(
            parse("demo --json -o x"),
            Ok(Command::Demo(vec![
                "--json".into(),
                "-o".into(),
                "x".into()
            ]))
        );
    }

    #[test]
    fn the_benchmark_takes_its_options_in_any_order() {
        let options = bench::Options {
            quick: true,
            program: Some("x/gearmesh".into()),
        };
        let page = |line: &str, options| {
            let words: Vec<&str> = line.split_whitespace().collect();
            let (page, _) = figures::Page::named(&words).ok_or("no such page")?;
            Ok(Command::Page(page, options))
        };
        assert_eq!(
            parse("bench offline --program x/gearmesh --quick"),
            page("bench offline", options)
        );
        for line in ["bench offline", "accuracy-cost", "accuracy-cost elements"] {
            assert_eq!(parse(line), page(line, bench::Options::default()));
        }
        assert_eq!(parse("accuracy-cost --help"), Ok(Command::Help));
        assert_eq!(
            parse("accuracy-cost now"),
            Err("unknown argument `now` of `accuracy-cost`".into())
        );
        assert_eq!(
            parse("bench chain --quick"),
            Err("unknown argument `--quick` of `bench chain`".into())
        );
        assert_eq!(
            parse("bench offline --program"),
            Err("`--program` needs a path".into())
        );
        assert_eq!(
            parse("bench online"),
            Err(
                "`bench` needs what to measure: `bench offline`, `bench chain` or `bench bearings`"
                    .into()
            )
        );
    }

    #[test]
    fn mistakes_are_named() {
        assert_eq!(parse(""), Err("no command given".into()));
        assert_eq!(parse("tset"), Err("unknown command `tset`".into()));
        assert_eq!(
            parse("test --fats"),
            Err("unknown argument `--fats` of `test`".into())
        );
    }
}
