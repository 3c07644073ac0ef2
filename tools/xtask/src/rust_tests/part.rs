//! A part of a test program: tests that run one after another in one process.

use std::process::Command;
use std::time::{Duration, Instant};

use crate::console::readable;
use crate::error::XtaskError;
use crate::rust_tests::binaries::Binary;
use crate::steps::{Extent, shown};
use crate::venv::Venv;
use crate::watched::{self, Ended, SILENCE};

/// How long a program takes, and whether it is cut.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Length {
    /// Seconds: one part.
    Short,
    /// Minutes: one part, for its tests share what takes long to make.
    Long,
    /// Minutes: a part for each module.
    LongInModules,
}

/// Tests of a program that run in one process, so that they share what the first of them makes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Part {
    /// The program.
    pub binary: Binary,
    /// Package, target and, of a program that is cut, module.
    pub label: String,
    /// Full names of the tests.
    pub tests: Vec<String>,
    /// Whether it takes minutes. Its loops are to keep to one thread: the other parts have the other cores.
    pub long: bool,
    /// A variable of its environment, where what its tests print is wanted, of those that pass too.
    pub shows_output: Option<(&'static str, &'static str)>,
}

/// What came of a part.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PartResult {
    /// As in [`Part`].
    pub label: String,
    /// Whether all tests passed.
    pub passed: bool,
    /// Each test that ran and its time.
    pub times: Vec<(String, Duration)>,
    /// All that it printed.
    pub output: String,
}

/// Cuts a program into its parts: one, or of a long program one for each module.
///
/// # Errors
/// [`XtaskError::Failed`] or [`XtaskError::Io`] where the program does not tell its tests.
pub fn parts_of(binary: Binary, extent: Extent, length: Length) -> Result<Vec<Part>, XtaskError> {
    let mut tests = names(&binary, &[])?;
    if extent == Extent::Fast {
        let ignored = names(&binary, &["--ignored"])?;
        tests.retain(|name| !ignored.contains(name));
    }
    let label = binary.label();
    let mut parts: Vec<Part> = Vec::new();
    for test in tests {
        let label = match module(&test) {
            Some(module) if length == Length::LongInModules => format!("{label} {module}"),
            _ => label.clone(),
        };
        match parts.iter_mut().find(|part| part.label == label) {
            Some(part) => part.tests.push(test),
            None => parts.push(Part {
                binary: binary.clone(),
                label,
                tests: vec![test],
                long: length != Length::Short,
                shows_output: None,
            }),
        }
    }
    Ok(parts)
}

/// The module at the top in which a test is.
fn module(test: &str) -> Option<&str> {
    test.split_once("::").map(|(module, _)| module)
}

/// Names of the program's tests.
fn names(binary: &Binary, choice: &[&str]) -> Result<Vec<String>, XtaskError> {
    let mut command = Command::new(&binary.program);
    command.args(["--list", "--format", "terse"]).args(choice);
    let output = command
        .current_dir(&binary.folder)
        .output()
        .map_err(XtaskError::io(|| format!("starting {}", shown(&command))))?;
    if !output.status.success() {
        return Err(XtaskError::Failed {
            command: shown(&command),
            status: output.status.to_string(),
        });
    }
    let text = String::from_utf8_lossy(&output.stdout);
    let tests = text.lines().filter_map(|line| line.strip_suffix(": test"));
    Ok(tests.map(str::to_owned).collect())
}

impl Part {
    /// Whether a name is that of its package, of its program or of a module in it.
    pub fn has(&self, name: &str) -> bool {
        self.is_all_of(name) || self.tests.iter().any(|test| module(test) == Some(name))
    }

    fn is_all_of(&self, name: &str) -> bool {
        self.binary.label().split(' ').any(|word| word == name)
    }

    /// Keeps the tests that one of the names has.
    pub fn keep(&mut self, names: &[String]) {
        if !names.iter().any(|name| self.is_all_of(name)) {
            let named = |test: &str| names.iter().any(|name| module(test) == Some(name));
            self.tests.retain(|test| named(test));
        }
    }

