#![doc = include_str!("../README.md")]
//!
//! # Where things are
//!
//! Each operation is a function of its own module: a request and a [`Watch`] in, a typed result out. Results say their
//! figures for other programs as JSON; what people read is made of them by the doors.
//!
//! | operation | module |
//! | --- | --- |
//! | reduce a gear of either family | [`reduce`] |
//! | mesh it, find its modes, load a tooth | [`mesh`], [`modes`], [`compliance`] |
//! | strain of gauges, a whole field | [`recover`] |
//! | a page, a comparison, files of other programs | [`report`], [`compare`], [`export`] |
//! | the stress of a bevel pair's bodies | [`bevel_stress`] |
//! | a scene, a pair of either family included, to its result | [`run`] |
//!
//! [`stressed_gear`] is a gear's body under forces, [`tooth_stress`] and [`result_stress`] are the pictures of it.

pub mod accuracy;
mod answer;
pub mod bevel_pair;
pub mod bevel_stress;
pub mod by_name;
pub mod changed_pair;
pub mod check;
pub mod compare;
pub mod compliance;
pub mod cross_section;
pub mod export;
mod failure;
pub mod file_words;
pub mod gear_file;
pub mod import;
pub mod import_trial;
pub mod losses;
pub mod memory;
pub mod mesh;
mod mesh_axes;
pub mod mesh_file;
pub mod modes;
mod moving_modes;
mod moving_parts;
mod moving_system;
pub mod new_files;
mod one_or_many;
pub mod optimise;
pub mod output_name;
pub mod overwriting;
pub mod page_file;
mod pair_table;
pub mod periods;
pub mod plan;
mod projected_compliance;
mod ratings;
pub mod recover;
pub mod reduce;
pub mod report;
mod result_scene;
pub mod result_stress;
pub mod run;
pub mod run_within;
pub mod schema;
mod scratch;
mod sets;
mod stages;
pub mod stressed_gear;
pub mod study;
mod system_figures;
pub mod system_moments;
mod system_table;
pub mod tca;
mod tca_page;
mod tca_sides;
pub mod templates;
pub mod tooth_stress;
pub mod uff;
mod watch;

pub use answer::Answer;
pub use failure::{Cause, Failure, Fault, Result};
pub use moving_modes::MovingModes;
pub use moving_system::moving_system;
pub use scratch::Scratch;
pub use watch::{Listener, Silent, Task, Watch};
