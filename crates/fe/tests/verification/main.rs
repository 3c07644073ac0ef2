//! Finite elements against closed forms, other methods and identities.
#![allow(clippy::print_stdout, clippy::unwrap_used, missing_docs)]

mod annular_plate;
mod cantilever;
#[path = "../common/mod.rs"]
mod common;
mod convergence;
mod cyclic;
mod edge_crack;
mod elements;
mod factorisation;
mod mass;
mod modes;
mod patch_test;
mod rigid_groups;
mod rigid_motions;
#[path = "../../../../tests/support/whole_compliance.rs"]
mod whole_compliance;
