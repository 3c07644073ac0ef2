//! Planetary sets from one table: natural frequencies of a published set, load sharing, phases, refusals, motion.

mod bearings;
mod coupling;
mod errors;
mod hybrid;
mod meshed;
mod modes;
mod motion;
mod pins;
mod positions;
mod ravigneaux;
mod refusals;
mod shared;
mod sharing;
mod sidebands;
mod stepped;
mod teeth;

use std::path::Path;

use gearmesh_scene::system_run::{RunJob, SystemResult};

use crate::common::*;
use crate::system_runs::Desk;

/// Gear files of a set without profile shift: sun, planet, ring.
fn write_gears(folder: &Path, [sun, planet]: [usize; 2], pressure_angle_deg: f64) {
    let ring = sun + 2 * planet;
    let blank = "[blank]\nkind = \"solid\"\nbore_diameter_mm = 20.0";
    let rim = format!(
        "[blank]\nkind = \"ring\"\nouter_diameter_mm = {}",
        3 * ring + 30
    );
    for (name, teeth, tip, blank) in [
        (
            "sun",
            format!("{sun}"),
            "rack_tip_radius = 0.2",
            blank.to_owned(),
        ),
        (
            "planet",
            format!("{planet}"),
            "rack_tip_radius = 0.2",
            blank.to_owned(),
        ),
        ("ring", format!("-{ring}"), "addendum = 0.8", rim),
    ] {
        let text = format!(
            "name = \"{name}\"\n[tooth]\nteeth = {teeth}\nmodule_mm = 3.0\npressure_angle_deg = {pressure_angle_deg:?}\n{tip}\nthickness_allowance_mm = 0.1\n\
             face_width_mm = 25.0\n{blank}\n[material]\nyoung_GPa = 206.0\npoisson = 0.3\ndensity_kg_per_m3 = 7850.0\n"
        );
        std::fs::write(folder.join(format!("{name}.toml")), text).unwrap();
    }
}

/// A scene with one set; `run` and the keys of sun, ring, carrier, planets.
fn scene(run: &str, distance_mm: f64, [sun, ring, carrier, planets, more]: [&str; 5]) -> String {
    format!(
        "title = \"set\"\n[run]\n{run}\n[[planetary]]\nname = \"set\"\ncentre_distance_mm = {distance_mm:?}\n{more}\n\
         sun_mesh = {{ model = {{ kind = \"iso6336\", stiffness_N_per_mm_um = 20.0 }} }}\n\
         ring_mesh = {{ model = {{ kind = \"iso6336\", stiffness_N_per_mm_um = 20.0 }} }}\n\
         [planetary.sun]\ngear = \"sun.toml\"\n{sun}\n[planetary.ring]\ngear = \"ring.toml\"\n{ring}\n\
         [planetary.carrier]\nmass_kg = 5.43\n{carrier}\n[planetary.planets]\ngear = \"planet.toml\"\n{planets}\n"
    )
}

/// The sets of docs/planetary.md of which the first has this name, after the tables of a run.
fn documented(name: &str, run: &str) -> String {
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/planetary.md");
    let page = std::fs::read_to_string(page).unwrap();
    let begin = format!("[[planetary]]\nname = \"{name}\"\n");
    let mut blocks = page
        .split("```toml\n")
        .filter(|block| block.starts_with(&begin));
    let (text, _) = blocks.next().unwrap().split_once("```").unwrap();
    format!("title = \"documented\"\n[run]\n{run}\n{text}")
}

fn run(text: &str, folder: &Path) -> SystemResult {
    Desk::new().run(RunJob::from_scene(load(text, folder).unwrap()).unwrap())
}
