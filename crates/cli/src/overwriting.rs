//! What a command reads is never what it writes: told before anything is computed, however the two are spelled.

use crate::arguments::Command;
use crate::failure::Failure;
use gearmesh_geometry::input::{InputDocument, MOST_TEXT_BYTES, demand_readable};
use gearmesh_model::FileError;
use gearmesh_scene::named_files;
use std::path::{Path, PathBuf};

/// Refuses an output that is a symbolic link, or that is one of the files that the command reads: an argument, or what
/// scenes, studies and gear files among the arguments name.
///
/// # Errors
/// [`Failure`] that names both.
pub fn refuse(command: &Command) -> Result<(), Failure> {
    let (inputs, outputs) = files(command);
    // Most outputs are new.
    if outputs.iter().all(|path| path.symlink_metadata().is_err()) {
        return Ok(());
    }
    let inputs = with_named(inputs);
    outputs.iter().try_for_each(|output| apart(output, &inputs))
}

/// Refuses an output that is one of the inputs.
///
/// # Errors
/// [`Failure`] that names both.
pub fn apart(output: &Path, inputs: &[PathBuf]) -> Result<(), Failure> {
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

/// What a command reads and writes, as far as its arguments say it.
fn files(command: &Command) -> (Vec<PathBuf>, Vec<PathBuf>) {
    let some = |path: &Option<PathBuf>| path.iter().cloned().collect::<Vec<_>>();
    let record = |folder: &PathBuf| ["record.toml", "data.csv"].map(|name| folder.join(name));
    match command {
        Command::Mesh(a) => (vec![a.gear.clone()], vec![a.output.clone()]),
        Command::Reduce(a) => (vec![a.gear.clone()], vec![a.output.clone()]),
        Command::Modes(a) => (vec![a.gear.clone()], some(&a.shapes)),
        Command::Run(a) => (vec![a.scene.clone()], vec![a.output.clone()]),
        Command::Recover(a) => {
            let further = some(&a.field_output).into_iter();
            let outputs = further.chain([a.output.clone()]).collect();
            (vec![a.result.clone()], outputs)
        }
        Command::Export(a) => {
            let inputs = vec![a.result.clone(), a.result.join("study.csv")];
            (inputs, vec![a.output.clone()])
        }
        Command::Record(a) => {
            let files = a.output.iter().flat_map(record);
            (vec![a.measured.clone()], files.collect())
        }
        Command::Report(a) => {
            let records = a.reference.iter().flat_map(record);
            let inputs = a.results.iter().cloned().chain(records).collect();
            (inputs, vec![a.output.clone()])
        }
        Command::Signal(a) => match a.analysis.series() {
            Some(a) => (vec![a.result.clone()], some(&a.output)),
            None => Default::default(),
        },
        Command::Accuracy(a) => (vec![a.scene.clone()], some(&a.output)),
        Command::Optimise(a) => {
            let names = ["front.csv", "tried.csv", "optimise.html"];
            (
                vec![a.file.clone()],
                names.map(|name| a.output.join(name)).into(),
            )
        }
        Command::Study(a) => (
            vec![a.study.clone()],
            ["study.csv", "study.html"]
                .map(|name| a.output.join(name))
                .into(),
        ),
        Command::Tca(a) => (vec![a.pair.clone()], some(&a.report)),
        Command::Bearing(a) => (vec![a.bearing.clone()], some(&a.report)),
        Command::BearingFrequencies(_)
        | Command::Bevel(_)
        | Command::Compliance(_)
        | Command::Plan(_)
        | Command::Compare(_)
        | Command::Check(_)
        | Command::Import(_)
        | Command::Init(_)
        | Command::Doctor(_)
        | Command::Completions(_)
        | Command::Man(_)
        | Command::Schema(_)
        | Command::Studio(_)
        | Command::Demo(_) => Default::default(),
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
