//! The files that a scene or study names.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// All files that texts of a TOML document name, relative to `folder`: by the name in the document, sorted. A text that
/// only happens to be the name of a file is among them.
pub fn named_files(text: &str, folder: &Path) -> BTreeMap<String, PathBuf> {
    let mut found = BTreeMap::new();
    if let Ok(table) = text.parse::<toml::Table>() {
        collect(&toml::Value::Table(table), folder, &mut found);
    }
    found
}

fn collect(value: &toml::Value, folder: &Path, found: &mut BTreeMap<String, PathBuf>) {
    match value {
        toml::Value::String(name) => {
            let path = folder.join(name);
            if !name.is_empty() && path.is_file() {
                found.insert(name.clone(), path);
            }
        }
        toml::Value::Array(values) => values.iter().for_each(|v| collect(v, folder, found)),
        toml::Value::Table(table) => table.values().for_each(|v| collect(v, folder, found)),
        _ => {}
    }
}
