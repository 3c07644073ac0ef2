#![doc = include_str!("../README.md")]
//!
//! # Where things are
//!
//! REXS, the gear industry's exchange format for gearboxes: XML, JSON or a zip of one, versions 1.0 to 2.0.0.
//!
//! Data walk one way: bytes ([`container`]) → text of a [`model::Model`] ([`xml`], [`json`]) → names of version 2.0.0
//! ([`versions`]) → values with units ([`source`], which keeps the list of what was taken) → shafts, gears, bearings,
//! loads → gear files, scenes, bearing files, bevel pair files as text ([`mod@import`]). docs/rexs.md says what
//! becomes of what.

pub mod axial_supports;
pub mod backlash;
pub mod bearing;
pub mod bearings_and_couplings;
pub mod bevel;
pub mod bevel_force;
pub mod bevel_loads;
pub mod by_number;
pub mod container;
pub mod coupling;
mod cylindrical;
pub mod drive_text;
mod effort;
pub mod error;
pub mod gear;
pub mod gear_bodies;
pub mod gear_text;
mod gearbox;
pub mod import;
pub mod in_time;
pub mod json;
pub mod ledger;
pub mod loads;
pub mod loose_gears;
pub mod material;
pub mod mesh_model;
pub mod microgeometry;
pub mod model;
pub mod placement;
pub mod planetary;
mod planetary_parts;
pub mod planetary_set;
pub mod power_flow;
mod running;
pub mod scene_text;
pub mod shaft;
pub mod shaft_sections;
pub mod sheet;
pub mod source;
pub mod structure;
pub mod supports;
pub mod text;
pub mod tooth_thickness;
pub mod train;
pub mod train_finish;
pub mod train_places;
pub mod train_power;
pub mod units;
pub mod unjoined;
mod vectors;
pub mod versions;
pub mod xml;

pub use error::RexsError;
pub use import::{Import, ImportedFile, import, import_to_run};
pub use ledger::{About, Entry, Ledger, Weight};
pub use mesh_model::{Meshes, model_file};
pub use running::Running;
pub use sheet::{Port, Sheet};
