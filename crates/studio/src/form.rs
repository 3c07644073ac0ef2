//! The keys of a scene that the page may set. Names, meanings, kinds and words come from the JSON Schema that
//! `gearmesh schema scene` prints. What names a file is left out: the page reads nothing that the command line has not
//! named.

use gearmesh_geometry::{GearDefinition, InputError};
use gearmesh_report::words_and_unit;
use gearmesh_scene::study::BaseScene;
use serde::Serialize;
use serde_json::{Map, Value};

/// Parts of a scene that name files, and those that belong to one side of the flanks or to what comes after a run.
const LEFT_OUT: [&str; 8] = [
    "pair.gear_1",
    "pair.gear_2",
    "pair.misalignment_from",
    "topography",
    "left",
    "right",
    "rating",
    "title",
];

/// Amounts that need a second key, and that key.
const NEEDED_WITH: [(&str, &str); 4] = [
    ("tip_relief_um", "tip_relief_start_diameter_mm"),
    ("root_relief_um", "root_relief_start_diameter_mm"),
    ("profile_crowning_um", "profile_crowning_diameter_mm"),
    ("end_relief_um", "end_relief_length_mm"),
];

/// Kind of a value.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// A number.
    Number,
    /// A whole number.
    Whole,
    /// One of these words.
    Word(Vec<Word>),
    /// Numbers, at least one.
    Numbers,
    /// Some of these names.
    Names(Vec<String>),
    /// Pitch errors: material removed from each tooth \[µm\], tooth 0 first.
    PitchErrors(usize),
}

/// A word and its meaning.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Word {
    word: String,
    help: String,
}

/// A key of the scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Field {
    /// Dotted path.
    pub key: String,
    /// The table that it stands in.
    pub group: String,
    /// In words.
    pub label: String,
    /// Unit of its value.
    pub unit: &'static str,
    /// What it means.
    pub help: String,
    /// What its values are.
    pub kind: Kind,
    /// Whether the scene must state it.
    pub needed: bool,
    /// What the scene states; none where it does not.
    pub stated: Option<Value>,
    /// Keys that are set with it, and values that suit these gears: where the scene does not state them.
    pub with: Map<String, Value>,
    /// Where a slider goes; values beyond may be typed.
    pub reach: Option<[f64; 2]>,
}

