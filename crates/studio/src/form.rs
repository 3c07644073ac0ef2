//! The keys of files that the page may set. Names, meanings, kinds, words and ranges come from the JSON Schemas that
//! `gearmesh schema` prints. What names a file is left out: the page reads nothing that the command line has not named.

use gearmesh_geometry::{GearDefinition, InputError};
use gearmesh_operations::changed_pair::GEARS;
use gearmesh_operations::schema::{TextKind, schema};
use gearmesh_scene::study::BaseScene;
use serde::Serialize;
use serde_json::{Map, Value};

use crate::form_walk::Walk;

/// Parts of a scene that name files, and those that belong to one side of the flanks or to what comes after a run.
const NOT_OF_SCENES: [&str; 8] = [
    "pair.gear_1",
    "pair.gear_2",
    "pair.misalignment_from",
    "topography",
    "left",
    "right",
    "rating",
    "title",
];

/// Parts of a gear file that name files, that scenes state, and those that no slider suits.
const NOT_OF_GEARS: [&str; 11] = [
    "name",
    "blank.file",
    "blank.length_unit",
    "microgeometry",
    "mesh",
    "reduction",
    "modes",
    "hub",
    "gauge",
    "crack",
    "tooth.cutter",
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
    /// Whole numbers, at least one.
    Counts,
    /// Some of these names.
    Names(Vec<String>),
    /// Pitch errors: material removed from each tooth \[µm\], tooth 0 first.
    PitchErrors(usize),
}

/// A word and its meaning.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Word {
    /// The word.
    pub word: String,
    /// Its meaning.
    pub help: String,
}

/// A key of a file.
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
    /// Whether the file must state it.
    pub needed: bool,
    /// Whether a gear is reduced again for it.
    pub reduces: bool,
    /// What the file states; none where it does not.
    pub stated: Option<Value>,
    /// Least and largest value of the schema.
    pub allowed: [Option<f64>; 2],
    /// Keys that are set with it, and values that suit these gears: where the file does not state them.
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
    /// Their files.
    pub files: [&'a toml::Value; 2],
}

/// The fields of a file.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(transparent)]
pub struct Form {
    /// In the order of the schema.
    pub fields: Vec<Field>,
}

impl Form {
    /// The fields of a pair scene of these gears, and those of the gears' bodies.
    pub fn of_pair(base: &BaseScene, gears: Gears<'_>) -> Self {
        let of_scene = schema(TextKind::Scene);
        let stated = |key: &str| base.value(key);
        let mut walk = Walk::new(&of_scene, &stated, &NOT_OF_SCENES);
        walk.gears = Some(gears);
        walk.table("", &of_scene["$defs"]["PairTables"], &Map::new());
        let mut fields = walk.fields;
        let of_gear = schema(TextKind::Gear);
        for (number, key) in GEARS.iter().enumerate() {
            let stated = |key: &str| found_at(gears.files[number], key).cloned();
            let mut walk = Walk::new(&of_gear, &stated, &NOT_OF_GEARS);
            walk.gear = Some(gears.definitions[number]);
            walk.table("", &of_gear, &Map::new());
            fields.extend(walk.fields.into_iter().map(|field| {
                Field {
                    key: format!("{key}:{}", field.key),
                    group: format!("{}_body.{}", &key["pair.".len()..], field.group),
                    with: (field.with.into_iter())
                        .map(|(second, value)| (format!("{key}:{second}"), value))
                        .collect(),
                    reduces: true,
                    ..field
                }
            }));
        }
        Self { fields }
    }

    /// The fields of a text of a kind; none of a text that is no TOML.
    pub fn of_text(kind: TextKind, text: &str) -> Self {
        let root = toml::from_str(text).unwrap_or(toml::Value::Table(toml::Table::new()));
        let whole = schema(kind);
        let stated = |key: &str| found_at(&root, key).cloned();
        let left_out: &[&str] = match kind {
            TextKind::Scene => &NOT_OF_SCENES,
            TextKind::Gear => &NOT_OF_GEARS,
            _ => &["file", "title", "name"],
        };
        let mut walk = Walk::new(&whole, &stated, left_out);
        let top = match kind {
            TextKind::Scene => &whole["$defs"]["PairTables"],
            _ => &whole,
        };
        walk.table("", top, &Map::new());
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

/// What stands at a dotted path.
pub fn found_at<'a>(root: &'a toml::Value, key: &str) -> Option<&'a toml::Value> {
    key.split('.').try_fold(root, |place, part| place.get(part))
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
        let whole = |value: &Value| {
            let whole = number(value).filter(|x| x.fract() == 0.0 && x.abs() < 1e15);
            whole.map(|x| toml::Value::Integer(x as i64))
        };
        let text = |value: &Value| value.as_str().map(str::to_owned);
        match &self.kind {
            Kind::Number => number(value)
                .map(toml::Value::Float)
                .ok_or_else(|| wrong("a number")),
            Kind::Whole => whole(value).ok_or_else(|| wrong("a whole number")),
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
            Kind::Counts => {
                let list = value.as_array().map(|list| list.iter().map(whole));
                let list = list.and_then(Iterator::collect::<Option<Vec<_>>>);
                list.map(toml::Value::Array)
                    .ok_or_else(|| wrong("a list of whole numbers"))
            }
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

/// The pitch errors among the errors that a scene states: their place and their numbers.
pub fn pitch_errors(errors: &toml::Value) -> Option<(usize, &toml::Value)> {
    let list = errors.as_array()?;
    let place = list
        .iter()
        .position(|error| error.get("kind").and_then(toml::Value::as_str) == Some("pitch"))?;
    Some((place, list[place].get("removed_um")?))
}
