//! JSON Schema of scene files and study files.

use gearmesh_geometry::input::file_schema;
use schemars::{JsonSchema, Schema};

use crate::optimise::OptimiseTables;
use crate::pair::PairTables;
use crate::study::StudyTables;
use crate::system::SystemTables;

/// A scene file of either kind.
#[derive(JsonSchema)]
#[schemars(untagged, title = "gearmesh scene")]
#[allow(dead_code)]
enum SceneTables {
    /// One gear pair, static positions over driver angles.
    Pair(Box<PairTables>),
    /// A multibody system.
    System(Box<SystemTables>),
}

/// JSON Schema (draft 2020-12) of scene files: of a pair, or of a multibody system. What depends on other keys, such as
/// the keys of one mesh model, is said in the descriptions and checked when the scene is read.
pub fn scene() -> Schema {
    file_schema::<SceneTables>()
}

/// JSON Schema of files for optimisations.
pub fn optimise() -> Schema {
    file_schema::<OptimiseTables>()
}

/// JSON Schema of study files.
pub fn study() -> Schema {
    file_schema::<StudyTables>()
}
