//! Parameter studies: one scene, computed again and again with some of its keys changed.
//!
//! | question | answer | file |
//! | --- | --- | --- |
//! | what the file says | [`Study`] | `study_file.rs` |
//! | which values make which cases | [`Design`], [`Case`] | `design.rs`, `scatter.rs` |
//! | the scene of a case | [`BaseScene`] | `varied_scene.rs` |
//! | cases, their results and figures | [`run_study`] | `cases.rs`, `system_cases.rs`, `pair_cases.rs` |
//! | cases for other machines, and the table of what they gave | [`StudyCases`], [`CaseRunner`], [`gather_study`] | `elsewhere.rs` |
//! | which figures a gear pair has | [`PairColumn`] | `pair_columns.rs` |
//! | what is written | `study.csv` | `table.rs` |
//!
//! The result of a case is named by a digest of all that it depends on: a study that is broken off goes on where it
//! was, and one that gets a further value computes that value only. Models are read once, and a gear is reduced again
//! only where a key of its body varies, once for each value.

mod cases;
mod design;
mod elsewhere;
mod pair_cases;
mod pair_columns;
mod scatter;
mod study_file;
mod system_cases;
mod table;
mod varied_scene;

pub use cases::{
    CaseResult, Selected, SelectedValue, StudyError, StudyOptions, StudyOutcome, StudyScenes,
    run_study,
};
pub use design::{Case, Design, Setting};
pub(crate) use design::{probabilities, seeded};
pub use elsewhere::{CaseRunner, SentCase, StudyCases, gather_study};
pub use pair_cases::{PairCases, PairFigures};
pub use pair_columns::PairColumn;
pub(crate) use pair_columns::{columns, names as column_names, place as column_place};
pub use scatter::{NormalTable, SpacedTable, UniformTable};
pub use study_file::{ParameterTable, Study, StudyTables};
pub use varied_scene::{BaseScene, MadeFile, MadeFiles, VaryError};
