//! `pair.misalignment_from`: the result from which the axes of a pair are taken, by `pair_load/taken_axes.rs`.

use std::path::PathBuf;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// `misalignment_from`.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MisalignmentFrom {
    /// Result of a `static` run, relative to the scene.
    pub result: PathBuf,
    /// Name of the gear mesh in it.
    pub mesh: String,
    /// Which equilibrium, from 0; the last where not given.
    pub point: Option<usize>,
}
