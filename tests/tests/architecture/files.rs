//! The files of the project.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .parent()
        .expect("tests/ is inside the project")
        .to_owned()
}

pub fn relative(file: &Path) -> String {
    file.strip_prefix(root())
        .unwrap_or(file)
        .to_string_lossy()
        .into_owned()
}

pub fn read(file: &Path) -> String {
    fs::read_to_string(file).unwrap_or_else(|error| panic!("{}: {error}", file.display()))
}

pub fn rust_files(below: &str) -> Vec<PathBuf> {
    let dir = root().join(below);
    let is_wanted =
        |file: &PathBuf| file.starts_with(&dir) && file.extension().is_some_and(|end| end == "rs");
    all_files().into_iter().filter(is_wanted).collect()
}

/// Every file that belongs to the project, sorted: what git lists, or, in an unpacked archive, what lies there
/// without the directories that are made.
pub fn all_files() -> Vec<PathBuf> {
    let listed = Command::new("git")
        .current_dir(root())
        .args([
            "ls-files",
            "-z",
            "--cached",
            "--others",
            "--exclude-standard",
        ])
        .output();
    let mut files = match listed {
        Ok(output) if output.status.success() => String::from_utf8_lossy(&output.stdout)
            .split_terminator('\0')
            .map(|name| root().join(name))
            .filter(|file| file.is_file())
            .collect(),
        _ => {
            let mut files = Vec::new();
            walk(&root(), &mut files);
            files
        }
    };
    files.sort();
    assert!(!files.is_empty(), "no files found in {}", root().display());
    files
}

pub fn walk(dir: &Path, files: &mut Vec<PathBuf>) {
    const MADE: [&str; 5] = [".git", ".venv", "target", "out", "__pycache__"];
    for entry in fs::read_dir(dir).expect("a readable directory") {
        let path = entry.expect("a readable entry").path();
        let is_made = path
            .file_name()
            .is_some_and(|name| MADE.iter().any(|made| name == *made));
        if is_made || path.is_symlink() {
            continue;
        }
        if path.is_dir() {
            walk(&path, files);
        } else {
            files.push(path);
        }
    }
}
