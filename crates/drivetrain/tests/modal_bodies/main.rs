//! Gear bodies with vibration modes under mesh forces.
//!
//! One program, so that its libraries are linked once.
#![allow(clippy::unwrap_used)]

#[path = "../mesh_common/mod.rs"]
mod mesh_common;

mod at_rest;
mod bevel;
mod friction;
mod in_time;
mod loads;
#[allow(dead_code)]
#[path = "../mesh_common/running_bevel.rs"]
mod running_bevel;
mod vibrating_pair;
