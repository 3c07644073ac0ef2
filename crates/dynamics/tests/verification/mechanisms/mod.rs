//! Mechanisms with loops: Andrews' squeezing mechanism, five bars that pass through their straight position; chains;
//! force elements with coordinates of their own, and such whose model ends somewhere; any free system. One program, so
//! that its libraries are linked once.
#![allow(clippy::unwrap_used)] // test code

mod andrews;
mod beads;
mod five_bars;
mod friction;
mod host_elements;
mod output_columns;
mod own_coordinates;
mod random_systems;
mod sparse;
mod strayed_iterates;

#[path = "../../problems"]
pub mod problems {
    pub mod andrews;
    pub mod chain;
    pub mod distance_sensor;
    pub mod maxwell;
}
