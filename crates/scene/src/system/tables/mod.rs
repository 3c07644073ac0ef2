//! The tables of a scene file: keys as written in the file, and their checks. One file per table.

pub mod bearing;
pub mod body;
pub mod connection;
pub mod flank_errors;
pub mod friction;
pub mod function;
pub mod gear_mesh;
pub mod joint;
pub mod load;
pub mod mesh_model;
pub mod output;
pub mod planet_pin;
pub mod planetary;
pub mod python_element;
pub mod run;
pub mod shaft;
pub mod solver;

/// A millimetre in metres.
pub(crate) const MM: f64 = 1e-3;
/// A micrometre in metres.
pub(crate) const UM: f64 = 1e-6;
