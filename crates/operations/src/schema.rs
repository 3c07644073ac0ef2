//! What may be in a text file: JSON Schemas by kind of file, and how they are followed.

use serde_json::Value;

/// Kinds of text files that have a schema.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum TextKind {
    /// A gear pair at rest or a multibody system.
    Scene,
    /// A study of either.
    Study,
    /// Keys of a scene that make objectives least.
    Optimise,
    /// A rolling bearing.
    Bearing,
    /// A bevel pair.
    Bevel,
    /// A member of a bevel pair as a body.
    BevelGear,
    /// A cylindrical gear.
    Gear,
}

/// JSON Schema (draft 2020-12) of files of a kind.
#[must_use]
pub fn schema(kind: TextKind) -> Value {
    match kind {
        TextKind::Scene => gearmesh_specification::schema::scene(),
        TextKind::Study => gearmesh_specification::schema::study(),
        TextKind::Optimise => gearmesh_specification::schema::optimise(),
        TextKind::Bearing => gearmesh_bearings::bearing_file::schema(),
        TextKind::Bevel => gearmesh_bevel::pair_file::schema(),
        TextKind::BevelGear => gearmesh_bevel::gear_file::gear_schema(),
        TextKind::Gear => gearmesh_geometry::gear_file::schema(),
    }
    .to_value()
}

/// What a part of a schema stands for: its reference followed, `null` beside it left out; with the name of the
/// definition that it refers to. `definitions` are those of the whole schema (`$defs`).
#[must_use]
pub fn followed<'a>(definitions: &'a Value, part: &'a Value) -> (&'a Value, Option<&'a str>) {
    if let Some(reference) = part["$ref"].as_str() {
        let name = reference.rsplit('/').next().unwrap_or_default();
        return (&definitions[name], Some(name));
    }
    for list in ["anyOf", "allOf"] {
        let Some(parts) = part[list].as_array() else {
            continue;
        };
        let mut others = parts.iter().filter(|part| part["type"] != "null");
        if let (Some(only), None) = (others.next(), others.next()) {
            return followed(definitions, only);
        }
    }
    (part, None)
}
