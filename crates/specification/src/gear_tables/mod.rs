//! Tables of gears and their teeth that scenes of both kinds have: pairs and multibody systems.

pub mod flank_errors;
pub mod friction;
pub mod path_word;
pub mod seat;

/// A millimetre in metres.
pub const MM: f64 = 1e-3;
/// A micrometre in metres.
pub const UM: f64 = 1e-6;
