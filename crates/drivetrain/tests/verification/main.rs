//! Gears and meshes as parts of a system: conformance of all mesh models, motion, effort.
#![allow(clippy::print_stdout, clippy::unwrap_used)]

mod conformance;
mod coupled_meshes;
mod effort;
mod gear_body;
mod gears_on_rollers;
mod helical;
mod internal_pairs;
mod kinematics;
#[path = "../mesh_common/mod.rs"]
mod mesh_common;
mod modal_bodies;
mod pairs_in_time;
#[path = "../../../../tests/support/property_cases.rs"]
mod property_cases;
#[path = "../mesh_common/running_bevel.rs"]
mod running_bevel;
mod static_scene;
mod strain_gauges;
mod two_gears;
