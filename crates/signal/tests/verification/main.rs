//! Verification of the signal processing against closed forms. One binary, so that it links once.

#![allow(clippy::unwrap_used)]

mod campbell_map;
mod modulation;
mod resampling;
mod spectra;
mod test_signals;
mod unequal_teeth;
