//! The reduction of a bevel gear: one member of a pair, its flanks loaded over (u, v).
//!
//! Everything that knows no teeth is that of cylindrical gears: repetition, compliance, identities, dynamics. Own are
//! the finite elements (`body.rs`), loads (`loads.rs`), gauges (`gauge.rs`), the near field (`near_field.rs`), the
//! coarser meshes of the error estimate (`coarser_meshes.rs`) and the assembly of the model (`reduce.rs`).
//! docs/theory/bevel_gears.md has the derivation.

pub mod body;
mod coarser_meshes;
pub mod gauge;
pub mod loads;
pub mod near_field;
pub mod reduce;

pub use body::{bevel_body, bevel_body_of, bevel_model};
pub use reduce::reduce_bevel;
