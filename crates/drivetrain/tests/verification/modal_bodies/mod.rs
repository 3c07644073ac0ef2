//! Gear bodies with vibration modes under mesh forces.
//!
//! One program, so that its libraries are linked once.

mod at_rest;
mod bevel;
mod friction;
mod in_time;
mod loads;
#[allow(dead_code)]
mod vibrating_pair;
