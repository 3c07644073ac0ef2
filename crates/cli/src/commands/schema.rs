//! `gearmesh schema`: what may be in a file, as JSON Schema for editors and scripts; of HDF5 files the data sets.

use gearmesh_model::{ListedField, ReducedGear, list_record};
use gearmesh_scene::pair::SceneResult;
use gearmesh_scene::system_run::SystemResult;
use serde_json::Value;

use super::{data_set_page, schema_page};
use crate::arguments::{SchemaArguments, SchemaKind};
use crate::console;
use gearmesh_operations::Failure;

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
    let (contents, kind) = match arguments.kind {
        SchemaKind::Scene => (Keys(gearmesh_scene::schema::scene().to_value()), "scene"),
        SchemaKind::Study => (Keys(gearmesh_scene::schema::study().to_value()), "study"),
        SchemaKind::Optimise => (
            Keys(gearmesh_scene::schema::optimise().to_value()),
            "optimise",
        ),
        SchemaKind::Bearing => (
            Keys(gearmesh_bearings::bearing_file::schema().to_value()),
            "bearing",
        ),
        SchemaKind::Bevel => (
            Keys(gearmesh_bevel::pair_file::schema().to_value()),
            "bevel",
        ),
        SchemaKind::BevelGear => (
            Keys(gearmesh_bevel::gear_file::gear_schema().to_value()),
            "bevel-gear",
        ),
        SchemaKind::Gear => (
            Keys(gearmesh_geometry::gear_file::schema().to_value()),
            "gear",
        ),
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
