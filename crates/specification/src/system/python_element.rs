//! `[[python_element]]`: a force between two bodies that a Python function computes.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// `[[python_element]]`: a force element for prototypes, run from Python only (docs/python.md). Its function gets the
/// motion of body 2 as seen from body 1 and gives force and moment on body 2, axes of the marker of body 1.
#[derive(Debug, Clone, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PythonElementTable {
    /// Name.
    pub name: String,
    /// Name of the function, as given to gearmesh.Scene.
    pub function: String,
    /// First body; "ground" where not given.
    pub body_1: Option<String>,
    /// Second body.
    pub body_2: String,
    /// Where, in the world at the start; the origin of `body_2` where not given.
    pub at_mm: Option<[f64; 3]>,
    /// The marker's z axis in the world at the start; the axes of `body_2` where not given.
    pub axis: Option<[f64; 3]>,
}
