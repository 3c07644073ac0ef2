//! Bevel gears: blank, flanks, contact.
#![allow(clippy::unwrap_used, clippy::expect_used)] // test code

mod bare_points;
mod blanks;
mod brute_force;
mod common;
mod contacts;
mod flanks;
mod patches;
mod points;
mod thickness;
