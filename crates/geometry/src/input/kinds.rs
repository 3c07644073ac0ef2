//! Tables whose keys belong to a kind: a tag, such as `kind = "linear"`, says which keys stand beside it. A key of
//! another kind is refused with the kind that knows it.
//!
//! serde reads such tables, too, but forgets where it is as soon as it has seen the tag. Here complaints keep the key.

use serde::de::{
    DeserializeOwned, DeserializeSeed, Deserializer, EnumAccess, Error, IntoDeserializer,
    VariantAccess, Visitor, value,
};
use serde::{Deserialize, Serialize, Serializer};

use super::reader::Reader;

/// An enumeration of tables, one variant a kind. Made by [`kinds!`](crate::kinds), not by hand.
pub trait Kinds: Sized {
    /// The key that says which kind it is.
    const TAG: &'static str;

    /// Reads `{ KIND = { keys of the kind } }`, serde's own form.
    ///
    /// # Errors
    /// Those of the deserializer.
    fn from_named<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error>;

    /// Writes that form.
    ///
    /// # Errors
    /// Those of the serializer.
    fn to_named<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error>;
}

/// Makes an enumeration readable from tables with a tag, and writable: `kinds!(BearingModel, "kind");`.
///
/// The enumeration derives `Deserialize` and `Serialize` with `#[serde(remote = "Self", deny_unknown_fields)]` and has
/// no variants without a table; for its schema it says `#[schemars(tag = "kind", rename = "ITS NAME")]`.
#[macro_export]
macro_rules! kinds {
    ($name:ident, $tag:literal) => {
        impl $crate::input::Kinds for $name {
            const TAG: &'static str = $tag;

            fn from_named<'de, D: ::serde::Deserializer<'de>>(
                deserializer: D,
            ) -> Result<Self, D::Error> {
                // serde's derived function; `remote` keeps it from being the trait's.
                Self::deserialize(deserializer)
            }

            fn to_named<S: ::serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                Self::serialize(self, serializer)
            }
        }

        impl ::serde::Serialize for $name {
            fn serialize<S: ::serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                $crate::input::write_kind(self, serializer)
            }
        }

        impl<'de> ::serde::Deserialize<'de> for $name {
            fn deserialize<D: ::serde::Deserializer<'de>>(
                deserializer: D,
            ) -> Result<Self, D::Error> {
                $crate::input::read_kind(deserializer)
            }
        }
    };
}

/// Reads a table of one of the kinds.
///
/// # Errors
/// The deserializer's, with the path of the key where it lies deeper.
pub fn read_kind<'de, T: Kinds, D: Deserializer<'de>>(deserializer: D) -> Result<T, D::Error> {
    let mut table = toml::Table::deserialize(deserializer)?;
    let known = keys_by_kind::<T>();
    let kind = match table.remove(T::TAG) {
        None => return Err(without_tag::<T, _>(&table, &known)),
        Some(toml::Value::String(kind)) => kind,
        Some(_) => return Err(below(&[T::TAG.to_owned()], "allowed is a name in quotes")),
    };
    let Some((_, keys)) = known.iter().find(|(name, _)| *name == kind) else {
        let names: Vec<String> = known.iter().map(|(name, _)| format!("`{name}`")).collect();
        let problem = format!("unknown kind `{kind}`, expected {}", one_of(&names));
        return Err(below(&[T::TAG.to_owned()], &problem));
    };
    if let Some(key) = table.keys().find(|key| !keys.contains(&key.as_str())) {
        return Err(below(
            std::slice::from_ref(key),
            &unknown_key::<T>(key, &kind, keys, &known),
        ));
    }
    let named = toml::Table::from_iter([(kind, toml::Value::Table(table))]);
    T::from_named(Reader(&toml::Value::Table(named))).map_err(|problem| {
        let path = problem.path();
        // The first part is the kind.
        below(path.get(1..).unwrap_or_default(), &problem.message)
    })
}

