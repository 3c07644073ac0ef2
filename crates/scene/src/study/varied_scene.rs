//! A scene with some of its keys changed, and files that it names with some of theirs.
//!
//! | key | what changes | what that costs |
//! | --- | --- | --- |
//! | `gear_1.microgeometry.tip_relief_um` | the scene; a table that it leaves to the gear file begins as that file states it | nothing is reduced |
//! | `pair.gear_1:blank.web_thickness_mm` | the gear file inside the model that `pair.gear_1` names | the gear is reduced, once for each value |
//! | `bearing.0.model.file:radial_clearance_um` | a copy of the file that the key names | nothing |

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{GearDefinition, InputError};
use gearmesh_model::bytes_digest;
use gearmesh_specification::former_forms::{PAIR, SYSTEM};
use gearmesh_specification::names::unknown;
use gearmesh_specification::study::{Case, OperationTable, Setting};

use super::changed_file::{absolute_names, check, file_text, is_hdf5};
use super::subject::{OPERATION, Subject, is_bearing};
use crate::named_files;

/// Digits of the digest in the name of a file that a study makes.
const NAME_DIGITS: usize = 16;

/// A file that cases need and a study makes, each once.
#[derive(Debug, Clone)]
pub enum MadeFile {
    /// A changed copy of a text.
    Text(String),
    /// A changed gear, to be reduced.
    Model(Box<GearDefinition>),
}

/// Files to make, by path.
pub type MadeFiles = BTreeMap<PathBuf, MadeFile>;

/// Why a case comes to no scene.
#[derive(Debug)]
pub enum VaryError {
    /// A key of a parameter cannot take its value.
    Key {
        /// Name of the parameter.
        parameter: String,
        /// What is wrong, with the key.
        problem: String,
    },
    /// The scene refuses what it is made to say.
    Scene(InputError),
}

/// The scene that is varied.
#[derive(Debug, Clone)]
pub struct BaseScene {
    document: InputDocument,
    folder: PathBuf,
    /// As the file has it.
    given: toml::Value,
    begun: toml::Value,
}

