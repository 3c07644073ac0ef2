//! serde's complaints in the words of a person who writes gear files, not Rust.

use super::near_names::nearest;

/// The key that a complaint is about, as a dotted path, and what is wrong with it; `path` and `message` are serde's.
///
/// A message that is not known here stays as it is.
pub(super) fn in_plain_words(mut path: Vec<String>, message: &str) -> (String, String) {
    let problem = if let Some(field) = message
        .strip_prefix("missing field `")
        .and_then(|rest| rest.strip_suffix('`'))
    {
        // serde blames the table; a person looks for the key.
        path.push(field.to_string());
        "missing; it has no default".to_string()
    } else if message.starts_with("unknown field `")
        || (message.starts_with('`') && message.contains("` belongs to "))
    {
        // The message names the key already.
        path.pop();
        match hint(message) {
            Some(hint) => format!("{message}; {hint}"),
            None => message.to_string(),
        }
    } else if message == "wanted string or table" {
        // For an enumeration; its names are known to serde only after it has seen a string.
        "allowed is a name in quotes".to_string()
    } else {
        wrong_type(message).unwrap_or_else(|| message.to_string())
    };
    (path.join("."), problem)
}

/// Lines that increase, in words: "line 3 is", "lines 3 to 5, 8 are".
pub(super) fn lines(lines: &[usize]) -> String {
    let runs = lines.chunk_by(|a, b| a + 1 == *b);
    let runs: Vec<String> = runs
        .map(|run| match run {
            [only] => only.to_string(),
            [first, second] => format!("{first}, {second}"),
            [first, .., last] => format!("{first} to {last}"),
            [] => String::new(),
        })
        .collect();
    match lines {
        [_] => format!("line {} is", runs.join(", ")),
        _ => format!("lines {} are", runs.join(", ")),
    }
}

/// For serde's "invalid type: string "18", expected usize": found and allowed.
fn wrong_type(message: &str) -> Option<String> {
    let (found, allowed) = message
        .strip_prefix("invalid type: ")
        .or_else(|| message.strip_prefix("invalid value: "))?
        // From the right, because a found text may hold anything.
        .rsplit_once(", expected ")?;
    Some(format!(
        "found {}, allowed is {}",
        found_value(found),
        allowed_type(allowed)
    ))
}

fn found_value(found: &str) -> String {
    match found {
        "sequence" => "a list".to_string(),
        "map" => "a table".to_string(),
        _ => match found.strip_prefix("string ") {
            Some(text) => format!("the text {text}"),
            // integer `18`, floating point `1.5`, boolean `true`: the value says what it is.
            None => found.split('`').nth(1).unwrap_or(found).to_string(),
        },
    }
}

fn allowed_type(allowed: &str) -> &str {
    match allowed {
        "usize" | "u8" | "u16" | "u32" | "u64" => "a whole number of 0 or more",
        "isize" | "i8" | "i16" | "i32" | "i64" => "a whole number",
        "f32" | "f64" => "a number",
        "a boolean" => "true or false",
        "a string" | "path string" => "text in quotes",
        "a sequence" => "a list",
        "a map" => "a table",
        _ if allowed.starts_with("struct ") => "a table",
        _ => allowed,
    }
}

/// For serde's "unknown field `a_m`, expected one of `a_mm`, ...": the expected key with the same stem, else the one
/// that is written most alike.
fn hint(message: &str) -> Option<String> {
    let rest = message.strip_prefix("unknown field `")?;
    let (found, expected) = rest.split_once('`')?;
    if expected.ends_with("which is missing") {
        return None;
    }
    let expected: Vec<&str> = expected.split('`').skip(1).step_by(2).collect();
    let stem_of = |name: &str| name.rsplit_once('_').map_or(name, |(stem, _)| stem).len();
    let stem = &found[..stem_of(found)];
    let same = |name: &&&str| name[..stem_of(name)] == *stem || **name == stem;
    match expected.iter().find(same) {
        Some(name) => Some(format!(
            "did you mean `{name}`? The unit is part of the key"
        )),
        None => nearest(found, &expected).map(|name| format!("did you mean `{name}`?")),
    }
}
