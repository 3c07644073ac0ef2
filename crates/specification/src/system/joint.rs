//! `[[joint]]` and `[[motion]]`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::function::FunctionTable;

/// `[[joint]]` as written in the file. Places and axes are those of the world at the start.
#[derive(Debug, Clone, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JointTable {
    /// Name.
    pub name: String,
    /// Which relative motions remain.
    pub kind: JointWord,
    /// First body; "ground" where not given.
    pub body_1: Option<String>,
    /// Second body, whose motion is seen from the first.
    pub body_2: String,
    /// Where, in the world at the start; the origin of `body_2` where not given.
    pub at_mm: Option<[f64; 3]>,
    /// Axis in the world at the start; the z axis of `body_2` where not given. Not used by fixed and spherical joints.
    pub axis: Option<[f64; 3]>,
}

/// `joint.kind`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum JointWord {
    /// No relative motion.
    #[default]
    Fixed,
    /// Turns about the axis.
    Revolute,
    /// Slides along the axis.
    Prismatic,
    /// Turns about and slides along the axis.
    Cylindrical,
    /// Turns freely about the point.
    Spherical,
    /// Slides across the axis and turns about it.
    Planar,
}

impl JointWord {
    /// Name in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Fixed => "fixed",
            Self::Revolute => "revolute",
            Self::Prismatic => "prismatic",
            Self::Cylindrical => "cylindrical",
            Self::Spherical => "spherical",
            Self::Planar => "planar",
        }
    }
}

/// `[[motion]]` as written in the file: exactly one of the four functions.
#[derive(Debug, Clone, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MotionTable {
    /// Name; "motion of JOINT" where not given.
    pub name: Option<String>,
    /// The joint that is driven.
    pub joint: String,
    /// Angle about the joint's axis, counted from the start.
    pub angle_deg: Option<FunctionTable>,
    /// Speed about the joint's axis.
    pub speed_rpm: Option<FunctionTable>,
    /// Place along the joint's axis, counted from the start.
    pub position_mm: Option<FunctionTable>,
    /// Speed along the joint's axis.
    pub speed_mm_per_s: Option<FunctionTable>,
}

impl MotionTable {
    /// Its name, given or made.
    #[must_use]
    pub fn name(&self) -> String {
        self.name
            .clone()
            .unwrap_or_else(|| format!("motion of {}", self.joint))
    }
}