    /// Runs the tests one after another.
    ///
    /// # Errors
    /// [`XtaskError::Io`] where the program does not start.
    pub fn run(&self, venv: &Venv) -> Result<PartResult, XtaskError> {
        let mut command = Command::new(&self.binary.program);
        command
            .args(["--include-ignored", "--test-threads=1", "--exact"])
            .args(&self.tests)
            .current_dir(&self.binary.folder)
            .env("CARGO_MANIFEST_DIR", &self.binary.folder);
        if let Some((name, value)) = self.shows_output {
            command.arg("--show-output").env(name, value);
        }
        crate::steps::set_environment(&mut command, venv);
        if self.long {
            // Of our own solvers, and of the linear algebra of the Python programs they are compared with.
            for threads in ["RAYON_NUM_THREADS", "OPENBLAS_NUM_THREADS"] {
                command.env(threads, "1");
            }
        }
        let mut times = Vec::new();
        let mut last = Instant::now();
        let hear = |line: &str| {
            if let Some((name, _)) = ended(line) {
                times.push((name.to_owned(), last.elapsed()));
                last = Instant::now();
            }
        };
        let program = self.binary.program.display();
        let Ended { status, mut output } = watched::run(&mut command, SILENCE, hear)
            .map_err(XtaskError::io(|| format!("running {program}")))?;
        if !status.success() {
            output.push_str(&format!("{status}\n"));
        }
        // A name that the program does not know would pass as no test at all.
        let all = output.contains(&format!("running {} test", self.tests.len()));
        Ok(PartResult {
            label: self.label.clone(),
            passed: status.success() && all,
            times,
            output,
        })
    }
}

impl PartResult {
    /// One line for the console.
    pub fn line(&self) -> String {
        let time: Duration = self.times.iter().map(|(_, time)| *time).sum();
        let verdict = if self.passed { "" } else { "  FAILED" };
        let count = self.times.len();
        format!(
            "{:>12}  {}, {count} tests{verdict}",
            readable(time),
            self.label
        )
    }

    /// Names of the tests that failed; the part's own where it ended otherwise.
    pub fn failures(&self) -> Vec<String> {
        let lines = self.output.lines().filter_map(ended);
        let failed = lines.filter(|(_, passed)| !passed);
        let names: Vec<String> = failed.map(|(name, _)| self.full_name(name)).collect();
        if names.is_empty() {
            return vec![self.label.clone()];
        }
        names
    }

    /// The lines that a test printed, as the harness shows them behind all tests.
    pub fn printed_by(&self, test: &str) -> Vec<String> {
        let head = format!("---- {test} stdout ----");
        let after = self.output.lines().skip_while(|line| *line != head).skip(1);
        after
            .take_while(|line| {
                !line.starts_with("---- ")
                    && !line.starts_with("successes:")
                    && !line.starts_with("failures:")
            })
            .map(|line| line.trim().to_owned())
            .filter(|line| !line.is_empty())
            .collect()
    }

    /// Package, target and name of a test.
    pub fn full_name(&self, test: &str) -> String {
        let mut words = self.label.splitn(3, ' ');
        let (package, target) = (words.next(), words.next());
        format!(
            "{} {} {test}",
            package.unwrap_or_default(),
            target.unwrap_or_default()
        )
    }
}

