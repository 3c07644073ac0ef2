//! Every package by itself builds its dependencies with the features that the whole workspace gives them.

use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;

use crate::assert_no_faults;
use crate::files::root;
use crate::packages::{packages, text};

/// Package of a registry to the sets of features with which it is built, as `cargo tree` lists them.
type Features = BTreeMap<String, BTreeSet<String>>;

/// Dependencies of tests, too.
const ALL: &str = "normal,build,dev";

fn features(edges: &str, selection: &[&str]) -> Features {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let output = Command::new(cargo)
        .current_dir(root())
        .args(["tree", "--locked", "--prefix", "none", "--no-dedupe"])
        .args(["-e", edges, "-f", "{p}|{f}"])
        .args(selection)
        .output()
        .expect("cargo starts");
    assert!(
        output.status.success(),
        "cargo tree failed: {}",
        String::from_utf8_lossy(&output.stderr)
    );
    let mut found = Features::new();
    for line in String::from_utf8_lossy(&output.stdout).lines() {
        let Some((package, features)) = line.split_once('|') else {
            continue;
        };
        // Packages of the workspace have a path behind their version.
        if !package.contains('/') {
            let sets = found.entry(package.to_owned()).or_default();
            sets.insert(features.to_owned());
        }
    }
    found
}

/// What is built of `selection` with other features than tests of the whole workspace build.
fn faults_of(whole: &Features, (edges, selection): (&str, &[&str]), command: &str) -> Vec<String> {
    let mut faults = Vec::new();
    for (used, sets) in features(edges, selection) {
        let known = whole.get(&used);
        for set in sets
            .iter()
            .filter(|&set| !known.is_some_and(|all| all.contains(set)))
        {
            faults.push(format!(
                "`{command}` builds {used} with the features [{set}], `cargo test --workspace` with {known:?}, so that \
                 what stands on it is compiled again: name the missing ones in tools/one_feature_set/Cargo.toml"
            ));
        }
    }
    faults
}

fn whole() -> Features {
    let whole = features(ALL, &["--workspace"]);
    assert!(whole.len() > 100, "cargo tree lists too few packages");
    whole
}

#[test]
fn a_package_by_itself_has_the_features_of_the_workspace() {
    let whole = whole();
    let mut faults = Vec::new();
    for package in packages() {
        let name = text(&package, "name");
        if name.starts_with("gearmesh-") {
            let command = format!("cargo test -p {name}");
            faults.extend(faults_of(&whole, (ALL, &["-p", name]), &command));
        }
    }
    assert_no_faults(&faults);
}

#[test]
fn a_build_without_tests_has_the_features_of_tests() {
    let selection = ("normal,build", &["--workspace"][..]);
    assert_no_faults(&faults_of(&whole(), selection, "cargo build --workspace"));
}
