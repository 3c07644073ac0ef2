//! A JSON Schema as a page of Markdown: `gearmesh schema KIND --markdown`, the pages in docs/reference.

use gearmesh_geometry::input::NumberRange;
use gearmesh_operations::schema::followed;
use serde_json::Value;
use std::collections::BTreeSet;
use std::fmt::Write as _;

/// Makes the page.
pub fn page(schema: &Value, kind: &str) -> String {
    let mut page = Page {
        definitions: &schema["$defs"],
        told: BTreeSet::new(),
        text: String::new(),
    };
    let _ = write!(
        page.text,
        "# Keys of {kind} files\n\nMade by `gearmesh schema {kind} --markdown` from what the program reads; units are part of the names of the keys. \
         Keys in **bold** must be given. Of a table with kinds, keys above the first kind belong to all.\n"
    );
    match schema["anyOf"].as_array() {
        None => page.table("Top level", "", schema),
        Some(kinds) => {
            for one in kinds {
                page.table(words_of(one).trim_end_matches('.'), "", one);
            }
        }
    }
    page.text
}

struct Page<'a> {
    definitions: &'a Value,
    /// Tables that have been described.
    told: BTreeSet<String>,
    text: String,
}

impl<'a> Page<'a> {
    /// What a schema stands for: its reference followed, `null` beside it left out.
    fn resolved(&self, schema: &'a Value) -> (&'a Value, Option<&'a str>) {
        followed(self.definitions, schema)
    }

    /// A section with the keys of a table, then those of the tables in it. `path` is empty for the file itself.
    fn table(&mut self, title: &str, path: &str, schema: &'a Value) {
        let (found, name) = self.resolved(schema);
        if name.is_some_and(|name| !self.told.insert(name.to_owned())) {
            return;
        }
        let _ = write!(self.text, "\n## {title}\n\n");
        let about = words_of(found);
        if !about.is_empty() && !path.is_empty() {
            let _ = write!(self.text, "{about}\n\n");
        }
        self.text += "| key | value | meaning |\n| --- | --- | --- |\n";
        let variants = variants(found);
        let shared = shared_keys(&variants);
        let mut inner = Vec::new();
        for (number, variant) in variants.into_iter().enumerate() {
            let needed: Vec<&str> = strings(&variant["required"]);
            let Some(keys) = variant["properties"].as_object() else {
                continue;
            };
            // Before those of the first kind stand the keys that all kinds have; the word that tells the kinds apart
            // stands above the keys of its kind.
            let of_all = |key: &str| shared.contains(&key);
            let is_word = |value: &Value| !value["const"].is_null();
            let is_first = |(key, _): &(&String, &Value)| number == 0 && of_all(key);
            let own = || keys.iter().filter(|(key, _)| !of_all(key));
            let (words, others): (Vec<_>, Vec<_>) = own().partition(|(_, value)| is_word(value));
            let all = keys.iter().filter(is_first);
            for (key, value) in all.chain(words).chain(others) {
                self.row(key, value, (variant, needed.contains(&key.as_str())));
                let (target, _) = self.resolved(value);
                let (element, is_list) = match target["items"] {
                    Value::Null => (target, false),
                    ref items => (self.resolved(items).0, true),
                };
                let mut kinds = self::variants(element).into_iter();
                if kinds.any(|v| v["properties"].is_object()) {
                    inner.push((key.clone(), is_list, value));
                }
            }
        }
        for (key, is_list, value) in inner {
            let path = if path.is_empty() {
                key
            } else {
                format!("{path}.{key}")
            };
            let title = if is_list {
                format!("`[[{path}]]`")
            } else {
                format!("`[{path}]`")
            };
            let (target, _) = self.resolved(value);
            let inner = if is_list { &target["items"] } else { value };
            self.table(&title, &path, inner);
        }
    }

