//! `[[gear_mesh]]`: two gears, the model of their teeth and what else is computed.

use std::path::PathBuf;

use gearmesh_contact::LocalContact;
use gearmesh_drivetrain::Damping;
use gearmesh_geometry::input::TableKeys;
use gearmesh_geometry::{Flank, InputError};
use schemars::JsonSchema;
use serde::Deserialize;

use super::flank_errors::{CrackTable, FlankErrorTable};
use super::friction::FrictionTable;
use super::{MM, UM};

/// `[[gear_mesh]]` as it stands in the file.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct GearMeshTable {
    /// Name.
    pub name: String,
    /// Body of gear 1.
    pub gear_1: String,
    /// Body of gear 2.
    pub gear_2: String,
    /// Model of the teeth.
    pub model: MeshModel,
    /// Flanks that can touch: "both" (backlash is what the tooth thickness leaves), or "right" or "left" alone. Right
    /// flanks touch where gear 1 drives clockwise. "both" where not given. Not with `kinematic`.
    pub flanks: Option<TouchingFlanks>,
    /// Beyond the ends of the path of contact: "extended" lets the tip edges go on, "line-of-action" does not.
    /// "extended" where not given. Not with `kinematic`.
    pub path: Option<PathWord>,
    /// Slices over the overlap of the faces; 1 where not given, with `hybrid` those of the models. Not with `kinematic`.
    pub slices: Option<usize>,
    /// `impact`: K of F = K (δ/mm)^e; its unit is N/mm^e with the exponent below.
    pub stiffness_N_per_mm_e: Option<f64>,
    /// `impact`: e, at least 1; with `stiffness` that of the pair's curve where not given.
    pub exponent: Option<f64>,
    /// `impact`: largest damping, none where not given.
    pub damping_N_s_per_mm: Option<f64>,
    /// `impact` with damping: depth from which it acts in full.
    pub full_damping_depth_um: Option<f64>,
    /// `impact`, `iso6336`: the stiffness of the pair itself, from its static curve at one torque, instead of a stated
    /// one.
    pub stiffness: Option<PairStiffnessTable>,
    /// `iso6336`: mesh stiffness c_γα; after ISO 6336-1 method B from the gears' data where neither this nor
    /// `stiffness` is given.
    pub stiffness_N_per_mm_um: Option<f64>,
    /// `iso6336` without a stated stiffness: line load F_t K_A/b, below 100 N/mm the stiffness falls; 100 where not
    /// given.
    pub line_load_N_per_mm: Option<f64>,
    /// `iso6336`: amplitude of the stiffness over the mesh cycle, over its mean, below 1; constant where not given.
    pub stiffness_amplitude: Option<f64>,
    /// `hybrid`: local contact; "calibrated" where not given.
    pub local: Option<LocalContact>,
    /// `hybrid`: normal force to which the floor of the local law's logarithm belongs (a millionth of its mean slice
    /// force); 100 N/mm times the face width where not given.
    pub nominal_force_N: Option<f64>,
    /// Damping of `iso6336`, `analytic` and `hybrid`; none where not given.
    pub damping: Option<DampingTable>,
    /// Friction; none where not given. Not with `kinematic`.
    pub friction: Option<FrictionTable>,
    /// Whether the microgeometry of the bodies or gear files acts, as it does where nothing is said. `kinematic` and `iso6336`
    /// know no flanks: with them it must be set to false for gears that have microgeometry, but for `iso6336` with
    /// `stiffness`, whose curve holds it.
    pub microgeometry: Option<bool>,
    /// Errors and faults of gear 1. Not with `kinematic` and `iso6336`.
    #[serde(default)]
    pub errors_1: Vec<FlankErrorTable>,
    /// Errors and faults of gear 2.
    #[serde(default)]
    pub errors_2: Vec<FlankErrorTable>,
    /// `analytic`: root cracks of gear 1.
    #[serde(default)]
    pub cracks_1: Vec<CrackTable>,
    /// `analytic`: root cracks of gear 2.
    #[serde(default)]
    pub cracks_2: Vec<CrackTable>,
    /// Place of gear 1 on its body: runout and wobble. Not with `kinematic`.
    pub eccentricity_1: Option<EccentricityTable>,
    /// Place of gear 2 on its body.
    pub eccentricity_2: Option<EccentricityTable>,
}