/// The gears that the keys act on.
#[derive(Debug, Clone, Copy)]
pub struct Gears<'a> {
    /// Definitions of both.
    pub definitions: [&'a GearDefinition; 2],
    /// Names of the gauges that their models have.
    pub gauges: [&'a [String]; 2],
}

/// The fields of a scene.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(transparent)]
pub struct Form {
    /// In the order of the schema.
    pub fields: Vec<Field>,
}

impl Form {
    /// The fields of a pair scene of these gears.
    pub fn of_pair(base: &BaseScene, gears: Gears<'_>) -> Self {
        let schema = gearmesh_scene::schema::scene().to_value();
        let pair = &schema["$defs"]["SceneTable"];
        let mut walk = Walk {
            definitions: &schema["$defs"],
            within: Vec::new(),
            base,
            gears,
            fields: Vec::new(),
        };
        walk.table("", pair, &Map::new());
        Self {
            fields: walk.fields,
        }
    }

    /// The field of a key.
    ///
    /// # Errors
    /// What to say of a key that is none.
    pub fn field(&self, key: &str) -> Result<&Field, InputError> {
        let found = self.fields.iter().find(|field| field.key == key);
        found.ok_or_else(|| refused(key, "is no key that the page may set"))
    }
}

impl Field {
    /// A value from the page as the scene has it.
    ///
    /// # Errors
    /// [`InputError`] for a value of another kind.
    pub fn value(&self, value: &Value) -> Result<toml::Value, InputError> {
        let wrong =
            |allowed: &str| refused(&self.key, &format!("found {value}, allowed is {allowed}"));
        let number = |value: &Value| value.as_f64().filter(|x| x.is_finite());
        let numbers = |value: &Value| -> Option<Vec<toml::Value>> {
            let list = value.as_array()?;
            list.iter()
                .map(|x| number(x).map(toml::Value::Float))
                .collect()
        };
        let text = |value: &Value| value.as_str().map(str::to_owned);
        match &self.kind {
            Kind::Number => number(value)
                .map(toml::Value::Float)
                .ok_or_else(|| wrong("a number")),
            Kind::Whole => {
                let whole = number(value).filter(|x| x.fract() == 0.0 && x.abs() < 1e15);
                whole
                    .map(|x| toml::Value::Integer(x as i64))
                    .ok_or_else(|| wrong("a whole number"))
            }
            Kind::Word(words) => {
                let known = text(value).filter(|text| words.iter().any(|word| word.word == *text));
                let all: Vec<&str> = words.iter().map(|word| &word.word[..]).collect();
                known
                    .map(toml::Value::String)
                    .ok_or_else(|| wrong(&all.join(", ")))
            }
            Kind::Numbers => numbers(value)
                .map(toml::Value::Array)
                .ok_or_else(|| wrong("a list of numbers")),
            Kind::Names(names) => {
                let list = value.as_array().ok_or_else(|| wrong("a list of names"))?;
                let known = list
                    .iter()
                    .map(|name| text(name).filter(|name| names.contains(name)));
                let known: Option<Vec<String>> = known.collect();
                let known = known.ok_or_else(|| wrong(&names.join(", ")))?;
                Ok(toml::Value::Array(
                    known.into_iter().map(toml::Value::String).collect(),
                ))
            }
            Kind::PitchErrors(teeth) => {
                let allowed = format!("a list of {teeth} numbers: one a tooth");
                let removed = numbers(value).filter(|list| list.len() == *teeth);
                removed
                    .map(toml::Value::Array)
                    .ok_or_else(|| wrong(&allowed))
            }
        }
    }
}

/// A complaint about a key of a request.
fn refused(key: &str, problem: &str) -> InputError {
    InputError {
        file: "the page".to_owned(),
        line: None,
        key: key.to_owned(),
        problem: problem.to_owned(),
    }
}

struct Walk<'a> {
    definitions: &'a Value,
    /// Names of the definitions around the one that is looked at: a table may contain itself.
    within: Vec<&'a str>,
    base: &'a BaseScene,
    gears: Gears<'a>,
    fields: Vec<Field>,
}

impl<'a> Walk<'a> {
    /// What a schema stands for: its reference followed, `null` beside it left out.
    fn resolved(&self, schema: &'a Value) -> (&'a Value, Option<&'a str>) {
        if let Some(reference) = schema["$ref"].as_str() {
            let name = reference.rsplit('/').next().unwrap_or_default();
            return (&self.definitions[name], Some(name));
        }
        let parts = schema["anyOf"]
            .as_array()
            .map(Vec::as_slice)
            .unwrap_or_default();
        let mut others = parts.iter().filter(|part| part["type"] != "null");
        match (others.next(), others.next()) {
            (Some(only), None) => self.resolved(only),
            _ => (schema, None),
        }
    }

    /// The keys of a table. `tags`: what must stand beside them so that they mean something.
    fn table(&mut self, path: &str, table: &'a Value, tags: &Map<String, Value>) {
        let Some(keys) = table["properties"].as_object() else {
            return;
        };
        let needed = table["required"]
            .as_array()
            .map(Vec::as_slice)
            .unwrap_or_default();
        for (name, schema) in keys {
            let key = match path {
                "" => name.clone(),
                path => format!("{path}.{name}"),
            };
            let is_left_out = LEFT_OUT.iter().any(|out| *out == name || *out == key);
            if is_left_out || !schema["const"].is_null() {
                continue;
            }
            let (found, definition) = self.resolved(schema);
            if let Some(kind) = self.kind(&key, found) {
                let words = schema["description"]
                    .as_str()
                    .or(found["description"].as_str());
                let is_needed = needed.iter().any(|one| one == name);
                let field = self.field((path, name), words, kind, is_needed);
                self.fields.push(Field {
                    with: self.with(&key, tags),
                    ..field
                });
                continue;
            }
            if definition.is_some_and(|name| self.within.contains(&name)) {
                continue;
            }
            self.within.extend(definition);
            self.inner(&key, found);
            if definition.is_some() {
                self.within.pop();
            }
        }
    }

