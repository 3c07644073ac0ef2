//! `gear_mesh.model`: the models of a mesh, one table a kind, cheapest first.

use std::path::PathBuf;

use gearmesh_contact::LocalContact;
use gearmesh_drivetrain::Damping;
use gearmesh_geometry::gear_file::PoissonRatio;
use gearmesh_geometry::input::{Bounded, Count, End, NotNegative, Positive, Within};
use gearmesh_geometry::{kinds, number_range};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::gear_tables::flank_errors::CrackTable;
use crate::gear_tables::{MM, UM};

/// `gear_mesh.model`, cheapest first.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(remote = "Self", rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(tag = "kind", rename = "MeshModel")]
pub enum MeshModel {
    /// An ideal ratio.
    Kinematic {},
    /// K δ^e with damping, as in ADAMS.
    Impact(ImpactTable),
    /// One spring for the whole mesh, after ISO 6336-1.
    Iso6336(Iso6336Table),
    /// Each tooth a beam on its foundation, Hertz.
    Analytic(AnalyticTable),
    /// Flanks as points on a grid: nodes of gear 1 against bilinear patches of gear 2.
    NodeToSurface(NodeSurfaceTable),
    /// Reduced gears and the complementarity problem.
    Hybrid(HybridTable),
}

kinds!(MeshModel, "kind");

impl Default for MeshModel {
    /// The cheapest.
    fn default() -> Self {
        Self::Kinematic {}
    }
}

/// A kind of model without its keys.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MeshKind {
    /// See [`MeshModel::Kinematic`].
    Kinematic,
    /// See [`MeshModel::Impact`].
    Impact,
    /// See [`MeshModel::Iso6336`].
    Iso6336,
    /// See [`MeshModel::Analytic`].
    Analytic,
    /// See [`MeshModel::NodeToSurface`].
    NodeToSurface,
    /// See [`MeshModel::Hybrid`].
    Hybrid,
}

impl MeshKind {
    /// Name in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.of_parts().trim_end_matches(" mesh")
    }

    /// Name among the kinds of parts of a system.
    pub fn of_parts(self) -> &'static str {
        match self {
            Self::Kinematic => "kinematic mesh",
            Self::Impact => "impact mesh",
            Self::Iso6336 => "iso6336 mesh",
            Self::Analytic => "analytic mesh",
            Self::NodeToSurface => "node-to-surface mesh",
            Self::Hybrid => "hybrid mesh",
        }
    }
}

impl MeshModel {
    /// Its kind.
    #[must_use]
    pub fn kind(&self) -> MeshKind {
        match self {
            Self::Kinematic {} => MeshKind::Kinematic,
            Self::Impact(_) => MeshKind::Impact,
            Self::Iso6336(_) => MeshKind::Iso6336,
            Self::Analytic(_) => MeshKind::Analytic,
            Self::NodeToSurface(_) => MeshKind::NodeToSurface,
            Self::Hybrid(_) => MeshKind::Hybrid,
        }
    }

    /// Slices that it states.
    #[must_use]
    pub fn slices(&self) -> Option<usize> {
        match self {
            Self::Kinematic {} | Self::NodeToSurface(_) => None,
            Self::Impact(table) => table.slices.map(Count::get),
            Self::Iso6336(table) => table.slices.map(Count::get),
            Self::Analytic(table) => table.slices.map(Count::get),
            Self::Hybrid(table) => table.slices,
        }
    }

    /// The curve of the pair that it takes its stiffness from.
    #[must_use]
    pub fn pair_stiffness(&self) -> Option<&PairStiffnessTable> {
        match self {
            Self::Impact(table) => table.stiffness.as_ref(),
            Self::Iso6336(table) => table.stiffness.as_ref(),
            _ => None,
        }
    }

    /// Its damping in words for the plan; none where it has none.
    pub fn damping_in_words(&self) -> Option<String> {
        let step = |damping: Option<_>| damping.map(|_| "STEP of the depth");
        let words = match self {
            Self::Kinematic {} => None,
            Self::Impact(table) => step(table.damping_N_s_per_mm),
            Self::NodeToSurface(table) => step(table.damping_N_s_per_mm),
            Self::Iso6336(table) => table.damping.as_ref().map(DampingTable::words),
            Self::Analytic(table) => table.damping.as_ref().map(DampingTable::words),
            Self::Hybrid(table) => table.damping.as_ref().map(DampingTable::words),
        };
        words.map(str::to_owned)
    }
}

