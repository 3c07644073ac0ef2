//! Verification of the reduction on small gears. One binary, so that it links once and long tests run beside each
//! other.
#![allow(clippy::print_stdout, clippy::unwrap_used, missing_docs)]

mod bevel_bodies;
mod bevel_gauges;
mod bevel_gears;
mod bevel_webs;
mod bore_patterns;
#[path = "../../../../tests/support/computed.rs"]
mod computed;
mod cut_into_shaft;
mod cut_with_stubs;
mod cyclic_symmetry;
mod free_gear;
mod hard_bodies;
mod helical;
mod hub_patterns;
mod imported_mesh;
mod natural_modes;
mod near_field;
#[path = "../../../../tests/support/pinion_with_stubs.rs"]
mod pinion_with_stubs;
mod projection;
mod random_blanks;
mod reduction;
mod rings;
mod root_crack;
mod small_gears;
mod tetrahedra;
#[path = "../../../../tests/support/whole_compliance.rs"]
mod whole_compliance;
