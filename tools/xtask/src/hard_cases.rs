//! `cargo xtask hard-cases`: every hard case of every crate, run and written into one page.
//!
//! A hard case is one test in one place: in a file of `crates/*/tests` whose name has the word `hard`. The comment
//! above the test says what is hard and what must hold; what the test prints are the figures it found. The page is made
//! of these and of nothing else, so that it knows no case that CI does not run.

use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use crate::bench::{Host, Options, write_whole};
use crate::console::{readable, say};
use crate::error::XtaskError;
use crate::rust_tests::{self, Finished};
use crate::steps;
use crate::workspace::Workspace;

/// The page.
const PAGE: &str = "docs/hard-cases.md";

/// Problems that the page's run of the contact solver's random family solves; CI takes a smaller number.
const NLCP_PROBLEMS: (&str, &str) = ("NLCP_PROBLEMS", "1000000");

/// One hard case as its source says it.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Case {
    /// The package's folder under `crates`.
    package: String,
    /// The test program.
    target: String,
    /// Full name of the test in it.
    test: String,
    /// What is hard, what must hold.
    comment: String,
}

impl Case {
    /// All cases of a source file, whose path is relative to `crates`.
    fn of_file(path: &Path, source: &str) -> Vec<Self> {
        let words: Vec<String> = (path.iter())
            .map(|word| word.to_string_lossy().trim_end_matches(".rs").to_owned())
            .collect();
        let [package, _, target, modules @ ..] = words.as_slice() else {
            return Vec::new();
        };
        let mut cases = Vec::new();
        let (mut comment, mut is_test) = (String::new(), false);
        for line in source.lines() {
            if let Some(text) = line.strip_prefix("///") {
                comment.push_str(text);
            } else if line == "#[test]" {
                is_test = true;
            } else if line.starts_with("#[") {
                // Another attribute.
            } else {
                let name = line
                    .strip_prefix("fn ")
                    .and_then(|rest| rest.split('(').next());
                if let (true, Some(name)) = (is_test, name) {
                    let mut path = modules.to_vec();
                    path.push(name.to_owned());
                    cases.push(Self {
                        package: package.clone(),
                        target: target.clone(),
                        test: path.join("::"),
                        comment: comment.trim().to_owned(),
                    });
                }
                (comment, is_test) = (String::new(), false);
            }
        }
        cases
    }

    /// The name without modules and underscores.
    fn title(&self) -> String {
        let name = self.test.rsplit("::").next().unwrap_or(&self.test);
        name.replace('_', " ")
    }
}

/// The cases of all crates, by package and file.
///
/// # Errors
/// [`XtaskError::Io`] where a folder or file cannot be read.
fn cases(root: &Path) -> Result<Vec<Case>, XtaskError> {
    let crates = root.join("crates");
    let mut files = Vec::new();
    for package in sorted(&crates)? {
        let tests = package.join("tests");
        if tests.is_dir() {
            hard_files(&tests, &mut files)?;
        }
    }
    let mut all = Vec::new();
    for file in files {
        let source = std::fs::read_to_string(&file)
            .map_err(XtaskError::io(|| format!("reading {}", file.display())))?;
        let path = file.strip_prefix(&crates).unwrap_or(&file);
        all.extend(Case::of_file(path, &source));
    }
    Ok(all)
}

fn sorted(folder: &Path) -> Result<Vec<PathBuf>, XtaskError> {
    let entries = std::fs::read_dir(folder)
        .map_err(XtaskError::io(|| format!("reading {}", folder.display())))?;
    let mut paths: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    paths.sort();
    Ok(paths)
}

/// Adds the files below a folder whose names have the word `hard`.
fn hard_files(folder: &Path, files: &mut Vec<PathBuf>) -> Result<(), XtaskError> {
    for path in sorted(folder)? {
        if path.is_dir() {
            hard_files(&path, files)?;
            continue;
        }
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let is_rust = path.extension().is_some_and(|ending| ending == "rs");
        if is_rust && stem.split('_').any(|word| word == "hard") {
            files.push(path);
        }
    }
    Ok(())
}

