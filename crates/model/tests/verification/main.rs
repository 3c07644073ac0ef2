//! Model files: written, read, damaged, interrupted.
#![allow(clippy::unwrap_used)]

mod damaged_files;
mod definition_parts;
mod interrupted_writing;
#[path = "../../../../tests/support/made_up_models.rs"]
mod made_up_models;
mod reduced_gear_roundtrip;
