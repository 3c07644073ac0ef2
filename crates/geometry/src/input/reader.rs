//! Values of a document as serde reads them. One reader for files, tables in memory and the tables of a kind: each type
//! is compiled for it once, and a complaint keeps the path of its key.

use super::kinds::told_below;
use serde::de::value::StrDeserializer;
use serde::de::{
    DeserializeOwned, DeserializeSeed, Deserializer, EnumAccess, Error, Expected, MapAccess,
    SeqAccess, Unexpected, VariantAccess, Visitor,
};
use std::fmt::Display;
use toml::Value;
use toml::de::{DeTable, DeValue};

/// What is wrong with a value, in serde's words, and where.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{message}")]
pub(super) struct Refusal {
    /// Parts of the path, the last one first.
    reversed: Vec<String>,
    /// serde's words.
    pub message: String,
}

impl Refusal {
    fn of(message: impl Display) -> Self {
        let message = message.to_string();
        let (deeper, message) = told_below(&message);
        Self {
            reversed: deeper.iter().rev().map(|part| (*part).to_owned()).collect(),
            message: message.to_owned(),
        }
    }

    /// The same one level higher.
    fn below(mut self, part: impl Display) -> Self {
        self.reversed.push(part.to_string());
        self
    }

    /// Path of the value: keys and numbers of list items.
    pub fn path(&self) -> Vec<String> {
        self.reversed.iter().rev().cloned().collect()
    }
}

impl Error for Refusal {
    fn custom<T: Display>(message: T) -> Self {
        Self::of(message)
    }
}

/// Reads a type from a value.
///
/// # Errors
/// [`Refusal`] with the path below `value`.
pub(super) fn read<T: DeserializeOwned>(value: &Value) -> Result<T, Refusal> {
    T::deserialize(Reader(value))
}

/// The values of a table without their places in the text.
///
/// # Errors
/// [`Refusal`] for a number that no processor holds.
pub(super) fn table_of(table: &DeTable<'_>) -> Result<toml::Table, Refusal> {
    let entry = |(key, value): (&toml::Spanned<_>, &toml::Spanned<DeValue<'_>>)| {
        let key: &str = AsRef::<str>::as_ref(key.get_ref());
        let value = value_of(value.get_ref()).map_err(|problem| problem.below(key))?;
        Ok((key.to_owned(), value))
    };
    table.iter().map(entry).collect()
}

fn value_of(value: &DeValue<'_>) -> Result<Value, Refusal> {
    let out_of_range = |found: &dyn Display, allowed: &str| {
        Refusal::of(format!("found {found}, allowed is {allowed}"))
    };
    Ok(match value {
        DeValue::String(text) => Value::String(text.to_string()),
        DeValue::Integer(digits) => {
            let number = i64::from_str_radix(digits.as_str(), digits.radix());
            Value::Integer(
                number.map_err(|_| out_of_range(digits, "a whole number of at most 18 digits"))?,
            )
        }
        DeValue::Float(digits) => match digits.as_str().parse::<f64>() {
            Ok(number)
                if number.is_finite()
                    || !digits.as_str().contains(|c: char| c.is_ascii_digit()) =>
            {
                Value::Float(number)
            }
            _ => return Err(out_of_range(digits, "a finite number")),
        },
        DeValue::Boolean(truth) => Value::Boolean(*truth),
        DeValue::Datetime(date) => Value::Datetime(*date),
        DeValue::Array(items) => {
            let items = items.iter().enumerate();
            let item = |(i, item): (usize, &toml::Spanned<DeValue<'_>>)| {
                value_of(item.get_ref()).map_err(|problem| problem.below(i))
            };
            Value::Array(items.map(item).collect::<Result<_, _>>()?)
        }
        DeValue::Table(table) => Value::Table(table_of(table)?),
    })
}

/// A value that is being read.
#[derive(Clone, Copy)]
pub(super) struct Reader<'a>(pub &'a Value);

impl Reader<'_> {
    /// serde's complaint about a value of another type.
    fn wrong_type(self, expected: &dyn Expected) -> Refusal {
        let date;
        let found = match self.0 {
            Value::String(text) => Unexpected::Str(text),
            Value::Integer(number) => Unexpected::Signed(*number),
            Value::Float(number) => Unexpected::Float(*number),
            Value::Boolean(truth) => Unexpected::Bool(*truth),
            Value::Datetime(found) => {
                date = format!("the date {found}");
                Unexpected::Other(&date)
            }
            Value::Array(_) => Unexpected::Seq,
            Value::Table(_) => Unexpected::Map,
        };
        Refusal::invalid_type(found, expected)
    }
}

