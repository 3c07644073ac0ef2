//! Tables with the keys of two structures: what several kinds of a thing share stands in one of them.

use std::any::TypeId;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt;
use std::marker::PhantomData;
use std::sync::{Mutex, PoisonError};

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::{DeserializeOwned, Deserializer, Error, MapAccess, Visitor};
use serde::{Deserialize, Serialize, Serializer};
use serde_json::Value;

use super::kinds::{below, keys_of};
use super::reader;

/// A table whose keys are those of `A` and those of `B`, as if one structure had them all. Both deny unknown keys.
///
/// serde's `flatten` does the same, but then neither structure can refuse a key, and complaints lose their places.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Beside<A, B>(
    /// What others share.
    pub A,
    /// Its own.
    pub B,
);

impl<'de, A, B> Deserialize<'de> for Beside<A, B>
where
    A: DeserializeOwned + 'static,
    B: DeserializeOwned + 'static,
{
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let keys = all_keys::<A, B>();
        deserializer.deserialize_struct("table", keys, Both(keys, PhantomData))
    }
}

/// Reads the entries of a table into the structure that knows their keys.
struct Both<A, B>(&'static [&'static str], PhantomData<(A, B)>);

impl<'de, A: DeserializeOwned, B: DeserializeOwned> Visitor<'de> for Both<A, B> {
    type Value = Beside<A, B>;

    fn expecting(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        to.write_str("a table")
    }

    fn visit_map<M: MapAccess<'de>>(self, mut map: M) -> Result<Self::Value, M::Error> {
        let of_first = keys_of::<A>();
        let (mut first, mut second) = (toml::Table::new(), toml::Table::new());
        while let Some((key, value)) = map.next_entry::<String, toml::Value>()? {
            if !self.0.contains(&key.as_str()) {
                return Err(M::Error::unknown_field(&key, self.0));
            }
            let table = match of_first.contains(&key.as_str()) {
                true => &mut first,
                false => &mut second,
            };
            table.insert(key, value);
        }
        Ok(Beside(read(first)?, read(second)?))
    }
}

fn read<T: DeserializeOwned, E: Error>(table: toml::Table) -> Result<T, E> {
    let read = reader::read(&toml::Value::Table(table));
    read.map_err(|problem| below(&problem.path(), &problem.message))
}

impl<A: Serialize, B: Serialize> Serialize for Beside<A, B> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut table = toml::Table::try_from(&self.0).map_err(serde::ser::Error::custom)?;
        table.extend(toml::Table::try_from(&self.1).map_err(serde::ser::Error::custom)?);
        table.serialize(serializer)
    }
}

impl<A: JsonSchema, B: JsonSchema> JsonSchema for Beside<A, B> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("{}Beside{}", A::schema_name(), B::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let shared = A::json_schema(generator);
        let mut schema = B::json_schema(generator);
        let own = schema.ensure_object();
        if let Some(Value::Object(keys)) = shared.get("properties") {
            let all = own
                .entry("properties")
                .or_insert_with(|| Value::Object(Default::default()));
            if let Value::Object(all) = all {
                all.extend(keys.clone());
            }
        }
        if let Some(Value::Array(needed)) = shared.get("required") {
            let all = own
                .entry("required")
                .or_insert_with(|| Value::Array(Vec::new()));
            if let Value::Array(all) = all {
                all.extend(needed.iter().cloned());
            }
        }
        schema
    }
}