number_range!(
    /// Shares that stay below the whole.
    pub BelowOne: End::At(0.0), End::Beyond(1.0)
);

/// Keys of `kind = "impact"`.
#[derive(Debug, Clone, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[allow(non_snake_case)]
pub struct ImpactTable {
    /// K of F = K (δ/mm)^e; its unit is N/mm^e with the exponent below.
    pub stiffness_N_per_mm_e: Option<Bounded<Positive>>,
    /// e, at least 1; with `stiffness` that of the pair's curve where not given.
    pub exponent: Option<Bounded<Within<1, 5>>>,
    /// Instead of a stated one: the stiffness of the pair itself, from its static curve at one torque.
    pub stiffness: Option<PairStiffnessTable>,
    /// Instead of a stated one, bevel pairs: K and e = 1.5 after Hertz from both flanks' curvatures at each contact.
    pub hertz: Option<HertzTable>,
    /// Largest damping, none where not given.
    pub damping_N_s_per_mm: Option<Bounded<NotNegative>>,
    /// With damping: depth from which it acts in full.
    pub full_damping_depth_um: Option<Bounded<Positive>>,
    /// Slices across the face width, 1 where not given.
    pub slices: Option<Count<1, 200>>,
}

/// Keys of `kind = "node-to-surface"`.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct NodeSurfaceTable {
    /// K of F = K (δ/mm)^e of a pair of teeth; its unit is N/mm^e with the exponent below.
    pub stiffness_N_per_mm_e: Bounded<Positive>,
    /// e, at least 1.
    pub exponent: Bounded<Within<1, 5>>,
    /// Largest damping of a pair, shared by its nodes as K is; none where not given.
    pub damping_N_s_per_mm: Option<Bounded<NotNegative>>,
    /// With damping: depth from which it acts in full.
    pub full_damping_depth_um: Option<Bounded<Positive>>,
    /// Longest edge of a patch along the face.
    pub along_um: Bounded<Positive>,
    /// Longest edge of a patch up the flank.
    pub up_um: Bounded<Positive>,
    /// What of K a node has.
    pub weights: NodeWeights,
}

impl NodeSurfaceTable {
    /// Its law as `impact` states it.
    pub fn law(&self) -> ImpactTable {
        ImpactTable {
            stiffness_N_per_mm_e: Some(self.stiffness_N_per_mm_e),
            exponent: Some(self.exponent),
            damping_N_s_per_mm: self.damping_N_s_per_mm,
            full_damping_depth_um: self.full_damping_depth_um,
            ..ImpactTable::default()
        }
    }
}

/// `weights` of `node-to-surface`.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(remote = "Self", rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(tag = "kind", rename = "NodeWeights")]
#[allow(non_snake_case)]
pub enum NodeWeights {
    /// The share of its area in that over which the whole contact gives K δ^e at the approach of a stated force.
    Area {
        /// That force of a pair of teeth.
        nominal_force_N: Bounded<Positive>,
    },
    /// The whole K at every node: the force grows with their number.
    None {},
}

kinds!(NodeWeights, "kind");

/// `gear_mesh.model.hertz`, `half_space` and `gear_mesh.tooth_pairs`: material of both gears.
#[derive(Debug, Clone, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[allow(non_snake_case)]
pub struct HertzTable {
    /// Young's modulus, 206 where not given (steel).
    pub young_GPa: Option<Bounded<Positive>>,
    /// Poisson's ratio, 0.3 where not given.
    pub poisson: Option<Bounded<PoissonRatio>>,
}