impl<'a> Deserializer<'a> for Reader<'a> {
    type Error = Refusal;

    fn deserialize_any<V: Visitor<'a>>(self, visitor: V) -> Result<V::Value, Refusal> {
        match self.0 {
            Value::Array(items) => {
                let mut list = Items { items, next: 0 };
                let read = visitor.visit_seq(&mut list)?;
                match list.items.get(list.next) {
                    None => Ok(read),
                    Some(_) => Err(Refusal::invalid_length(items.len(), &Length(list.next))),
                }
            }
            Value::Table(_) => self.deserialize_map(visitor),
            Value::String(text) => visitor.visit_borrowed_str(text),
            Value::Integer(number) => visitor.visit_i64(*number),
            Value::Float(number) => visitor.visit_f64(*number),
            Value::Boolean(truth) => visitor.visit_bool(*truth),
            Value::Datetime(_) => Err(self.wrong_type(&visitor)),
        }
    }

    fn deserialize_option<V: Visitor<'a>>(self, visitor: V) -> Result<V::Value, Refusal> {
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'a>>(
        self,
        _: &'static str,
        visitor: V,
    ) -> Result<V::Value, Refusal> {
        visitor.visit_newtype_struct(self)
    }

    fn deserialize_map<V: Visitor<'a>>(self, visitor: V) -> Result<V::Value, Refusal> {
        let Value::Table(table) = self.0 else {
            return Err(self.wrong_type(&visitor));
        };
        visitor.visit_map(Entries {
            entries: table.iter(),
            current: None,
        })
    }

    fn deserialize_struct<V: Visitor<'a>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Refusal> {
        self.deserialize_map(visitor)
    }

    /// A name, or a table of one entry: the variant and what is in it.
    fn deserialize_enum<V: Visitor<'a>>(
        self,
        _: &'static str,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Refusal> {
        let variant = match self.0 {
            Value::String(name) => Variant { name, inside: None },
            Value::Table(table) => match (table.iter().next(), table.len()) {
                (Some((name, inside)), 1) => Variant {
                    name,
                    inside: Some(Reader(inside)),
                },
                (None, _) => return Err(Refusal::of("wanted exactly 1 element, found 0 elements")),
                _ => return Err(Refusal::of("wanted exactly 1 element, more than 1 element")),
            },
            _ => return Err(Refusal::of("wanted string or table")),
        };
        visitor.visit_enum(variant)
    }

    fn deserialize_ignored_any<V: Visitor<'a>>(self, visitor: V) -> Result<V::Value, Refusal> {
        visitor.visit_unit()
    }

    // serde's own visitors say what they take.
    serde::forward_to_deserialize_any! {
        <V: Visitor<'a>>
        bool i8 i16 i32 i64 u8 u16 u32 u64 f32 f64 char str string bytes byte_buf unit unit_struct seq tuple
        tuple_struct identifier
    }
}

/// Items of a list.
struct Items<'a> {
    items: &'a [Value],
    next: usize,
}

impl<'a> SeqAccess<'a> for &mut Items<'a> {
    type Error = Refusal;

    fn next_element_seed<S: DeserializeSeed<'a>>(
        &mut self,
        seed: S,
    ) -> Result<Option<S::Value>, Refusal> {
        let Some(item) = self.items.get(self.next) else {
            return Ok(None);
        };
        let number = self.next;
        self.next += 1;
        let read = seed.deserialize(Reader(item));
        read.map(Some).map_err(|problem| problem.below(number))
    }

    fn size_hint(&self) -> Option<usize> {
        Some(self.items.len() - self.next)
    }
}

/// How many items a list of a given length has too few.
struct Length(usize);

impl Expected for Length {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} items", self.0)
    }
}

/// Entries of a table.
struct Entries<'a> {
    entries: toml::map::Iter<'a, String, Value>,
    current: Option<(&'a String, &'a Value)>,
}

impl<'a> MapAccess<'a> for Entries<'a> {
    type Error = Refusal;

    fn next_key_seed<S: DeserializeSeed<'a>>(
        &mut self,
        seed: S,
    ) -> Result<Option<S::Value>, Refusal> {
        self.current = self.entries.next();
        let Some((key, _)) = self.current else {
            return Ok(None);
        };
        let read = seed.deserialize(StrDeserializer::new(key));
        read.map(Some)
            .map_err(|problem: Refusal| problem.below(key))
    }

    fn next_value_seed<S: DeserializeSeed<'a>>(&mut self, seed: S) -> Result<S::Value, Refusal> {
        let Some((key, value)) = self.current else {
            return Err(Refusal::of("a value was asked for before its key"));
        };
        let read = seed.deserialize(Reader(value));
        read.map_err(|problem| problem.below(key))
    }
}

/// A variant of an enumeration.
struct Variant<'a> {
    name: &'a str,
    inside: Option<Reader<'a>>,
}

impl<'a> Variant<'a> {
    /// What must be in the variant.
    fn inside(&self) -> Result<Reader<'a>, Refusal> {
        self.inside
            .ok_or_else(|| Refusal::of(format!("`{}` needs a table of its keys", self.name)))
    }
}

impl<'a> EnumAccess<'a> for Variant<'a> {
    type Error = Refusal;
    type Variant = Self;

    fn variant_seed<S: DeserializeSeed<'a>>(self, seed: S) -> Result<(S::Value, Self), Refusal> {
        let read = seed.deserialize(StrDeserializer::new(self.name))?;
        Ok((read, self))
    }
}

