//! Mechanisms with loops: Andrews' squeezing mechanism, five bars that pass through their straight position; chains; any free system. One program, so that its
//! libraries are linked once.
#![allow(clippy::unwrap_used)] // test code

mod andrews;
mod five_bars;
#[path = "../../../../tests/support/property_cases.rs"]
mod property_cases;
mod random_systems;
mod sparse;

#[path = "../problems"]
mod problems {
    pub mod andrews;
    pub mod chain;
}
