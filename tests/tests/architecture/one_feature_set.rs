//! Every package by itself builds its dependencies with the features that the whole workspace gives them.

use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;

use crate::assert_no_faults;
use crate::files::root;
use crate::packages::{packages, text};

/// Package of a registry to the sets of features with which it is built, as `cargo tree` lists them.
type Features = BTreeMap<String, BTreeSet<String>>;

fn features(selection: &[&str]) -> Features {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let output = Command::new(cargo)
        .current_dir(root())
        .args(["tree", "--locked", "--prefix", "none", "--no-dedupe"])
        .args(["-e", "normal,build,dev", "-f", "{p}|{f}"])
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

#[test]
fn a_package_by_itself_has_the_features_of_the_workspace() {
    let whole = features(&["--workspace"]);
    assert!(whole.len() > 100, "cargo tree lists too few packages");
    let mut faults = Vec::new();
    for package in packages() {
        let name = text(&package, "name");
        if !name.starts_with("gearmesh-") {
            continue;
        }
        for (used, sets) in features(&["-p", name]) {
            let known = whole.get(&used);
            for set in sets
                .iter()
                .filter(|&set| !known.is_some_and(|all| all.contains(set)))
            {
                faults.push(format!(
                    "`cargo test -p {name}` builds {used} with the features [{set}], the workspace with {known:?}, so \
                     that what stands on it is compiled again: name the missing ones in tools/one_feature_set/Cargo.toml"
                ));
            }
        }
    }
    assert_no_faults(&faults);
}
