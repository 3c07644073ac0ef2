//! Teeth, blanks and gear files against closed forms and other constructions.
#![allow(clippy::unwrap_used, missing_docs)]

mod contour_elements;
mod crack;
mod gears;
mod helical;
mod modes_and_hub;
mod plane_strain;
#[path = "../../../../tests/support/property_cases.rs"]
mod property_cases;
mod rings;
