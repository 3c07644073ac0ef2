//! The JSON Schema of scenes. That files satisfy it or not is asked by `tests/python/test_schemas.py`.

use serde_json::Value;

/// A key without a description is of no use in an editor.
#[test]
fn every_key_of_a_scene_is_described() {
    let schema = gearmesh_specification::schema::scene().to_value();
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
