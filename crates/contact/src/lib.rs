#![doc = include_str!("../README.md")]
//!
//! # Where things are
//!
//! Contact of two elastic gears: patches, their compliance and local contact, the complementarity problem; involute
//! pairs at rest.
//!
//! | question | answer | file |
//! | --- | --- | --- |
//! | what is a slice of a contact line, of whatever gears | [`ContactPatch`] | `contact_patch.rs` |
//! | how does a slice on a contact line deflect another | [`SliceCompliance`] | `slice_compliance.rs`, `coupled_places.rs`, `station_blocks.rs` |
//! | the same of a bevel gear | [`SliceCompliance::of_bevel`] | `bevel_slices.rs` |
//! | how does the force of one mesh of a gear deflect it at another | [`CrossCompliance`] | `cross_compliance.rs` |
//! | how does a body bend over its bore, which rollers hold | [`BoreBending`] | `bore_bending.rs` |
//! | the forces of several meshes and what they deflect together | [`JointContact`] | `joint_contact.rs` |
//! | what a root crack adds to that | [`crack_rows`] | `crack_rows.rs` |
//! | where does a slice stand that has walked along the tooth | [`SliceWalk`] | `walked_slice.rs` |
//! | how do the slices of a mesh sit on a flank, of either family | [`FlankSlices`] | `flank_slices.rs` |
//! | where do the faces overlap, and which slices lie there | [`ContactZone`], [`SliceLayout`] | `contact_zone.rs` |
//! | flanks on slices that several meshes share | [`CondensedFlanks`] | `condensed_flanks.rs` |
//! | which stations along the tooth carry a slice's force | [`AxialSpread`] | `axial_spread.rs`, a gear's own slices: `placed_slice.rs` |
//! | which unit loads make a force at a place along the profile | [`ProfileHats`] | `profile_shares.rs` |
//! | what completes it under the contact itself | [`LocalContact`] | `local_contact.rs` |
//! | the same of a calibrated model | | `calibrated_field.rs` |
//! | what short slices pass to their neighbours of it | [`slice_spread`] | `slice_spread.rs` |
//! | bodies that deflect at their surfaces only, as Hertz has it | [`HalfSpaces`] | `half_spaces.rs` |
//! | which patches of an involute pair touch at a driver angle, and how far apart are they | [`ContactLines`] | `contact_lines.rs` |
//! | which part of a helical slice is on the path | [`slice_part::SlicePart`] | `slice_part.rs` |
//! | what is removed from the flanks | [`FlankDeviations`] | `flank_deviations.rs` |
//! | gears that stand beside their axes | [`Runout`] | `runout.rs` |
//! | where does a tip edge touch beyond the ends of the path | [`TipContact`] | `tip_contact.rs` |
//! | forces of patches at given gaps | [`SliceContact`] | `slice_contact.rs` |
//! | what drives them | [`Drive`] | `drive.rs` |
//! | a flank as a surface: points, normals, curvatures | [`FlankSurface`] | `flank_surface.rs` |
//! | which patches face each other at rest, of any family of flanks | [`FlanksAtRest`] | `flanks_at_rest.rs` |
//! | forces and transmission error at one position | [`StaticContact`] | `static_contact.rs` |
//! | why there are none | [`ContactError`] | `contact_error.rs` |
//! | deflection of one flank under a line load | [`flank_deflection`] | `flank_deflection.rs` |
//! | mesh stiffness over a mesh cycle | [`mesh_stiffness`] | `mesh_stiffness.rs` |
//! | how wide and under which pressure do two cylinders touch | [`hertz`] | `hertz.rs` |
//! | the complementarity problem itself, which knows no gear | [`nlcp`] | `nlcp.rs` |
//!
//! Cost of a static position with five slices and one or two pairs: some microseconds, without allocation.
//! The theory is in docs/theory/contact.md.

pub mod axial_spread;
pub mod bevel_slices;
pub mod bore_bending;
mod calibrated_field;
pub mod condensed_flanks;
mod contact_error;
pub mod contact_lines;
pub mod contact_patch;
pub mod contact_zone;
pub mod coupled_places;
pub mod crack_rows;
pub mod cross_compliance;
pub mod drive;
pub mod flank_deflection;
pub mod flank_deviations;
mod flank_slices;
pub mod flank_surface;
pub mod flanks_at_rest;
pub mod half_spaces;
pub mod hertz;
mod involute_at_rest;
pub mod joint_contact;
pub mod local_contact;
pub mod mesh_stiffness;
pub mod nlcp;
mod place_blocks;
pub mod placed_slice;
pub mod profile_shares;
pub mod runout;
pub mod slice_compliance;
pub mod slice_contact;
pub mod slice_part;
pub mod slice_spread;
pub mod static_contact;
pub mod station_blocks;
pub mod tip_contact;
mod walked_slice;

pub use axial_spread::AxialSpread;
pub use bore_bending::{BoreBending, BoreFlank};
pub use condensed_flanks::CondensedFlanks;
pub use contact_error::ContactError;
pub use contact_lines::{ContactLine, ContactLines, Friction};
pub use contact_patch::{ContactPatch, FlankPlace, PatchBalance, PatchEdge};
pub use contact_zone::{ContactZone, SliceLayout};
pub use cross_compliance::CrossCompliance;
pub use drive::Drive;
pub use flank_deviations::FlankDeviations;
pub use flank_slices::FlankSlices;
pub use flank_surface::{FlankSurface, InvoluteSurface, RelativeCurvature, SurfaceCurvature};
pub use flanks_at_rest::FlanksAtRest;
pub use half_spaces::HalfSpaces;
pub use involute_at_rest::InvoluteAtRest;
pub use joint_contact::{JointContact, MeshLink};
pub use local_contact::LocalContact;
pub use profile_shares::{ProfileHats, ProfilePlace};
pub use runout::{GearSeat, Placement, Runout};
pub use slice_compliance::SliceCompliance;
pub use slice_contact::SliceContact;
pub use static_contact::{ContactOptions, ContactState, StaticContact};
pub use tip_contact::{PathExtension, TipContact, TipGear};
pub use walked_slice::{SliceWalk, WalkedSlice};
