//! Hand of spiral and the two sides of a tooth.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Hand of spiral: a right-hand tooth turns counter-clockwise about the member's axis (apex to heel) on its way from toe to heel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Hand {
    /// Left.
    Left,
    /// Right.
    Right,
}

impl Hand {
    /// +1 for a right hand, −1 for a left one.
    pub fn sign(self) -> f64 {
        match self {
            Self::Left => -1.0,
            Self::Right => 1.0,
        }
    }

    /// The hand of the mate, of external bevel gears the other one.
    pub fn mate(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
        }
    }

    /// As in files.
    pub fn word(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Right => "right",
        }
    }
}

/// Side of a tooth. Of a tooth without curvature (straight bevel) the one that a face mill would make so.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum FlankSide {
    /// Cut by the outside of the blades.
    Concave,
    /// Cut by the inside of the blades.
    Convex,
}

impl FlankSide {
    /// Both.
    pub const BOTH: [Self; 2] = [Self::Concave, Self::Convex];

    /// +1 for concave (outside blades), −1 for convex (inside blades).
    pub fn sign(self) -> f64 {
        match self {
            Self::Concave => 1.0,
            Self::Convex => -1.0,
        }
    }

    /// The flank that meets this one.
    pub fn mate(self) -> Self {
        match self {
            Self::Concave => Self::Convex,
            Self::Convex => Self::Concave,
        }
    }

    /// As in files.
    pub fn word(self) -> &'static str {
        match self {
            Self::Concave => "concave",
            Self::Convex => "convex",
        }
    }

    /// +1 where this flank of a member of that hand faces counter-clockwise about the member's axis, −1 where it faces clockwise.
    pub fn facing(self, hand: Hand) -> f64 {
        self.sign() * hand.sign()
    }
}
