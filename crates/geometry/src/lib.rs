#![doc = include_str!("../README.md")]
//! # Where things are
//!
//! Gear definition, tooth flanks, fillet, microgeometry and the kinematics of a pair.
//!
//! The way through this crate is the way the theory goes:
//!
//! | step | type | file |
//! | --- | --- | --- |
//! | read a gear file (TOML, units in the keys) | [`GearDefinition`] | `gear_file.rs`, `gear_file/`, `definition.rs`, `blank.rs` |
//! | tool, involute and fillet of one tooth | [`ToothGeometry`] | `tooth.rs`, `cut_tooth.rs`, `internal_tooth.rs`, `fillet/` |
//! | that tooth's outline by arc length | [`ProfileCurve`] | `profile_curve.rs` |
//! | the body's axial contour with fillets | [`body_outline`] | `body_outline.rs` |
//! | material removed from the ideal flank | [`Microgeometry`] | `microgeometry.rs`, `microgeometry/` |
//! | material removed from single flanks: errors and faults | [`flank_error::FlankError`] | `flank_error.rs` |
//! | two bodies that touch in a point, after Hertz | [`point_contact::PointContact`] | `point_contact.rs`, `elliptic.rs` |
//! | the base circles of a pair: line of action, gap, curvature | [`BaseCircles`] | `base_circles.rs` |
//! | two gears at a centre distance | [`GearPair`] | `pair.rs`, `tip_in_fillet.rs`, `tip_sweep.rs` |
//!
//! Everything is in SI units; millimetres, degrees and micrometres exist only in the gear file. Frames and signs:
//! z is the gear axis and zero at mid-face, tooth 0 is centred on +x, teeth are numbered counter-clockwise seen
//! from +z, the *right* flank of a tooth faces clockwise. Formulas are derived in docs/theory/geometry.md.

pub mod base_circles;
mod bisection;
pub mod blank;
pub mod body_outline;
mod cut_tooth;
pub mod definition;
pub mod elliptic;
pub mod fillet;
mod flank;
pub mod flank_error;
pub mod gear_file;
pub mod input;
mod internal_tooth;
pub mod involute;
pub mod microgeometry;
pub mod pair;
pub mod pair_error;
pub mod point_contact;
pub mod profile_curve;
mod tip_in_fillet;
mod tip_sweep;
pub mod tooth;
mod tooth_definition;
pub mod tooth_error;

pub use base_circles::BaseCircles;
pub use blank::{
    Blank, Contour, ContourPoint, CutIntoShaft, Holes, LengthUnit, Lugs, MeshedBody, Openings, Rim,
    Slots, Web,
};
pub use definition::{
    BoreMotions, CrackDefinition, Flank, GaugeDefinition, GearDefinition, Gearing, HubSupport,
    InternalRoot, Material, MeshSettings, ModeRange, PinionCutter, ReductionSettings, RootPosition,
    Symmetry, ToothDefinition,
};
pub use gearmesh_elements::Element;
pub use input::InputError;
pub use microgeometry::{GearMicrogeometry, Microgeometry};
pub use pair::{GearPair, Misalignment};
pub use pair_error::PairError;
pub use profile_curve::ProfileCurve;
pub use tooth::ToothGeometry;
pub use tooth_error::GeometryError;