    /// A table in a table: by itself, or the only kind of its kinds.
    fn inner(&mut self, key: &str, table: &'a Value) {
        let kinds = table["oneOf"]
            .as_array()
            .map(Vec::as_slice)
            .unwrap_or_default();
        let [only] = kinds else {
            return self.table(key, table, &Map::new());
        };
        let mut tags = Map::new();
        for (name, schema) in only["properties"].as_object().into_iter().flatten() {
            if !schema["const"].is_null() {
                tags.insert(format!("{key}.{name}"), schema["const"].clone());
            }
        }
        self.table(key, only, &tags);
    }

    fn kind(&self, key: &str, schema: &'a Value) -> Option<Kind> {
        let is = |schema: &Value, word: &str| match &schema["type"] {
            Value::String(one) => one == word,
            Value::Array(several) => several.iter().any(|one| one == word),
            _ => false,
        };
        if is(schema, "number") {
            return Some(Kind::Number);
        }
        if is(schema, "integer") {
            return Some(Kind::Whole);
        }
        if is(schema, "array") {
            let (items, name) = self.resolved(&schema["items"]);
            return match key {
                _ if is(items, "number") => Some(Kind::Numbers),
                "gauges.gear_1" => Some(Kind::Names(self.gears.gauges[0].to_vec())),
                "gauges.gear_2" => Some(Kind::Names(self.gears.gauges[1].to_vec())),
                _ if name == Some("FlankErrorTable") => {
                    let gear = usize::from(key.ends_with('2'));
                    Some(Kind::PitchErrors(self.gears.definitions[gear].tooth.teeth))
                }
                _ => None,
            };
        }
        let words = schema["oneOf"].as_array().or(schema["enum"].as_array())?;
        let word = |one: &Value| {
            let word = one["const"].as_str().or(one.as_str())?;
            let help = one["description"].as_str().unwrap_or_default();
            Some(Word {
                word: word.to_owned(),
                help: help.to_owned(),
            })
        };
        words
            .iter()
            .map(word)
            .collect::<Option<Vec<Word>>>()
            .map(Kind::Word)
    }

    fn field(
        &self,
        (path, name): (&str, &str),
        words: Option<&str>,
        kind: Kind,
        needed: bool,
    ) -> Field {
        let key = format!("{path}.{name}");
        let (label, unit) = words_and_unit(name);
        let (label, unit) = match &kind {
            // Of the errors of a gear the page sets those of the pitch.
            Kind::PitchErrors(_) => (
                format!("pitch {label}").replace("errors", "errors of gear"),
                "µm",
            ),
            _ => (label, unit),
        };
        let help = match &kind {
            Kind::PitchErrors(_) => self.pitch_help(),
            _ => words.unwrap_or_default().replace('\n', " "),
        };
        let stated = self.base.value(&key).and_then(|value| match kind {
            Kind::PitchErrors(_) => pitch_errors(&value).map(|(_, removed)| removed.clone()),
            _ => Some(value),
        });
        let stated = stated.and_then(|value| serde_json::to_value(value).ok());
        Field {
            group: path.to_owned(),
            label,
            unit,
            help,
            needed,
            reach: self.reach(&key, unit, stated.as_ref()),
            stated,
            kind,
            key,
            with: Map::new(),
        }
    }

    /// What the schema says of the numbers of pitch errors.
    fn pitch_help(&self) -> String {
        let kinds = self.definitions["FlankErrorTable"]["oneOf"].as_array();
        let pitch = kinds
            .into_iter()
            .flatten()
            .find(|kind| kind["properties"]["kind"]["const"] == "pitch");
        let words =
            pitch.and_then(|pitch| pitch["properties"]["removed_um"]["description"].as_str());
        words.unwrap_or_default().to_owned()
    }