/// Runs all cases and writes the page.
///
/// # Errors
/// [`XtaskError`] where something does not build; a case that fails is named in the page and in the exit code.
pub fn hard_cases(workspace: &Workspace, _: &Options) -> Result<ExitCode, XtaskError> {
    let cases = cases(workspace.root())?;
    let venv = crate::prepare::prepare(workspace)?;
    let mut build = steps::cargo(workspace, &venv);
    build.args(["test", "--workspace"]);
    let targets: BTreeSet<&str> = cases.iter().map(|case| &*case.target).collect();
    for target in targets {
        build.args(["--test", target]);
    }
    let wanted: Vec<[&str; 3]> = (cases.iter())
        .map(|case| [&*case.package, &*case.target, &*case.test])
        .collect();
    let finished = rust_tests::run_named(build, &venv, &wanted, NLCP_PROBLEMS)?;
    let host = Host::find(workspace.root());
    let rows: Vec<(&Case, Option<&Finished>)> = (cases.iter())
        .map(|case| {
            let of_case = |f: &&Finished| {
                [&*f.package, &*f.target, &*f.test] == [&*case.package, &*case.target, &*case.test]
            };
            (case, finished.iter().find(of_case))
        })
        .collect();
    write_whole(&workspace.root().join(PAGE), &page(&host, &rows))?;
    let failed = rows
        .iter()
        .filter(|(_, f)| !f.is_some_and(|f| f.passed))
        .count();
    say(&format!(
        "\n{} hard cases, {failed} failed: {PAGE}",
        rows.len()
    ));
    Ok(ExitCode::from(u8::from(failed > 0)))
}

/// Figures that a page shows of a number at most: enough to see how a figure converges.
const SHOWN_DIGITS: usize = 7;

/// A text whose numbers with more figures than [`SHOWN_DIGITS`] are rounded.
fn in_short(text: &str) -> String {
    let mut short = String::new();
    let mut rest = text;
    while let Some(begin) = rest.find(|c: char| c.is_ascii_digit()) {
        let (before, number) = rest.split_at(begin);
        let end = number
            .find(|c: char| !(c.is_ascii_digit() || c == '.'))
            .unwrap_or(number.len());
        let (mantissa, after) = number.split_at(end);
        let digits = mantissa.trim_start_matches(['0', '.']);
        let count = digits.chars().filter(char::is_ascii_digit).count();
        short.push_str(before);
        match (mantissa.parse::<f64>(), mantissa.split_once('.')) {
            (Ok(value), Some((_, decimals))) if count > SHOWN_DIGITS => {
                let kept = decimals.len().saturating_sub(count - SHOWN_DIGITS);
                short.push_str(&format!("{value:.kept$}"));
            }
            _ => short.push_str(mantissa),
        }
        rest = after;
    }
    short + rest
}

/// The page.
fn page(host: &Host, rows: &[(&Case, Option<&Finished>)]) -> String {
    let total: Duration = rows.iter().filter_map(|(_, f)| *f).map(|f| f.time).sum();
    let mut page = format!(
        "# Hard cases\n\nWritten by `cargo xtask hard-cases`; do not edit.\n\n\
        | | |\n| --- | --- |\n| processor | {}, {} cores |\n| date | {} |\n| commit | {} |\n| cases | {}, {} one after another |\n\n\
        Each is a test in a file of `crates/*/tests` with `hard` in its name; CI runs all of them (of the random problems fewer). \
        *What*: what is hard, what must hold. *Found*: what the test prints.\n",
        host.cpu,
        host.cores,
        host.date,
        host.commit,
        rows.len(),
        readable(total)
    );
    let mut place = String::new();
    for (case, finished) in rows {
        let module = case.test.rsplit_once("::").map_or("", |(module, _)| module);
        let here = format!("{} {} {module}", case.package, case.target);
        if here != place {
            let file = [&*case.target, module].join("/").replace("::", "/");
            let file = file.trim_end_matches('/');
            let _ = write!(
                page,
                "\n## {}: {file}.rs\n\n| case | what | found | time |\n| --- | --- | --- | ---: |\n",
                case.package
            );
            place = here;
        }
        let (verdict, found, time) = match finished {
            Some(f) if f.passed => ("", in_short(&f.printed.join("<br>")), readable(f.time)),
            Some(f) => ("**FAILED** ", f.printed.join("<br>"), readable(f.time)),
            None => ("**NOT RUN** ", String::new(), String::new()),
        };
        let cell = |text: &str| text.replace('|', "\\|");
        let _ = writeln!(
            page,
            "| {verdict}{} | {} | {} | {time} |",
            case.title(),
            cell(&case.comment),
            cell(&found)
        );
    }
    page
}

