//! Numbers of input files whose type says what is allowed. The range is written once: the reader refuses what lies
//! outside it, and the JSON Schema states it, so that an editor warns while one types. Ranges that depend on other keys
//! are checked where those keys are read.
//!
//! ```
//! use gearmesh_geometry::input::{Bounded, InputDocument, Positive};
//!
//! #[derive(serde::Deserialize)]
//! struct Table {
//!     step_s: Bounded<Positive>,
//! }
//!
//! let read = |text| InputDocument::new("scene.toml", text).parse::<Table>();
//! assert_eq!(*read("step_s = 1e-5")?.step_s, 1e-5);
//! let problem = read("step_s = 0").map(|_| ()).unwrap_err();
//! assert_eq!(problem.to_string(), "scene.toml:1: step_s: found 0, allowed is more than 0");
//! # Ok::<(), gearmesh_geometry::input::InputError>(())
//! ```

use super::table_keys::found_number;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::borrow::Cow;
use std::marker::PhantomData;
use std::ops::{Deref, Mul};

/// One end of a range.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum End {
    /// No end of its own; that of the key's unit holds.
    Open,
    /// The number itself is allowed.
    At(f64),
    /// The number itself is not allowed.
    Beyond(f64),
}

/// What is allowed of a number.
pub trait Range {
    /// Lower end.
    const LOW: End;
    /// Upper end.
    const HIGH: End;
    /// The reason, where it is not plain.
    const WHY: &'static str = "";
}

/// Makes a [`Range`](crate::input::Range): a name, both ends and, where it is not plain, the reason.
#[macro_export]
macro_rules! number_range {
    ($(#[$about:meta])* $vis:vis $name:ident: $low:expr, $high:expr $(, $why:literal)?) => {
        $(#[$about])*
        $vis enum $name {}

        impl $crate::input::Range for $name {
            const LOW: $crate::input::End = $low;
            const HIGH: $crate::input::End = $high;
            $(const WHY: &'static str = $why;)?
        }
    };
}

/// More than 0.
pub enum Positive {}

impl Range for Positive {
    const LOW: End = End::Beyond(0.0);
    const HIGH: End = End::Open;
}

/// 0 or more.
pub enum NotNegative {}

impl Range for NotNegative {
    const LOW: End = End::At(0.0);
    const HIGH: End = End::Open;
}

/// From one whole number to another, both allowed.
pub enum Within<const LOW: i32, const HIGH: i32> {}

impl<const LOW: i32, const HIGH: i32> Range for Within<LOW, HIGH> {
    const LOW: End = End::At(LOW as f64);
    const HIGH: End = End::At(HIGH as f64);
}

/// More than 0, up to a whole number, which is allowed.
pub enum UpTo<const HIGH: i32> {}

impl<const HIGH: i32> Range for UpTo<HIGH> {
    const LOW: End = End::Beyond(0.0);
    const HIGH: End = End::At(HIGH as f64);
}

/// What is allowed, in words.
fn allowed<R: Range>() -> String {
    use End::{At, Beyond, Open};
    let range = match (R::LOW, R::HIGH) {
        (Open, Open) => "a finite number".to_owned(),
        (Open, At(high)) => format!("at most {high}"),
        (Open, Beyond(high)) => format!("less than {high}"),
        (At(low), Open) => format!("{low} or more"),
        (Beyond(low), Open) => format!("more than {low}"),
        (At(low), At(high)) => format!("{low} to {high}"),
        (At(low), Beyond(high)) => format!("{low} up to, not including, {high}"),
        (Beyond(low), At(high)) => format!("more than {low} and at most {high}"),
        (Beyond(low), Beyond(high)) => format!("more than {low} and less than {high}"),
    };
    match R::WHY {
        "" => range,
        why => format!("{range}: {why}"),
    }
}

/// A number within its range, in the unit of its key: checked where a table is read, files and tables in memory alike.
pub struct Bounded<R>(f64, PhantomData<R>);

impl<R> Clone for Bounded<R> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<R> Copy for Bounded<R> {}

impl<R> std::fmt::Debug for Bounded<R> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.fmt(f)
    }
}

impl<R> std::fmt::Display for Bounded<R> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.fmt(f)
    }
}

impl<R> Default for Bounded<R> {
    fn default() -> Self {
        0.0.into()
    }
}

impl<R> PartialEq for Bounded<R> {
    fn eq(&self, other: &Self) -> bool {
        self.0 == other.0
    }
}

impl<R> Deref for Bounded<R> {
    type Target = f64;

    fn deref(&self) -> &f64 {
        &self.0
    }
}

/// The number as it stands, for tables in memory: it is checked where the table is read.
impl<R> From<f64> for Bounded<R> {
    fn from(value: f64) -> Self {
        Self(value, PhantomData)
    }
}

impl<R> From<Bounded<R>> for f64 {
    fn from(bounded: Bounded<R>) -> Self {
        bounded.0
    }
}

impl<R> Mul<Bounded<R>> for f64 {
    type Output = f64;

    fn mul(self, bounded: Bounded<R>) -> f64 {
        self * bounded.0
    }
}

