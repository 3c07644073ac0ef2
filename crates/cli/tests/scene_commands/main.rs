//! The commands on scenes, with two small gears: what they print, what they write, and identities of the figures.
#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::print_stdout,
    missing_docs
)]

mod bearing;
mod bevel;
mod bevel_stress;
#[path = "../common/mod.rs"]
mod common;
#[path = "../../../scene/tests/made_up_gears/drilled_pair.rs"]
mod drilled_pair;
mod export;
mod first_steps;
mod hard_bevel;
mod import;
mod import_trial;
mod loaded_bevel;
mod measured;
mod modal_bevel;
mod moving;
mod pages;
#[path = "../../../contact/tests/pair_common/mod.rs"]
mod pair_common;
mod plan;
mod planetary_gearbox;
mod planetary_rexs;
mod random_gearboxes;
mod recover;
mod report;
mod run;
mod schema;
mod shipped_gearboxes;
mod studio;
mod unequal_pair;
mod whole_machines;

use common::{Desk, argument, succeeds, workshop};
use gearmesh_scene::{SceneResult, StrainSeries};
use std::path::Path;

/// A multibody scene with the two reduced gears in a `hybrid` mesh, for a millisecond.
fn hybrid_scene() -> String {
    let gear = |name: &str, model: &Path, x_mm: f64| {
        format!(
            "[[body]]\nname = \"{name}\"\ngear = \"{}\"\nmass_kg = 0.2\ninertia_kg_m2 = [3e-5, 3e-5, 5e-5]\nposition_mm = [{x_mm}, 0, 0]\n\
             [[joint]]\nname = \"axle of {name}\"\nkind = \"revolute\"\nbody_2 = \"{name}\"\n",
            model.display()
        )
    };
    format!(
        "title = \"hybrid\"\n[run]\nkind = \"transient\"\nend_s = 1e-3\n[solver]\nstep_s = 1e-6\n[output]\ninterval_s = 1e-5\n{}{}\
         [[motion]]\njoint = \"axle of solid\"\nspeed_rpm = -60.0\n[[load]]\nbody = \"thin\"\ntorque_Nm = -10.0\n\
         [[gear_mesh]]\nname = \"mesh\"\ngear_1 = \"solid\"\ngear_2 = \"thin\"\nmodel.kind = \"hybrid\"\nmodel.local = \"weber-banaschek\"\nteeth.flanks = \"right\"\n\
         [[gauge]]\nbody = \"thin\"\nnames = [\"tension\"]\n",
        gear("solid", &workshop().solid, 0.0),
        gear("thin", &workshop().thin, 54.7)
    )
}

/// Recovers the strain of all gauges: tension, compression.
fn recovered(desk: &Desk, result: &Path) -> [StrainSeries; 2] {
    let output = desk.path("strain.h5");
    succeeds(&["recover", argument(result), "-o", argument(&output)]);
    SceneResult::read(&output)
        .unwrap()
        .strain
        .try_into()
        .unwrap()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |worst, v| v.abs().max(worst))
}
