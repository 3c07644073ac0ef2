//! A gear pair whose scene, and whose gears, the page changes again and again.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use gearmesh_model::ReducedGear;
use gearmesh_operations::Watch;
use gearmesh_operations::changed_pair::ChangedPair;
use gearmesh_report::moving::GearShape;
use gearmesh_report::words_and_unit;
use gearmesh_scene::pair::PairWatch;
use gearmesh_scene::study::PairColumns;
use gearmesh_scene::{LoadedScene, SceneResult};
use gearmesh_specification::study::{Case, Setting};
use serde::Deserialize;
use serde_json::{Value, json};

use crate::answer::PairAnswer;
use crate::form::Form;
use crate::form_field::{Field, Gears, Kind, pitch_errors};
use crate::problem::Problem;

/// Bytes of forces, pressures and places that a page can show; results beyond belong into a file.
const MOST_BYTES: f64 = 30e6;

/// What the page has changed.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Change {
    /// Keys of the scene and their values; those of a gear's body as `pair.gear_1:blank.bore_diameter_mm`.
    #[serde(default)]
    pub settings: BTreeMap<String, Value>,
    /// Keys that the scene states and that are taken away.
    #[serde(default)]
    pub removed: Vec<String>,
}

impl Change {
    /// The part of it that gears are reduced for, as a text.
    pub fn of_bodies(&self) -> String {
        let of_bodies = self.settings.iter().filter(|(key, _)| key.contains(':'));
        let all: BTreeMap<&String, &Value> = of_bodies.collect();
        json!(all).to_string()
    }
}

/// A pair scene and its models, in memory.
#[derive(Debug)]
pub struct PairSession {
    pair: ChangedPair,
    flank: String,
    title: String,
    /// Of the scene as it is.
    form: Form,
    gauges: [Vec<String>; 2],
    files: [toml::Value; 2],
    /// Columns that may be objectives.
    columns: Vec<String>,
    /// Where models of changed bodies are kept when a state is saved.
    models: PathBuf,
}

impl PairSession {
    /// Reads a scene and its models.
    ///
    /// # Errors
    /// [`Problem`] for a scene or a model that is wrong.
    pub fn read(path: &Path) -> Result<Self, Problem> {
        Self::new(ChangedPair::read(path)?, path)
    }

    /// The scene of a result; its models stand where the result says.
    ///
    /// # Errors
    /// As [`PairSession::read`].
    pub fn of_result(path: &Path, result: &SceneResult) -> Result<Self, Problem> {
        Self::new(ChangedPair::of_result(path, result)?, path)
    }

    fn new(pair: ChangedPair, path: &Path) -> Result<Self, Problem> {
        let loaded = pair.loaded(&Case::default())?;
        let read = |model: &ReducedGear| -> Result<toml::Value, Problem> {
            let file = toml::from_str(&model.input.text);
            file.map_err(|error| Problem::Input(format!("{}: {error}", model.name)))
        };
        let [model_1, model_2] = &loaded.models;
        let folder = path.parent().unwrap_or(Path::new("")).join("models");
        let mut this = Self {
            flank: loaded.scene.flank.name().to_owned(),
            title: loaded.scene.title.clone(),
            form: Form { fields: Vec::new() },
            gauges: [gauge_names(model_1), gauge_names(model_2)],
            files: [read(model_1)?, read(model_2)?],
            columns: PairColumns::of_scene(&loaded).names(),
            models: std::path::absolute(&folder).unwrap_or(folder),
            pair,
        };
        this.form = this.form(&Case::default())?.0;
        Ok(this)
    }

    /// The keys, for the gears of a case, and the shapes of these.
    fn form(&self, case: &Case) -> Result<(Form, [GearShape; 2]), Problem> {
        let gears = self.pair.gears(case)?;
        let form = Form::of_pair(
            self.pair.base(),
            Gears {
                definitions: [&gears[0], &gears[1]],
                gauges: [&self.gauges[0], &self.gauges[1]],
                files: [&self.files[0], &self.files[1]],
            },
        );
        Ok((form, [GearShape::of(&gears[0]), GearShape::of(&gears[1])]))
    }

    /// What the page is made of: the keys, the gears, of a changed pair.
    ///
    /// # Errors
    /// [`Problem`] for what the scene or a gear refuses.
    pub fn description(&self, change: &Change) -> Result<Value, Problem> {
        let (form, shapes) = self.form(&self.case(change)?)?;
        Ok(json!({
            "title": self.title,
            "file": self.pair.base().file(),
            "fields": form,
            "columns": self.columns.iter().map(column).collect::<Vec<_>>(),
            "gears": shapes,
        }))
    }

    /// The changed pair, computed.
    ///
    /// # Errors
    /// [`Problem`] for what the scene refuses, for a run that is too long for a page, for bodies that are not reduced
    /// yet, and once `watch` stops it.
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
        let result = ChangedPair::solve(&loaded, watch)?;
        PairAnswer::new(&loaded, &result)
    }

    /// Reduces the changed bodies.
    ///
    /// # Errors
    /// [`Problem`] for a body that cannot be reduced, and once `watch` stops it.
    pub fn reduce(&self, change: &Change, watch: &Watch<'_>) -> Result<Value, Problem> {
        self.pair.reduce(&self.case(change)?, watch)?;
        Ok(Value::Null)
    }

    /// The changed scene as a file.
    ///
    /// # Errors
    /// [`Problem`] for what the scene refuses.
    pub fn toml(&self, change: &Change) -> Result<String, Problem> {
        let case = self.case(change)?;
        self.demand_reduced(&case)?;
        Ok(self.pair.toml(&case, &self.models)?)
    }

    /// The changed scene with its models where they are now: for what is done in its lifetime.
    pub(crate) fn text(&self, change: &Change) -> Result<String, Problem> {
        let case = self.case(change)?;
        self.demand_reduced(&case)?;
        Ok(self.pair.text(&case)?)
    }

    /// The field of a key.
    pub(crate) fn field(&self, key: &str) -> Result<&Field, Problem> {
        Ok(self.form.field(key)?)
    }

    fn loaded(&self, change: &Change) -> Result<LoadedScene, Problem> {
        let case = self.case(change)?;
        self.demand_reduced(&case)?;
        Ok(self.pair.loaded(&case)?)
    }

    fn demand_reduced(&self, case: &Case) -> Result<(), Problem> {
        let unreduced = self.pair.unreduced(case)?;
        match unreduced.is_empty() {
            true => Ok(()),
            false => Err(Problem::Unreduced(unreduced.join(", "))),
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
                case.settings.push(Setting::of(&key, value));
            }
        }
        for key in &change.removed {
            let field = self.form.field(key)?;
            if field.reduces {
                let problem = format!("{key}: keys of a body are not taken away here; set it");
                return Err(Problem::Input(problem));
            }
            if let Kind::PitchErrors(_) = field.kind {
                // Other errors of the gear stay.
                case.settings
                    .push(Setting::of(key, self.with_pitch_errors(key, None)));
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
        let stated = self.pair.base().value(key);
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

fn column(name: &String) -> Value {
    let (label, unit) = words_and_unit(name);
    json!({"name": name, "label": label, "unit": unit})
}

fn gauge_names(model: &ReducedGear) -> Vec<String> {
    model
        .gauges
        .iter()
        .map(|gauge| gauge.name.clone())
        .collect()
}