    /// The row of a key.
    fn row(&mut self, key: &str, value: &'a Value, (variant, is_needed): (&Value, bool)) {
        let shown = match is_needed {
            true => format!("**`{key}`**"),
            false => format!("`{key}`"),
        };
        // The word that tells one kind of table from the others means that kind.
        let meanings = [value, self.resolved(value).0, variant].map(words_of);
        let meaning = meanings.into_iter().find(|text| !text.is_empty());
        let kind = self.kind(value, NumberRange::of(key));
        let meaning = cell(&meaning.unwrap_or_default());
        let _ = writeln!(self.text, "| {shown} | {kind} | {meaning} |");
    }

    /// What a value is, in words; a range where it is narrower than that of all numbers of the unit.
    fn kind(&self, schema: &'a Value, unit: NumberRange) -> String {
        let (found, _) = self.resolved(schema);
        if let Some(word) = found["const"].as_str() {
            return format!("`\"{word}\"`");
        }
        let words = strings(&found["enum"]);
        if !words.is_empty() {
            return words
                .iter()
                .map(|w| format!("`\"{w}\"`"))
                .collect::<Vec<_>>()
                .join(", ");
        }
        for list in ["oneOf", "anyOf"] {
            if let Some(parts) = found[list].as_array() {
                let mut kinds: Vec<String> =
                    parts.iter().map(|part| self.kind(part, unit)).collect();
                kinds.dedup();
                return kinds.join(", ");
            }
        }
        let types = match &found["type"] {
            Value::String(one) => vec![one.as_str()],
            list => strings(list),
        };
        match types.iter().find(|kind| **kind != "null") {
            Some(&"array") => {
                let of = self.kind(&found["items"], unit);
                match found["maxItems"].as_u64() {
                    Some(count) => format!("{count} × {of}"),
                    None => format!("list: {of}"),
                }
            }
            Some(&"string") => "text".to_owned(),
            Some(&"boolean") => "true or false".to_owned(),
            Some(&"object") => "table".to_owned(),
            // Counts are not negative.
            Some(&"integer") if found["maximum"].is_null() => "integer".to_owned(),
            Some(other) => format!("{other}{}", range(found, unit)),
            None => "any".to_owned(),
        }
    }
}

/// The ends of a number's range, as in " > 0, ≤ 1".
fn range(schema: &Value, unit: NumberRange) -> String {
    let ends = [
        ("exclusiveMinimum", ">"),
        ("minimum", "≥"),
        ("exclusiveMaximum", "<"),
        ("maximum", "≤"),
    ];
    let ends = ends.iter().filter_map(|(end, sign)| {
        let value = schema[*end].as_f64()?;
        (value.abs() < unit.largest()).then(|| format!("{sign} {value}"))
    });
    let ends: Vec<String> = ends.collect();
    match ends.is_empty() {
        true => String::new(),
        false => format!(" {}", ends.join(", ")),
    }
}

/// A table itself, or the tables that it may be.
fn variants(schema: &Value) -> Vec<&Value> {
    let several = schema["oneOf"].as_array().or(schema["anyOf"].as_array());
    several.map_or(vec![schema], |list| list.iter().collect())
}

/// Keys that several kinds of a table all have, with the same meaning.
fn shared_keys<'a>(variants: &[&'a Value]) -> Vec<&'a str> {
    let [first, others @ ..] = variants else {
        return Vec::new();
    };
    if others.is_empty() {
        return Vec::new();
    }
    let is_needed = |variant: &Value, key: &str| strings(&variant["required"]).contains(&key);
    let keys = first["properties"].as_object().into_iter().flatten();
    let shared = keys.filter(|(key, value)| {
        others.iter().all(|other| {
            other["properties"][key.as_str()] == **value
                && is_needed(other, key) == is_needed(first, key)
        })
    });
    shared.map(|(key, _)| key.as_str()).collect()
}

fn words_of(schema: &Value) -> String {
    schema["description"]
        .as_str()
        .unwrap_or_default()
        .replace('\n', " ")
}

/// A text that does not end a cell.
fn cell(text: &str) -> String {
    text.replace('|', "\\|")
}

fn strings(list: &Value) -> Vec<&str> {
    let list = list.as_array().map_or(&[][..], Vec::as_slice);
    list.iter().filter_map(Value::as_str).collect()
}
