//! What a command reads is never what it writes: told before anything is computed, however the two are spelled.

use crate::arguments::Command;
use gearmesh_operations::Failure;
use std::path::PathBuf;

/// Refuses an output that is a symbolic link, or that is one of the files that the command reads: an argument, or what
/// scenes, studies and gear files among the arguments name.
///
/// # Errors
/// [`Failure`] that names both.
pub fn refuse(command: &Command) -> Result<(), Failure> {
    let (inputs, outputs) = files(command);
    gearmesh_operations::overwriting::refuse(inputs, &outputs)
}

/// What a command reads and writes, as far as its arguments say it.
fn files(command: &Command) -> (Vec<PathBuf>, Vec<PathBuf>) {
    let some = |path: &Option<PathBuf>| path.iter().cloned().collect::<Vec<_>>();
    let record = |folder: &PathBuf| ["record.toml", "data.csv"].map(|name| folder.join(name));
    match command {
        Command::Reduce(a) => (vec![a.gear.clone()], vec![a.output.clone()]),
        Command::Run(a) => (vec![a.scene.clone()], vec![a.output.clone()]),
        Command::Record(a) => {
            let files = a.output.iter().flat_map(record);
            (vec![a.measured.clone()], files.collect())
        }
        Command::Signal(a) => match a.analysis.series() {
            Some(a) => (vec![a.result.clone()], some(&a.output)),
            None => Default::default(),
        },
        Command::Study(a) => (
            vec![a.study.clone()],
            ["study.csv", "study.html"]
                .map(|name| a.output.join(name))
                .into(),
        ),
        Command::Bearing(a) => (vec![a.bearing.clone()], some(&a.report)),
        // Operations that refuse it themselves, and commands without an output.
        Command::Mesh(_)
        | Command::Modes(_)
        | Command::Recover(_)
        | Command::Export(_)
        | Command::Report(_)
        | Command::Accuracy(_)
        | Command::Optimise(_)
        | Command::Tca(_)
        | Command::BearingFrequencies(_)
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
