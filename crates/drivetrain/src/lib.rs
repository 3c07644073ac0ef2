#![doc = include_str!("../README.md")]
//!
//! # Where things are
//!
//! Gear pairs as force elements of a multibody system.
//!
//! | question | answer | file |
//! | --- | --- | --- |
//! | which teeth face each other at any pose of two gears, how far apart, with all derivatives | [`MeshKinematics`] | `mesh_kinematics.rs`, `pose.rs`; `mesh_frame.rs`, `slice_plane.rs`, `pose_geometry.rs`, `base_helix.rs`, `path_ends.rs`; what is found: `flank_contacts.rs` |
//! | what a mesh asks of a family of flanks | [`FlankKinematics`] | `flank_kinematics.rs`; involute gears: `involute_mesh.rs`; bevel gears: [`BevelMesh`], `bevel/` |
//! | what resists | the models | `models/` |
//! | what simple models take from a pair's own static curve | [`PairCurve`] | `pair_curve.rs`, `roll_harmonics.rs` |
//! | what is spent | [`Damping`], [`Friction`] | `damping.rs`, `friction.rs` |
//! | teeth that are apart, or overlap | `nearest_flanks.rs`, `tooth_overlap.rs` |
//! | force, moment and tangents on two gears | [`GearMesh`] | `gear_mesh.rs`, a side of it `side_assembly.rs` |
//! | vibration modes of the gear bodies at the flanks | [`FlankModes`] | `flank_modes.rs`, `modal_loads.rs` |
//! | the same between two bodies of a system | [`MeshElement`] | `mesh_element.rs` |
//! | meshes that share gear bodies, solved together, with the rollers in their bores | [`CoupledMeshes`] | `coupled_meshes.rs` |
//! | root strain at gauges while a run goes on | [`StrainGauges`] | `strain_gauges.rs` |
//! | errors and faults of teeth | [`FlankError`] | `flank_error.rs`, `errors/` |
//! | a gear cut into its shaft, its frame on one face, the other moving by modes | [`GearOnFaces`] | `gear_on_faces.rs` |
//! | mass and inertia of a gear body, from its geometry or its model file | [`GearInertia`], [`gear_body()`], [`modal_gear_body`] | `gear_inertia.rs`, `gear_body.rs` |
//!
//! An effect that is not asked for is not called: friction, damping, the coast side and flank errors are absent unless
//! given. Spur and helical gears on parallel axes, bevel gears on axes that meet. The theory is in
//! docs/theory/gear_meshes.md.

mod base_helix;
pub mod bevel;
pub mod coupled_meshes;
pub mod damping;
pub mod error;
pub mod errors;
pub mod flank_contacts;
pub mod flank_error;
pub mod flank_kinematics;
pub mod flank_modes;
pub mod friction;
mod gap_curvature;
pub mod gear_body;
pub mod gear_inertia;
pub mod gear_mesh;
pub mod gear_on_faces;
mod involute_mesh;
mod mesh_channels;
pub mod mesh_element;
mod mesh_frame;
pub mod mesh_kinematics;
mod mesh_load;
pub mod modal_loads;
pub mod models;
mod nearest_flanks;
mod node_surface;
mod pair_channels;
pub mod pair_curve;
pub mod path_ends;
pub mod pose;
mod pose_geometry;
pub mod posed_flanks;
pub mod ring_foundation;
pub mod roll_harmonics;
mod side_assembly;
pub mod slice_plane;
pub mod step;
pub mod strain_gauges;
pub mod tooth_compliance;
pub mod tooth_overlap;

pub use bevel::{BevelAtRest, BevelMesh, BevelSlices, FacetKind, FacetSize, PlaceAtRest};
pub use coupled_meshes::{CoupledMeshes, CoupledPart, FoundTogether, GearOnRollers, MeshToCouple};
pub use damping::{Damped, Damping};
pub use error::DrivetrainError;
pub use flank_contacts::FlankContacts;
pub use flank_error::{FlankError, FlankPoint, Removed};
pub use flank_kinematics::{ContactPatch, FlankKinematics, PatchAxes, Tangent};
pub use flank_modes::{FlankModes, ModalMotion};
pub use friction::Friction;
pub use gear_body::{gear_body, modal_gear_body, modes_up_to};
pub use gear_inertia::GearInertia;
pub use gear_mesh::{GearMesh, MeshEffort, MeshLoad};
pub use gear_on_faces::GearOnFaces;
pub use mesh_element::MeshElement;
pub use mesh_kinematics::MeshKinematics;
pub use models::analytic::BeamTeeth;
pub use models::hybrid::ReducedTeeth;
pub use models::impact::{Impact, PowerStiffness};
pub use models::iso6336::{MeshSpring, SingleStiffness};
pub use models::kinematic::kinematic_mesh;
pub use models::teeth_model::{self, TeethLoads, TeethModel};
pub use node_surface::{
    DigitalFlank, NodeSurfaces, PatchSize, ReferenceApproach, line_contact_area_m2,
    point_contact_area_m2,
};
pub use pair_channels::{SlicePressure, ToothPairs};
pub use pair_curve::{PairCurve, PairSamples};
pub use path_ends::PathEnds;
pub use pose::Pose;
pub use posed_flanks::PosedFlanks;
pub use side_assembly::FlankFriction;
pub use strain_gauges::{ModalPart, StrainGauges};
pub use tooth_compliance::{BeamTooth, RootCrack};
