//! `gearmesh schema`: what may stand in a file, as JSON Schema for editors and scripts.

use crate::arguments::{SchemaArguments, SchemaKind};
use crate::console;
use crate::failure::Failure;

/// Runs the command.
pub fn run(arguments: &SchemaArguments) -> Result<(), Failure> {
    let schema = match arguments.kind {
        SchemaKind::Scene => gearmesh_scene::schema::scene(),
        SchemaKind::Study => gearmesh_scene::schema::study(),
        SchemaKind::Gear => gearmesh_geometry::gear_file::schema(),
    };
    console::json(schema.as_value());
    Ok(())
}
