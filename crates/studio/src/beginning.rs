//! What is begun without a file: texts from templates, changed by fields or as text, looked at while they are typed.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use gearmesh_geometry::input::InputDocument;
use gearmesh_model::{write_bytes, write_text};
use gearmesh_operations::import::{ImportRequest, import};
use gearmesh_operations::new_files::{self, KINDS, NewKind, Texts};
use gearmesh_operations::{Scratch, Watch};
use gearmesh_scene::{named_files, renamed_files};
use serde::Deserialize;
use serde_json::{Value, json};

use crate::bevel::{self, BevelModels};
use crate::form::Form;
use crate::problem::Problem;
use crate::text_edit;

/// Files of something new.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NewFiles {
    /// Its kind.
    pub kind: String,
    /// All its files.
    pub files: Texts,
}

/// A text, and keys of it that are changed.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Edit {
    kind: String,
    name: String,
    text: String,
    #[serde(default)]
    settings: BTreeMap<String, Value>,
    #[serde(default)]
    removed: Vec<String>,
}

/// What can be begun, and its files; `begun`: what the page begins with.
pub fn kinds(begun: Option<&NewFiles>) -> Value {
    let kinds = KINDS.iter().map(|kind| {
        let files = kind.files.iter().map(|file| {
            let fields = file.kind.map(|kind| Form::of_text(kind, file.text));
            json!({"name": file.name, "text": file.text, "fields": fields})
        });
        json!({"name": kind.name, "title": kind.title, "about": kind.about, "files": files.collect::<Vec<_>>()})
    });
    json!({
        "kinds": kinds.collect::<Vec<_>>(),
        "folder": place().display().to_string(),
        "begun": begun.map(|begun| json!({"kind": begun.kind, "files": begun.files})),
    })
}

/// A bevel pair from its file, with whole paths: something begun already.
///
/// # Errors
/// [`Problem`] for a file that is no bevel pair.
pub fn bevel_pair(path: &Path) -> Result<NewFiles, Problem> {
    let kind = new_files::kind("bevel-pair")?;
    let document = InputDocument::read(path)?;
    let folder = std::path::absolute(path.parent().unwrap_or(Path::new("")));
    let files = named_files(&document.text, &folder.unwrap_or_default());
    let whole = |(name, file): (String, PathBuf)| (name, file.display().to_string());
    let names: BTreeMap<String, String> = files.into_iter().map(whole).collect();
    // Comments are lost with the names; a text that names no file stays as it is.
    let text = match names.is_empty() {
        true => document.text,
        false => renamed_files(&document.text, &names).map_err(Problem::Input)?,
    };
    let name = kind.files[0].name.to_owned();
    Ok(NewFiles {
        kind: kind.name.to_owned(),
        files: Texts::from([(name, text)]),
    })
}

/// A text with keys changed, and its fields.
///
/// # Errors
/// [`Problem`] for a key or a value that the file does not have.
pub fn edited(edit: &Edit) -> Result<Value, Problem> {
    let kind = new_files::kind(&edit.kind)?;
    let template = kind.files.iter().find(|file| file.name == edit.name);
    let kind = template.and_then(|file| file.kind).ok_or(Problem::Absent)?;
    let (mut text, form) = (edit.text.clone(), Form::of_text(kind, &edit.text));
    let about = |problem: String| Problem::Input(format!("{}: {problem}", edit.name));
    for (key, value) in &edit.settings {
        let value = form.field(key)?.value(value)?;
        text = text_edit::set(&text, key, &value).map_err(about)?;
    }
    for key in &edit.removed {
        form.field(key)?;
        text = text_edit::remove(&text, key).map_err(about)?;
    }
    Ok(json!({"text": text, "fields": Form::of_text(kind, &text)}))
}

/// What should be known of files, and what is found without waiting for it: all of a bearing, a bevel pair under its
/// torques.
///
/// # Errors
/// [`Problem`] for the first of them that is wrong, and once `stop` is set.
pub fn looked_at(
    new: &NewFiles,
    models: &BevelModels,
    stop: &AtomicBool,
) -> Result<Value, Problem> {
    let kind = new_files::kind(&new.kind)?;
    let scratch = Scratch::new()?;
    write(kind, &new.files, scratch.path())?;
    let last = kind.files.last().map_or("", |file| file.name);
    let found = match kind.name {
        "bevel-pair" => bevel::live(&scratch.path().join(last), models, stop),
        _ => others(kind, scratch.path()),
    };
    found.map_err(|problem| named(problem, scratch.path()))
}

