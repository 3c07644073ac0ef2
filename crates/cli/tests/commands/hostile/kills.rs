//! Commands killed at moments all over their work: a folder that belongs together is there whole or not at all, a file
//! is the old one, whole, or not there; the next call needs no tidying.

use crate::common::{send, succeeds};
use crate::hostile::bench::{Bench, Names};
use crate::hostile::links::{files, tidy};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Kills of each command.
const KILLS: u32 = 6;

/// What a command has made that is not hidden: whole HDF5 files by their names (they hold times), others by what is in
/// them.
fn made(bench: &Bench, before: &BTreeSet<PathBuf>) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    for name in files(bench.folder()).difference(before) {
        let parts = || name.iter().map(|part| part.to_string_lossy());
        if parts().any(|part| part.starts_with('.') || part.ends_with(".part")) {
            continue;
        }
        let path = bench.folder().join(name);
        let is_hdf5 = path.extension().is_some_and(|ending| ending == "h5");
        let content = if is_hdf5 {
            succeeds(&[Path::new("check"), &path]);
            Vec::new()
        } else {
            std::fs::read(&path).unwrap()
        };
        found.insert(name.clone(), content);
    }
    found
}

#[test]
fn killed_at_any_moment_a_command_leaves_nothing_half() {
    let bench = Bench::new(Names::Plain);
    let before = files(bench.folder());
    let mut random = fastrand::Rng::with_seed(5);
    for (words, is_one) in [
        ("import box.rexs -o out --no-run", true),
        (
            "record curves.csv -o out --title t --source s --angle-origin a --column te_um_50Nm=TE",
            true,
        ),
        ("reduce gear.toml -o o.h5 --no-error-estimate", true),
        ("run pair.toml -o o.h5", true),
        ("run wheel.toml -o o.h5", true),
        ("study study.toml -o out", false),
    ] {
        let begun = Instant::now();
        let answer = bench.run(words);
        assert_eq!(answer.code, Some(0), "{words}: {answer:#?}");
        let taken = begun.elapsed();
        let whole = made(&bench, &before);
        assert!(!whole.is_empty());
        tidy(bench.folder(), &before);
        let mut ended = 0;
        for kill in 0..KILLS {
            let moment = (f64::from(kill) + random.f64()) / f64::from(KILLS);
            let mut child = bench.command(words).spawn().unwrap();
            std::thread::sleep(Duration::from_secs_f64(moment * taken.as_secs_f64()));
            ended += u32::from(child.try_wait().unwrap().is_some());
            send("-KILL", child.id());
            child.wait().unwrap();
            let found = made(&bench, &before);
            for (name, content) in &found {
                assert_eq!(whole.get(name), Some(content), "{words}: {name:?} is half");
            }
            assert!(
                !is_one || found.is_empty() || found == whole,
                "{words} left {:?}",
                found.keys()
            );
        }
        assert!(ended < KILLS, "{words}: no call was killed");
        // Over what the killed ones left: all is there, and nothing else.
        let answer = bench.run(words);
        assert_eq!(answer.code, Some(0), "{words}: {answer:#?}");
        assert_eq!(made(&bench, &before), whole, "{words}");
        let left: Vec<PathBuf> = files(bench.folder()).difference(&before).cloned().collect();
        assert_eq!(left.len(), whole.len(), "{words} left {left:?}");
        tidy(bench.folder(), &before);
    }
}
