//! `[[body]]`: mass and inertia, stated or from a gear; place and speed at the start.

use std::path::PathBuf;

use gearmesh_geometry::gear_file::MicrogeometryTable;
use gearmesh_geometry::input::{Bounded, End};
use gearmesh_geometry::number_range;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use crate::gear_tables::seat::BoreHold;

number_range!(
    /// Damping ratios below the critical one.
    pub DampingRatio: End::At(0.0), End::Beyond(1.0)
);

/// `[[body]]` as written in the file.
#[derive(Debug, Clone, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BodyTable {
    /// Name by which the other tables know the body. "ground" is the world.
    pub name: String,
    /// A gear file (.toml) or a reduced gear (.h5), relative to the scene: mass, inertia and teeth. The body's frame is
    /// the gear's: z along the axis, origin at mid-face, tooth 0 on +x. Of a bevel gear the reduced one: origin in the
    /// pitch apex, teeth by the `bevel_pair` of its mesh.
    pub gear: Option<PathBuf>,
    /// Microgeometry of the gear in all its meshes, instead of all that the gear file states.
    pub microgeometry: Option<MicrogeometryTable>,
    /// Mass; from the gear where not given.
    pub mass_kg: Option<f64>,
    /// Inertia about the centre of mass, body axes: [Jxx, Jyy, Jzz] or [Jxx, Jyy, Jzz, Jxy, Jxz, Jyz], off-diagonal
    /// entries −∫xy dm; from the gear where not given.
    pub inertia_kg_m2: Option<Vec<f64>>,
    /// Centre of mass from the body's origin, body axes; from the gear, or [0, 0, 0].
    pub centre_of_mass_mm: Option<[f64; 3]>,
    /// Gears: "rigid"; "reduced", the static patterns of the model deflect in `hybrid` meshes; "modal", its natural
    /// modes vibrate, too, and carry their inertia. Rigid or reduced, as the meshes need, where not given.
    pub flexibility: Option<Flexibility>,
    /// Gear in several `hybrid` meshes: "all-meshes", each mesh feels what the forces of the others make of the body;
    /// "own-mesh", each feels its own forces alone. "all-meshes" where not given. Not of meshes with modal gears, whose
    /// modes all meshes feel.
    pub coupling: Option<Coupling>,
    /// Reduced gear with [reduction.bore]: "bonded", the bore is glued to a rigid pin; "sliding", it slides on it;
    /// "rollers", those of the quasi-static cylindrical roller bearing whose outer ring (`body_1`) is this body press
    /// on it, each where it touches. "bonded" where not given.
    pub bore: Option<BoreHold>,
    /// `modal`: modes up to this frequency; all of the model where not given.
    #[serde(rename = "modes_up_to_Hz")]
    pub modes_up_to_hz: Option<f64>,
    /// `modal`: damping ratio of all modes; none where not given.
    pub modal_damping_ratio: Option<Bounded<DampingRatio>>,
    /// Origin of the body in the world; [0, 0, 0], or the seat on a shaft.
    pub position_mm: Option<[f64; 3]>,
    /// Cardan angles: turned about x, then the new y, then the new z. With two angles, or none, a mesh may turn gear 2
    /// about its z so that the teeth touch.
    pub cardan_deg: Option<Vec<f64>>,
    /// Velocity of the origin, world axes; [0, 0, 0] where not given.
    pub velocity_mm_per_s: Option<[f64; 3]>,
    /// Speed about the body's own z, counter-clockwise positive. Where not given: that of its shaft, or what a mesh
    /// with a gear of stated speed makes of it, or 0.
    pub speed_rpm: Option<f64>,
    /// Angular velocity, body axes, instead of `speed_rpm`.
    pub angular_velocity_rad_per_s: Option<[f64; 3]>,
}

/// Whose forces a mesh feels in a body that it shares with others.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Coupling {
    /// Those of all meshes.
    #[default]
    AllMeshes,
    /// Its own.
    OwnMesh,
}

/// How a gear body deflects.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Flexibility {
    /// Not at all.
    Rigid,
    /// By the static patterns of its model.
    Reduced,
    /// By its natural modes and, beside them, its static patterns: Craig-Bampton.
    Modal,
}

impl Flexibility {
    /// Name in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Rigid => "rigid",
            Self::Reduced => "reduced",
            Self::Modal => "modal",
        }
    }
}
