//! `cargo xtask figures`: the pages whose figures were measured, and which of them are older than the code.
//!
//! Each such page says in its head on which commit, day and processor it was made. It is stale where the code has
//! changed since, where it was made with changes that no commit has, or on another processor than this one: figures of
//! one kind are compared with each other, so they should be of one machine.

use std::io::Write;
use std::path::Path;
use std::process::{Command, ExitCode};

use crate::bench::{self, Host, Options};
use crate::console::say;
use crate::error::XtaskError;
use crate::workspace::Workspace;

/// A page that a command measures and writes.
pub struct Page {
    /// Words of the command behind `cargo xtask`.
    pub words: &'static [&'static str],
    /// The page, from the project's root.
    pub path: &'static str,
    /// Makes it.
    pub make: fn(&Workspace, &Options) -> Result<ExitCode, XtaskError>,
    /// Whether it takes `--quick` and `--program`.
    pub has_options: bool,
    /// What it takes on two cores where that is more than some minutes.
    pub long: Option<&'static str>,
}

/// All pages; of two whose words begin alike the longer one comes first.
pub const PAGES: [Page; 9] = [
    Page {
        words: &["bench", "chain"],
        path: "docs/benchmarks/chain.md",
        make: bench::chain,
        has_options: false,
        long: None,
    },
    Page {
        words: &["bench", "bearings"],
        path: "docs/benchmarks/bearings.md",
        make: bench::bearings,
        has_options: false,
        long: None,
    },
    Page {
        words: &["bench", "offline"],
        path: "docs/benchmarks/offline.md",
        make: bench::offline,
        has_options: true,
        long: Some("a quarter of an hour"),
    },
    Page {
        words: &["accuracy-cost", "bearings"],
        path: "docs/benchmarks/bearing-models.md",
        make: bench::bearing_models,
        has_options: true,
        long: None,
    },
    Page {
        words: &["accuracy-cost", "elements"],
        path: "docs/benchmarks/elements.md",
        make: bench::elements,
        has_options: true,
        long: Some("an hour"),
    },
    Page {
        words: &["accuracy-cost", "bevel-machines"],
        path: "docs/benchmarks/bevel-machines.md",
        make: bench::bevel_machines,
        has_options: true,
        long: Some("a quarter of an hour"),
    },
    Page {
        words: &["accuracy-cost", "whole-machines"],
        path: "docs/benchmarks/whole-machines.md",
        make: bench::whole_machines,
        has_options: true,
        long: Some("a quarter of an hour"),
    },
    Page {
        words: &["accuracy-cost"],
        path: "docs/accuracy-cost.md",
        make: bench::accuracy_cost,
        has_options: true,
        long: Some("half an hour"),
    },
    Page {
        words: &["hard-cases"],
        path: "docs/hard-cases.md",
        make: crate::hard_cases::hard_cases,
        has_options: false,
        long: None,
    },
];

impl std::fmt::Debug for Page {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.path)
    }
}

impl PartialEq for Page {
    fn eq(&self, other: &Self) -> bool {
        self.path == other.path
    }
}

impl Eq for Page {}

impl Page {
    /// The page whose command the words begin with, and the words behind it.
    pub fn named<'a>(words: &'a [&'a str]) -> Option<(&'static Self, &'a [&'a str])> {
        let page = PAGES.iter().find(|page| words.starts_with(page.words))?;
        Some((page, &words[page.words.len()..]))
    }

    /// The command without `cargo xtask`.
    pub fn command(&self) -> String {
        self.words.join(" ")
    }

    /// What the page is called on the command line: its path without folders and ending.
    fn name(&self) -> &'static str {
        let stem = Path::new(self.path).file_stem();
        stem.and_then(|stem| stem.to_str()).unwrap_or(self.path)
    }
}