/// Writes a table of one of the kinds.
///
/// # Errors
/// The serializer's.
pub fn write_kind<T: Kinds, S: Serializer>(kind: &T, serializer: S) -> Result<S::Ok, S::Error> {
    struct Named<'a, T>(&'a T);
    impl<T: Kinds> Serialize for Named<'_, T> {
        fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
            self.0.to_named(serializer)
        }
    }
    let named = toml::Value::try_from(Named(kind)).map_err(serde::ser::Error::custom)?;
    let mut written = toml::Table::new();
    for (name, keys) in named.as_table().into_iter().flatten() {
        written.insert(T::TAG.to_owned(), toml::Value::String(name.clone()));
        written.extend(keys.as_table().cloned().unwrap_or_default());
    }
    written.serialize(serializer)
}

/// A table without its tag: perhaps the tag is misspelt, and stands there as a key that no kind knows.
fn without_tag<T: Kinds, E: Error>(table: &toml::Table, known: &[KeysOfKind]) -> E {
    let knows = |key: &str| known.iter().any(|(_, keys)| keys.contains(&key));
    match table.keys().find(|key| !knows(key)) {
        None => E::missing_field(T::TAG),
        Some(key) => {
            let problem = format!(
                "unknown field `{key}`, expected `{}`, which is missing",
                T::TAG
            );
            below(std::slice::from_ref(key), &problem)
        }
    }
}

/// What to say of a key that the kind does not know; begins as serde's own complaint does.
fn unknown_key<T: Kinds>(key: &str, kind: &str, keys: &[&str], known: &[KeysOfKind]) -> String {
    let mut expected = vec![format!("`{}`", T::TAG)];
    expected.extend(keys.iter().map(|key| format!("`{key}`")));
    let owners: Vec<String> = known
        .iter()
        .filter(|(_, keys)| keys.contains(&key))
        .map(|(name, _)| format!("\"{name}\""))
        .collect();
    let tag = T::TAG;
    if owners.is_empty() {
        format!("unknown field `{key}`, expected {}", one_of(&expected))
    } else {
        format!(
            "`{key}` belongs to {tag} {}, not to \"{kind}\", which knows {}",
            all_of(&owners),
            expected.join(", ")
        )
    }
}

/// Names with "and" before the last.
fn all_of(names: &[String]) -> String {
    match names {
        [others @ .., before, last] => {
            let others: String = others.iter().map(|name| format!("{name}, ")).collect();
            format!("{others}{before} and {last}")
        }
        _ => names.concat(),
    }
}

/// serde's way to list names.
fn one_of(names: &[String]) -> String {
    match names {
        [only] => only.clone(),
        [first, second] => format!("{first} or {second}"),
        several => format!("one of {}", several.join(", ")),
    }
}

/// Stands before and behind the path of a complaint that lies deeper than its reader knows; in no text that people
/// write.
const MARK: char = '\u{1f}';
/// Between the parts of such a path.
const PART: char = '\u{1e}';

/// A complaint about a place below the one that the deserializer is at.
pub(super) fn below<E: Error>(path: &[String], message: &str) -> E {
    let (deeper, message) = told_below(message);
    let path: Vec<&str> = path.iter().map(String::as_str).chain(deeper).collect();
    E::custom(format!(
        "{MARK}{}{MARK}{message}",
        path.join(&PART.to_string())
    ))
}

/// The path and the words of a complaint that may come from [`below`].
pub(super) fn told_below(message: &str) -> (Vec<&str>, &str) {
    let marked = message.strip_prefix(MARK);
    match marked.and_then(|rest| rest.split_once(MARK)) {
        Some((path, message)) => (
            path.split(PART).filter(|p| !p.is_empty()).collect(),
            message,
        ),
        None => (Vec::new(), message),
    }
}

/// Name of a kind and its keys.
type KeysOfKind = (&'static str, Vec<&'static str>);

/// The keys of a structure, as serde knows them.
pub(super) fn keys_of<T: DeserializeOwned>() -> Vec<&'static str> {
    let mut keys = Asked::default();
    let _ = T::deserialize(Question {
        kind: None,
        told: &mut keys,
    });
    keys.0
}

