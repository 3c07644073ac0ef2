//! Validation: transmission error of a planet in a ring at rest, from a scene, against an independent plane-strain
//! solution of both bodies (reference/plane_planet): one and two pairs of teeth, three loads, either gear driving.

use gearmesh_geometry::input::InputDocument;
use gearmesh_model::write_reduced_gear;
use gearmesh_scene::{Scene, SceneResult, load, run};
use std::path::Path;

use super::gears::{FACE_M, planet, ring};

const MODULE_M: f64 = 2e-3;
/// Loads along the line of action \[N/m\].
const LOADS: [f64; 3] = [20e3, 100e3, 300e3];
/// Positions of the reference are whole hundredths of a pitch.
const POINTS: usize = 100;

/// Places in hundredths of a pitch, pairs of teeth, and approach of the base circles \[µm\] at each load.
fn reference() -> Vec<(usize, usize, [f64; 3])> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../reference/plane_planet/data.csv");
    let text = std::fs::read_to_string(path).unwrap();
    let row = |line: &str| {
        let v: Vec<f64> = line.split(',').map(|v| v.parse().unwrap()).collect();
        let place = (v[0] * POINTS as f64).round() as usize;
        (place, v[1] as usize, [v[2], v[3], v[4]])
    };
    text.lines().skip(1).map(row).collect()
}

/// The pair at rest; `base_2_m`: base radius of the driven gear.
fn at_rest(folder: &Path, gears: [&str; 2], flank: &str, base_2_m: f64) -> SceneResult {
    let torques = LOADS.map(|load| load * FACE_M * base_2_m);
    let text = format!(
        "title = \"planet\"\n[pair]\ngear_1 = \"{}.h5\"\ngear_2 = \"{}.h5\"\ncentre_distance_mm = 51.0\nflank = \"{flank}\"\n\
         [run]\ntorques_Nm = {torques:?}\npitches = 1\npoints_per_pitch = {POINTS}\n\
         [mesh]\nmodel.kind = \"hybrid\"\nmodel.local = \"calibrated\"\nteeth.path = \"line-of-action\"\n",
        gears[0], gears[1]
    );
    let scene = Scene::from_document(InputDocument::new("pair.toml", text), folder).unwrap();
    run(&load(scene).unwrap(), &|_, _| ()).unwrap()
}

/// 0.5 % of the transmission error, as asked of all deflections.
#[test]
fn the_transmission_error_of_a_planet_in_a_ring_agrees() {
    let folder = tempfile::tempdir().unwrap();
    for (name, model) in [("planet", planet(false)), ("ring", ring())] {
        write_reduced_gear(&folder.path().join(format!("{name}.h5")), model).unwrap();
    }
    let base_m = |teeth: f64| 0.5 * MODULE_M * teeth * 20f64.to_radians().cos();
    let driven = at_rest(folder.path(), ["planet", "ring"], "right", base_m(75.0));
    let mut seen = [false; 2];
    for (place, pairs, approach_um) in reference() {
        seen[pairs - 1] = true;
        for (torque, reference_um) in approach_um.into_iter().enumerate() {
            let found_um = -1e6 * driven.curve(&driven.te_m, torque)[place];
            let off = found_um / reference_um - 1.0;
            println!(
                "{place}: {pairs} pairs, {found_um:.4} um, {:+.3} %",
                100.0 * off
            );
            assert!(off.abs() < 0.005, "{place} {torque}: {off}");
        }
    }
    assert!(seen[0] && seen[1]);
    // The ring drives: the same contacts are passed from the other end, the other flanks of the planet touch as right
    // ones of the ring. Pair 0 of the first run at −θ is that of the second at +θ: both have the same approach in the
    // pitch point, and over a pitch the same mean.
    let back = at_rest(folder.path(), ["ring", "planet"], "left", base_m(24.0));
    for torque in 0..LOADS.len() {
        let [forth, back] = [&driven, &back].map(|result| result.curve(&result.te_m, torque));
        for k in 0..POINTS {
            let mirrored = back[(POINTS - k) % POINTS];
            assert!(
                (forth[k] / mirrored - 1.0).abs() < 1e-6,
                "{torque} {k}: {} {mirrored}",
                forth[k]
            );
        }
    }
}
