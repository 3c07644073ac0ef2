//! `gearmesh schema`: what may be in a file, as JSON Schema for editors and scripts; of HDF5 files the data sets.

use gearmesh_model::{ListedField, ReducedGear, list_record};
use gearmesh_scene::pair::SceneResult;
use gearmesh_scene::system_run::SystemResult;
use serde_json::Value;

use super::{data_set_page, schema_page};
use crate::arguments::{SchemaArguments, SchemaKind};
use crate::console;
use gearmesh_operations::Failure;
use gearmesh_operations::schema::{TextKind, schema};

/// What is known of a kind of file.
enum Contents {
    /// Keys of a text file.
    Keys(Value),
    /// Data sets of an HDF5 file.
    DataSets(Vec<ListedField>),
}

/// Runs the command.
pub fn run(arguments: &SchemaArguments) -> Result<(), Failure> {
    use Contents::{DataSets, Keys};
    let keys = |kind| Keys(schema(kind));
    let (contents, kind) = match arguments.kind {
        SchemaKind::Scene => (keys(TextKind::Scene), "scene"),
        SchemaKind::Study => (keys(TextKind::Study), "study"),
        SchemaKind::Optimise => (keys(TextKind::Optimise), "optimise"),
        SchemaKind::Bearing => (keys(TextKind::Bearing), "bearing"),
        SchemaKind::Bevel => (keys(TextKind::Bevel), "bevel"),
        SchemaKind::BevelGear => (keys(TextKind::BevelGear), "bevel-gear"),
        SchemaKind::Gear => (keys(TextKind::Gear), "gear"),
        SchemaKind::Model => (DataSets(list_record::<ReducedGear>()), "model"),
        SchemaKind::PairResult => (DataSets(list_record::<SceneResult>()), "pair-result"),
        SchemaKind::SystemResult => (DataSets(SystemResult::data_sets()), "system-result"),
    };
    match (contents, arguments.markdown) {
        (Keys(schema), true) => {
            console::data(schema_page::page(&schema, kind).trim_end());
        }
        (Keys(schema), false) => console::json(&schema),
        (DataSets(list), true) => console::data(data_set_page::page(&list, kind).trim_end()),
        (DataSets(list), false) => console::json(&data_set_page::json(&list)),
    }
    Ok(())
}