/// The kinds with their keys, as serde knows them.
fn keys_by_kind<T: Kinds>() -> Vec<KeysOfKind> {
    let mut kinds = Vec::new();
    // Asked for no kind, it tells their names.
    let mut names = Asked::default();
    let _ = T::from_named(Question {
        kind: None,
        told: &mut names,
    });
    for (number, name) in names.0.iter().enumerate() {
        let mut keys = Asked::default();
        let _ = T::from_named(Question {
            kind: Some(number as u64),
            told: &mut keys,
        });
        kinds.push((*name, keys.0));
    }
    kinds
}

/// Names that a derived reader has told.
#[derive(Default)]
struct Asked(Vec<&'static str>);

/// A deserializer without data: it listens to what a derived reader expects and ends there.
struct Question<'a> {
    /// The kind whose keys are asked for; none for the kinds themselves.
    kind: Option<u64>,
    told: &'a mut Asked,
}

fn heard() -> value::Error {
    value::Error::custom("heard")
}

impl<'de> Deserializer<'de> for Question<'_> {
    type Error = value::Error;

    fn deserialize_any<V: Visitor<'de>>(self, _: V) -> Result<V::Value, Self::Error> {
        Err(heard())
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        fields: &'static [&'static str],
        _: V,
    ) -> Result<V::Value, Self::Error> {
        self.told.0.extend(fields);
        Err(heard())
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Self::Error> {
        match self.kind {
            None => {
                self.told.0.extend(variants);
                Err(heard())
            }
            Some(_) => visitor.visit_enum(self),
        }
    }

    serde::forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option unit unit_struct
        newtype_struct seq tuple tuple_struct map identifier ignored_any
    }
}

impl<'de> EnumAccess<'de> for Question<'_> {
    type Error = value::Error;
    type Variant = Self;

    fn variant_seed<V: DeserializeSeed<'de>>(
        self,
        seed: V,
    ) -> Result<(V::Value, Self), Self::Error> {
        let number = self.kind.ok_or_else(heard)?;
        let variant =
            seed.deserialize(IntoDeserializer::<value::Error>::into_deserializer(number))?;
        Ok((variant, self))
    }
}

