//! The JSON Schema of a file: each number states its unit and its range.

use super::NumberRange;
use schemars::transform::transform_subschemas;
use schemars::{JsonSchema, Schema, generate::SchemaSettings};
use serde_json::{Map, Value};

/// JSON Schema (draft 2020-12) of the files that are read into `T`. Each key of numbers has its `unit`, the one at its
/// end, and the range of numbers of that unit where its type has none of its own.
pub fn file_schema<T: JsonSchema>() -> Schema {
    let settings = SchemaSettings::draft2020_12();
    let mut schema = settings.into_generator().into_root_schema_for::<T>();
    state_units(&mut schema);
    schema
}

fn state_units(schema: &mut Schema) {
    if let Some(Value::Object(keys)) = schema.get_mut("properties") {
        for (key, value) in keys {
            let range = NumberRange::of(key);
            if bound(value, range.largest())
                && !range.unit().is_empty()
                && let Value::Object(value) = value
            {
                value.insert("unit".to_owned(), range.unit().into());
            }
        }
    }
    transform_subschemas(&mut state_units, schema);
}

/// Bounds the numbers of a key; whether it has any.
fn bound(schema: &mut Value, largest: f64) -> bool {
    let Value::Object(schema) = schema else {
        return false;
    };
    let is = |schema: &Map<String, Value>, wanted: &str| match &schema["type"] {
        Value::String(one) => one == wanted,
        Value::Array(several) => several.iter().any(|one| one == wanted),
        _ => false,
    };
    if !schema.contains_key("type") {
        let parts = schema.get_mut("anyOf").and_then(Value::as_array_mut);
        let mut any = false;
        for part in parts.into_iter().flatten() {
            any |= bound(part, largest);
        }
        return any;
    }
    if is(schema, "array") {
        return schema
            .get_mut("items")
            .is_some_and(|items| bound(items, largest));
    }
    let is_number = is(schema, "number");
    if is_number {
        for (ends, value) in [
            (["minimum", "exclusiveMinimum"], -largest),
            (["maximum", "exclusiveMaximum"], largest),
        ] {
            if !ends.iter().any(|end| schema.contains_key(*end)) {
                schema.insert(ends[0].to_owned(), value.into());
            }
        }
    }
    is_number
}
