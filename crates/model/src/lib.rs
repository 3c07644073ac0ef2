#![doc = include_str!("../README.md")]
//!
//! # Where things are
//!
//! The contract between the offline and the online side, and every HDF5 file of gearmesh.
//!
//! | to store | use |
//! | --- | --- |
//! | a reduced gear (compliance, gauges, provenance) | [`ReducedGear`], [`write_reduced_gear`], [`read_reduced_gear`] |
//! | a mesh of volume elements with sets and fields | [`MeshData`], [`write_mesh`], [`read_mesh`] |
//! | anything else made of named arrays (a result, a strain record) | [`DataTree`] with a [`FileFormat`] of your own |
//! | rows that come one by one while a run goes on | [`RowLog`], at the end [`write_columns`]; read by [`ColumnFile`] |
//!
//! All files but the log are of one kind: HDF5 with named arrays that carry their unit, axis labels and description,
//! root attributes `format`, `formatVersion`, `software`, `softwareVersion` and `date`, and a seal (size and BLAKE3
//! digest of the bytes) in the HDF5 user block. Writing is atomic: the file appears complete under its name, or the old
//! one stays. Reading checks the seal before libhdf5 parses a byte, so that a truncated or altered file is a typed
//! [`FileError`] and never a wrong number.
//!
//! No other crate calls HDF5.

// Made-up models of the tests name the crate as others do.
#[cfg(test)]
extern crate self as gearmesh_model;

mod atomic_file;
mod bevel_body;
mod bevel_body_file;
mod blank_record;
mod bore_patterns;
mod column_file;
mod csv_cell;
mod data_tree;
mod data_tree_file;
mod data_tree_read;
mod data_tree_take;
mod data_tree_write;
mod definition_record;
mod file_error;
mod hub_patterns;
#[cfg(test)]
#[path = "../../../tests/support/made_up_models.rs"]
mod made_up_models;
mod mesh_data;
mod mesh_file;
mod microgeometry_record;
mod modal_basis;
mod near_field;
mod own_storage;
mod quantity_check;
mod record;
mod reduced_gear;
mod reduced_gear_axes;
mod reduced_gear_check;
mod reduced_gear_error;
mod reduced_gear_file;
mod reduced_gear_parts;
mod rigid_body;
mod root_crack;
mod row_log;
mod seal;
mod shaft_faces;
mod shaft_faces_file;
mod sliding_bore;
mod smooth_curve;
mod staged_folder;
mod stored_gear;
mod text_heap;
mod timestamp;

pub use atomic_file::{
    demand_output, wait_for_writes, write_by, write_bytes, write_streamed, write_text,
};
pub use bevel_body::{BevelBody, BevelMember, BevelNearField, SpiralHand};
pub use bore_patterns::{BoreMotion, BorePatterns, bore_wave};
pub use column_file::{Column, ColumnFile, write_columns};
pub use csv_cell::{csv_cell, no_formula, without_apostrophe};
pub use data_tree::{DataArray, DataTree, FileFormat, Values};
pub use data_tree_read::format_of;
pub use file_error::FileError;
pub use gearmesh_elements::CellKind;
pub use gearmesh_geometry::Flank;
pub use hub_patterns::HubPatterns;
pub use mesh_data::{EXPORT_ENDINGS, Field, MeshData, MeshDataError};
pub use mesh_file::{MESH_FORMAT, read_mesh, write_mesh};
pub use modal_basis::ModalBasis;
pub use near_field::{ContactCurve, NearField};
pub use record::{
    Fields, ListedField, Named, OPEN, Record, list_record, read_record, write_record,
};
pub use reduced_gear::{FlankGrid, GaugeRows, Provenance, ReducedGear, ReductionChecks};
pub use reduced_gear_error::ReducedGearError;
pub use reduced_gear_file::{REDUCED_GEAR_FORMAT, read_reduced_gear, write_reduced_gear};
pub use rigid_body::{ReferencePoint, RigidBody};
pub use root_crack::RootCrack;
pub use row_log::{LockedLog, RowLog};
pub use seal::{bytes_digest, file_digest};
pub use shaft_faces::{FaceMass, ShaftFaces};
pub use sliding_bore::{RadialMotions, SlidingBore};
pub use smooth_curve::SmoothCurve;
pub use staged_folder::write_folder;
pub use stored_gear::StoredGear;
pub use timestamp::utc_now;
