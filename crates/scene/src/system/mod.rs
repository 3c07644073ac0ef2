//! Scenes of multibody systems: bodies, joints, forces and gear meshes, each with its model; nothing else is computed.
//!
//! | step | type | file |
//! | --- | --- | --- |
//! | read and check the file | [`SystemScene`] | `scene.rs` |
//! | read the gears that it names | [`LoadedSystem`] | `assembly/gears.rs` |
//! | a multibody system with the names of its parts | [`BuiltSystem`] | `built.rs`, `assembly/` |
//! | a stage of gears at a glance | [`StageSummary`] | `stage_summary.rs`, `iso_stiffness.rs` |
//! | what will be computed | [`SystemPlan`] | `plan.rs` |

pub mod assembly;
pub mod built;
mod complaint;
mod iso_stiffness;
pub(crate) mod names;
mod other_run_kind;
pub mod plan;
pub mod planetary;
pub mod scene;
mod stage_summary;

pub use assembly::{
    BodyAtStart, GearState, GearsInMotion, LoadedSystem, MovingElements, MovingGear, MovingPart,
    MovingParts, MovingShape, PartKind, PartShape, SliceLoad, Variation,
};
pub(crate) use assembly::{STEPS_A_PERIOD, floored, line_of_centres_rad_per_s};
pub use built::{
    BuiltBody, BuiltGauge, BuiltMesh, BuiltPart, BuiltSystem, BuiltTogether, Effect, RatingJob,
    RatingRule,
};
pub use plan::SystemPlan;
pub(crate) use plan::step_in_words;
pub use scene::SystemScene;
pub use stage_summary::StageSummary;
