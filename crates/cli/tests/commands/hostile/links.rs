//! Every command among traps: it ends as it should, imports nothing of the working folder, and writes nothing through a
//! link that lies where an output goes.

use crate::hostile::bench::{Bench, Names};
use crate::hostile::commands::CASES;
use std::collections::BTreeSet;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};

/// Outputs of one command that are tried, of many files the first ones and the last.
const MOST_LINKS: usize = 4;

/// Files below a folder, by their paths in it; what a cluster keeps for itself is not looked at.
pub fn files(folder: &Path) -> BTreeSet<PathBuf> {
    let mut found = BTreeSet::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in std::fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() && !path.is_symlink() {
                folders.push(path);
            } else {
                found.insert(path.strip_prefix(folder).unwrap().to_owned());
            }
        }
    }
    found
}

/// Removes what a command has made.
pub fn tidy(folder: &Path, before: &BTreeSet<PathBuf>) {
    for made in files(folder).difference(before) {
        std::fs::remove_file(folder.join(made)).unwrap();
    }
    let entries = std::fs::read_dir(folder).unwrap();
    let folders = entries.map(|entry| entry.unwrap().path());
    for made in folders.filter(|path| path.is_dir() && !path.ends_with("record")) {
        std::fs::remove_dir_all(made).unwrap();
    }
}

/// A file that a command has made is a link now; the target is there every other time.
fn writes_through_no_link(bench: &Bench, words: &str, output: &Path, number: usize) {
    let link = bench.folder().join(output);
    std::fs::create_dir_all(link.parent().unwrap()).unwrap();
    let elsewhere = tempfile::tempdir().unwrap();
    let target = elsewhere.path().join("target");
    let old = (number % 2 == 1).then_some("what was there");
    if let Some(text) = old {
        std::fs::write(&target, text).unwrap();
    }
    symlink(&target, &link).unwrap();
    let answer = bench.run(words);
    let found = std::fs::read_to_string(&target).ok();
    assert_eq!(found.as_deref(), old, "{words}: written through {output:?}");
    // A folder of moments takes the place of the one that was there, links and all.
    if words.contains(".pvd") && answer.code == Some(0) {
        return;
    }
    assert!(link.is_symlink(), "{words}: {output:?} was replaced");
    assert!(answer.code != Some(0), "{words}, {output:?}: {answer:#?}");
    // `init` leaves what is there; a study says it of the case.
    let (name, told) = (
        output.file_name().unwrap().to_str().unwrap(),
        answer.stdout + &answer.stderr,
    );
    assert!(
        told.contains(name) && (told.contains("link") || told.contains("there already")),
        "{words}, {output:?}: {told}"
    );
}

#[test]
fn every_command_among_traps_and_links() {
    let bench = Bench::new(Names::Plain);
    let before = files(bench.folder());
    for case in CASES {
        let answer = bench.run(case.words);
        assert_eq!(answer.code, Some(case.code), "{}: {answer:#?}", case.words);
        let made: Vec<PathBuf> = files(bench.folder()).difference(&before).cloned().collect();
        tidy(bench.folder(), &before);
        // What a cluster writes beside the table takes seconds a try: its log alone is tried.
        let is_log = |path: &&PathBuf| path.ends_with("cluster.log");
        let own: Vec<&PathBuf> = (made.iter())
            .filter(|path| !case.words.contains("--scheduler") || is_log(path))
            .collect();
        let chosen =
            (own.iter().take(MOST_LINKS - 1)).chain(own.iter().skip(MOST_LINKS - 1).last());
        for (number, output) in chosen.enumerate() {
            writes_through_no_link(&bench, case.words, output, number);
            tidy(bench.folder(), &before);
        }
    }
    // The rows of a run that is not finished.
    let part = Path::new("o.h5.part/rows.log");
    writes_through_no_link(&bench, "run wheel.toml -o o.h5", part, 0);
    tidy(bench.folder(), &before);
    // The same of a study's case.
    let words = "study study.toml -o out";
    bench.run(words);
    let made = files(bench.folder());
    let case = made
        .iter()
        .find(|path| path.starts_with("out") && path.extension().is_some_and(|end| end == "h5"));
    let part = case.unwrap().with_extension("h5.part").join("rows.log");
    tidy(bench.folder(), &before);
    writes_through_no_link(&bench, words, &part, 1);
}