/// The test whose end a line of the harness tells, and whether it passed.
fn ended(line: &str) -> Option<(&str, bool)> {
    let (name, verdict) = line
        .trim_end()
        .strip_prefix("test ")?
        .rsplit_once(" ... ")?;
    // "name - should panic"
    let name = name.split(" - ").next()?;
    match verdict {
        "ok" => Some((name, true)),
        "FAILED" => Some((name, false)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::PathBuf;

    #[test]
    fn lines_of_the_harness_are_read() {
        assert_eq!(ended("test a::b ... ok\n"), Some(("a::b", true)));
        assert_eq!(
            ended("test a - should panic ... FAILED"),
            Some(("a", false))
        );
        for other in [
            "test result: ok. 1 passed",
            "running 3 tests",
            "",
            "test a ... ",
        ] {
            assert_eq!(ended(other), None, "{other}");
        }
    }

    #[test]
    fn what_a_test_prints_is_found_behind_all_tests() {
        let output = "test a ... ok\ntest b ... ok\n\nsuccesses:\n\n---- a stdout ----\nworst 1e-12\n 3 of 4\n\n---- b stdout ----\nb\n\n\
            successes:\n    a\n    b\n\ntest result: ok.";
        let result = PartResult {
            label: "x y".into(),
            passed: true,
            times: Vec::new(),
            output: output.into(),
        };
        assert_eq!(result.printed_by("a"), ["worst 1e-12", "3 of 4"]);
        assert_eq!(result.printed_by("b"), ["b"]);
        assert!(result.printed_by("c").is_empty());
    }

    /// This very program, as a binary of two kinds.
    fn own_parts(length: Length) -> Vec<Part> {
        let program = std::env::current_exe().unwrap_or_else(|_| PathBuf::new());
        let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
        let name = "xtask".to_owned();
        let binary = Binary {
            name,
            folder,
            program,
        };
        parts_of(binary, Extent::Full, length).unwrap_or_default()
    }

    #[test]
    fn a_long_program_is_cut_by_modules_and_loses_no_test() {
        let (whole, cut) = (own_parts(Length::Long), own_parts(Length::LongInModules));
        assert_eq!(whole.len(), 1);
        assert!(cut.len() > 5 && cut.iter().any(|part| part.label == "xtask xtask console"));
        let mut names: Vec<&String> = cut.iter().flat_map(|part| &part.tests).collect();
        let mut all: Vec<&String> = whole[0].tests.iter().collect();
        names.sort();
        all.sort();
        assert_eq!(names, all);
    }

    #[test]
    fn parts_are_kept_by_package_program_or_module() {
        let names = |words: &[&str]| {
            words
                .iter()
                .map(|&word| word.to_owned())
                .collect::<Vec<String>>()
        };
        let whole = own_parts(Length::Long).remove(0);
        assert!(whole.has("xtask") && whole.has("console") && !whole.has("consol"));
        let mut all = whole.clone();
        all.keep(&names(&["console", "xtask"]));
        assert_eq!(all, whole);
        let mut some = whole.clone();
        some.keep(&names(&["console", "venv"]));
        assert!(!some.tests.is_empty() && some.tests.len() < whole.tests.len());
        assert!(
            some.tests
                .iter()
                .all(|test| test.starts_with("console::") || test.starts_with("venv::"))
        );
        some.keep(&names(&["elsewhere"]));
        assert!(some.tests.is_empty());
    }

    fn ran(tests: &[&str]) -> PartResult {
        let mut part = own_parts(Length::Short).remove(0);
        part.tests = tests.iter().map(|&name| name.to_owned()).collect();
        let venv = Venv::at(PathBuf::from("no-venv"));
        let told = |error: XtaskError| panic!("{error}");
        part.run(&venv).unwrap_or_else(told)
    }

    #[test]
    fn a_part_runs_its_tests_alone_and_times_them() {
        let name = "console::tests::durations_read_naturally";
        let result = ran(&[name]);
        assert!(result.passed, "{}", result.output);
        let names: Vec<&str> = result.times.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, [name]);
        assert!(
            result.line().ends_with("xtask xtask, 1 tests"),
            "{}",
            result.line()
        );
        assert_eq!(result.full_name(name), format!("xtask xtask {name}"));
    }

    #[test]
    fn a_test_that_is_not_there_does_not_pass() {
        let result = ran(&["console::tests::no_such_test"]);
        assert!(!result.passed);
        assert_eq!(result.failures(), ["xtask xtask"]);
    }
}