/// `stiffness`: the pair's own static curve.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct PairStiffnessTable {
    /// Result (.h5) of a `[pair]` scene of these gears, relative to the scene. Where not given, the curve is computed,
    /// as the models of the two bodies' reduced gears have it.
    pub from: Option<PathBuf>,
    /// Torque on gear 2 at which stiffness and transmission error are taken, without sign; with `from` one of that
    /// scene's torques.
    pub torque_Nm: f64,
    /// `iso6336`: harmonics of the mesh cycle, 20 where not given; 0 for the means alone.
    pub harmonics: Option<usize>,
    /// Without `from`: local contact of the curve; "calibrated" where not given.
    pub local: Option<LocalContact>,
}

/// `gear_mesh.model`, cheapest first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum MeshModel {
    /// An ideal ratio.
    Kinematic,
    /// K δ^e with damping, as in ADAMS.
    Impact,
    /// One spring for the whole mesh, after ISO 6336-1.
    Iso6336,
    /// Each tooth a beam on its foundation, Hertz.
    Analytic,
    /// Reduced gears and the complementarity problem.
    Hybrid,
}

impl MeshModel {
    /// Name in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Kinematic => "kinematic",
            Self::Impact => "impact",
            Self::Iso6336 => "iso6336",
            Self::Analytic => "analytic",
            Self::Hybrid => "hybrid",
        }
    }
}

/// Flanks that can touch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
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
    pub(crate) fn flanks(self) -> &'static [Flank] {
        match self {
            Self::Both => &Flank::ALL,
            Self::Right => &[Flank::Right],
            Self::Left => &[Flank::Left],
        }
    }
}

/// Ends of the path of contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum PathWord {
    /// Contact on the rigid path only.
    LineOfAction,
    /// Tip edges go on touching.
    #[default]
    Extended,
}

/// `damping`.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
#[allow(non_snake_case)]
pub enum DampingTable {
    /// The teeth feel the gap g + τ ġ.
    StiffnessProportional {
        /// τ: damping over stiffness.
        time_s: f64,
        /// Depth from which it acts in full.
        full_depth_um: f64,
    },
    /// c for each pair of teeth.
    Viscous {
        /// c.
        damping_N_s_per_mm: f64,
        /// Depth from which it acts in full.
        full_depth_um: f64,
    },
}

impl DampingTable {
    /// The damping in SI units; `keys` are those of the mesh.
    ///
    /// # Errors
    /// [`InputError`] for a number out of its range.
    pub(crate) fn check(&self, keys: &TableKeys<'_>) -> Result<Damping, InputError> {
        let (name, value, depth) = match self {
            Self::StiffnessProportional {
                time_s,
                full_depth_um,
            } => ("time_s", *time_s, *full_depth_um),
            Self::Viscous {
                damping_N_s_per_mm,
                full_depth_um,
            } => ("damping_N_s_per_mm", *damping_N_s_per_mm, *full_depth_um),
        };
        let at = |name: &str| format!("damping.{name}");
        keys.require(&at(name), value, value >= 0.0, "0 or more")?;
        keys.require(&at("full_depth_um"), depth, depth > 0.0, "more than 0")?;
        let full_depth_m = UM * depth;
        Ok(match self {
            Self::StiffnessProportional { time_s, .. } => Damping::StiffnessProportional {
                time_s: *time_s,
                full_depth_m,
            },
            Self::Viscous { .. } => Damping::Viscous {
                coefficient_n_s_per_m: value / MM,
                full_depth_m,
            },
        })
    }
}

/// `eccentricity_1` and `eccentricity_2`.
#[derive(Debug, Clone, Copy, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct EccentricityTable {
    /// Distance of the gear's axis from the body's z axis.
    pub offset_um: f64,
    /// Its direction from the body's x axis.
    pub direction_deg: f64,
    /// Tilt of the gear's axis.
    pub tilt_mrad: f64,
    /// Direction of the tilt's axis from the body's x axis.
    pub tilt_direction_deg: f64,
}
