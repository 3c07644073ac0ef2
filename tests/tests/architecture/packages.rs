//! The packages of the workspace and what they depend on.

use std::collections::BTreeSet;
use std::process::Command;

use serde_json::Value;

use crate::files::root;

/// Which dependencies of a package count.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Kinds {
    All,
    WithoutTests,
}

/// The packages of the workspace as `cargo metadata` lists them.
pub fn packages() -> Vec<Value> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let output = Command::new(cargo)
        .current_dir(root())
        .args(["metadata", "--no-deps", "--format-version", "1"])
        .output()
        .expect("cargo starts");
    assert!(
        output.status.success(),
        "cargo metadata failed: {}",
        String::from_utf8_lossy(&output.stderr)
    );
    let metadata: Value =
        serde_json::from_slice(&output.stdout).expect("cargo metadata prints JSON");
    metadata["packages"]
        .as_array()
        .expect("a list of packages")
        .clone()
}

pub fn text<'a>(value: &'a Value, key: &str) -> &'a str {
    value[key]
        .as_str()
        .unwrap_or_else(|| panic!("cargo metadata has no text `{key}`"))
}

pub fn dependencies(package: &Value, kinds: Kinds) -> BTreeSet<String> {
    let listed = package["dependencies"]
        .as_array()
        .expect("a list of dependencies");
    let counts =
        |dependency: &&Value| kinds == Kinds::All || dependency["kind"].as_str() != Some("dev");
    listed
        .iter()
        .filter(counts)
        .map(|dependency| text(dependency, "name").to_owned())
        .collect()
}
