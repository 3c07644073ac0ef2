//! Machines with everything in them: elastic gears, balls and cages that move, friction, weight, root strain. The
//! shipped scenes with coarse gears, for some milliseconds.

use std::path::Path;

use gearmesh_scene::system_run::SystemResult;

use super::bevel::shipped;
use super::loaded_bevel::members;
use crate::common::{Desk, argument, changed, succeeds, workshop};

fn run(folder: &Path, name: &str, text: &str) -> SystemResult {
    let file = folder.join(format!("{name}.toml"));
    std::fs::write(&file, text).unwrap();
    let output = folder.join(format!("{name}.h5"));
    succeeds(&["run", argument(&file), "-o", argument(&output)]);
    SystemResult::open(&output).unwrap()
}

fn with_file(folder: &Path, name: &str) {
    std::fs::copy(shipped(name), folder.join(name)).unwrap();
}

/// A run balances its energy, does not depend on the step or on who looks at strain, and every part of it carries.
fn assert_sound(folder: &Path, name: &str, scene: &str, step_s: f64, carrying: &[&str]) {
    let whole = run(folder, name, scene);
    // As of the machines on balls with rigid teeth.
    let energy = whole.relative_energy_error().unwrap();
    assert!(energy < 1e-5, "{energy:e}");
    let stated = format!("step_s = {step_s:e}");
    let half = changed(scene, &stated, &format!("step_s = {:e}", 0.5 * step_s));
    let half = run(folder, &format!("{name}_half"), &half);
    let mean = |result: &SystemResult, column: &str| {
        let values = result.rows.read(column).unwrap();
        values.iter().map(|x| x.abs()).sum::<f64>() / values.len() as f64
    };
    for column in carrying {
        let [a, b] = [&whole, &half].map(|result| mean(result, column));
        // As of the bevel pairs of the hard cases.
        assert!(b > 0.0 && (a / b - 1.0).abs() < 0.02, "{column}: {a}, {b}");
    }
    let gauges = scene.find("[[gauge]]").unwrap();
    let unseen = run(folder, &format!("{name}_unseen"), &scene[..gauges]);
    for column in unseen.rows.columns() {
        let [a, b] = [&whole, &unseen].map(|result| result.rows.read(&column.name).unwrap());
        assert_eq!(a, b, "{}", column.name);
    }
}

#[test]
fn a_bevel_machine_has_everything_at_once() {
    let folder = members();
    with_file(folder, "bearing_seed_000.toml");
    let mut scene = std::fs::read_to_string(shipped("dynamics_bevel_13_35_chain.toml")).unwrap();
    for (from, to) in [
        ("../out/scenes/bevel_pinion_13_35.h5", "pinion.h5"),
        ("../out/scenes/bevel_gear_13_35.h5", "gear.h5"),
        ("end_s = 0.04\n", "end_s = 0.002\n"),
        (
            "{ step = { start_s = 0.0, from = 0.0, end_s = 0.02, to = 6000.0 } }",
            "6000.0",
        ),
        ("end_s = 0.01, to = 100.0", "end_s = 0.0005, to = 100.0"),
    ] {
        scene = changed(&scene, from, to);
    }
    let scene = scene.replace("speed_rpm = 0.0\n", "speed_rpm = 6000.0\n");
    let carrying = [
        "elements/mesh/normal_force_left_N",
        "elements/pinion near/force_radial_N",
        "elements/pinion far/force_radial_N",
        "elements/gear near/force_radial_N",
        "elements/gear far/force_radial_N",
        "elements/mesh/strain_gear1_root_method2_ustrain",
        "elements/pinion near/ball_1_inner_N",
        "elements/gear near/cage_1_speed_ratio",
    ];
    assert_sound(folder, "chain", &scene, 5e-6, &carrying);
}

#[test]
fn a_pair_on_shafts_has_everything_at_once() {
    let desk = Desk::new();
    let folder = desk.path("");
    with_file(&folder, "bearing_shaft_pair_b.toml");
    // The small gears' models have no mass.
    let gear = |model: &Path| {
        format!(
            "{}\"\nmass_kg = 0.2\ninertia_kg_m2 = [3e-5, 3e-5, 5e-5]\n",
            model.display()
        )
    };
    let [solid, thin] = [&workshop().solid, &workshop().thin].map(|model| gear(model));
    let mut scene = std::fs::read_to_string(shipped("dynamics_pair_b_machine.toml")).unwrap();
    for (from, to) in [
        ("../out/demo/gear1.h5\"\n", &solid[..]),
        ("../out/demo/gear3.h5\"\n", &thin),
        ("origin_mm = [150.0", "origin_mm = [54.7"),
        ("end_s = 1.0\n", "end_s = 0.01\n"),
        (
            "{ step = { start_s = 0.0, from = 0.0, end_s = 1.0, to = -600.0 } }",
            "-600.0",
        ),
        ("end_s = 0.1, to = -100.0", "end_s = 0.001, to = -20.0"),
        (
            "model = { kind = \"hybrid\",",
            "model = { kind = \"hybrid\", local = \"weber-banaschek\",",
        ),
        (
            "[\"t0_tension\", \"t0_compression\"]",
            "[\"tension\", \"compression\"]",
        ),
    ] {
        scene = changed(&scene, from, to);
    }
    let scene = scene.replace("speed_rpm = 0.0\n", "speed_rpm = -600.0\n");
    let carrying = [
        "elements/mesh/normal_force_right_N",
        "elements/input left/force_radial_N",
        "elements/output right/force_radial_N",
        "elements/output left/cage_1_speed_ratio",
    ];
    assert_sound(&folder, "shafts", &scene, 2e-5, &carrying);
}
