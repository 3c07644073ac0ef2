//! What accuracy costs in time, for a scene of the user's own: every knob that the scene has, one at a time and
//! together, against a reference with all of them at the top.
//!
//! | question | answer | file |
//! | --- | --- | --- |
//! | which knobs a scene has, and their rungs | [`Knob`] | `knobs.rs`, `system_knobs.rs`, `element_knob.rs` |
//! | which effects it has, or could have | [`Effect`] | `effects.rs` |
//! | what a setting gives, and what it takes | [`Bench`] | `bench.rs` |
//! | which settings are tried, and which one to take | [`accuracy`] | `ladder.rs` |
//! | how far the reference itself may be off, chaotic runs | [`Accuracy::doubts`] | `doubt.rs` |
//! | the setting for a goal, by a few runs | [`choose`] | `chosen.rs`, `fronts.rs` |
//! | errors of columns | | `column_errors.rs` |
//! | what is judged where nothing is named | | `default_columns.rs` |
//! | the lines to paste | | `paste.rs` |
//!
//! Errors are those against the reference of the same program: what no knob of the scene changes (its shafts, its
//! loads) is in none of them.

mod bench;
mod chosen;
mod column_errors;
mod default_columns;
mod doubt;
mod effects;
mod element_knob;
mod fronts;
mod knobs;
mod ladder;
mod paste;
mod system_knobs;

pub use bench::{Bench, BenchOptions, JudgedTime, Measured, Reduce};
pub use chosen::{Chosen, choose};
pub use effects::Effect;
pub use knobs::{Knob, Rung};
pub use ladder::{Accuracy, Advice, EffectFound, Goal, Tried, accuracy, words};
