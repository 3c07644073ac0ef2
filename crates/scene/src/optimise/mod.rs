//! Optimisation of a gear pair, or of what else a study computes: keys of its scene that make its objectives least,
//! under scatter of manufacture and mounting; of several objectives the Pareto front.
//!
//! | question | answer | file |
//! | --- | --- | --- |
//! | what a choice of the variables is worth | [`Evaluator`] | `evaluator.rs` |
//! | which choices are tried | [`optimise`] | `search.rs` |
//! | which of them no other one beats | [`front`] | `pareto.rs` |
//!
//! The search is that of the crate argmin: a particle swarm over the whole of the bounds, then Nelder and Mead's
//! simplex from its best. Both ask for no derivatives, which peak-to-peak values and pressures do not have everywhere.

mod evaluator;
mod pareto;
mod search;

pub use evaluator::{Evaluator, Trial};
pub use pareto::front;
pub use search::{Optimum, optimise};