/// What `cargo xtask figures` is to do.
#[derive(Debug, PartialEq, Eq)]
pub enum Which {
    /// List all pages.
    List,
    /// Make the stale ones that are not long.
    Stale,
    /// Make these.
    Named(Vec<&'static Page>),
}

impl Which {
    /// Reads the words behind `figures`; the error is a sentence for the user.
    pub fn parse(words: &[&str]) -> Result<Self, String> {
        let named = |word: &&str| {
            PAGES
                .iter()
                .find(|page| page.name() == *word)
                .ok_or_else(|| {
                    let names: Vec<&str> = PAGES.iter().map(Page::name).collect();
                    format!(
                        "no page is called `{word}`; there are: {} (or `--made`)",
                        names.join(", ")
                    )
                })
        };
        match words {
            [] => Ok(Self::List),
            ["--made"] => Ok(Self::Stale),
            words => words
                .iter()
                .map(named)
                .collect::<Result<_, _>>()
                .map(Self::Named),
        }
    }
}

/// What a page says of its making.
#[derive(Debug, PartialEq, Eq)]
struct Made {
    processor: String,
    date: String,
    commit: String,
    is_clean: bool,
}

impl Made {
    /// The rows of the table in the page's head.
    fn of(page: &str) -> Option<Self> {
        let row = |key: &str| {
            let start = format!("| {key} | ");
            let line = page.lines().find_map(|line| line.strip_prefix(&start))?;
            Some(line.trim_end_matches(['|', ' ']).to_owned())
        };
        let commit = row("commit")?;
        Some(Self {
            // "name, 2 cores"
            processor: row("processor")?.rsplit_once(", ")?.0.to_owned(),
            date: row("date")?,
            is_clean: commit.ends_with("clean tree"),
            commit: commit.split([',', ' ']).next()?.to_owned(),
        })
    }

    /// Why figures made so are no longer those of today's code here; nothing where they are.
    fn stale_because(&self, root: &Path, host: &Host) -> Vec<String> {
        let mut reasons = Vec::new();
        if !self.is_clean {
            reasons.push("made with changes that no commit has".to_owned());
        }
        match commits_since(root, &self.commit) {
            Some(0) => {}
            Some(count) => reasons.push(format!("the code has {count} commits more")),
            None => reasons.push("its commit is not known here".to_owned()),
        }
        if self.processor != host.cpu {
            reasons.push(format!("made on another processor, {}", self.processor));
        }
        reasons
    }
}

/// Commits after `commit` that change what is measured.
fn commits_since(root: &Path, commit: &str) -> Option<usize> {
    let range = format!("{commit}..HEAD");
    let output = Command::new("git")
        .current_dir(root)
        .args(["rev-list", "--count", &range, "--"])
        .args(["crates", "fe_models", "tools", "Cargo.toml", "Cargo.lock"])
        .output()
        .ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().parse().ok())?
}

