#![doc = include_str!("../README.md")]
//!
//! # Where things are
//!
//! The offline stage: from a gear definition to its [`ReducedGear`](gearmesh_model::ReducedGear).
//!
//! | step | file |
//! | --- | --- |
//! | unit loads on the flank grid, as nodal loads | `flank_loads.rs` |
//! | integration over a part of an element face | `face_overlap.rs` |
//! | forces at single places: the face under a point; of a flank | `face_projection.rs`; `projected_flank.rs` |
//! | mesh, model and the way it is solved | `gear_body.rs` |
//! | by repetition: a tooth, a sector, the ring | `tooth_substructure.rs`, `sector_substructure.rs`, `sector_condensation.rs`, `sector_stiffness.rs`, `separating_circle.rs`, `cyclic_body.rs`, `cyclic_response.rs` |
//! | by one factorisation of everything | `whole_gear.rs` |
//! | loads of tooth 0 turned to other teeth | `tooth_vectors.rs` |
//! | the tooth-only submodel and its solution W | `tooth_submodel.rs` |
//! | calibration of the near field in plane strain | `near_field.rs` |
//! | a narrow load on a fine section of the tooth | `contact_problem.rs` |
//! | a gauge as one row of nodal weights | `gauge_row.rs` |
//! | compliance and its checks; what gauges read | `flank_compliance.rs`; `asked_gauges.rs` |
//! | C_hub of a body that does not repeat, by patterns | `hub_patterns.rs`, `single_sector.rs` |
//! | the reduction | `reduce.rs`, of a bevel gear `bevel/` |
//! | the steps of both, their wall time | `reduction_steps.rs`, `stages.rs` |
//! | a gear that was meshed elsewhere | `import.rs`, `imported_mesh.rs` |
//! | whether its mesh fits; the outlines found in it | `imported_check.rs`, `imported_error.rs`; `imported_outline.rs` |
//! | points in the frame of a tooth | `tooth_frame.rs` |
//! | what all of them ask of a mesh | `toothed_mesh.rs`, `repeated_mesh.rs` |
//! | mass, rigid motions, natural modes for the dynamics | `rigid_mass.rs`, `dynamics.rs` |
//! | motions of the bore, for bodies that slide or roll on their pin | `bore_patterns.rs` |
//! | faces of a gear that is cut into its shaft; natural modes with them held | `shaft_faces.rs`; `modes_on_faces.rs` |
//! | natural modes: the search, one harmonic of it, what a shape is like | `gear_modes.rs`, `harmonic_problem.rs`, `mode_figures.rs` |
//! | discretisation error from a coarser mesh | `error_estimate.rs` |
//! | memory that all this will take, before it is taken | `memory_estimate.rs`, `mode_count.rs` |
//! | a crack in one tooth, as rows added to the compliance | `root_crack.rs` |
//! | the whole displacement and stress field | `field.rs` |
//! | the surface and the stress on it | `skin.rs` |
//!
//! With N the unit loads, U = K⁻¹N, W the same loads on the tooth-only submodel and Ψ = U − W the deformation
//! patterns, the reduced compliance is C_g = ΨᵀKΨ = NᵀU − NᵀW. It is never computed by inverting ΨᵀKΨ: the proof that
//! it need not be is in docs/theory/reduction.md, and every reduction checks the identity on its own numbers.

mod asked_gauges;
pub mod bevel;
pub mod bore_patterns;
pub mod contact_problem;
pub mod cyclic_body;
mod cyclic_response;
pub mod dynamics;
pub mod error_estimate;
pub mod face_overlap;
pub mod face_projection;
pub mod field;
mod flank_compliance;
pub mod flank_loads;
pub mod gauge_row;
pub mod gear_body;
pub mod gear_modes;
mod harmonic_problem;
pub mod hub_patterns;
pub mod import;
mod imported_check;
pub mod imported_error;
pub mod imported_mesh;
mod imported_outline;
pub mod memory_estimate;
pub mod mode_count;
pub mod mode_figures;
mod modes_on_faces;
pub mod near_field;
mod part;
pub mod projected_flank;
pub mod reduce;
mod reduction_steps;
pub mod repeated_mesh;
pub mod rigid_mass;
pub mod root_crack;
mod sector_condensation;
mod sector_stiffness;
pub mod sector_substructure;
mod separating_circle;
pub mod shaft_faces;
mod single_sector;
pub mod skin;
mod stages;
mod time_estimate;
mod tooth_frame;
pub mod tooth_submodel;
pub mod tooth_substructure;
pub mod tooth_vectors;
pub mod toothed_mesh;
pub mod whole_gear;

pub use gear_body::GearBody;
pub use gear_modes::GearModes;
pub use import::{read_body, reduce_imported};
pub use memory_estimate::{MemoryEstimate, OfflineJob};
pub use mode_figures::GearMode;
pub use reduce::{ReductionOptions, reduce};