impl<'a> VariantAccess<'a> for Variant<'a> {
    type Error = Refusal;

    fn unit_variant(self) -> Result<(), Refusal> {
        match self.inside {
            None => Ok(()),
            Some(inside) => {
                let alone = format!("nothing: `{}` stands alone, in quotes", self.name);
                Err(inside.wrong_type(&&*alone).below(self.name))
            }
        }
    }

    fn newtype_variant_seed<S: DeserializeSeed<'a>>(self, seed: S) -> Result<S::Value, Refusal> {
        let read = seed.deserialize(self.inside()?);
        read.map_err(|problem| problem.below(self.name))
    }

    fn tuple_variant<V: Visitor<'a>>(self, _: usize, visitor: V) -> Result<V::Value, Refusal> {
        let read = self.inside()?.deserialize_any(visitor);
        read.map_err(|problem| problem.below(self.name))
    }

    fn struct_variant<V: Visitor<'a>>(
        self,
        _: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Refusal> {
        let read = self.inside()?.deserialize_map(visitor);
        read.map_err(|problem| problem.below(self.name))
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use crate::input::InputDocument;
    use serde::Deserialize;

    #[derive(Debug, PartialEq, Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Wheel {
        teeth: u32,
        #[serde(default)]
        flanks: Vec<Flank>,
        bore: Option<Bore>,
        size: Option<(f64, String)>,
    }

    #[derive(Debug, PartialEq, Deserialize)]
    #[serde(rename_all = "kebab-case")]
    enum Flank {
        Straight,
        Crowned { by_um: f64 },
        Cut(Bore),
    }

    #[derive(Debug, PartialEq, Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Bore {
        radius_mm: f64,
    }

    fn read(text: &str) -> Result<Wheel, String> {
        let read = InputDocument::new("w.toml", text).parse();
        read.map_err(|error| error.to_string())
    }

    #[test]
    fn every_kind_of_value_is_read() {
        let text = "teeth = 0x11\nflanks = ['straight', { crowned = { by_um = 3 } }, { cut = { radius_mm = 1e-3 } }]\n\
            bore.radius_mm = 1_0.5\nsize = [2, 'wide']";
        let wheel = Wheel {
            teeth: 17,
            flanks: vec![
                Flank::Straight,
                Flank::Crowned { by_um: 3.0 },
                Flank::Cut(Bore { radius_mm: 1e-3 }),
            ],
            bore: Some(Bore { radius_mm: 10.5 }),
            size: Some((2.0, "wide".to_owned())),
        };
        assert_eq!(read(text).unwrap(), wheel);
    }

    /// Records have days.
    #[test]
    fn a_table_keeps_its_dates() {
        let record = InputDocument::new("r.toml", "day = 2026-11-27\nfrom = [{ at = 10:30:00 }]");
        let table = record.table().unwrap();
        assert_eq!(table["day"].to_string(), "2026-11-27");
        assert_eq!(table["from"][0]["at"].to_string(), "10:30:00");
    }

    /// The path goes into lists and variants, and the line is that of the key.
    #[test]
    fn what_is_wrong_is_named_with_its_path() {
        for (text, problem) in [
            (
                "bore = {radius_mm = 1}",
                "1: teeth: missing; it has no default",
            ),
            (
                "teeth = 2\nbore = [1.0]",
                "2: bore: found a list, allowed is a table",
            ),
            (
                "teeth = 99999999999999999999",
                "1: teeth: found 99999999999999999999, allowed is a whole number of at most 18 digits",
            ),
            (
                "teeth = 3\nsize = [1e999, 'x']",
                "2: size.0: found 1e999, allowed is a finite number",
            ),
            (
                "teeth = 3\nsize = [1, 'x', 2]",
                "2: size: invalid length 3, expected 2 items",
            ),
            (
                "teeth = 2026-11-27",
                "1: teeth: found the date 2026-11-27, allowed is a whole number of 0 or more",
            ),
            (
                "teeth = 3\nflanks = [\n'straight',\n{ crowned = { by_um = 'x' } }]",
                "4: flanks.1.crowned.by_um: found the text \"x\", allowed is a number",
            ),
            (
                "teeth = 3\nflanks = [{ straight = 1 }]",
                "2: flanks.0.straight: found 1, allowed is nothing: `straight` stands alone, in quotes",
            ),
            (
                "teeth = 3\nflanks = ['crowned']",
                "2: flanks.0: `crowned` needs a table of its keys",
            ),
            (
                "teeth = 3\nflanks = [7]",
                "2: flanks.0: allowed is a name in quotes",
            ),
            (
                "teeth = 3\nbore = { radius_um = 1 }",
                "2: bore: unknown field `radius_um`, expected `radius_mm`; did you mean `radius_mm`? The unit is part of the key",
            ),
        ] {
            assert_eq!(read(text).unwrap_err(), format!("w.toml:{problem}"));
        }
    }
}
