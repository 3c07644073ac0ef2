//! What an operation reads is never what it writes, however the two are spelled.

use crate::failure::{Failure, Result};
use gearmesh_geometry::input::{InputDocument, MOST_TEXT_BYTES, demand_readable};
use gearmesh_model::FileError;
use gearmesh_scene::named_files;
use std::path::{Path, PathBuf};

/// Refuses outputs that are symbolic links, or one of the files that are read: these, or what scenes, studies and gear
/// files among them name.
///
/// # Errors
/// [`Failure`] that names both.
pub fn refuse(inputs: Vec<PathBuf>, outputs: &[PathBuf]) -> Result<()> {
    // Most outputs are new.
    if outputs.iter().all(|path| path.symlink_metadata().is_err()) {
        return Ok(());
    }
    let inputs = with_named(inputs);
    outputs.iter().try_for_each(|output| apart(output, &inputs))
}

/// As [`refuse`], of the files that a text in memory names, relative to `folder`, and of the file that it was read
/// from.
///
/// # Errors
/// [`Failure`] that names both.
pub fn refuse_named(text: &str, [file, folder]: [&Path; 2], output: &Path) -> Result<()> {
    let named = named_files(text, folder).into_values();
    let inputs = named.chain([file.to_owned()]).collect();
    refuse(inputs, &[output.to_owned()])
}

/// Refuses an output that is one of the inputs.
///
/// # Errors
/// [`Failure`] that names both.
pub fn apart(output: &Path, inputs: &[PathBuf]) -> Result<()> {
    let path = output.to_owned();
    match output.symlink_metadata() {
        Err(_) => return Ok(()),
        Ok(found) if found.is_symlink() => {
            return Err(Failure::input(FileError::OutputIsALink { path }));
        }
        Ok(_) => {}
    }
    match inputs.iter().find(|input| is_same(output, input)) {
        None => Ok(()),
        Some(input) => Err(Failure::input(format!(
            "{} is read by this command ({}); name another output file",
            output.display(),
            input.display()
        ))),
    }
}

/// The files, and those that TOML files among them name, and so on.
fn with_named(mut files: Vec<PathBuf>) -> Vec<PathBuf> {
    let mut next = 0;
    while let Some(path) = files.get(next).cloned() {
        next += 1;
        let is_toml = path.extension().is_some_and(|ending| ending == "toml");
        if !is_toml || demand_readable(&path, MOST_TEXT_BYTES).is_err() {
            continue;
        }
        let Ok(document) = InputDocument::read(&path) else {
            continue;
        };
        let folder = path.parent().unwrap_or(Path::new(""));
        for named in named_files(&document.text, folder).into_values() {
            if !files.iter().any(|known| is_same(known, &named)) {
                files.push(named);
            }
        }
    }
    files
}

/// Whether two paths lead to the same file: through links, hard links, or spelled differently.
fn is_same(a: &Path, b: &Path) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        match (a.metadata(), b.metadata()) {
            (Ok(a), Ok(b)) => (a.dev(), a.ino()) == (b.dev(), b.ino()),
            _ => false,
        }
    }
    #[cfg(not(unix))]
    {
        match (a.canonicalize(), b.canonicalize()) {
            (Ok(a), Ok(b)) => a == b,
            _ => false,
        }
    }
}
