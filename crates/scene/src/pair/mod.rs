//! Scenes of one gear pair: static positions over a range of driver angles. `scene_file.rs` reads and checks, `plan.rs`
//! says what will be computed, `run.rs` computes, `coverage.rs` says how much of each period that sees, `result.rs`
//! keeps and stores, `rating.rs` judges, `warnings.rs` tells where the model's assumptions are strained.

mod contact_places;
mod coverage;
pub mod plan;
pub mod rating;
pub mod result;
pub mod run;
pub mod scene_file;
pub mod warnings;

pub use contact_places::ContactPlaces;
pub use plan::Plan;
pub use result::{RESULT_FORMAT, SceneResult, StrainSeries};
pub use run::{LoadedScene, RunError, load, run};
pub use scene_file::Scene;
