//! Parameter studies: one multibody scene, run again and again with some of its keys changed.
//!
//! | question | answer | file |
//! | --- | --- | --- |
//! | which keys take which values | [`Study`] | `study_file.rs` |
//! | the scene of a case | [`varied`] | `varied_scene.rs` |
//! | cases, their results and figures | [`run_study`] | `cases.rs` |
//!
//! The result of a case is named by a digest of all that it depends on: a study that is broken off goes on where it
//! was, and one that gets a further value computes that value only.

mod cases;
mod study_file;
mod varied_scene;

pub use cases::{CaseResult, Selected, StudyError, StudyOutcome, StudyScenes, run_study};
pub use study_file::{Case, Design, ParameterTable, Setting, Study, StudyTables};
pub use varied_scene::varied;
