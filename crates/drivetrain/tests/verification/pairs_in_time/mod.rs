//! Gear pairs in time: hard cases, what must be conserved, resonance with backlash, parametric instability, a cracked
//! tooth, seed 003.
//!
//! One program, so that its libraries are linked once.
#![allow(clippy::unwrap_used, clippy::print_stdout)] // the figures are printed

mod conservation;
mod hard_cases;
mod hard_friction;
mod hard_impacts;
mod hard_resonance;
mod helical;
mod instability;
mod newton;
mod overloaded_flanks;
mod root_crack;
mod scene;
mod seed_003;