    fn with(&self, key: &str, tags: &Map<String, Value>) -> Map<String, Value> {
        let mut with = tags.clone();
        let (path, name) = key.rsplit_once('.').unwrap_or(("", key));
        for (_, second) in NEEDED_WITH.iter().filter(|(amount, _)| *amount == name) {
            let second = format!("{path}.{second}");
            if let Some(value) = self.suited(&second) {
                with.insert(second, value.into());
            }
        }
        with.retain(|key, _| self.base.value(key).is_none());
        with
    }

    /// A value that suits the gears: reliefs begin halfway in roll length between the pitch circle and the tip or the form
    /// circle, crowning is zero at the pitch circle, end reliefs take a tenth of the face. In hundredths of a millimetre.
    fn suited(&self, key: &str) -> Option<f64> {
        let gear = self.gear_of(key)?;
        let tooth = &gear.profile;
        let pitch_roll = (tooth.reference_radius_m / tooth.base_radius_m).powi(2) - 1.0;
        let pitch_roll = pitch_roll.max(0.0).sqrt();
        let diameter = |roll: f64| 2e3 * tooth.base_radius_m * (1.0 + roll * roll).sqrt();
        let value = match key.rsplit('.').next()? {
            "tip_relief_start_diameter_mm" => diameter(0.5 * (pitch_roll + tooth.tip_roll_rad)),
            "root_relief_start_diameter_mm" => diameter(0.5 * (pitch_roll + tooth.form_roll_rad)),
            "profile_crowning_diameter_mm" => diameter(pitch_roll),
            "end_relief_length_mm" => 1e2 * gear.tooth.face_width_m,
            _ => return None,
        };
        Some((value * 100.0).round() / 100.0)
    }

    fn gear_of(&self, key: &str) -> Option<&GearDefinition> {
        let place = ["gear_1.", "gear_2."]
            .iter()
            .position(|start| key.starts_with(start))?;
        Some(self.gears.definitions[place])
    }

    /// Where a slider goes, about what is stated; a matter of taste, no limit.
    fn reach(&self, key: &str, unit: &str, stated: Option<&Value>) -> Option<[f64; 2]> {
        let now = stated.and_then(|value| match value {
            Value::Array(list) => list.iter().filter_map(Value::as_f64).reduce(f64::max),
            value => value.as_f64(),
        });
        let name = key.rsplit('.').next().unwrap_or(key);
        let reach = match (name, unit) {
            ("centre_distance_mm", _) => now.map(|a| [a - 0.2, a + 0.5])?,
            ("torques_Nm", _) => now.map(|most| [0.02 * most, 2.0 * most])?,
            ("dynamic_coefficient", _) => [0.0, 0.3],
            ("edge_radius_um", _) => [1.0, 500.0],
            ("slices", _) => [1.0, 2.0 * self.slices()],
            ("points_per_pitch", _) => [8.0, 120.0],
            ("pitches", _) => [1.0, 12.0],
            ("start_deg", _) => [0.0, 360.0 / self.gears.definitions[0].tooth.teeth as f64],
            ("end_relief_length_mm", _) => [0.0, 5e2 * self.gear_of(key)?.tooth.face_width_m],
            (name, "mm") if name.contains("diameter") => {
                let tooth = &self.gear_of(key)?.profile;
                let form = tooth.base_radius_m * (1.0 + tooth.form_roll_rad.powi(2)).sqrt();
                [2e3 * form, 2e3 * tooth.tip_radius_m]
            }
            (name, "µm") if name.contains("angle") || name.contains("twist") => [-40.0, 40.0],
            (_, "µm") => [0.0, 60.0],
            (_, "mrad") => [-0.5, 0.5],
            (_, "mm") => [-5.0, 5.0],
            _ => return None,
        };
        // What is stated lies on it.
        Some(now.map_or(reach, |now| [reach[0].min(now), reach[1].max(now)]))
    }

    fn slices(&self) -> f64 {
        self.gears.definitions[0].reduction.slices as f64
    }
}

/// The pitch errors among the errors that a scene states: their place and their numbers.
pub fn pitch_errors(errors: &toml::Value) -> Option<(usize, &toml::Value)> {
    let list = errors.as_array()?;
    let place = list
        .iter()
        .position(|error| error.get("kind").and_then(toml::Value::as_str) == Some("pitch"))?;
    Some((place, list[place].get("removed_um")?))
}
