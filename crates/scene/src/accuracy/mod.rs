//! What accuracy costs in time, for a scene of the user's own: every knob that the scene has, one at a time and together,
//! against a reference with all of them at the top.
//!
//! | question | answer | file |
//! | --- | --- | --- |
//! | which knobs a scene has, and their rungs | [`Knob`] | `knobs.rs` |
//! | what a setting gives, and how long it takes | [`Bench`] | `bench.rs` |
//! | which settings are tried, and which one to take | [`accuracy`] | `ladder.rs` |
//!
//! Errors are those against the reference of the same program: what no knob of the scene changes (its gears' meshes and models, its
//! loads) is in none of them.

mod bench;
mod knobs;
mod ladder;

pub use bench::{Bench, Wanted};
pub use knobs::{Knob, Rung};
pub use ladder::{Accuracy, Advice, Goal, Tried, accuracy, words};
