//! Meshes of gear bodies.
#![allow(clippy::print_stdout, clippy::unwrap_used, missing_docs)]

mod bevel_gears;
mod contour;
mod gears;
mod helical;
#[path = "../../../../tests/support/property_cases.rs"]
mod property_cases;
