//! Bearings whose balls are bodies: derivatives, blows, agreement with the equilibrium, cages, skidding.
#![allow(clippy::print_stdout)]
#![allow(clippy::unwrap_used, clippy::expect_used)] // test code

mod blows;
mod cages;
#[allow(dead_code)] // shared with the equilibrium's tests
#[path = "../equilibrium/common.rs"]
mod common;
mod equilibria;
mod faults;
mod hard_cases;
mod quasi_static_element;
mod rig;
mod skidding;
mod tangents;
mod triangles;
