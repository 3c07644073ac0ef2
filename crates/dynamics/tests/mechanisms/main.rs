//! Mechanisms with loops: Andrews' squeezing mechanism, five bars that pass through their straight position. One program, so that its
//! libraries are linked once.
#![allow(clippy::unwrap_used)] // test code

mod andrews;
mod five_bars;
mod own_coordinates;
mod sparse;

#[path = "../problems"]
mod problems {
    pub mod andrews;
    pub mod chain;
    pub mod maxwell;
}