/// Why a gear could not be reduced.
#[derive(Debug, thiserror::Error)]
pub enum ReductionError {
    /// No mesh.
    #[error(transparent)]
    Mesh(#[from] gearmesh_mesh::MeshError),
    /// The finite element model is not sound.
    #[error(transparent)]
    Fe(#[from] gearmesh_fe::FeError),
    /// A model without usable motions of its bore.
    #[error(transparent)]
    Bore(#[from] gearmesh_model::ReducedGearError),
    /// A mesh from elsewhere is not the gear's.
    #[error(transparent)]
    Imported(#[from] Box<imported_error::ImportedMeshError>),
    /// A force stands beside the flank.
    #[error(transparent)]
    OffFlank(#[from] face_projection::OffEveryFace),
    /// A gauge covers no element face.
    #[error(
        "gauge {name}: no element face lies under it; make it longer or wider, or refine mesh.fillet_mm"
    )]
    EmptyGauge {
        /// Name of the gauge.
        name: String,
    },
    /// No place of a bevel tooth's fillet has the tangent of a gauge.
    #[error(
        "gauge {name}: no place of the fillet has that tangent; tangent_deg may be {from_deg:.1} to {to_deg:.1} there"
    )]
    NoGaugePlace {
        /// Name of the gauge.
        name: String,
        /// Tangent where the flank begins.
        from_deg: f64,
        /// Tangent at the fillet's lower end.
        to_deg: f64,
    },
    /// Something touches the doubled nodes of a crack.
    #[error(
        "the crack begins or runs within one element of {what}; move one of them (crack.tangent_deg or crack.radius_mm places the crack's \
         mouth), or refine mesh.fillet_mm"
    )]
    AtCrack {
        /// What touches it.
        what: String,
    },
    /// A field of a gear with a crack.
    #[error(
        "no field is made of a gear with a crack: the solution at hand is that of the sound gear; remove [crack] from the gear file and reduce it again"
    )]
    FieldWithCrack,
    /// The mesh was made without the crack.
    #[error("the mesh has no line for the crack: mesh the gear from its own definition")]
    NoCrackLine,
    /// Modes were asked for where the file has no density.
    #[error(
        "natural modes need a density; add material.density_kg_per_m3 to the gear file, 7850 for steel"
    )]
    NoDensity,
    /// Modes were asked for of a cross-section.
    #[error("plane strain has no natural modes of a gear; set mesh.plane_strain = false")]
    ModesInPlaneStrain,
    /// The range holds no mode.
    #[error(
        "the gear has no natural mode up to {up_to_hz} Hz; ask for a higher frequency, or for modes by count"
    )]
    NoModes {
        /// End of the range \[Hz\].
        up_to_hz: f64,
    },
    /// Nodes of a tooth, or of the ring below it, are held.
    #[error(
        "the gear is held too far out: {held} of the held nodes belong to teeth or to the ring below them; make blank.bore_diameter_mm or \
         blank.shaft_diameter_mm smaller"
    )]
    HeldTeeth {
        /// Number of such nodes.
        held: usize,
    },
    /// The mesh does not tell the motions of the bore apart.
    #[error(
        "the bore has {nodes} nodes, too few to tell motions of {harmonics} harmonics and {along} polynomials apart; make \
         reduction.bore.harmonics or along smaller, or mesh.body_mm or axial_mm"
    )]
    BoreMotions {
        /// Nodes of the bore.
        nodes: usize,
        /// Highest harmonic asked for.
        harmonics: usize,
        /// Polynomials along it.
        along: usize,
    },
    /// An identity that holds exactly was violated: the numbers cannot be trusted.
    #[error(
        "the reduction failed its own check: {check} is {found:.2e}, at most {allowed:.0e} is expected; the stiffness matrix is too ill-conditioned (very thin web, very slender elements?)"
    )]
    Check {
        /// Which identity.
        check: &'static str,
        /// Relative violation.
        found: f64,
        /// What round-off explains.
        allowed: f64,
    },
}

impl ReductionError {
    /// True when the gear file is to blame, not the computation.
    #[must_use]
    pub fn is_input(&self) -> bool {
        use gearmesh_mesh::MeshError;
        match self {
            Self::EmptyGauge { .. }
            | Self::NoGaugePlace { .. }
            | Self::NoDensity
            | Self::ModesInPlaneStrain
            | Self::NoModes { .. }
            | Self::HeldTeeth { .. }
            | Self::BoreMotions { .. }
            | Self::AtCrack { .. }
            | Self::Mesh(
                MeshError::NoCut { .. }
                | MeshError::OpeningsAcross { .. }
                | MeshError::CrackTip { .. }
                | MeshError::NoMesh { .. }
                | MeshError::TooManyTetrahedra { .. }
                | MeshError::CrossedLines { .. }
                | MeshError::Quality { .. }
                | MeshError::Bevel(_)
                | MeshError::MeshedElsewhere { .. },
            ) => true,
            Self::Imported(cause) => cause.is_input(),
            _ => false,
        }
    }
}

impl From<imported_error::ImportedMeshError> for ReductionError {
    fn from(error: imported_error::ImportedMeshError) -> Self {
        Self::Imported(Box::new(error))
    }
}

/// Where a long computation stands.
pub trait Progress: Sync {
    /// A stage begins.
    fn stage(&self, name: &str);
    /// `done` of `total` pieces of the present stage are finished.
    fn advance(&self, done: usize, total: usize);
    /// The present stage cannot count its pieces and will take about so many seconds from now; zero: not long.
    fn expect(&self, seconds: f64);
}

/// Says nothing.
pub struct Silent;

impl Progress for Silent {
    fn stage(&self, _name: &str) {}
    fn advance(&self, _done: usize, _total: usize) {}
    fn expect(&self, _seconds: f64) {}
}

/// The stages of a part of a longer job, each named after it.
pub(crate) struct Within<'a> {
    pub(crate) all: &'a dyn Progress,
    pub(crate) part: String,
}

impl Progress for Within<'_> {
    fn stage(&self, name: &str) {
        self.all.stage(&format!("{}, {name}", self.part));
    }

    fn advance(&self, done: usize, total: usize) {
        self.all.advance(done, total);
    }

    fn expect(&self, seconds: f64) {
        self.all.expect(seconds);
    }
}
