//! A gear pair whose scene is changed again and again: models are read once, flanks condensed once for each number of
//! slices.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use gearmesh_geometry::input::InputDocument;
use gearmesh_model::ReducedGear;
use gearmesh_scene::pair::{ModelShelf, PairWatch, load_from, run_watched};
use gearmesh_scene::study::{BaseScene, Case, MadeFiles, Setting, Subject, VaryError};
use gearmesh_scene::{LoadedScene, Scene, named_files, renamed_files};
use serde::Deserialize;
use serde_json::{Value, json};

use crate::answer::PairAnswer;
use crate::form::{Form, Gears, Kind, pitch_errors};
use crate::problem::Problem;
use crate::shape::GearShape;

/// Bytes of forces, pressures and places that a page can show; results beyond belong into a file.
const MOST_BYTES: f64 = 30e6;

/// What the page has changed.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Change {
    /// Keys of the scene and their values.
    #[serde(default)]
    pub settings: BTreeMap<String, Value>,
    /// Keys that the scene states and that are taken away.
    #[serde(default)]
    pub removed: Vec<String>,
}

/// A pair scene and its models, in memory.
#[derive(Debug)]
pub struct PairSession {
    base: BaseScene,
    /// As the file has it, files by their absolute names: what is saved works from any folder.
    names: BTreeMap<String, String>,
    flank: String,
    title: String,
    shelf: ModelShelf,
    form: Form,
    shapes: [GearShape; 2],
}

impl PairSession {
    /// Reads a scene and its models.
    ///
    /// # Errors
    /// [`Problem`] for a scene or a model that is wrong.
    pub fn read(path: &Path) -> Result<Self, Problem> {
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::new(InputDocument::read(path)?, folder)
    }

    /// The scene of a result; its models stand where the result says.
    ///
    /// # Errors
    /// As [`PairSession::read`].
    pub fn of_models(scene: InputDocument, models: [String; 2]) -> Result<Self, Problem> {
        let table: toml::Table = scene.glance()?;
        let names = ["gear_1", "gear_2"]
            .into_iter()
            .zip(models)
            .filter_map(|(gear, model)| {
                let named = table.get("pair")?.get(gear)?.as_str()?;
                Some((named.to_owned(), model))
            });
        let text = renamed_files(&scene.text, &names.collect()).map_err(Problem::Input)?;
        Self::new(InputDocument::new(scene.file, text), Path::new(""))
    }

    fn new(document: InputDocument, folder: &Path) -> Result<Self, Problem> {
        let named = named_files(&document.text, folder).into_iter();
        let names = named.map(|(name, path)| {
            let path = std::path::absolute(&path).unwrap_or(path);
            (name, path.display().to_string())
        });
        let names = names.collect();
        // A key of each gear begins its whole microgeometry.
        let begun = [
            "gear_1.microgeometry.tip_relief_um",
            "gear_2.microgeometry.tip_relief_um",
        ];
        let scene = Scene::from_document(document.clone(), folder)?;
        let base = BaseScene::from_document(document, folder, begun.into_iter(), None)?;
        let shelf = ModelShelf::default();
        let (flank, title) = (scene.flank.name().to_owned(), scene.title.clone());
        let loaded = load_from(scene, &shelf)?;
        let [model_1, model_2] = &loaded.models;
        let definitions = [
            model_1.input.definition_in("gear 1")?,
            model_2.input.definition_in("gear 2")?,
        ];
        let gauges = [model_1, model_2].map(|model| gauge_names(model));
        let gears = Gears {
            definitions,
            gauges: [&gauges[0], &gauges[1]],
        };
        let form = Form::of_pair(&base, gears);
        let shapes = definitions.map(GearShape::of);
        Ok(Self {
            base,
            names,
            flank,
            title,
            shelf,
            form,
            shapes,
        })
    }

    /// What the page is made of: the keys, the gears.
    pub fn description(&self) -> Value {
        json!({
            "title": self.title,
            "file": self.base.file(),
            "fields": self.form,
            "gears": self.shapes,
        })
    }

