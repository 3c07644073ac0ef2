//! Under what a bearing is evaluated: speeds, and how balls roll.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How the spin axis of a ball lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Control {
    /// No spin at the outer race (Jones).
    #[default]
    OuterRace,
    /// For each ball the race whose control turns less power into heat by spin.
    LeastSpin,
}

/// Speeds of the rings, and the places of cage and inner ring.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Operation {
    /// Speed of the inner ring \[rad/s\].
    pub inner_rad_per_s: f64,
    /// Speed of the outer ring \[rad/s\].
    pub outer_rad_per_s: f64,
    /// Angle by which the cage has turned \[rad\].
    pub cage_angle_rad: f64,
    /// Angle by which the inner ring has turned against the outer one: where the faults of its races are \[rad\].
    pub inner_angle_rad: f64,
    /// How balls roll.
    pub control: Control,
}

impl Operation {
    /// Whether rolling elements feel any speed.
    #[must_use]
    pub fn is_turning(&self) -> bool {
        self.inner_rad_per_s != 0.0 || self.outer_rad_per_s != 0.0
    }

    /// The same with rings that stand still.
    pub(crate) fn at_rest(&self) -> Self {
        Self {
            inner_rad_per_s: 0.0,
            outer_rad_per_s: 0.0,
            ..*self
        }
    }

    /// Angle of a ball or roller, counted from 0, of so many that go round with the cage \[rad\].
    #[must_use]
    pub fn element_angle_rad(&self, first_rad: f64, number: usize, count: usize) -> f64 {
        first_rad + self.cage_angle_rad + std::f64::consts::TAU * number as f64 / count as f64
    }
}
