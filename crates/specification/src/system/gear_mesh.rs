//! `[[gear_mesh]]`: two gears, the model of their teeth, and what the teeth have whatever the model.

use std::path::PathBuf;

use gearmesh_geometry::{Flank, kinds};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::mesh_model::{HertzTable, MeshModel};
use crate::gear_tables::flank_errors::FlankErrorTable;
use crate::gear_tables::friction::FrictionTable;
pub use crate::gear_tables::path_word::PathWord;
pub use crate::gear_tables::seat::EccentricityTable;

/// `[[gear_mesh]]` as written in the file.
#[derive(Debug, Clone, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GearMeshTable {
    /// Name.
    pub name: String,
    /// Body of gear 1.
    pub gear_1: String,
    /// Body of gear 2.
    pub gear_2: String,
    /// A bevel pair file, relative to the scene: gear 1 is its pinion, gear 2 its gear. The origin of both bodies is
    /// the pitch apex, z points from the apex to the heel, the middle of tooth 0 stands on +x. Models `impact` and
    /// `hybrid`.
    pub bevel_pair: Option<PathBuf>,
    /// With `bevel_pair` and kind `hybrid`: reduced models (.h5) of the pinion and the gear, relative to the scene;
    /// where the bodies name none as their `gear`.
    pub bevel_models: Option<[PathBuf; 2]>,
    /// With `bevel_pair` and kind `impact`: flanks of the pinion divided into facets against the smooth ones of the
    /// gear; smooth on both where not given.
    pub bevel_surface: Option<BevelSurfaceTable>,
    /// Model of the teeth.
    pub model: MeshModel,
    /// What touches and how. Not with kind `kinematic`.
    pub teeth: Option<TeethTable>,
    /// Columns of each pair of teeth that carries: tooth, force, place on both flanks, largest pressure after Hertz;
    /// none where not given. Not with
    /// kinds `kinematic` and `iso6336`. Bevel pairs of kind `impact` have the contact ellipse, too, with this
    /// material, `{}` for steel; elsewhere
    /// slices are summed by pair, and the materials are those of the model or the gears: `{}`.
    pub tooth_pairs: Option<HertzTable>,
    /// Whether the microgeometry of the gears acts, as it does where nothing is said. `kinematic` and `iso6336` know no
    /// flanks: with them it must be set to false for gears that have microgeometry, but for `iso6336` with `stiffness`,
    /// whose curve holds it.
    pub microgeometry: Option<bool>,
}

/// `gear_mesh.bevel_surface`: what the pinion's flanks are divided into. Edges should be a fifth of the contact ellipse
/// or less; at least eight facets along the face and up the flank, two hundred thousand on a flank at most.
#[derive(Debug, Clone, Copy, Deserialize, Serialize, JsonSchema)]
#[serde(remote = "Self", rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(tag = "kind", rename = "BevelSurfaceTable")]
pub enum BevelSurfaceTable {
    /// Plane triangles.
    Triangles {
        /// Longest edge along the face.
        along_um: f64,
        /// Longest edge up the flank.
        up_um: f64,
    },
    /// Quadrilaterals, bilinear between their corners.
    Quadrilaterals {
        /// Longest edge along the face.
        along_um: f64,
        /// Longest edge up the flank.
        up_um: f64,
    },
}

kinds!(BevelSurfaceTable, "kind");

/// `gear_mesh.teeth`: what touches and how, whatever the model that knows flanks.
#[derive(Debug, Clone, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct TeethTable {
    /// Flanks that can touch: "both" (backlash is what the tooth thickness leaves), or "right" or "left" alone. Right
    /// flanks touch where gear 1 drives clockwise. "both" where not given.
    pub flanks: TouchingFlanks,
    /// Beyond the ends of the path of contact: "extended" lets the tip edges go on, "line-of-action" does not.
    /// "extended" where not given; bevel pairs always have their edges.
    pub path: PathWord,
    /// Flanks of gear 1 that touch at the start where a mesh turns a gear there: "right" or "left"; those with which
    /// gear 1 drives where not given, right ones where it stands.
    pub touching_at_start: Option<Flank>,
    /// Friction; none where not given.
    pub friction: Option<FrictionTable>,
    /// Errors and faults of gear 1. Not with kind `iso6336`.
    pub errors_1: Vec<FlankErrorTable>,
    /// Errors and faults of gear 2. Not with kind `iso6336`.
    pub errors_2: Vec<FlankErrorTable>,
    /// Place of gear 1 on its body: runout and wobble.
    pub eccentricity_1: Option<EccentricityTable>,
    /// Place of gear 2 on its body.
    pub eccentricity_2: Option<EccentricityTable>,
}

/// Flanks that can touch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum TouchingFlanks {
    /// Both sides of the teeth.
    #[default]
    Both,
    /// Right flanks.
    Right,
    /// Left flanks.
    Left,
}

impl TouchingFlanks {
    /// The flanks that it names.
    pub fn flanks(self) -> &'static [Flank] {
        match self {
            Self::Both => &Flank::ALL,
            Self::Right => &[Flank::Right],
            Self::Left => &[Flank::Left],
        }
    }
}
