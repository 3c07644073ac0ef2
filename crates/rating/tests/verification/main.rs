//! Verification of the rating against closed forms and published tables. One binary, so that it links once.

#![allow(clippy::unwrap_used, clippy::print_stdout)]

mod bending;
mod cycles;
mod fatigue;
mod helical;
mod iso_nominal;
mod pressure;
mod teeth;
