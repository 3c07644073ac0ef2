//! Fuzzing: whatever stands in a file, its reader answers with a value or an error, never with a panic, an endless
//! loop or a full memory.
//!
//! The normal tests make a few hundred cases of each target, always the same ones. With `GEARMESH_FUZZ_SECONDS` each
//! target goes on for that time with cases that no run has had; how to: docs/fuzzing.md. A case that fails is kept in
//! `target/fuzz-findings`; mended, it becomes a file in `regressions/TARGET`, which every run begins with.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stdout,
    clippy::print_stderr,
    missing_docs
)]

#[path = "../common/mod.rs"]
mod common;
#[path = "../../../scene/tests/made_up_gears/drilled_pair.rs"]
mod drilled_pair;
mod files;
mod mutation;
mod numbers;
#[path = "../../../contact/tests/pair_common/mod.rs"]
mod pair_common;
mod parts;
mod results;
mod trees;

use common::root;
use cpu_time::ProcessTime;
use fastrand::Rng;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

/// A case that takes more of the processor is a finding: beside other work the time on the clock says nothing.
const LONGEST: Duration = Duration::from_secs(10);

/// Runs the cases of a target: the regression files, then what `make` makes, `usual` cases or as long as the
/// environment says.
pub fn fuzz(target: &str, usual: u64, make: impl Fn(&mut Rng) -> Vec<u8>, read: impl Fn(&[u8])) {
    let findings = root().join("target/fuzz-findings");
    std::fs::create_dir_all(&findings).unwrap();
    let current = findings.join(format!("{target}-current"));
    let mut found = Vec::new();
    let mut try_case = |case: &[u8], keep: bool| {
        if keep {
            // What ends the whole process leaves its case here.
            std::fs::write(&current, case).unwrap();
        }
        let begun = ProcessTime::now();
        let outcome = catch_unwind(AssertUnwindSafe(|| read(case)));
        let taken = begun.elapsed();
        if outcome.is_err() || taken > LONGEST {
            let digest = gearmesh_model::bytes_digest(case);
            let path = findings.join(format!("{target}-{}", &digest[..12]));
            std::fs::write(&path, case).unwrap();
            let what = if outcome.is_err() { "panic" } else { "slow" };
            found.push(format!(
                "{what} ({:.1} s): {}",
                taken.as_secs_f64(),
                path.display()
            ));
        }
    };
    let regressions = root()
        .join("crates/cli/tests/fuzz/regressions")
        .join(target);
    for entry in std::fs::read_dir(regressions).into_iter().flatten() {
        try_case(&std::fs::read(entry.unwrap().path()).unwrap(), false);
    }
    let seconds = std::env::var("GEARMESH_FUZZ_SECONDS").ok();
    let seconds = seconds.map(|text| {
        text.parse::<u64>()
            .expect("GEARMESH_FUZZ_SECONDS: whole seconds")
    });
    let mut random = match seconds {
        None => Rng::with_seed(11),
        Some(_) => Rng::new(),
    };
    let (begun, mut count) = (Instant::now(), 0);
    while match seconds {
        None => count < usual,
        Some(seconds) => begun.elapsed() < Duration::from_secs(seconds),
    } {
        try_case(&make(&mut random), true);
        count += 1;
    }
    println!(
        "{target}: {count} cases in {:.1} s",
        begun.elapsed().as_secs_f64()
    );
    assert!(
        found.is_empty(),
        "{} findings:\n{}",
        found.len(),
        found.join("\n")
    );
    let _ = std::fs::remove_file(current);
}
