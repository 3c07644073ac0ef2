//! One file per command.

pub mod bearing;
pub mod bearing_frequencies;
pub mod bevel;
pub mod check;
pub mod compare;
pub mod compliance;
mod data_set_page;
pub mod demo;
pub mod export;
pub mod mesh;
pub mod mesh_axes;
pub mod modes;
pub mod periods;
pub mod plan;
pub mod ratings;
pub mod recover;
pub mod reduce;
pub mod report;
pub mod run;
pub mod run_system;
pub mod schema;
mod schema_page;
pub mod signal;
pub mod stress_picture;
pub mod study;
pub mod system_table;
pub mod tca;
