//! Files that are written anew: what is wrong with them while they are typed, and what they come to.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use gearmesh_geometry::input::InputDocument;
use gearmesh_scene::ModelShelf;
use gearmesh_scene::SceneFile;
use gearmesh_scene::pair::{BevelScene, demand_gears_that_fit};
use gearmesh_scene::study::{RestCases, RestFigures, Subject};
use serde_json::{Value, json};

use crate::check::{Finding, bevel_pair, check};
use crate::failure::{Failure, Result};
use crate::gear_file::GearFile;
use crate::reduce::{Reduction, reduce_to};
use crate::schema::TextKind;
use crate::templates::{self, Template};
use crate::watch::{Listener, Silent, Task, Watch};

/// What can be begun.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NewKind {
    /// A word.
    pub name: &'static str,
    /// In words.
    pub title: &'static str,
    /// What it is for.
    pub about: &'static str,
    /// Its files, the one that is computed last.
    pub files: &'static [Template],
}

/// All that can be begun.
pub const KINDS: [NewKind; 4] = [
    NewKind {
        name: "pair",
        title: "Gear pair",
        about: "Two spur gears: each is reduced once, then every slider answers at once.",
        files: &[templates::PINION, templates::WHEEL, templates::PAIR],
    },
    NewKind {
        name: "helical-pair",
        title: "Helical pair",
        about: "The same with helical teeth.",
        files: &[
            templates::HELICAL_PINION,
            templates::HELICAL_WHEEL,
            templates::HELICAL_PAIR,
        ],
    },
    NewKind {
        name: "bearing",
        title: "Rolling bearing",
        about: "From its designation or its catalogue line: loads, stiffness, life.",
        files: &[templates::OPERATION, templates::BEARING],
    },
    NewKind {
        name: "bevel-pair",
        title: "Bevel pair",
        about: "From its blank: tooth contact, transmission error and pressure under torques.",
        files: &[templates::BEVEL_PAIR],
    },
];

/// The kind of a name.
///
/// # Errors
/// [`Failure`] for a name that is none.
pub fn kind(name: &str) -> Result<NewKind> {
    let found = KINDS.into_iter().find(|kind| kind.name == name);
    found.ok_or_else(|| {
        let known: Vec<&str> = KINDS.iter().map(|kind| kind.name).collect();
        let known = known.join(", ");
        Failure::input(format!("`{name}` cannot be begun; there are {known}"))
    })
}

/// Texts by the names of their files.
pub type Texts = BTreeMap<String, String>;

/// Demands that these are the files of a kind and no others.
///
/// # Errors
/// [`Failure`] with the name that is missing or too much.
pub fn demand_names(kind: NewKind, files: &Texts) -> Result<()> {
    let names: Vec<&str> = kind.files.iter().map(|file| file.name).collect();
    let missing = names.iter().find(|name| !files.contains_key(**name));
    let others = files.keys().map(String::as_str);
    let more = others.into_iter().find(|name| !names.contains(name));
    match missing.copied().or(more) {
        None => Ok(()),
        Some(name) => Err(Failure::input(format!(
            "{name}: allowed are the files {}",
            names.join(", ")
        ))),
    }
}

/// Warnings that are kept.
#[derive(Debug, Default)]
struct Kept(Mutex<Vec<String>>);

impl Kept {
    /// Hears the warnings of an operation that nothing stops.
    fn watch(&self) -> Watch<'_> {
        Watch {
            listener: self,
            ..Watch::unattended()
        }
    }

    fn all(self) -> Vec<String> {
        let kept = self.0.into_inner();
        kept.unwrap_or_else(PoisonError::into_inner)
    }
}

impl Listener for Kept {
    fn begin(&self, _: &str) -> Box<dyn Task + '_> {
        Box::new(Silent)
    }

    fn note(&self, _: &str) {}

    fn warning(&self, text: &str) {
        let mut all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        all.push(text.to_owned());
    }
}

