//! Model files: written, read, damaged, interrupted.
#![allow(clippy::unwrap_used)]

mod damaged_files;
mod definition_parts;
mod interrupted_writing;
mod reduced_gear_roundtrip;
