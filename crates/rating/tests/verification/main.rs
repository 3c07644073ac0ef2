//! Verification of the rating against closed forms and published tables. One binary, so that it links once.

#![allow(clippy::unwrap_used)]

mod bending;
mod cycles;
mod fatigue;
mod helical;
mod pressure;
mod teeth;