/// Lists the pages or makes some of them again.
///
/// # Errors
/// [`XtaskError`] of the page that could not be made; those before it are written.
pub fn figures(workspace: &Workspace, which: &Which) -> Result<ExitCode, XtaskError> {
    let host = Host::find(workspace.root());
    let mut again = Vec::new();
    for page in &PAGES {
        let path = workspace.root().join(page.path);
        let text = std::fs::read_to_string(&path).unwrap_or_default();
        let (made, reasons) = match Made::of(&text) {
            Some(made) => {
                let reasons = made.stale_because(workspace.root(), &host);
                (format!("{}, {:.10}", made.date, made.commit), reasons)
            }
            None => ("no date".to_owned(), vec!["not made yet".to_owned()]),
        };
        let verdict = match reasons.is_empty() {
            true => "as the code is".to_owned(),
            false => format!("STALE: {}", reasons.join("; ")),
        };
        let time = page
            .long
            .map_or(String::new(), |time| format!(" (takes {time})"));
        let line = format!("{}: {made}: {verdict}{time}\n", page.name());
        // A closed stdout is not an error.
        let _ = std::io::stdout().write_all(line.as_bytes());
        if !reasons.is_empty() && page.long.is_none() {
            again.push(page);
        }
    }
    let pages = match which {
        Which::List => return Ok(ExitCode::SUCCESS),
        Which::Stale => again,
        Which::Named(pages) => pages.clone(),
    };
    for page in pages {
        say(&format!("\n== cargo xtask {}", page.command()));
        let code = (page.make)(workspace, &Options::default())?;
        if code != ExitCode::SUCCESS {
            return Ok(code);
        }
    }
    Ok(ExitCode::SUCCESS)
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "# Time\n\nWritten by `x`; do not edit.\n\n| | |\n| --- | --- |\n| processor | Some CPU, 2 cores |\n\
        | memory | 25 GB |\n| date | 2026-11-23 00:55 UTC |\n| commit | 7304f62b, clean tree |\n";

    fn host(cpu: &str) -> Host {
        let text = String::new;
        Host {
            cpu: cpu.into(),
            cores: 2,
            memory: text(),
            system: text(),
            date: text(),
            commit: text(),
        }
    }

    #[test]
    fn the_head_of_a_page_is_read() {
        let made = Made::of(HEAD);
        let expected = Made {
            processor: "Some CPU".into(),
            date: "2026-11-23 00:55 UTC".into(),
            commit: "7304f62b".into(),
            is_clean: true,
        };
        assert_eq!(made, Some(expected));
        let changed = HEAD.replace(", clean tree", " with uncommitted changes");
        assert_eq!(
            Made::of(&changed).map(|made| (made.commit, made.is_clean)),
            Some(("7304f62b".into(), false))
        );
        assert_eq!(Made::of("# A page without a head"), None);
    }

    #[test]
    fn a_page_of_another_processor_or_commit_is_stale() -> Result<(), XtaskError> {
        let workspace = Workspace::find()?;
        let head = Command::new("git")
            .current_dir(workspace.root())
            .args(["rev-parse", "HEAD"])
            .output()
            .map_err(XtaskError::io(|| "git".into()))?;
        let head = String::from_utf8_lossy(&head.stdout).trim().to_owned();
        let made = |commit: &str, is_clean| Made {
            processor: "Some CPU".into(),
            date: String::new(),
            commit: commit.to_owned(),
            is_clean,
        };
        let reasons = |made: Made, cpu: &str| made.stale_because(workspace.root(), &host(cpu));
        if !head.is_empty() {
            assert_eq!(reasons(made(&head, true), "Some CPU"), Vec::<String>::new());
            assert_eq!(reasons(made(&head, true), "another").len(), 1);
            assert_eq!(reasons(made(&head, false), "another").len(), 2);
        }
        let unknown = reasons(made("0000000000", true), "Some CPU");
        assert_eq!(unknown, ["its commit is not known here"]);
        Ok(())
    }

    /// Every page that names a command and a commit is in the list, and the list's pages name their commands.
    #[test]
    fn the_list_is_whole() -> Result<(), XtaskError> {
        let root = Workspace::find()?.root().to_owned();
        let mut found = Vec::new();
        for folder in ["docs", "docs/benchmarks"] {
            let entries = std::fs::read_dir(root.join(folder))
                .map_err(XtaskError::io(|| folder.to_owned()))?;
            for entry in entries.flatten().filter(|entry| entry.path().is_file()) {
                let text = std::fs::read_to_string(entry.path()).unwrap_or_default();
                if text.lines().any(|line| line.starts_with("| commit | ")) {
                    found.push(format!("{folder}/{}", entry.file_name().to_string_lossy()));
                }
            }
        }
        found.retain(|path| PAGES.iter().all(|page| page.path != path));
        assert!(found.is_empty(), "no command makes {found:?}");
        for page in &PAGES {
            let text = std::fs::read_to_string(root.join(page.path)).unwrap_or_default();
            let command = format!("`cargo xtask {}`", page.command());
            assert!(
                text.is_empty() || text.contains(&command),
                "{} names {command}",
                page.path
            );
        }
        Ok(())
    }

    #[test]
    fn pages_are_named_by_their_files() {
        assert_eq!(Which::parse(&[]), Ok(Which::List));
        assert_eq!(Which::parse(&["--made"]), Ok(Which::Stale));
        let page = |path| PAGES.iter().find(|page| page.path == path);
        let both = ["docs/benchmarks/chain.md", "docs/accuracy-cost.md"].map(page);
        let both: Option<Vec<&Page>> = both.into_iter().collect();
        assert_eq!(
            Which::parse(&["chain", "accuracy-cost"]).ok(),
            both.map(Which::Named)
        );
        let wrong = Which::parse(&["chian"]).err().unwrap_or_default();
        assert!(
            wrong.contains("`chian`") && wrong.contains("bearing-models"),
            "{wrong}"
        );
    }
}
