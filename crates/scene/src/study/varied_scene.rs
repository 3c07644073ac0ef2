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
use gearmesh_model::{bytes_digest, read_reduced_gear};

use super::design::Case;
use crate::former_forms::{PAIR, SYSTEM};
use crate::named_files;
use crate::scene_file::SceneFile;

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
    given: toml::Value,
    begun: toml::Value,
}

impl BaseScene {
    /// Reads the scene and begins the microgeometry that `keys` vary and that the scene leaves to the gear files.
    ///
    /// # Errors
    /// [`InputError`] for a scene that is wrong as it is, and for a gear file that cannot be read.
    pub fn read<'a>(path: &Path, keys: impl Iterator<Item = &'a str>) -> Result<Self, InputError> {
        let document = InputDocument::read(path)?;
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        let scene = SceneFile::from_document(document.clone(), &folder)?;
        let former = match scene {
            SceneFile::Pair(_) => PAIR,
            SceneFile::System(_) => SYSTEM,
        };
        let document = document.with_former(former);
        let given: toml::Value = document.glance()?;
        let mut begun = given.clone();
        for key in keys {
            begin_microgeometry(&mut begun, key, &folder)?;
        }
        Ok(Self {
            document,
            folder,
            given,
            begun,
        })
    }

    /// Name of the scene's file.
    #[must_use]
    pub fn file(&self) -> &str {
        &self.document.file
    }

    /// The value that stands at a key of the scene; none where the scene does not state it.
    #[must_use]
    pub fn value(&self, key: &str) -> Option<toml::Value> {
        let mut place = &self.begun;
        for part in self.document.present_path(key).split('.') {
            place = match place {
                toml::Value::Table(table) => table.get(part)?,
                toml::Value::Array(items) => items.get(part.parse::<usize>().ok()?)?,
                _ => return None,
            };
        }
        Some(place.clone())
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
    ) -> Result<SceneFile, VaryError> {
        if case.settings.is_empty() {
            let document = self.document.clone();
            return SceneFile::from_document(document, &self.folder).map_err(VaryError::Scene);
        }
        let mut root = self.begun.clone();
        // Keys of files, by the key that names the file.
        let mut of_files: BTreeMap<&str, Vec<(&str, &str, &toml::Value)>> = BTreeMap::new();
        let mut added = None;
        for setting in &case.settings {
            for key in &setting.keys {
                if let Some((file, inner)) = key.split_once(':') {
                    let entry = (inner, &setting.parameter[..], &setting.value);
                    of_files.entry(file).or_default().push(entry);
                    continue;
                }
                let outcome = set(&mut root, &self.document.present_path(key), &setting.value);
                let is_new =
                    outcome.map_err(|problem| of_key(&setting.parameter, key, &problem))?;
                if is_new {
                    added = Some((&setting.parameter, key));
                }
            }
        }
        for (file, keys) in of_files {
            self.vary_file(&mut root, (file, &keys), files, out)?;
        }
        if root == self.given {
            let document = self.document.clone();
            return SceneFile::from_document(document, &self.folder).map_err(VaryError::Scene);
        }
        let text =
            toml::to_string(&root).map_err(|e| VaryError::Scene(self.document.error("", e)))?;
        let name = format!("{} with {}", self.document.file, case.name());
        SceneFile::from_document(InputDocument::new(name, text), &self.folder).map_err(|error| {
            match added {
                // The key is what the scene did not have: the fault lies with it.
                Some((parameter, key)) => of_key(parameter, key, &refusal(key, &error.problem)),
                None => VaryError::Scene(error),
            }
        })
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
        let Some(toml::Value::String(name)) = self.value(file) else {
            let problem = format!("begins with `{file}`, which names no file in the scene");
            return Err(of_key(first.1, &whole(first.0), &problem));
        };
        let path = self.folder.join(name);
        let text = file_text(&path).map_err(VaryError::Scene)?;
        let shown = path.display().to_string();
        let document = InputDocument::new(shown, text);
        let mut varied: toml::Value = document.glance().map_err(VaryError::Scene)?;
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
        let (made, made_path) = if is_model {
            let name = format!("{} changed", document.file);
            let gear = GearDefinition::from_document(&InputDocument::new(name, &text));
            let gear =
                gear.map_err(|e| of_key(first.1, &whole(first.0), &refusal(first.0, &e.problem)))?;
            (
                MadeFile::Model(Box::new(gear)),
                out.join(format!("models/{digest}.h5")),
            )
        } else {
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

/// What to say of a key that a file did not have and does not take.
fn refusal(key: &str, problem: &str) -> String {
    let last = key.rsplit('.').next().unwrap_or(key);
    // What a reader of keys offers stands between accents.
    let offered = problem
        .split('`')
        .skip(1)
        .step_by(2)
        .filter(|word| *word != last);
    let nearest = offered
        .map(|word| (strsim::jaro_winkler(last, word), word))
        .filter(|(similarity, _)| *similarity > 0.8)
        .max_by(|a, b| a.0.total_cmp(&b.0));
    let hint = nearest.map_or_else(String::new, |(_, word)| format!("; did you mean `{word}`?"));
    format!("is refused: {problem}{hint}")
}

fn is_hdf5(path: &Path) -> bool {
    path.extension().is_some_and(|e| e == "h5")
}

/// The text of a file, of a model that of its gear.
fn file_text(path: &Path) -> Result<String, InputError> {
    if !is_hdf5(path) {
        return Ok(InputDocument::read(path)?.text);
    }
    let model = read_reduced_gear(path).map_err(|error| InputError {
        file: path.display().to_string(),
        line: None,
        key: String::new(),
        problem: error.to_string(),
    })?;
    Ok(model.input.text)
}

/// A copy stands elsewhere: files that it names keep their places.
fn absolute_names(value: &mut toml::Value, named: &BTreeMap<String, PathBuf>) {
    match value {
        toml::Value::String(name) => {
            if let Some(path) = named.get(name) {
                let path = std::path::absolute(path).unwrap_or_else(|_| path.clone());
                *name = path.display().to_string();
            }
        }
        toml::Value::Array(items) => items.iter_mut().for_each(|v| absolute_names(v, named)),
        toml::Value::Table(table) => {
            table.iter_mut().for_each(|(_, v)| absolute_names(v, named));
        }
        _ => {}
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
    if has(root, &stated) || !path.exists() {
        return Ok(());
    }
    let document = InputDocument::new(path.display().to_string(), file_text(&path)?);
    let gear: toml::Value = document.glance()?;
    if let Some(table) = gear.get("microgeometry") {
        // Tables on the way are made; nothing else can be wrong.
        let _ = set(root, &stated, table);
    }
    Ok(())
}

fn has(root: &toml::Value, key: &str) -> bool {
    let mut place = Some(root);
    for part in key.split('.') {
        place = place.and_then(|place| match part.parse::<usize>() {
            Ok(number) => place.get(number),
            Err(_) => place.get(part),
        });
    }
    place.is_some()
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