#[cfg(test)]
mod tests {
    use super::*;

    const SOURCE: &str = "/// No case.\nfn helper() {}\n\n/// One ball:\n/// it carries.\n#[test]\nfn one_ball() {\n}\n\n\
        /// Long.\n#[test]\n#[ignore = \"long\"]\nfn long() {}\n";

    #[test]
    fn cases_are_read_with_their_comments() {
        let cases = Case::of_file(Path::new("bearings/tests/dynamic/hard_cases.rs"), SOURCE);
        let names: Vec<&str> = cases.iter().map(|case| &*case.test).collect();
        assert_eq!(names, ["hard_cases::one_ball", "hard_cases::long"]);
        assert_eq!(cases[0].comment, "One ball: it carries.");
        assert_eq!(
            (&*cases[0].package, &*cases[0].target),
            ("bearings", "dynamic")
        );
        assert_eq!(cases[0].title(), "one ball");
        let alone = Case::of_file(Path::new("contact/tests/hard_cases.rs"), SOURCE);
        assert_eq!(
            (&*alone[0].target, &*alone[0].test),
            ("hard_cases", "one_ball")
        );
    }

    #[test]
    fn long_numbers_are_rounded() {
        let text = "[12405.761537860184, -4.707098051431353e-6] 0.0008948564855751848 m, 1.2.3, 100000 steps, v2, 0.25";
        let short = "[12405.76, -4.707098e-6] 0.0008948565 m, 1.2.3, 100000 steps, v2, 0.25";
        assert_eq!(in_short(text), short);
    }

    /// Every case of the project says what is hard in it.
    #[test]
    fn every_case_has_a_comment() -> Result<(), XtaskError> {
        let cases = cases(Workspace::find()?.root())?;
        assert!(cases.len() >= 58, "{}", cases.len());
        let silent: Vec<String> = (cases.iter())
            .filter(|case| case.comment.is_empty())
            .map(|case| format!("{} {} {}", case.package, case.target, case.test))
            .collect();
        assert!(silent.is_empty(), "no word on what is hard: {silent:#?}");
        Ok(())
    }

    #[test]
    fn the_page_shows_what_failed() {
        let cases = Case::of_file(Path::new("contact/tests/hard_cases.rs"), SOURCE);
        let host = Host {
            cpu: "Some CPU".into(),
            cores: 2,
            memory: String::new(),
            system: String::new(),
            date: "today".into(),
            commit: "abc".into(),
        };
        let finished = Finished {
            package: "contact".into(),
            target: "hard_cases".into(),
            test: "one_ball".into(),
            passed: false,
            time: Duration::from_millis(1500),
            printed: vec!["a | b".into(), "c".into()],
        };
        let page = page(&host, &[(&cases[0], Some(&finished)), (&cases[1], None)]);
        for part in [
            "| cases | 2, 1.5 s one after another |",
            "## contact: hard_cases.rs",
            "| **FAILED** one ball | One ball: it carries. | a \\| b<br>c | 1.5 s |",
            "| **NOT RUN** long | Long. |  |  |",
        ] {
            assert!(page.contains(part), "{part}\n{page}");
        }
    }
}