impl BaseScene {
    /// Reads the scene and begins the microgeometry that `keys` vary and that the scene leaves to the gear files.
    /// `operation` is what a bearing carries, whose keys stand behind those of its file.
    ///
    /// # Errors
    /// [`InputError`] for a scene that is wrong as it is, and for a gear file that cannot be read.
    pub fn read<'a>(
        path: &Path,
        keys: impl Iterator<Item = &'a str>,
        operation: Option<&OperationTable>,
    ) -> Result<Self, InputError> {
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::from_document(InputDocument::read(path)?, folder, keys, operation)
    }

    /// The same of a scene that is already in memory; files are relative to `folder`.
    ///
    /// # Errors
    /// As [`BaseScene::read`].
    pub fn from_document<'a>(
        mut document: InputDocument,
        folder: &Path,
        keys: impl Iterator<Item = &'a str>,
        operation: Option<&OperationTable>,
    ) -> Result<Self, InputError> {
        if let Some(operation) = operation {
            if !is_bearing(&document)? {
                let problem = "is no bearing file; `operation` belongs to bearings, remove it";
                return Err(document.error("", problem));
            }
            let table = toml::to_string(operation).map_err(|e| document.error("", e))?;
            let text = format!("{}\n[{OPERATION}]\n{table}", document.text);
            document = InputDocument::new(document.file, text);
        }
        let document = match Subject::from_document(document.clone(), folder)? {
            Subject::Pair(_) => document.with_former(PAIR),
            Subject::System(_) => document.with_former(SYSTEM),
            Subject::Bevel(_) | Subject::Bearing(_) => document,
        };
        let given = toml::Value::Table(document.table()?);
        let mut begun = given.clone();
        for key in keys {
            begin_microgeometry(&mut begun, key, folder)?;
        }
        Ok(Self {
            document,
            folder: folder.to_owned(),
            given,
            begun,
        })
    }

    /// Name of the scene's file.
    #[must_use]
    pub fn file(&self) -> &str {
        &self.document.file
    }

    /// The value that stands at a key of the scene; none where the scene does not state it. A key that was a word in a
    /// former form and is a table now is the table.
    #[must_use]
    pub fn value(&self, key: &str) -> Option<toml::Value> {
        match found_at(&self.begun, key) {
            Some(table @ toml::Value::Table(_)) => Some(table.clone()),
            _ => found_at(&self.begun, &self.document.present_path(key)).cloned(),
        }
    }

    /// The value that stands at a key of the scene, or of a file that it names (`FILE-KEY:KEY`); none where it is not
    /// stated, or the file cannot be read.
    #[must_use]
    pub fn stated(&self, key: &str) -> Option<toml::Value> {
        let Some((file, inner)) = key.split_once(':') else {
            return self.value(key);
        };
        let path = self.named_file(file)?;
        let document = InputDocument::new(path.display().to_string(), file_text(&path).ok()?);
        let table = toml::Value::Table(document.table().ok()?);
        found_at(&table, inner).cloned()
    }

    /// Whether a key is one of the gear inside a reduced model.
    #[must_use]
    pub fn is_of_model(&self, key: &str) -> bool {
        let file = key.split_once(':').map(|(file, _)| file);
        file.and_then(|file| self.named_file(file))
            .is_some_and(|path| is_hdf5(&path))
    }

    /// The file that a key of the scene names.
    fn named_file(&self, key: &str) -> Option<PathBuf> {
        match self.value(key) {
            Some(toml::Value::String(name)) => Some(self.folder.join(name)),
            _ => None,
        }
    }

    /// Where a value of this kind goes.
    fn path_for(&self, key: &str, value: &toml::Value) -> String {
        match value {
            toml::Value::Table(_) => key.to_owned(),
            _ => self.document.present_path(key),
        }
    }

    /// The scene of a case. `files` takes what has to be made for it before it is loaded, below the folder `out`.
    ///
    /// # Errors
    /// [`VaryError`] for keys and values that the scene or a file does not take.
    pub fn scene(
        &self,
        case: &Case,
        files: &mut MadeFiles,
        out: &Path,
    ) -> Result<Subject, VaryError> {
        let as_it_is = || {
            let document = self.document.clone();
            Subject::from_document(document, &self.folder).map_err(VaryError::Scene)
        };
        if case.settings.is_empty() && case.removed.is_empty() {
            return as_it_is();
        }
        let mut root = self.begun.clone();
        // Keys of files, by the key that names the file.
        let mut of_files: BTreeMap<&str, Vec<(&str, &str, &toml::Value)>> = BTreeMap::new();
        let mut added: Vec<(&Setting, &str)> = Vec::new();
        for setting in &case.settings {
            for key in &setting.keys {
                if let Some((file, inner)) = key.split_once(':') {
                    let entry = (inner, &setting.parameter[..], &setting.value);
                    of_files.entry(file).or_default().push(entry);
                    continue;
                }
                let path = self.path_for(key, &setting.value);
                let outcome = set(&mut root, &path, &setting.value);
                let is_new =
                    outcome.map_err(|problem| of_key(&setting.parameter, key, &problem))?;
                if is_new {
                    added.push((setting, key));
                }
            }
        }
        for (file, keys) in of_files {
            self.vary_file(&mut root, (file, &keys), files, out)?;
        }
        for key in &case.removed {
            remove(&mut root, &self.document.present_path(key));
        }
        if root == self.given {
            return as_it_is();
        }
        let text =
            toml::to_string(&root).map_err(|e| VaryError::Scene(self.document.error("", e)))?;
        // A slash would look like a folder, and bevel pair files find theirs by this name.
        let case_name = case.name().replace('/', "\u{2215}");
        let name = format!("{} with {case_name}", self.document.file);
        Subject::from_document(InputDocument::new(name, text), &self.folder).map_err(|error| {
            match self.at_fault(&added, &error) {
                // The key is what the scene did not have: the fault lies with it.
                Some((parameter, key)) => {
                    of_key(parameter, key, &format!("is refused: {}", error.problem))
                }
                None => VaryError::Scene(error),
            }
        })
    }

    /// Of keys that the scene did not have the one that is refused for the same reason by itself, else the last one.
    fn at_fault<'s>(
        &self,
        added: &[(&'s Setting, &'s str)],
        error: &InputError,
    ) -> Option<(&'s str, &'s str)> {
        let is_refused = |setting: &Setting, key: &str| {
            let mut root = self.begun.clone();
            let path = self.path_for(key, &setting.value);
            if set(&mut root, &path, &setting.value).is_err() {
                return true;
            }
            let text = toml::to_string(&root).unwrap_or_default();
            let document = InputDocument::new(&self.document.file, text);
            let outcome = Subject::from_document(document, &self.folder);
            outcome.is_err_and(|alone| alone.problem == error.problem)
        };
        let alone = added.iter().find(|(setting, key)| is_refused(setting, key));
        let (setting, key) = alone.or(added.last())?;
        Some((&setting.parameter, key))
    }

    /// Puts the name of a changed copy in the place of a file's.
    fn vary_file(
        &self,
        root: &mut toml::Value,
        (file, keys): (&str, &[(&str, &str, &toml::Value)]),
        files: &mut MadeFiles,
        out: &Path,
    ) -> Result<(), VaryError> {
        let first = keys[0];
        let whole = |key: &str| format!("{file}:{key}");
        let Some(path) = self.named_file(file) else {
            let known = file_keys(&self.begun);
            let problem = format!(
                "begins with `{file}`: {}",
                unknown("key that names a file", file, &known)
            );
            return Err(of_key(first.1, &whole(first.0), &problem));
        };
        let text = file_text(&path).map_err(VaryError::Scene)?;
        let shown = path.display().to_string();
        let document = InputDocument::new(shown, text);
        let table = document.table().map_err(VaryError::Scene)?;
        let mut varied = toml::Value::Table(table);
        let is_model = is_hdf5(&path);
        for (key, parameter, value) in keys {
            if is_model && key.starts_with("microgeometry") {
                let problem = "would reduce the gear for its flanks; vary the scene's microgeometry, which a model serves as it is";
                return Err(of_key(parameter, &whole(key), problem));
            }
            set(&mut varied, key, value).map_err(|p| of_key(parameter, &whole(key), &p))?;
        }
        let beside = path.parent().unwrap_or(Path::new(""));
        let named = named_files(&document.text, beside);
        absolute_names(&mut varied, &named);
        let text = toml::to_string(&varied).map_err(|e| VaryError::Scene(document.error("", e)))?;
        let digest: String = bytes_digest(text.as_bytes())
            .chars()
            .take(NAME_DIGITS)
            .collect();
        let refused = |e: InputError| {
            let own = keys.iter().find(|(key, ..)| *key == e.key);
            let (key, parameter, _) = own.unwrap_or(&first);
            let key = match &e.key[..] {
                "" => whole(key),
                at => whole(at),
            };
            of_key(parameter, &key, &format!("is refused: {}", e.problem))
        };
        let changed = InputDocument::new(format!("{} changed", document.file), &text);
        let (made, made_path) = if is_model {
            let gear = GearDefinition::from_document(&changed).map_err(refused)?;
            (
                MadeFile::Model(Box::new(gear)),
                out.join(format!("models/{digest}.h5")),
            )
        } else {
            check(&changed).map_err(refused)?;
            (
                MadeFile::Text(text),
                out.join(format!("files/{digest}.toml")),
            )
        };
        let made_path = std::path::absolute(&made_path).unwrap_or(made_path);
        let shown = toml::Value::String(made_path.display().to_string());
        set(root, &self.document.present_path(file), &shown)
            .map_err(|problem| of_key(first.1, file, &problem))?;
        files.insert(made_path, made);
        Ok(())
    }
}

