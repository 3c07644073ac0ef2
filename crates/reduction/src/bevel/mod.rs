//! The reduction of a bevel gear: one member of a pair, its flanks loaded over (u, v).
//!
//! Everything that knows no teeth is that of cylindrical gears: repetition, compliance, identities, dynamics. Own are the loads
//! (`loads.rs`), gauges (`gauge.rs`), the near field (`near_field.rs`) and the assembly of the model (`reduce.rs`).
//! docs/theory/bevel_gears.md has the derivation.

pub mod gauge;
pub mod loads;
pub mod near_field;
pub mod reduce;

pub use reduce::{bevel_body, bevel_body_of, bevel_model, reduce_bevel};
