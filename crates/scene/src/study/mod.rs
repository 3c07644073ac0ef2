//! Parameter studies: one scene, bevel pair or bearing, computed again and again with some of its keys changed.
//!
//! | question | answer | file |
//! | --- | --- | --- |
//! | what is computed | [`Subject`] | `subject.rs` |
//! | the scene of a case | [`BaseScene`] | `varied_scene.rs`, `changed_file.rs` |
//! | cases, their results and figures | [`run_study`] | `cases.rs`, `system_cases.rs`, `rest_cases.rs` |
//! | which figures there are | [`RestColumn`], [`Wanted`] | `pair_columns.rs`, `rest_columns.rs`, `loaded_columns.rs`, `figure.rs` |
//! | cases for other machines, and the table of what they gave | [`StudyCases`], [`CaseRunner`], [`gather_study`] | `elsewhere.rs` |
//! | what is written | `study.csv` | `table.rs` |
//!
//! The result of a case is named by a digest of all that it depends on: a study that is broken off goes on where it
//! was, and one that gets a further value computes that value only. Models are read once, and a gear is reduced again
//! only where a key of its body varies, once for each value.

mod cases;
mod changed_file;
mod elsewhere;
mod evaluate;
mod figure;
mod loaded_columns;
mod pair_columns;
mod rest_cases;
mod rest_columns;
mod subject;
mod system_cases;
mod table;
mod varied_scene;

pub use cases::{
    CaseResult, Selected, SelectedValue, StudyError, StudyOptions, StudyOutcome, StudyScenes,
    run_study,
};
pub(crate) use cases::{known_columns, make_files};
pub use elsewhere::{CaseRunner, SentCase, StudyCases, gather_study};
pub use evaluate::{Effort, Scratch};
pub(crate) use evaluate::{Evaluated, evaluate, number};
pub use figure::{Figure, FigureKinds, Wanted};
pub(crate) use loaded_columns::is_without_load;
pub use pair_columns::{PairColumns, RestColumn};
pub use rest_cases::{RestCases, RestFigures};
pub use subject::{BearingSubject, SeriesOver, Subject};
pub(crate) use system_cases::{SteadyMesh, result_size, steady_meshes};
pub use varied_scene::{BaseScene, MadeFile, MadeFiles, VaryError};