/// Keys of `kind = "iso6336"`.
#[derive(Debug, Clone, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[allow(non_snake_case)]
pub struct Iso6336Table {
    /// Mesh stiffness c_γα; after ISO 6336-1 method B from the gears' data where neither this nor `stiffness` is given.
    pub stiffness_N_per_mm_um: Option<Bounded<Positive>>,
    /// Without a stated stiffness: line load F_t K_A/b, below 100 N/mm the stiffness falls; 100 where not given.
    pub line_load_N_per_mm: Option<Bounded<Positive>>,
    /// Amplitude of the stiffness over the mesh cycle, over its mean, below 1; constant where not given.
    pub stiffness_amplitude: Option<Bounded<BelowOne>>,
    /// Instead of these: the stiffness of the pair itself, from its static curve at one torque.
    pub stiffness: Option<PairStiffnessTable>,
    /// Damping; none where not given.
    pub damping: Option<DampingTable>,
    /// Slices across the face width, 1 where not given.
    pub slices: Option<Count<1, 200>>,
}

/// Keys of `kind = "analytic"`.
#[derive(Debug, Clone, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct AnalyticTable {
    /// Damping; none where not given.
    pub damping: Option<DampingTable>,
    /// Slices across the face width, 1 where not given.
    pub slices: Option<Count<1, 200>>,
    /// Root cracks of gear 1.
    pub cracks_1: Vec<CrackTable>,
    /// Root cracks of gear 2.
    pub cracks_2: Vec<CrackTable>,
}

/// Keys of `kind = "hybrid"`.
#[derive(Debug, Clone, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[allow(non_snake_case)]
pub struct HybridTable {
    /// Local contact; "calibrated" where not given.
    pub local: Option<LocalContact>,
    /// Bevel pairs, instead of reduced gears: rigid ones whose surfaces deflect as half spaces do; their material.
    pub half_space: Option<HertzTable>,
    /// Slices over the overlap of the faces; those of the models where not given. Bevel pairs: along the face, 15
    /// without models.
    pub slices: Option<usize>,
    /// Normal force to which the floor of the local law's logarithm belongs (a millionth of its mean slice force); 100
    /// N/mm times the face width where not given.
    pub nominal_force_N: Option<Bounded<Positive>>,
    /// Damping; none where not given.
    pub damping: Option<DampingTable>,
}

/// `stiffness`: the pair's own static curve.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct PairStiffnessTable {
    /// Result (.h5) of a `[pair]` scene of these gears, relative to the scene. Where not given, the curve is computed,
    /// as the models of the two bodies' reduced gears have it.
    pub from: Option<PathBuf>,
    /// Torque on gear 2 at which stiffness and transmission error are taken, without sign; with `from` one of that
    /// scene's torques.
    pub torque_Nm: Bounded<Positive>,
    /// `iso6336`: harmonics of the mesh cycle, 20 where not given; 0 for the means alone.
    pub harmonics: Option<Count<0, 50>>,
    /// Without `from`: local contact of the curve; "calibrated" where not given.
    pub local: Option<LocalContact>,
}

/// `damping`.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(remote = "Self", rename_all = "kebab-case", deny_unknown_fields)]
#[schemars(tag = "kind", rename = "DampingTable")]
#[allow(non_snake_case)]
pub enum DampingTable {
    /// The teeth feel the gap g + τ ġ.
    StiffnessProportional {
        /// τ: damping over stiffness.
        time_s: Bounded<NotNegative>,
        /// Depth from which it acts in full.
        full_depth_um: Bounded<Positive>,
    },
    /// c for each pair of teeth.
    Viscous {
        /// c.
        damping_N_s_per_mm: Bounded<NotNegative>,
        /// Depth from which it acts in full.
        full_depth_um: Bounded<Positive>,
    },
}

kinds!(DampingTable, "kind");

impl DampingTable {
    /// In words.
    fn words(&self) -> &'static str {
        match self {
            Self::StiffnessProportional { .. } => "proportional to stiffness",
            Self::Viscous { .. } => "viscous",
        }
    }

    /// The damping in SI units.
    pub fn damping(&self) -> Damping {
        match *self {
            Self::StiffnessProportional {
                time_s,
                full_depth_um,
            } => Damping::StiffnessProportional {
                time_s: *time_s,
                full_depth_m: UM * full_depth_um,
            },
            Self::Viscous {
                damping_N_s_per_mm,
                full_depth_um,
            } => Damping::Viscous {
                coefficient_n_s_per_m: *damping_N_s_per_mm / MM,
                full_depth_m: UM * full_depth_um,
            },
        }
    }
}
