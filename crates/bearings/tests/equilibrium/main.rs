//! Equilibrium of bearings against independent solutions (tools/reference/bearings.py), their tangents, their lives,
//! and bad files.
#![allow(clippy::unwrap_used, clippy::expect_used)] // test code

mod ball_types;
mod barrels;
mod catalogue;
mod common;
mod dropped_balls;
mod files;
mod fits;
mod friction;
mod hard_cases;
mod hertz;
mod independent;
mod lives;
mod missing;
mod published;
mod random_bearings;
mod rests;
mod stress_risers;
mod tangents;
mod warnings;
