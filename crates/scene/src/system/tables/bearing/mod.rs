//! `[[bearing]]`: where it is, and its model; one file for each kind of model. Places and axes are those of the world at the start.

mod linear;
mod quasi_static;

pub use linear::LinearBearingTable;
pub use quasi_static::{ControlWord, QuasiStaticBearingTable};

use gearmesh_geometry::kinds;
use schemars::JsonSchema;
use serde::Deserialize;

/// `[[bearing]]`.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BearingTable {
    /// Name.
    pub name: String,
    /// Housing; "ground" where not given.
    pub body_1: Option<String>,
    /// Shaft.
    pub body_2: String,
    /// Where; the origin of `body_2` where not given.
    pub at_mm: Option<[f64; 3]>,
    /// Axis; the z axis of `body_2` where not given.
    pub axis: Option<[f64; 3]>,
    /// Model.
    pub model: BearingModel,
}

/// `bearing.model`. A bearing without elasticity is a revolute joint.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(remote = "Self", rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(tag = "kind", rename = "BearingModel")]
pub enum BearingModel {
    /// Constant stiffness and damping, turns freely.
    Linear(LinearBearingTable),
    /// Every ball or roller in equilibrium, from a bearing file.
    QuasiStatic(QuasiStaticBearingTable),
}

kinds!(BearingModel, "kind");
