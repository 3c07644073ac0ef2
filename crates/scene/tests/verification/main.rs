//! Scenes of all kinds: read, refused, run, studied, rated.
#![allow(
    clippy::expect_used,
    clippy::print_stdout,
    clippy::unwrap_used,
    missing_docs
)]

mod accuracy;
mod bad_scenes;
mod bearing_kinds;
mod bearings_of_seeds;
mod bevel_at_rest;
mod bevel_hard_cases;
mod bevel_hard_slices;
mod bevel_in_space;
mod bevel_machines;
mod bevel_pairs;
#[path = "../common/mod.rs"]
mod common;
#[path = "../made_up_pinion/core_of_a_beam.rs"]
mod core_of_a_beam;
mod dynamic_bearings;
mod epicyclic;
mod event_positions;
mod flanks_of_scenes;
mod gearbox;
mod golden_files;
mod harris_law;
mod helical_pair;
mod lost_meshes;
#[path = "../made_up_gears/mod.rs"]
mod made_up_gears;
mod modal_scene;
mod node_surface;
mod optimisations_of_all_kinds;
mod other_run_kinds;
mod pair_stiffness;
mod pair_study;
mod pairs_at_rest;
mod planetary;
mod power_losses;
#[path = "../../../../tests/support/property_cases.rs"]
mod property_cases;
mod provenance;
mod random_bevel_pairs;
mod rating;
mod ring_pairs;
mod rolling_bearings;
mod run_out;
mod run_statistics;
mod schema;
mod shafts;
mod shipped;
mod speed_sweep;
mod stages;
mod start;
mod static_pairs;
mod studies_of_all_kinds;
mod study;
mod system_run;
#[path = "../system_runs/mod.rs"]
mod system_runs;
mod tables;
mod taken_misalignment;
mod tilted_shafts;
mod tooth_pairs;
mod two_stage_train;
mod without_a_file;

use gearmesh_scene::system::BuiltSystem;

pub fn body<'a>(built: &'a BuiltSystem, name: &str) -> &'a gearmesh_dynamics::Body {
    built
        .system
        .bodies()
        .iter()
        .find(|body| body.name == name)
        .unwrap()
}

pub fn spin(built: &BuiltSystem, name: &str) -> f64 {
    body(built, name).angular_velocity_rad_per_s.z
}

/// Names and kinds stand in the order of the system, so that a result can be labelled.
pub fn assert_labelled(built: &BuiltSystem) {
    let names: Vec<&str> = built.system.elements().collect();
    assert_eq!(
        names,
        built
            .elements
            .iter()
            .map(|part| &*part.name)
            .collect::<Vec<_>>()
    );
    let names: Vec<&str> = built
        .system
        .joints()
        .iter()
        .map(|joint| joint.name())
        .collect();
    assert_eq!(
        names,
        built
            .joints
            .iter()
            .map(|part| &*part.name)
            .collect::<Vec<_>>()
    );
    let names: Vec<&str> = built
        .system
        .bodies()
        .iter()
        .map(|body| &*body.name)
        .collect();
    assert_eq!(
        names,
        built
            .bodies
            .iter()
            .map(|body| &*body.name)
            .collect::<Vec<_>>()
    );
}