/// The keys of both. Lists that serde is given live as long as the program: one is made for each pair of types.
fn all_keys<A, B>() -> &'static [&'static str]
where
    A: DeserializeOwned + 'static,
    B: DeserializeOwned + 'static,
{
    static KNOWN: Mutex<BTreeMap<[TypeId; 2], &'static [&'static str]>> =
        Mutex::new(BTreeMap::new());
    let pair = [TypeId::of::<A>(), TypeId::of::<B>()];
    let known = || KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    let found = known().get(&pair).copied();
    // Not made under the lock: a structure of the two may be such a table itself.
    found.unwrap_or_else(|| {
        let keys = [keys_of::<A>(), keys_of::<B>()].concat();
        known().entry(pair).or_insert_with(|| keys.leak())
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::Beside;
    use crate::input::{InputDocument, file_schema};
    use schemars::JsonSchema;
    use serde::{Deserialize, Serialize};

    /// General keys.
    #[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
    #[serde(deny_unknown_fields)]
    #[allow(non_snake_case)]
    struct General {
        /// Its name.
        name: Option<String>,
        /// Its mass.
        mass_kg: f64,
    }

    /// Keys of circles.
    #[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
    #[serde(deny_unknown_fields)]
    struct Circle {
        /// Its radius.
        radius_mm: f64,
    }

    /// Keys of rows.
    #[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
    #[serde(deny_unknown_fields)]
    struct Rows {
        /// Their places.
        places_mm: Option<[f64; 2]>,
    }

    #[derive(Debug, Clone, PartialEq, Deserialize, Serialize, JsonSchema)]
    #[serde(remote = "Self", rename_all = "kebab-case", deny_unknown_fields)]
    #[schemars(tag = "kind", rename = "Part")]
    enum Part {
        /// Round.
        Circle(Beside<General, Circle>),
        /// Round, in rows.
        Ring(Beside<General, Beside<Rows, Circle>>),
    }

    crate::kinds!(Part, "kind");

    fn read(text: &str) -> Result<Part, String> {
        let part = InputDocument::new("p.toml", text).parse::<Part>();
        part.map_err(|error| error.to_string())
    }

    #[test]
    fn keys_go_to_the_structure_that_knows_them_and_come_back() {
        let text = "kind = 'ring'\nradius_mm = 2.0\nmass_kg = 1.0\nplaces_mm = [1.0, 2.0]";
        let general = General {
            name: None,
            mass_kg: 1.0,
        };
        let rows = Rows {
            places_mm: Some([1.0, 2.0]),
        };
        let circle = Circle { radius_mm: 2.0 };
        let ring = Part::Ring(Beside(general, Beside(rows, circle)));
        assert_eq!(read(text), Ok(ring.clone()));
        let written = toml::Value::try_from(&ring).unwrap();
        assert_eq!(written.as_table().unwrap().len(), 4);
        assert_eq!(written.try_into(), Ok(ring));
    }

    #[test]
    fn complaints_are_those_of_one_table() {
        for (text, expected) in [
            (
                "kind = 'circle'\nradius_mm = 2.0",
                "p.toml:1: mass_kg: missing; it has no default",
            ),
            (
                "kind = 'circle'\nmass_kg = 'one'\nradius_mm = 2.0",
                "p.toml:2: mass_kg: found the text \"one\", allowed is a number",
            ),
            (
                "kind = 'ring'\nmass_kg = 1.0\nradius_mm = 2.0\nplaces_mm = [1.0, true]",
                "p.toml:4: places_mm.1: found true, allowed is a number",
            ),
            (
                "kind = 'ring'\nmass_k = 1.0",
                "p.toml:2: unknown field `mass_k`, expected one of `kind`, `name`, `mass_kg`, `places_mm`, `radius_mm`; did you mean `mass_kg`? \
                 The unit is part of the key",
            ),
            (
                "kind = 'circle'\nmass_kg = 1.0\nplaces_mm = [1.0, 2.0]",
                "p.toml:3: `places_mm` belongs to kind \"ring\", not to \"circle\", which knows `kind`, `name`, `mass_kg`, `radius_mm`",
            ),
        ] {
            assert_eq!(read(text).unwrap_err(), expected, "{text}");
        }
    }

    #[test]
    fn the_schema_of_a_kind_has_all_its_keys() {
        let schema = file_schema::<Part>();
        let ring = &schema.as_value()["oneOf"][1];
        let keys: Vec<&String> = ring["properties"].as_object().unwrap().keys().collect();
        assert_eq!(keys, ["kind", "mass_kg", "name", "places_mm", "radius_mm"]);
        let mut needed: Vec<&str> = (ring["required"].as_array().unwrap().iter())
            .filter_map(|key| key.as_str())
            .collect();
        needed.sort_unstable();
        assert_eq!(needed, ["kind", "mass_kg", "radius_mm"]);
        assert_eq!(ring["additionalProperties"], false);
        assert_eq!(ring["properties"]["radius_mm"]["unit"], "mm");
    }
}