/// A problem with its files named as the page shows them.
fn named(problem: Problem, folder: &Path) -> Problem {
    match problem {
        Problem::Input(text) => Problem::Input(text.replace(&format!("{}/", folder.display()), "")),
        other => other,
    }
}

/// What should be known of files that no bevel pair is made of, and the figures of a bearing.
fn others(kind: NewKind, folder: &Path) -> Result<Value, Problem> {
    let warnings = new_files::look(kind, folder)?;
    let columns = match kind.name {
        "bearing" => Some(new_files::bearing_figures(kind, folder)?),
        _ => None,
    };
    Ok(json!({"warnings": warnings, "columns": columns}))
}

/// Writes the files into a new folder and computes them: the gears of a pair are reduced, a bevel pair is analysed.
///
/// # Errors
/// [`Problem`] for what is wrong, and once `watch` stops it.
pub fn begun(new: &NewFiles, watch: &Watch<'_>) -> Result<(Value, PathBuf), Problem> {
    let kind = new_files::kind(&new.kind)?;
    let scratch = Scratch::new()?;
    write(kind, &new.files, scratch.path())?;
    // A bevel pair is solved below, and says then what is wrong with it; a folder is made for what is right.
    let looked = new_files::look(kind, scratch.path());
    looked.map_err(|failure| named(failure.into(), scratch.path()))?;
    let folder = new_folder(kind.name)?;
    write(kind, &new.files, &folder)?;
    let last = folder.join(kind.files.last().map_or("", |file| file.name));
    let result = match kind.name {
        "pair" | "helical-pair" => {
            new_files::reduce_gears(kind, &folder, watch)?;
            json!({"opens": true})
        }
        "bevel-pair" => bevel::written(&last, watch)?,
        _ => json!({"columns": new_files::bearing_figures(kind, &folder)?}),
    };
    Ok((with_folder(result, &folder), last))
}

/// Imports a gearbox from the bytes of a REXS file, whose name says its kind.
///
/// # Errors
/// [`Problem`] for what is no gearbox, and once `watch` stops it.
pub fn imported(name: &str, bytes: &[u8], watch: &Watch<'_>) -> Result<Value, Problem> {
    let name = Path::new(name).file_name().unwrap_or_default();
    let scratch = Scratch::new()?;
    let model = scratch.path().join(name);
    write_bytes(&model, bytes).map_err(Problem::not_written)?;
    let folder = new_folder("gearbox")?;
    let request = ImportRequest {
        model: model.clone(),
        output: folder.clone(),
        reduced: false,
        transient: false,
        no_run: false,
    };
    let found = import(&request, watch)?;
    let refusal = found.refusal(&request).map(|(_, failure)| failure.message);
    Ok(with_folder(
        json!({"import": found.figures(), "refused": refusal}),
        &folder,
    ))
}

fn with_folder(mut result: Value, folder: &Path) -> Value {
    result["folder"] = json!(folder.display().to_string());
    result
}

fn write(kind: NewKind, files: &Texts, folder: &Path) -> Result<(), Problem> {
    new_files::demand_names(kind, files)?;
    for (name, text) in files {
        write_text(&folder.join(name), text).map_err(Problem::not_written)?;
    }
    Ok(())
}

/// Where new folders are made: where the program was started.
fn place() -> PathBuf {
    std::env::current_dir().unwrap_or_default()
}

/// A folder that was not there: `pair`, `pair-2` and so on.
fn new_folder(name: &str) -> Result<PathBuf, Problem> {
    let numbered = |number: usize| match number {
        1 => place().join(name),
        number => place().join(format!("{name}-{number}")),
    };
    for folder in (1..10_000).map(numbered) {
        match std::fs::create_dir(&folder) {
            Ok(()) => return Ok(folder),
            Err(error) if error.kind() == std::io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(Problem::Work(format!("{}: {error}", folder.display()))),
        }
    }
    Err(Problem::Work(format!(
        "{}: has 10000 folders named {name}",
        place().display()
    )))
}
