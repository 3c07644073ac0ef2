//! A gearbox from a REXS file: its files, and what its scenes come to at rest.

use crate::failure::{Failure, Result};
use crate::import_trial::Trial;
use crate::overwriting::apart;
use crate::scratch::Scratch;
use crate::watch::Watch;
use gearmesh_geometry::input::read_bytes;
use gearmesh_model::write_folder;
use gearmesh_rexs::container::MOST_MB;
use gearmesh_rexs::{Entry, Import, Meshes, Running, Weight, import_to_run};
use serde::Deserialize;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// What is imported, and what for.
#[derive(Debug, Clone, clap::Args, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ImportRequest {
    /// REXS file: XML (.rexs), JSON (.rexsj) or a zip file of one (.rexsz)
    pub model: PathBuf,
    /// Folder for the files that are made; files of the same names are replaced
    #[arg(short, long)]
    pub output: PathBuf,
    /// Scenes of reduced gears (`hybrid` meshes) in place of the springs of ISO 6336: reduce the gear files first
    #[arg(long)]
    #[serde(default)]
    pub reduced: bool,
    /// Scenes that run in time, driven at the speeds of the file, in place of scenes at rest
    #[arg(long)]
    #[serde(default)]
    pub transient: bool,
    /// Write the files only: neither check them nor run the scenes at rest
    #[arg(long)]
    #[serde(default)]
    pub no_run: bool,
}

/// A gearbox whose files were written.
pub struct Imported {
    /// What became of the file.
    pub made: Import,
    /// How its meshes are modelled.
    pub with: Meshes,
    /// What makes the scenes another gearbox than that of the file.
    pub alarms: Vec<String>,
    /// What came of checking and running them.
    pub trial: Trial,
}

/// Writes the files of a gearbox into a folder, checks them and runs its scenes at rest. Files that cannot be used are
/// in [`Trial::refused`].
///
/// # Errors
/// [`Failure`] for a file that is no gearbox, and files that cannot be written.
pub fn import(a: &ImportRequest, watch: &Watch<'_>) -> Result<Imported> {
    let shown = a.model.display();
    let bytes = read_bytes(&a.model, MOST_MB << 20)
        .map_err(|cause| Failure::input(format!("{shown}: {cause}")))?;
    let stem = a.model.file_stem().unwrap_or_default().to_string_lossy();
    let made = |bytes, with, running| {
        import_to_run(bytes, &stem, with, running)
            .map_err(|cause| Failure::input(format!("{shown}: {cause}")))
    };
    let other = (a.reduced || a.transient).then(|| bytes.clone());
    let with = if a.reduced {
        Meshes::Hybrid
    } else {
        Meshes::Iso6336
    };
    let running = if a.transient {
        Running::InTime
    } else {
        Running::AtRest
    };
    let found = made(bytes, with, running)?;
    let list = (
        "import.md".to_owned(),
        found.ledger.page(
            &format!(
                "Import of {}",
                a.model.file_name().unwrap_or_default().to_string_lossy()
            ),
            with,
        ),
    );
    write(&found, &a.output, Some(list), &a.model)?;
    let mut trial = Trial::default();
    if !a.no_run {
        trial.check(&found, &a.output, !a.reduced);
        match other {
            None => trial.run(&found, &a.output, watch)?,
            // The models of the gears are not there yet, motion takes its time: the loads are those of the same scene
            // with springs, at rest.
            Some(bytes) => {
                let scratch = Scratch::new()?;
                let springs = made(bytes, Meshes::Iso6336, Running::AtRest)?;
                write(&springs, scratch.path(), None, &a.model)?;
                trial.run(&springs, scratch.path(), watch)?;
            }
        }
    }
    Ok(Imported {
        alarms: alarms(&found, with, &trial),
        made: found,
        with,
        trial,
    })
}

fn write(made: &Import, folder: &Path, list: Option<(String, String)>, model: &Path) -> Result<()> {
    let files = made.files.iter().map(|f| (f.name.clone(), f.text.clone()));
    let files: Vec<(String, String)> = files.chain(list).collect();
    for (name, _) in &files {
        apart(&folder.join(name), &[model.to_owned()])?;
    }
    Ok(write_folder(folder, &files)?)
}

/// An entry of the list on a line.
#[must_use]
pub fn line(entry: &Entry) -> String {
    format!("{}: {}", entry.subject, entry.text)
}

/// What makes the scenes another gearbox than that of the file.
fn alarms(made: &Import, with: Meshes, trial: &Trial) -> Vec<String> {
    let entries = made.ledger.of_weight(Weight::Warning, with).map(line);
    entries.chain(trial.warnings.iter().cloned()).collect()
}

impl Imported {
    /// What is wrong with files that cannot be used: the messages of all but the first, and the failure of the first.
    #[must_use]
    pub fn refusal(&self, a: &ImportRequest) -> Option<(Vec<String>, Failure)> {
        let (first, others) = self.trial.refused.split_first()?;
        let words =
            |(file, cause): &(String, Failure)| cause.clone().about(&a.output.join(file)).message;
        let count = match self.trial.refused.len() {
            1 => "but one of them".to_owned(),
            n => format!("but {n} of them"),
        };
        let failure = Failure {
            fault: first.1.fault,
            ..Failure::work(format!(
                "{}: its files are written, {count} cannot be used: {}",
                a.model.display(),
                words(first)
            ))
        };
        Some((others.iter().map(words).collect(), failure))
    }

    /// For other programs.
    #[must_use]
    pub fn figures(&self) -> Value {
        let (made, with) = (&self.made, self.with);
        let list = |entries: &[Entry]| -> Value {
            entries
                .iter()
                .map(|e| {
                    let weight = match e.about.weight(with) {
                        Weight::Warning => "warning",
                        Weight::Heavy => "more than 1 %",
                        Weight::Light => "less than 1 %",
                    };
                    json!({ "subject": e.subject, "text": e.text, "weight": weight })
                })
                .collect()
        };
        json!({
            "version": made.version,
            "application": made.application,
            "warnings": self.alarms,
            "at_rest": self.trial.json(),
            "files": made.files.iter().map(|f| &f.name).collect::<Vec<_>>(),
            "scenes": made.scenes,
            "gears": made.gears,
            "taken": list(&made.ledger.taken),
            "assumed": list(&made.ledger.assumed),
            "not_represented": list(&made.ledger.not_represented),
        })
    }
}
