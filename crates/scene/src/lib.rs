//! From a scene file to a result: which models, which effects, which loads; nothing else is computed.
//!
//! [`pair`]: scenes of one gear pair, static positions over a range of driver angles.

pub mod pair;

pub use pair::{
    LoadedScene, Plan, RESULT_FORMAT, RunError, Scene, SceneResult, StrainSeries, load, run,
};
