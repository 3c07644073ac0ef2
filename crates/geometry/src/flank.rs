//! Right and left: the hands of the flanks of a tooth.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::fmt;

/// Hand of a flank, and so of a side of the teeth; its words in files and on the command line are those of
/// [`Flank::name`]. Teeth are numbered counter-clockwise seen from +z.
#[derive(
    Debug,
    Clone,
    Copy,
    PartialEq,
    Eq,
    Hash,
    PartialOrd,
    Ord,
    Serialize,
    Deserialize,
    JsonSchema,
    Default,
)]
#[serde(rename_all = "kebab-case")]
pub enum Flank {
    /// Faces clockwise; a load on it turns the gear counter-clockwise.
    #[default]
    Right,
    /// Faces counter-clockwise, the mirror image; a load on it turns the gear clockwise.
    Left,
}

impl fmt::Display for Flank {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name())
    }
}

impl Flank {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Right, Self::Left];

    /// +1 for the right flank, −1 for its mirror image: the factor of y.
    pub fn mirror(self) -> f64 {
        match self {
            Self::Right => 1.0,
            Self::Left => -1.0,
        }
    }

    /// The other flank of the same tooth.
    pub fn opposite(self) -> Self {
        match self {
            Self::Right => Self::Left,
            Self::Left => Self::Right,
        }
    }

    /// Name in files and prints.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Left => "left",
        }
    }
}
