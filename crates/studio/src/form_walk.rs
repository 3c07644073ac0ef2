//! The way through a JSON Schema: each key that has a value of a kind that a page can set becomes a field.

use gearmesh_geometry::GearDefinition;
use gearmesh_operations::schema::followed;
use gearmesh_report::words_and_unit;
use serde_json::{Map, Value};

use crate::form_field::{Field, Gears, Kind, Word, pitch_errors};
use crate::form_reach::{Shape, allowed, reach, suited};

/// Amounts that need a second key, and that key.
const NEEDED_WITH: [(&str, &str); 4] = [
    ("tip_relief_um", "tip_relief_start_diameter_mm"),
    ("root_relief_um", "root_relief_start_diameter_mm"),
    ("profile_crowning_um", "profile_crowning_diameter_mm"),
    ("end_relief_um", "end_relief_length_mm"),
];

/// On its way through the schema of one file.
pub struct Walk<'a> {
    definitions: &'a Value,
    /// Names of the definitions around the one that is looked at: a table may contain itself.
    within: Vec<&'a str>,
    stated: &'a dyn Fn(&str) -> Option<toml::Value>,
    left_out: &'a [&'a str],
    /// The gears of a pair scene.
    pub gears: Option<Gears<'a>>,
    /// The gear of a gear file.
    pub gear: Option<&'a GearDefinition>,
    /// What was found.
    pub fields: Vec<Field>,
}

impl<'a> Walk<'a> {
    /// `stated`: what the file states at a key. `left_out`: last words of keys, or whole keys.
    pub fn new(
        schema: &'a Value,
        stated: &'a dyn Fn(&str) -> Option<toml::Value>,
        left_out: &'a [&'a str],
    ) -> Self {
        Self {
            definitions: &schema["$defs"],
            within: Vec::new(),
            stated,
            left_out,
            gears: None,
            gear: None,
            fields: Vec::new(),
        }
    }

    fn resolved(&self, schema: &'a Value) -> (&'a Value, Option<&'a str>) {
        followed(self.definitions, schema)
    }

    /// The keys of a table. `tags`: what must stand beside them so that they mean something.
    pub fn table(&mut self, path: &str, table: &'a Value, tags: &Map<String, Value>) {
        let Some(keys) = table["properties"].as_object() else {
            return;
        };
        let needed: Vec<&str> = (table["required"].as_array().into_iter().flatten())
            .filter_map(Value::as_str)
            .collect();
        for (name, schema) in keys {
            let key = below(path, name);
            let is_left_out = (self.left_out.iter()).any(|out| *out == name || *out == key);
            if is_left_out || !schema["const"].is_null() {
                continue;
            }
            let (found, definition) = self.resolved(schema);
            if let Some(kind) = self.kind(&key, found) {
                let words = schema["description"]
                    .as_str()
                    .or(found["description"].as_str());
                let is_needed = needed.contains(&&name[..]);
                let about = (words, allowed(schema, found, name));
                let mut field = self.field((path, name), about, kind, is_needed);
                field.with = self.with((path, name), &needed, tags);
                self.fields.push(field);
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

    /// A table in a table: by itself, the only kind of its kinds, or the kind that the file states.
    fn inner(&mut self, key: &str, table: &'a Value) {
        let kinds = table["oneOf"].as_array().map(Vec::as_slice);
        let kinds = kinds.unwrap_or_default();
        if kinds.is_empty() {
            return self.table(key, table, &Map::new());
        }
        let tags_of = |kind: &Value| -> Map<String, Value> {
            let keys = kind["properties"].as_object().into_iter().flatten();
            let tags = keys.filter(|(_, schema)| !schema["const"].is_null());
            tags.map(|(name, schema)| (below(key, name), schema["const"].clone()))
                .collect()
        };
        let is_stated = |kind: &&Value| {
            let tags = tags_of(kind);
            let mut tags = tags.iter().peekable();
            tags.peek().is_some()
                && tags.all(|(key, word)| {
                    (self.stated)(key).is_some_and(|found| found.as_str() == word.as_str())
                })
        };
        let only = (kinds.len() == 1).then(|| &kinds[0]);
        let Some(kind) = kinds.iter().find(is_stated).or(only) else {
            return;
        };
        let tags = tags_of(kind);
        let (kind, _) = self.resolved(kind);
        self.table(key, kind, &tags);
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
                _ if is(items, "integer") => Some(Kind::Counts),
                "gauges.gear_1" => Some(Kind::Names(self.gears?.gauges[0].to_vec())),
                "gauges.gear_2" => Some(Kind::Names(self.gears?.gauges[1].to_vec())),
                _ if name == Some("FlankErrorTable") => {
                    let gear = usize::from(key.ends_with('2'));
                    let definitions = self.gears?.definitions;
                    Some(Kind::PitchErrors(definitions[gear].tooth.teeth))
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
        let words: Option<Vec<Word>> = words.iter().map(word).collect();
        words.map(Kind::Word)
    }

    fn field(
        &self,
        (path, name): (&str, &str),
        (words, allowed): (Option<&str>, [Option<f64>; 2]),
        kind: Kind,
        needed: bool,
    ) -> Field {
        let key = below(path, name);
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
        let stated = (self.stated)(&key).and_then(|value| match kind {
            Kind::PitchErrors(_) => pitch_errors(&value).map(|(_, removed)| removed.clone()),
            _ => Some(value),
        });
        let stated = stated.and_then(|value| serde_json::to_value(value).ok());
        let shape = self.shape_of(&key);
        Field {
            group: path.to_owned(),
            label,
            unit,
            help,
            needed,
            reduces: false,
            reach: reach(&key, unit, (stated.as_ref(), allowed), shape),
            stated,
            allowed,
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

    /// What is set with a key: the words that its table needs, a second key of its amount, and the other keys that a
    /// table needs which the file does not have.
    fn with(
        &self,
        (path, name): (&str, &str),
        needed: &[&str],
        tags: &Map<String, Value>,
    ) -> Map<String, Value> {
        let mut with = tags.clone();
        let seconds = NEEDED_WITH.iter().filter(|(amount, _)| *amount == name);
        let others = needed.iter().filter(|other| **other != name);
        for second in seconds.map(|(_, second)| second).chain(others) {
            let second = below(path, second);
            let shape = self.shape_of(&second);
            if let Some(value) = shape.and_then(|shape| suited(&second, shape)) {
                with.insert(second, value.into());
            }
        }
        with.retain(|key, _| (self.stated)(key).is_none());
        with
    }

    /// The gear that a key acts on, or the first one.
    fn shape_of(&self, key: &str) -> Option<Shape<'a>> {
        let gear = match (self.gear, self.gears) {
            (Some(gear), _) => gear,
            (None, gears) => gears?.definitions[usize::from(key.starts_with("gear_2."))],
        };
        let of_gear =
            self.gear.is_some() || key.starts_with("gear_1.") || key.starts_with("gear_2.");
        Some(Shape { gear, of_gear })
    }
}

/// A key of a table.
fn below(path: &str, name: &str) -> String {
    match path {
        "" => name.to_owned(),
        path => format!("{path}.{name}"),
    }
}
