//! Verification of the tables: names, drawn numbers, cases. One binary, so that it links once.

#![allow(clippy::unwrap_used)]

mod design;
mod names;
mod scatter;
mod study_file;
