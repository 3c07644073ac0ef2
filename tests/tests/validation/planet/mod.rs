//! A planetary set in plane strain against independent solutions: a planet alone, in the ring, and the whole set. One
//! module, so that its tests run in one process and each gear is reduced once.

mod bore;
mod gears;
mod in_ring;
mod on_rollers;
mod set;
