//! `[[bearing]]`: where it is, and its model; one file for each kind of model. Places and axes are those of the world
//! at the start.

mod dynamic;
mod housing;
mod linear;
mod quasi_static;
mod rigid;

pub use dynamic::{
    CageTable, ContactTable, DynamicBearingTable, LandTable, PocketTable, ReboundTable,
    SurfaceTable, TractionTable,
};
pub use housing::HousingTable;
pub use linear::{AxialSupportWord, LinearBearingTable};
pub use quasi_static::QuasiStaticBearingTable;
pub use rigid::{HeldWord, RigidBearingTable};

use gearmesh_geometry::kinds;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// `[[bearing]]`.
#[derive(Debug, Clone, Default, Deserialize, Serialize, JsonSchema)]
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
    /// What lies between the outer ring and `body_1`; nothing where not given. The outer ring becomes a body, called
    /// `BEARING/ring`, on a stiffness, called `BEARING/housing`. Either the diagonals or the 6×6 matrices; order x, y,
    /// z, rotations about x, y, z, with z along the bearing's axis.
    pub housing: Option<HousingTable>,
    /// Model.
    pub model: BearingModel,
}

/// `bearing.model`, cheapest first.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(remote = "Self", rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(tag = "kind", rename = "BearingModel")]
pub enum BearingModel {
    /// A joint.
    Rigid(RigidBearingTable),
    /// Constant stiffness and damping, turns freely.
    Linear(Box<LinearBearingTable>),
    /// Every ball or roller in equilibrium, from a bearing file.
    QuasiStatic(QuasiStaticBearingTable),
    /// Every ball a body, from the bearing file of a ball bearing.
    Dynamic(Box<DynamicBearingTable>),
}

kinds!(BearingModel, "kind");

impl Default for BearingModel {
    /// The cheapest.
    fn default() -> Self {
        Self::Rigid(RigidBearingTable::default())
    }
}

impl BearingModel {
    /// The bearing file that it names.
    #[must_use]
    pub fn file(&self) -> Option<&str> {
        match self {
            Self::Rigid(_) => None,
            Self::Linear(table) => table.tangent_of.as_deref(),
            Self::QuasiStatic(table) => Some(&table.file),
            Self::Dynamic(table) => Some(&table.file),
        }
    }
}
