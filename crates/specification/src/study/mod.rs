//! The file of a study: what varies, which values make which cases.
//!
//! | question | answer | file |
//! | --- | --- | --- |
//! | what the file says | [`Study`] | `study_file.rs` |
//! | which values make which cases | [`Design`], [`Case`] | `design.rs`, `scatter.rs`, `varied_once.rs` |
//! | what a bearing by itself carries | [`BearingOperation`] | `bearing_operation.rs` |

mod bearing_operation;
mod design;
mod scatter;
mod study_file;
mod varied_once;

pub use bearing_operation::{BearingOperation, OperationTable};
pub use design::{Case, Design, Setting, probabilities, seeded};
pub use scatter::{NormalTable, SpacedTable, UniformTable};
pub use study_file::{ParameterTable, Study, StudyTables};
pub use varied_once::demand_each_once;
