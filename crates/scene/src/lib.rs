#![doc = include_str!("../README.md")]
//!
//! # Where things are
//!
//! From a scene file to a result: which models, which effects, which loads; nothing else is computed.
//!
//! | scene | how it is stated | module |
//! | --- | --- | --- |
//! | one gear pair, static positions over driver angles | `[pair]` | [`pair`] |
//! | a bevel pair under torques | `[bevel]` and `[load]` | [`pair`] |
//! | a multibody system | `[[body]]` | [`system`] |
//!
//! [`periods`] says how much of what repeats a run has seen, [`rating`] judges what both have given. [`SceneFile`]
//! tells them apart, [`ResultFile`] their results; what may be in a file stands in `gearmesh_specification`.
//! [`system_run`] runs multibody systems, [`study`] computes a scene again and again with keys that vary, [`optimise`]
//! seeks the best of them, [`accuracy`] says what exactness costs in time.

pub mod accuracy;
mod megabytes;
mod microgeometry_words;
mod model_shelf;
mod named_files;
pub mod optimise;
pub mod pair;
mod pair_load;
pub mod periods;
pub mod rating;
mod result_file;
pub mod scene_file;
pub mod study;
pub mod system;
pub mod system_run;

pub use model_shelf::{CondensedPairs, ModelShelf, ShelvedModel};
pub use named_files::{named_files, named_files_and_theirs, renamed_files};
pub use pair::{
    ContactPlaces, LoadedScene, Plan, RESULT_FORMAT, RunError, Scene, SceneResult, StrainSeries,
    run,
};
pub use pair_load::{load, load_from};
pub use result_file::ResultFile;
pub use scene_file::{InputKind, SceneFile};
