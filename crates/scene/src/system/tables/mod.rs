//! The tables of a scene file: keys as written in the file, and their checks. One file per table; those that
//! pairs have, too, are in `gear_tables/`.

pub mod bearing;
pub mod body;
pub mod connection;
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

pub(crate) use crate::gear_tables::{MM, UM};
pub use crate::gear_tables::{flank_errors, friction};