fn of_key(parameter: &str, key: &str, problem: &str) -> VaryError {
    VaryError::Key {
        parameter: parameter.to_owned(),
        problem: format!("`{key}` {problem}"),
    }
}

/// Gives the scene the microgeometry of a gear's file, where a key varies it and the scene does not state it.
fn begin_microgeometry(root: &mut toml::Value, key: &str, folder: &Path) -> Result<(), InputError> {
    let parts: Vec<&str> = key.split('.').collect();
    let (owner, file) = match parts[..] {
        [gear @ ("gear_1" | "gear_2"), "microgeometry", ..] => {
            let file = root.get("pair").and_then(|pair| pair.get(gear)).cloned();
            (Some(gear.to_owned()), file)
        }
        ["body", number, "microgeometry", ..] => {
            let body = root
                .get("body")
                .and_then(|bodies| bodies.get(number.parse::<usize>().ok()?));
            let file = body.and_then(|body| body.get("gear")).cloned();
            (Some(format!("body.{number}")), file)
        }
        _ => (None, None),
    };
    let (Some(owner), Some(toml::Value::String(file))) = (owner, file) else {
        return Ok(());
    };
    let stated = format!("{owner}.microgeometry");
    let path = folder.join(file);
    if found_at(root, &stated).is_some() || !path.exists() {
        return Ok(());
    }
    let document = InputDocument::new(path.display().to_string(), file_text(&path)?);
    let gear = toml::Value::Table(document.table()?);
    if let Some(table) = gear.get("microgeometry") {
        // Tables on the way are made; nothing else can be wrong.
        let _ = set(root, &stated, table);
    }
    Ok(())
}