/// Looks at files that lie in `folder`: what should be known of them. Nothing is reduced or run.
///
/// # Errors
/// [`Failure`] for the first one that is wrong, and for gears that do not run together.
pub fn look(kind: NewKind, folder: &Path) -> Result<Vec<String>> {
    let kept = Kept::default();
    let watch = kept.watch();
    for template in kind.files {
        let path = folder.join(template.name);
        match template.kind {
            Some(TextKind::Gear) => drop(GearFile::read(&path, &watch)?),
            Some(TextKind::Scene) => match SceneFile::read(&path)? {
                SceneFile::Pair(scene) => demand_gears_that_fit(&scene, &ModelShelf::default())?,
                SceneFile::Bevel(_) | SceneFile::System(_) => {
                    let problem = "allowed is a pair of cylindrical gears here";
                    return Err(Failure::input(problem).about(&path));
                }
            },
            Some(_) => told(check(&path)?, &path, &watch)?,
            None => {
                let table = InputDocument::read(&path)?;
                table.table()?;
            }
        }
    }
    Ok(kept.all())
}

/// What should be known of a bevel pair; flanks that its scene has made are not made again.
///
/// # Errors
/// [`Failure`] for flanks that cannot be made, do not touch or jam.
pub fn look_at_bevel(scene: &BevelScene) -> Result<Vec<String>> {
    let kept = Kept::default();
    let watch = kept.watch();
    told(bevel_pair(scene)?, Path::new(&scene.document.file), &watch)?;
    Ok(kept.all())
}

/// Tells what was found in a file that has no problem.
fn told(found: Finding, path: &Path, watch: &Watch<'_>) -> Result<()> {
    if let Some(problem) = found.problem {
        return Err(Failure::input(problem).about(path));
    }
    found.notes.iter().for_each(|note| watch.warning(note));
    watch.unit_slips(found.slips);
    Ok(())
}

/// What a bearing comes to at rest: its columns.
///
/// # Errors
/// [`Failure`] for what is wrong or not carried.
pub fn bearing_figures(kind: NewKind, folder: &Path) -> Result<Value> {
    let last = kind.files.last().map_or("", |file| file.name);
    let bearing = InputDocument::read(&folder.join(last))?;
    let operation = InputDocument::read(&folder.join(templates::OPERATION.name))?;
    let operation = operation.table()?;
    let table = toml::Table::from_iter([("operation".to_owned(), operation.into())]);
    let table = toml::to_string(&table).map_err(Failure::input)?;
    let document = InputDocument::new(&bearing.file, format!("{}\n{table}", bearing.text));
    let subject = Subject::from_document(document, folder)?;
    let (found, _) = RestCases::default().figures(&subject)?;
    Ok(figures_as_json(&found))
}

/// Columns at rest.
#[must_use]
pub fn figures_as_json(found: &RestFigures) -> Value {
    let columns = found.columns.iter().map(|column| {
        let (label, unit) = gearmesh_report::words_and_unit(&column.name);
        json!({"name": column.name, "label": label, "unit": unit, "values": column.values})
    });
    json!({"torques_Nm": found.torques_nm, "columns": columns.collect::<Vec<_>>()})
}

/// Reduces the gears of a new pair beside their files, as the scene names them.
///
/// # Errors
/// [`Failure`] for a gear that cannot be reduced, and once `watch` stops it.
pub fn reduce_gears(kind: NewKind, folder: &Path, watch: &Watch<'_>) -> Result<()> {
    let how = Reduction {
        estimate_error: false,
        even_if_memory_is_short: false,
    };
    let gears = kind.files.iter();
    for template in gears.filter(|file| file.kind == Some(TextKind::Gear)) {
        let path = folder.join(template.name);
        let model = path.with_extension("h5");
        reduce_to(&GearFile::read(&path, watch)?, how, &model, watch)?;
    }
    Ok(())
}
