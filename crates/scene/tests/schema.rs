//! The JSON Schema of scenes and gears: every shipped file satisfies it, and files with wrong keys do not.
#![allow(clippy::unwrap_used, clippy::expect_used, missing_docs)]

mod common;

use common::*;
use serde_json::Value;

/// The part of JSON Schema that the schemas use. Says where a value does not fit.
fn check(root: &Value, schema: &Value, value: &Value, at: &str) -> Result<(), String> {
    let Value::Object(rules) = schema else {
        return Ok(());
    };
    let each = |list: &Value, item: &Value, at: &str| -> Vec<Result<(), String>> {
        list.as_array()
            .unwrap()
            .iter()
            .map(|one| check(root, one, item, at))
            .collect()
    };
    for (word, rule) in rules {
        match word.as_str() {
            "$ref" => {
                let path = rule.as_str().unwrap().trim_start_matches('#');
                check(root, root.pointer(path).unwrap(), value, at)?;
            }
            "anyOf" => {
                let all = each(rule, value, at);
                if all.iter().all(Result::is_err) {
                    return Err(all
                        .into_iter()
                        .filter_map(Result::err)
                        .collect::<Vec<_>>()
                        .join(" | "));
                }
            }
            "oneOf" => {
                let all = each(rule, value, at);
                if all.iter().filter(|one| one.is_ok()).count() != 1 {
                    return Err(format!(
                        "{at}: not one of: {}",
                        all.into_iter()
                            .filter_map(Result::err)
                            .collect::<Vec<_>>()
                            .join(" | ")
                    ));
                }
            }
            "allOf" => each(rule, value, at)
                .into_iter()
                .collect::<Result<(), _>>()?,
            "type" => {
                let kind = match value {
                    Value::Null => "null",
                    Value::Bool(_) => "boolean",
                    Value::Number(n) if n.is_f64() => "number",
                    Value::Number(_) => "integer",
                    Value::String(_) => "string",
                    Value::Array(_) => "array",
                    Value::Object(_) => "object",
                };
                let fits =
                    |allowed: &Value| allowed == kind || (allowed == "number" && kind == "integer");
                let ok = rule
                    .as_array()
                    .map_or_else(|| fits(rule), |list| list.iter().any(fits));
                if !ok {
                    return Err(format!("{at}: {kind} is not {rule}"));
                }
            }
            "const" if rule != value => return Err(format!("{at}: {value} is not {rule}")),
            "enum" if !rule.as_array().unwrap().contains(value) => {
                return Err(format!("{at}: {value} is not in {rule}"));
            }
            "required" => {
                for key in rule.as_array().unwrap() {
                    if value.get(key.as_str().unwrap()).is_none() {
                        return Err(format!("{at}: {key} is missing"));
                    }
                }
            }
            "properties" => {
                for (key, schema) in rule.as_object().unwrap() {
                    if let Some(inner) = value.get(key) {
                        check(root, schema, inner, &format!("{at}.{key}"))?;
                    }
                }
            }
            "additionalProperties" if *rule == Value::Bool(false) => {
                let known = rules.get("properties").and_then(Value::as_object);
                for key in value
                    .as_object()
                    .into_iter()
                    .flat_map(|object| object.keys())
                {
                    if !known.is_some_and(|known| known.contains_key(key)) {
                        return Err(format!("{at}: {key} is not known"));
                    }
                }
            }
            "items" => {
                for (i, item) in value.as_array().into_iter().flatten().enumerate() {
                    check(root, rule, item, &format!("{at}.{i}"))?;
                }
            }
            "minItems"
                if value
                    .as_array()
                    .is_some_and(|list| (list.len() as u64) < rule.as_u64().unwrap()) =>
            {
                return Err(format!("{at}: fewer than {rule} items"));
            }
            "maxItems"
                if value
                    .as_array()
                    .is_some_and(|list| (list.len() as u64) > rule.as_u64().unwrap()) =>
            {
                return Err(format!("{at}: more than {rule} items"));
            }
            "const" | "enum" | "minItems" | "maxItems" | "additionalProperties" => {}
            "$schema" | "$defs" | "title" | "description" | "default" | "format" => {}
            "minimum" => {
                if value.as_f64().is_some_and(|x| x < rule.as_f64().unwrap()) {
                    return Err(format!("{at}: below {rule}"));
                }
            }
            other => return Err(format!("{at}: the checker does not know `{other}`")),
        }
    }
    Ok(())
}

fn fits(schema: &Value, text: &str) -> Result<(), String> {
    let value = serde_json::to_value(toml::from_str::<toml::Value>(text).unwrap()).unwrap();
    check(schema, schema, &value, "file")
}

#[test]
fn shipped_files_satisfy_the_schema() {
    let scene = gearmesh_scene::schema::scene().to_value();
    let gear = gearmesh_geometry::gear_file::schema().to_value();
    let mut seen = [0, 0];
    for entry in std::fs::read_dir(fe_models()).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|e| e != "toml") {
            continue;
        }
        let text = std::fs::read_to_string(&path).unwrap();
        let is_gear = text.contains("[tooth]");
        if !is_gear && !text.contains("[pair]") && !text.contains("[[body]]") {
            continue;
        }
        let schema = if is_gear { &gear } else { &scene };
        fits(schema, &text).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        seen[usize::from(is_gear)] += 1;
    }
    assert!(seen.iter().all(|count| *count > 2), "{seen:?}");
}

#[test]
fn wrong_files_do_not() {
    let schema = gearmesh_scene::schema::scene().to_value();
    let wheels = text("scene_two_wheels.toml");
    for (from, to, part) in [
        ("exponent = 1.5", "exponnt = 1.5", "exponnt is not known"),
        ("exponent = 1.5", "exponent = \"a\"", "string is not"),
        ("kind = \"impact\"", "kind = \"impct\"", "impct"),
        // A key of another kind.
        (
            "exponent = 1.5",
            "exponent = 1.5\nlocal = \"none\"",
            "local is not known",
        ),
        ("from = 0.0, ", "", "from"),
        ("name = \"mesh\"", "", "name"),
        (
            "position_mm = [150.0, 0.0, 0.0]",
            "position_mm = [150.0, 0.0]",
            "fewer than 3 items",
        ),
        (
            "gear_2 = \"wheel\"",
            "gear_2 = \"wheel\"\nteeth.errors_1 = [{ kind = \"spall\", tooth = 1 }]",
            "errors_1",
        ),
    ] {
        let found = fits(&schema, &changed(&wheels, from, to)).unwrap_err();
        assert!(found.contains(part), "{part}: {found}");
    }
}

/// A key without a description is of no use in an editor.
#[test]
fn every_key_of_a_scene_is_described() {
    let schema = gearmesh_scene::schema::scene().to_value();
    let mut bare = Vec::new();
    for (name, table) in schema["$defs"].as_object().unwrap() {
        for (key, rules) in table
            .get("properties")
            .and_then(Value::as_object)
            .into_iter()
            .flatten()
        {
            // The word that chooses a kind is described by its table; tables by themselves.
            if rules.get("description").is_none()
                && rules.get("const").is_none()
                && rules.get("$ref").is_none()
            {
                bare.push(format!("{name}.{key}"));
            }
        }
    }
    assert!(bare.is_empty(), "{bare:?}");
}
