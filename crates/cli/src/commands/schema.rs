//! `gearmesh schema`: what may stand in a file, as JSON Schema for editors and scripts.

use super::schema_page;
use crate::arguments::{SchemaArguments, SchemaKind};
use crate::console;
use crate::failure::Failure;

/// Runs the command.
pub fn run(arguments: &SchemaArguments) -> Result<(), Failure> {
    let (schema, kind) = match arguments.kind {
        SchemaKind::Scene => (gearmesh_scene::schema::scene(), "scene"),
        SchemaKind::Study => (gearmesh_scene::schema::study(), "study"),
        SchemaKind::Bearing => (gearmesh_bearings::bearing_file::schema(), "bearing"),
        SchemaKind::Bevel => (gearmesh_bevel::pair_file::schema(), "bevel"),
        SchemaKind::Gear => (gearmesh_geometry::gear_file::schema(), "gear"),
    };
    if arguments.markdown {
        console::data(schema_page::page(schema.as_value(), kind).trim_end());
    } else {
        console::json(schema.as_value());
    }
    Ok(())
}
