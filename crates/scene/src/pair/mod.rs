//! Scenes of one gear pair: static positions over a range of driver angles. `scene_file.rs` reads and checks,
//! `plan.rs` says what will be computed, `flank_effects.rs` makes errors and eccentricities of it, `run.rs` computes,
//! position by position (`all_positions.rs`, `position.rs`, `between_positions.rs`), `figures.rs` makes the figures of
//! a torque of it, `figure_table.rs` says how all doors show them, `contacts.rs` says where the teeth touch,
//! `coverage.rs` says how much of each period that sees, `result.rs` keeps, `result_record.rs` stores, `rating.rs`
//! judges, `bevel.rs` puts bevel pairs at rest, `bevel_result.rs` says what their results have besides,
//! `bevel_in_space.rs` where they stand for pictures, `warnings.rs` tells where the model's assumptions are strained.
//! `pair_load/` reads what a scene names.

mod all_positions;
mod between_positions;
pub mod bevel;
mod bevel_in_space;
pub mod bevel_result;
mod contact_places;
pub(crate) mod contacts;
mod coverage;
pub mod figure_table;
mod figures;
pub(crate) mod flank_effects;
pub mod plan;
mod position;
pub mod rating;
pub mod result;
mod result_record;
pub mod run;
pub mod scene_file;
pub mod warnings;

pub use between_positions::{BetweenPositions, PEAK_SHARE};
pub use bevel::{BevelScene, LoadedBevel};
pub use bevel_in_space::{BevelInSpace, BevelStand, BevelTeeth};
pub use contact_places::ContactPlaces;
pub use figures::{FigureErrors, PairFigures};
pub use plan::Plan;
pub use result::{LineForces, PairSolution, PairSource, SceneResult, StrainSeries};
pub use result_record::RESULT_FORMAT;
pub use run::{LoadedScene, PairWatch, RunError, demand_gears_that_fit, run, run_watched};
pub use scene_file::{PairGear, Scene};
