//! The mesh models, cheapest first; what they have in common is in `teeth_model.rs`.

pub mod analytic;
pub mod hybrid;
pub mod impact;
pub mod iso6336;
pub mod kinematic;
pub mod teeth_model;
