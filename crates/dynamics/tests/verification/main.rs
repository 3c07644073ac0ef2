//! Systems of rigid bodies in time, in equilibrium and vibrating.
#![allow(clippy::print_stdout, clippy::unwrap_used)]

mod hard_joints;
mod hard_many_bodies;
mod hard_masses;
mod hard_steps;
mod mechanisms;
#[path = "../../../../tests/support/property_cases.rs"]
mod property_cases;
mod rigid_body;
mod statics;
mod vibration;