impl<R: Range> Bounded<R> {
    /// The number, if it is allowed.
    pub fn new(value: f64) -> Option<Self> {
        let above = match R::LOW {
            End::Open => true,
            End::At(low) => value >= low,
            End::Beyond(low) => value > low,
        };
        let below = match R::HIGH {
            End::Open => true,
            End::At(high) => value <= high,
            End::Beyond(high) => value < high,
        };
        (above && below && value.is_finite()).then_some(Self(value, PhantomData))
    }
}

impl<'de, R: Range> Deserialize<'de> for Bounded<R> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = f64::deserialize(deserializer)?;
        let problem = || {
            let found = found_number(value);
            D::Error::custom(format!("found {found}, allowed is {}", allowed::<R>()))
        };
        Self::new(value).ok_or_else(problem)
    }
}

impl<R> Serialize for Bounded<R> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.serialize(serializer)
    }
}

impl<R: Range> JsonSchema for Bounded<R> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        allowed::<R>().into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let mut schema = json_schema!({ "type": "number" });
        let mut state = |end, [at, beyond]: [&str; 2]| match end {
            End::Open => {}
            End::At(value) => {
                schema.insert(at.to_owned(), value.into());
            }
            End::Beyond(value) => {
                schema.insert(beyond.to_owned(), value.into());
            }
        };
        state(R::LOW, ["minimum", "exclusiveMinimum"]);
        state(R::HIGH, ["maximum", "exclusiveMaximum"]);
        schema
    }
}

/// A whole number from `LOW` to `HIGH`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
#[serde(transparent)]
pub struct Count<const LOW: usize, const HIGH: usize>(usize);

impl<const LOW: usize, const HIGH: usize> Count<LOW, HIGH> {
    /// The number.
    pub fn get(self) -> usize {
        self.0
    }
}

/// The number as it stands, for tables in memory: it is checked where the table is read.
impl<const LOW: usize, const HIGH: usize> From<usize> for Count<LOW, HIGH> {
    fn from(value: usize) -> Self {
        Self(value)
    }
}

impl<'de, const LOW: usize, const HIGH: usize> Deserialize<'de> for Count<LOW, HIGH> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let value = usize::deserialize(deserializer)?;
        if (LOW..=HIGH).contains(&value) {
            Ok(Self(value))
        } else {
            let problem = format!("found {value}, allowed is {LOW} to {HIGH}");
            Err(D::Error::custom(problem))
        }
    }
}

impl<const LOW: usize, const HIGH: usize> JsonSchema for Count<LOW, HIGH> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("{LOW} to {HIGH}").into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "integer", "minimum": LOW, "maximum": HIGH })
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::input::InputDocument;

    crate::number_range!(Poisson: End::At(0.0), End::Beyond(0.5), "0.5 keeps its volume");

    #[derive(Debug, Deserialize, JsonSchema)]
    #[allow(dead_code)]
    struct Table {
        poisson: Option<Bounded<Poisson>>,
        share: Option<Bounded<Within<0, 1>>>,
        width_mm: Option<Bounded<UpTo<20>>>,
        rise_mm: Option<[Bounded<NotNegative>; 2]>,
        laminae: Option<Count<2, 1000>>,
    }

    /// The ends themselves, and what lies beside them.
    #[test]
    fn what_lies_outside_is_refused_in_words() {
        let read = |text: &str| InputDocument::new("t.toml", text).parse::<Table>();
        for text in [
            "poisson = 0",
            "poisson = 0.49999999",
            "share = 1",
            "width_mm = 20",
            "rise_mm = [0, 3.5]",
            "laminae = 2",
        ] {
            assert!(read(text).is_ok(), "{text}");
        }
        for (text, problem) in [
            (
                "poisson = 0.5",
                "poisson: found 0.5, allowed is 0 up to, not including, 0.5: 0.5 keeps its volume",
            ),
            (
                "share = 1.0000000001",
                "share: found 1.0000000001, allowed is 0 to 1",
            ),
            (
                "width_mm = 0",
                "width_mm: found 0, allowed is more than 0 and at most 20",
            ),
            (
                "rise_mm = [0, -1e-12]",
                "rise_mm.1: found -1e-12, allowed is 0 or more",
            ),
            ("laminae = 1", "laminae: found 1, allowed is 2 to 1000"),
            (
                "laminae = 2.5",
                "laminae: found 2.5, allowed is a whole number of 0 or more",
            ),
        ] {
            let found = read(text).unwrap_err().to_string();
            assert_eq!(found, format!("t.toml:1: {problem}"));
        }
    }

    /// The schema, which editors read, has the same ranges.
    #[test]
    fn the_schema_states_the_range() {
        let schema = crate::input::file_schema::<Table>().to_value();
        let keys = &schema["properties"];
        assert_eq!(keys["poisson"]["exclusiveMaximum"], 0.5);
        assert_eq!(keys["poisson"]["minimum"], 0.0);
        assert_eq!(keys["width_mm"]["exclusiveMinimum"], 0.0);
        assert_eq!(keys["width_mm"]["maximum"], 20.0);
        assert_eq!(keys["width_mm"]["unit"], "mm");
        assert_eq!(keys["rise_mm"]["items"]["minimum"], 0.0);
        // The unit's own end, where the key has none.
        assert_eq!(keys["rise_mm"]["items"]["maximum"], 1e6);
        assert_eq!(keys["laminae"]["maximum"], 1000);
    }
}