    /// The changed pair, computed.
    ///
    /// # Errors
    /// [`Problem`] for what the scene refuses, for a run that is too long for a page, and once `watch` stops it.
    pub fn answer(&self, change: &Change, watch: &PairWatch) -> Result<PairAnswer, Problem> {
        let loaded = self.loaded(change)?;
        let bytes = loaded.result_bytes();
        if bytes > MOST_BYTES {
            return Err(Problem::Input(format!(
                "run.pitches: {} positions at {} torques have {:.0} MB of forces and pressures, a page takes {:.0} MB; take fewer pitches here, \
                 and `gearmesh run` for all of them",
                loaded.scene.positions(),
                loaded.scene.torques_nm.len(),
                1e-6 * bytes,
                1e-6 * MOST_BYTES
            )));
        }
        let result = run_watched(&loaded, &|_, _| (), watch)?;
        PairAnswer::new(&loaded, &result)
    }

    /// The changed scene as a file.
    ///
    /// # Errors
    /// [`Problem`] for what the scene refuses.
    pub fn toml(&self, change: &Change) -> Result<String, Problem> {
        let scene = self.scene(change)?;
        renamed_files(&scene.document.text, &self.names).map_err(Problem::Work)
    }

    fn loaded(&self, change: &Change) -> Result<LoadedScene, Problem> {
        Ok(load_from(self.scene(change)?, &self.shelf)?)
    }

    fn scene(&self, change: &Change) -> Result<Scene, Problem> {
        let case = self.case(change)?;
        let mut files = MadeFiles::new();
        let subject = self.base.scene(&case, &mut files, &PathBuf::new());
        let subject = subject.map_err(|error| match error {
            VaryError::Key { problem, .. } => Problem::Input(problem),
            VaryError::Scene(error) => error.into(),
        })?;
        match subject {
            Subject::Pair(scene) => Ok(*scene),
            _ => Err(Problem::Work(
                "the changed scene is no pair any more".to_owned(),
            )),
        }
    }

    /// The change as a study has it. Only keys of the form pass, with values of their kinds.
    fn case(&self, change: &Change) -> Result<Case, Problem> {
        let mut case = Case::default();
        for (key, value) in &change.settings {
            let field = self.form.field(key)?;
            let value = field.value(value)?;
            let value = match field.kind {
                Kind::PitchErrors(_) => self.with_pitch_errors(key, Some(value)),
                _ => value,
            };
            let tags = field
                .with
                .iter()
                .filter_map(|(key, value)| Some((key, value.as_str()?)));
            let tags = tags.map(|(key, word)| (key.clone(), toml::Value::String(word.to_owned())));
            for (key, value) in tags.chain([(key.clone(), value)]) {
                case.settings.push(setting(&key, value));
            }
        }
        for key in &change.removed {
            let field = self.form.field(key)?;
            if let Kind::PitchErrors(_) = field.kind {
                // Other errors of the gear stay.
                case.settings
                    .push(setting(key, self.with_pitch_errors(key, None)));
                continue;
            }
            // A table that has lost the key that it needs goes as a whole.
            let is_table = field.needed && field.group.ends_with("friction");
            case.removed.push(if is_table {
                field.group.clone()
            } else {
                key.clone()
            });
        }
        Ok(case)
    }

    /// The errors that the scene states, with these of the pitch, or with none of it.
    fn with_pitch_errors(&self, key: &str, removed: Option<toml::Value>) -> toml::Value {
        let stated = self.base.value(key);
        let place = stated
            .as_ref()
            .and_then(pitch_errors)
            .map(|(place, _)| place);
        let mut errors = stated
            .and_then(|errors| errors.as_array().cloned())
            .unwrap_or_default();
        let stated = place.map(|place| errors.remove(place));
        if let Some(removed) = removed {
            let stated_side = stated.as_ref().and_then(|pitch| pitch.get("side")).cloned();
            let side = stated_side.unwrap_or_else(|| self.flank.clone().into());
            let pitch = [
                ("kind", "pitch".into()),
                ("side", side),
                ("removed_um", removed),
            ];
            let pitch = pitch.map(|(key, value)| (key.to_owned(), value));
            errors.push(toml::Value::Table(pitch.into_iter().collect()));
        }
        toml::Value::Array(errors)
    }
}

fn setting(key: &str, value: toml::Value) -> Setting {
    Setting {
        parameter: key.to_owned(),
        keys: vec![key.to_owned()],
        value,
    }
}

fn gauge_names(model: &ReducedGear) -> Vec<String> {
    model
        .gauges
        .iter()
        .map(|gauge| gauge.name.clone())
        .collect()
}
