//! Gear bodies with vibration modes under mesh forces.
//!
//! One program, so that its libraries are linked once.
#![allow(clippy::unwrap_used)]

#[path = "../mesh_common/mod.rs"]
mod mesh_common;

mod at_rest;
mod friction;
mod in_time;
mod loads;
mod vibrating_pair;
