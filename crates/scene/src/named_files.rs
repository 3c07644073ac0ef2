//! The files that a scene or study names.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use gearmesh_geometry::input::InputDocument;

/// All files that texts of a TOML document name, relative to `folder`: by the name in the document, sorted. A text that
/// only happens to be the name of a file is among them.
pub fn named_files(text: &str, folder: &Path) -> BTreeMap<String, PathBuf> {
    let mut found = BTreeMap::new();
    if let Ok(table) = text.parse::<toml::Table>() {
        collect(&toml::Value::Table(table), folder, &mut found);
    }
    found
}

/// The same with the files that TOML files among them name, and so on: by the names on the way, `pair.toml:
/// points.csv`. What a scene depends on.
pub fn named_files_and_theirs(text: &str, folder: &Path) -> BTreeMap<String, PathBuf> {
    let mut waiting: Vec<(String, PathBuf)> = named_files(text, folder).into_iter().collect();
    let mut found: BTreeMap<String, PathBuf> = BTreeMap::new();
    while let Some((name, path)) = waiting.pop() {
        // Files that name each other end here.
        if found.values().any(|known| *known == path) {
            found.insert(name, path);
            continue;
        }
        let is_toml = path.extension().is_some_and(|ending| ending == "toml");
        if let (true, Ok(document)) = (is_toml, InputDocument::read(&path)) {
            let beside = path.parent().unwrap_or(Path::new(""));
            let theirs = named_files(&document.text, beside).into_iter();
            waiting.extend(theirs.map(|(inner, path)| (format!("{name}: {inner}"), path)));
        }
        found.insert(name, path);
    }
    found
}

/// A TOML text with other names of files: texts that are one of the names, with an ending, are replaced.
///
/// # Errors
/// [`toml::de::Error`] and [`toml::ser::Error`] in words, where the text is no TOML.
pub fn renamed_files(text: &str, names: &BTreeMap<String, String>) -> Result<String, String> {
    let table: toml::Table = text.parse().map_err(|e: toml::de::Error| e.to_string())?;
    let mut root = toml::Value::Table(table);
    rename(&mut root, names);
    toml::to_string(&root).map_err(|e| e.to_string())
}

fn rename(value: &mut toml::Value, names: &BTreeMap<String, String>) {
    match value {
        // A name without an ending is that of a part, which only happens to be the name of a file.
        toml::Value::String(text) if text.contains('.') => {
            if let Some(other) = names.get(text) {
                other.clone_into(text);
            }
        }
        toml::Value::Array(items) => items.iter_mut().for_each(|item| rename(item, names)),
        toml::Value::Table(table) => table.iter_mut().for_each(|(_, item)| rename(item, names)),
        _ => {}
    }
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

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn files_of_files_are_found_once_and_renamed() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        std::fs::write(at("points.csv"), "1").unwrap();
        // They name each other.
        std::fs::write(at("pair.toml"), "a = \"points.csv\"\nb = \"other.toml\"").unwrap();
        std::fs::write(at("other.toml"), "a = \"pair.toml\"").unwrap();
        let scene = "[[gear_mesh]]\nbevel_pair = \"pair.toml\"\nname = \"pair\"";
        let found = named_files_and_theirs(scene, folder.path());
        let of = |name: &str| found.get(name).cloned();
        assert_eq!(of("pair.toml: points.csv"), Some(at("points.csv")));
        assert_eq!(of("pair.toml: other.toml"), Some(at("other.toml")));
        assert_eq!(found.len(), 4, "{found:?}");

        let names = BTreeMap::from([("pair.toml".to_owned(), "/elsewhere/p.toml".to_owned())]);
        let renamed = renamed_files(scene, &names).unwrap();
        let table: toml::Table = renamed.parse().unwrap();
        let mesh = table["gear_mesh"][0].as_table().unwrap();
        assert_eq!(mesh["bevel_pair"].as_str(), Some("/elsewhere/p.toml"));
        assert_eq!(mesh["name"].as_str(), Some("pair"));
        assert!(renamed_files("a = ", &names).is_err());
    }
}
