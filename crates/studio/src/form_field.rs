//! A key of a file as a field of the page: its kind, what it means, and values that the page sets.

use gearmesh_geometry::{GearDefinition, InputError};
use serde::Serialize;
use serde_json::{Map, Value};

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
pub fn refused(key: &str, problem: &str) -> InputError {
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
