//! Helical meshes: where slices stand and how that changes, and what pushes.
//!
//! One program, so that its libraries are linked once.
#![allow(clippy::unwrap_used, clippy::print_stdout)] // the figures are printed

mod forces;
mod kinematics;