impl<'de> VariantAccess<'de> for Question<'_> {
    type Error = value::Error;

    fn unit_variant(self) -> Result<(), Self::Error> {
        Ok(())
    }

    fn newtype_variant_seed<S: DeserializeSeed<'de>>(
        self,
        seed: S,
    ) -> Result<S::Value, Self::Error> {
        seed.deserialize(self)
    }

    fn tuple_variant<V: Visitor<'de>>(self, _: usize, _: V) -> Result<V::Value, Self::Error> {
        Err(heard())
    }

    fn struct_variant<V: Visitor<'de>>(
        self,
        fields: &'static [&'static str],
        _: V,
    ) -> Result<V::Value, Self::Error> {
        self.told.0.extend(fields);
        Err(heard())
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use crate::input::InputDocument;
    use serde::{Deserialize, Serialize};

    #[derive(Debug, PartialEq, Deserialize, Serialize)]
    #[serde(deny_unknown_fields)]
    struct Scene {
        bearing: Vec<Bearing>,
    }

    #[derive(Debug, PartialEq, Deserialize, Serialize)]
    #[serde(deny_unknown_fields)]
    struct Bearing {
        model: Model,
    }

    #[derive(Debug, PartialEq, Deserialize, Serialize)]
    #[serde(remote = "Self", rename_all = "kebab-case", deny_unknown_fields)]
    enum Model {
        Rigid {},
        Linear(Linear),
        Film {
            exponent: Option<f64>,
            gap_um: [f64; 2],
            damping: Option<Damping>,
        },
    }

    #[derive(Debug, PartialEq, Deserialize, Serialize)]
    #[serde(deny_unknown_fields)]
    #[allow(non_snake_case)]
    struct Linear {
        stiffness_N_per_mm: f64,
        #[serde(default)]
        exponent: f64,
    }

    #[derive(Debug, PartialEq, Deserialize, Serialize)]
    #[serde(remote = "Self", rename_all = "kebab-case", deny_unknown_fields)]
    enum Damping {
        Viscous { damping_s: f64 },
    }

    crate::kinds!(Model, "kind");
    crate::kinds!(Damping, "law");

    fn read(model: &str) -> Result<Model, String> {
        let text = format!("# head\n[[bearing]]\n[bearing.model]\n{model}");
        let scene = InputDocument::new("s.toml", text).parse::<Scene>();
        let mut scene = scene.map_err(|error| error.to_string())?;
        Ok(scene.bearing.remove(0).model)
    }

    #[test]
    fn each_kind_is_read_with_its_own_keys() {
        assert_eq!(read("kind = 'rigid'"), Ok(Model::Rigid {}));
        let linear = Linear {
            stiffness_N_per_mm: 5.0,
            exponent: 0.0,
        };
        let text = "kind = 'linear'\nstiffness_N_per_mm = 5.0";
        assert_eq!(read(text), Ok(Model::Linear(linear)));
        let film = Model::Film {
            exponent: None,
            gap_um: [1.0, 2.0],
            damping: Some(Damping::Viscous { damping_s: 3.0 }),
        };
        let text =
            "gap_um = [1.0, 2.0]\nkind = 'film'\ndamping = { law = 'viscous', damping_s = 3.0 }";
        assert_eq!(read(text).as_ref(), Ok(&film));
        let written = toml::Value::try_from(&film).unwrap();
        assert_eq!(written.try_into(), Ok(film));
    }

    /// Every way to be wrong, with the line that a person reads: as good as in a table without kinds, at any depth.
    #[test]
    fn complaints_name_line_key_and_the_kind_that_knows_it() {
        for (model, expected) in [
            (
                "gap_um = [1, 2]",
                "s.toml:3: bearing.0.model.kind: missing; it has no default",
            ),
            (
                "knd = 'film'",
                "s.toml:4: bearing.0.model: unknown field `knd`, expected `kind`, which is missing",
            ),
            (
                "\nkind = 'flim'",
                "s.toml:5: bearing.0.model.kind: unknown kind `flim`, expected one of `rigid`, `linear`, `film`",
            ),
            (
                "kind = 3",
                "s.toml:4: bearing.0.model.kind: allowed is a name in quotes",
            ),
            (
                "kind = 'linear'\nstiffness_N_per_mm = '5'",
                "s.toml:5: bearing.0.model.stiffness_N_per_mm: found the text \"5\", allowed is a number",
            ),
            (
                "kind = 'linear'",
                "s.toml:3: bearing.0.model.stiffness_N_per_mm: missing; it has no default",
            ),
            (
                "kind = 'linear'\n\nstiffness_N_per_m = 5e3",
                "s.toml:6: bearing.0.model: unknown field `stiffness_N_per_m`, expected one of `kind`, `stiffness_N_per_mm`, \
                 `exponent`; did you mean `stiffness_N_per_mm`? The unit is part of the key",
            ),
            (
                "kind = 'rigid'\nexponent = 1.5",
                "s.toml:5: bearing.0.model: `exponent` belongs to kind \"linear\" and \"film\", not to \"rigid\", which knows `kind`",
            ),
            (
                "kind = 'film'\ngap_um = [1, '2']",
                "s.toml:5: bearing.0.model.gap_um.1: found the text \"2\", allowed is a number",
            ),
            (
                "kind = 'film'\ngap_um = [1, 2]\n[bearing.model.damping]\nlaw = 'viscous'\ndamping_s = true",
                "s.toml:8: bearing.0.model.damping.damping_s: found true, allowed is a number",
            ),
            (
                "kind = 'film'\ngap_um = [1, 2]\ndamping = 3.0",
                "s.toml:6: bearing.0.model.damping: found 3.0, allowed is a table",
            ),
        ] {
            assert_eq!(read(model).unwrap_err(), expected, "{model}");
        }
    }
}
