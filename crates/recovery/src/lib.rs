#![doc = include_str!("../README.md")]
//!
//! # Where things are
//!
//! Strain at gauges from slice forces, without any displacement field: one row of numbers per gauge.
//!
//! Method 1 of *Transmission Error and Strain Analysis of Lightweight Gears* (seed 004 in docs/sources.md) superposes
//! the deformation patterns, ε₁ = gᵀΨ f, and knows normal forces only. Method 2 puts the true loads on the finite
//! element model, ε₂ = (K⁻¹g)ᵀ F_FE, friction included. Without friction they differ by gᵀW f, the strain that the
//! tooth-only submodel's local field leaves at the gauge (docs/theory/recovery.md).

mod gauge_reader;
mod grid_forces;
#[cfg(test)]
#[path = "../../../tests/support/made_up_models.rs"]
mod made_up_models;

pub use gauge_reader::{GaugeArray, GaugeReader, LoadedSlice, Strain};
pub use grid_forces::{GridLoadForce, PlacedForce, grid_forces, placed_forces};