/// Keys whose values look like names of gear, model or bearing files, as dotted paths.
fn file_keys(root: &toml::Value) -> Vec<String> {
    let mut found = Vec::new();
    let mut waiting: Vec<(String, &toml::Value)> = vec![(String::new(), root)];
    while let Some((path, value)) = waiting.pop() {
        let below = |key: &str| match &path[..] {
            "" => key.to_owned(),
            path => format!("{path}.{key}"),
        };
        match value {
            toml::Value::String(name) if name.ends_with(".h5") || name.ends_with(".toml") => {
                found.push(path);
            }
            toml::Value::Array(items) => {
                let items = items.iter().enumerate();
                waiting.extend(items.map(|(i, item)| (below(&i.to_string()), item)));
            }
            toml::Value::Table(table) => {
                waiting.extend(table.iter().map(|(key, item)| (below(key), item)));
            }
            _ => {}
        }
    }
    found.sort();
    found
}

/// What stands at a dotted path.
fn found_at<'a>(root: &'a toml::Value, key: &str) -> Option<&'a toml::Value> {
    let mut place = root;
    for part in key.split('.') {
        place = match place {
            toml::Value::Table(table) => table.get(part)?,
            toml::Value::Array(items) => items.get(part.parse::<usize>().ok()?)?,
            _ => return None,
        };
    }
    Some(place)
}

/// Takes away what stands at a dotted path, if anything does.
fn remove(root: &mut toml::Value, key: &str) {
    let (parents, last) = key.rsplit_once('.').unwrap_or(("", key));
    let mut place = Some(root);
    for part in parents.split('.').filter(|part| !part.is_empty()) {
        place = place.and_then(|place| match place {
            toml::Value::Table(table) => table.get_mut(part),
            toml::Value::Array(items) => part.parse().ok().and_then(|i: usize| items.get_mut(i)),
            _ => None,
        });
    }
    if let Some(toml::Value::Table(table)) = place {
        table.remove(last);
    }
}

/// Puts a value at a dotted path; true where there was none before. A value that was there keeps its kind.
fn set(root: &mut toml::Value, key: &str, value: &toml::Value) -> Result<bool, String> {
    let (mut place, mut walked) = (root, String::new());
    let mut is_new = false;
    for part in key.split('.') {
        let offers = match &*place {
            toml::Value::Array(items) => format!("items 0 to {}", items.len().saturating_sub(1)),
            _ => "nothing below it".to_owned(),
        };
        let next = match place {
            // A list of one item, counted from where, cannot be begun by the study.
            toml::Value::Table(table) if is_new && part.parse::<usize>().is_ok() => {
                return Err(format!(
                    "is not in the scene: it states no `{walked}`; state the whole list there (`operation` in the study itself), and its items can vary"
                ));
            }
            toml::Value::Table(table) => {
                is_new |= !table.contains_key(part);
                let empty = || toml::Value::Table(toml::Table::new());
                Some(table.entry(part).or_insert_with(empty))
            }
            toml::Value::Array(items) => part.parse().ok().and_then(|i: usize| items.get_mut(i)),
            _ => None,
        };
        let Some(next) = next else {
            return Err(format!(
                "is not in the scene: {walked} has {offers}, not `{part}`"
            ));
        };
        place = next;
        walked = format!("{walked}{}{part}", if walked.is_empty() { "" } else { "." });
    }
    let is_number = |value: &toml::Value| value.is_float() || value.is_integer();
    let alike = place.same_type(value) || is_number(place) && is_number(value);
    if !is_new && !alike {
        let (is, cannot) = (place.type_str(), value.type_str());
        return Err(format!("is {is} in the scene and cannot be {cannot}"));
    }
    *place = match (&*place, value) {
        // Counts stay counts: scatter and steps give whole numbers as decimals.
        (toml::Value::Integer(_), toml::Value::Float(x)) if x.fract() == 0.0 && x.abs() < 1e15 => {
            toml::Value::Integer(*x as i64)
        }
        _ => value.clone(),
    };
    Ok(is_new)
}
