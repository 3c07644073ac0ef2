//! Bodies of bevel gears with their vibration modes: coarse members of 13/35, named by the bodies of a scene.

use gearmesh_model::read_reduced_gear;
use gearmesh_scene::system_run::SystemResult;

use super::loaded_bevel::{members, scene};
use crate::common::{argument, changed, gearmesh, refused, succeeds};

/// The slow scene of the reduced members, whose bodies name their models themselves; more in their tables.
fn named_by_bodies(further: &str) -> String {
    let mut text = changed(
        &scene(),
        "bevel_models = [\"pinion.h5\", \"gear.h5\"]\n",
        "",
    );
    for (name, inertia) in [
        ("pinion", "[3e-4, 3e-4, 3e-4]"),
        ("gear", "[5e-3, 5e-3, 1e-2]"),
    ] {
        let stated = format!("name = \"{name}\"\nmass_kg = 1.0\ninertia_kg_m2 = {inertia}\n");
        let own = format!("name = \"{name}\"\ngear = \"{name}.h5\"\n{further}\n");
        text = changed(&text, &stated, &own);
    }
    // One mesh period and a half; what vibrates at a change of teeth is gone after a step.
    let text = changed(&text, "end_s = 0.18", "end_s = 0.12");
    changed(&text, "step_s = 2e-4", "step_s = 2e-4\nrho_infinity = 0.0")
}

fn run(name: &str, text: &str) -> SystemResult {
    let file = members().join(format!("{name}.toml"));
    std::fs::write(&file, text).unwrap();
    let output = members().join(format!("{name}.h5"));
    succeeds(&["run", argument(&file), "-o", argument(&output)]);
    SystemResult::open(&output).unwrap()
}

/// At low speed a pair with modes is the pair of reduced gears; its modal coordinates are written, gauges read the
/// same.
#[test]
fn slow_modal_members_are_reduced_ones() {
    let reduced = run(
        "slow_reduced",
        &named_by_bodies("flexibility = \"reduced\""),
    );
    let modal = run(
        "slow_modal",
        &named_by_bodies("flexibility = \"modal\"\nmodal_damping_ratio = 0.02"),
    );
    // Seen, over the largest value, at every row: 9.4e-5, 1.0e-4, 7.8e-6, 7.5e-5.
    let from = (0.06 / 4e-4) as usize;
    for (name, tolerance) in [
        ("elements/mesh/transmission_error_m", 2e-4),
        ("elements/mesh/normal_force_right_N", 2e-4),
        ("elements/mesh/strain_gear1_root_method1_ustrain", 1e-4),
        ("elements/mesh/strain_gear2_root_method2_ustrain", 2e-4),
    ] {
        let [a, b] = [&reduced, &modal].map(|result| result.rows.read(name).unwrap());
        let scale = a.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
        let pairs = a.iter().zip(&b).skip(from);
        let off = pairs.fold(0.0_f64, |most, (x, y)| most.max((x - y).abs())) / scale;
        assert!(scale > 0.0 && off < tolerance, "{name}: {off:e}");
    }
    for body in ["pinion", "gear"] {
        let count = model(body).modes.unwrap().count();
        for mode in 0..count {
            let eta = modal
                .rows
                .read(&format!("bodies/{body}/mode_{mode}_sqrt_kg_m"));
            assert!(eta.unwrap().iter().all(|x| x.is_finite()));
        }
        let eta = modal
            .rows
            .read(&format!("bodies/{body}/mode_0_sqrt_kg_m"))
            .unwrap();
        assert!(eta.iter().any(|x| x.abs() > 1e-10));
    }
}

fn model(member: &str) -> gearmesh_model::ReducedGear {
    read_reduced_gear(&members().join(format!("{member}.h5"))).unwrap()
}

/// With the bores held and the teeth apart the scene has the natural frequencies of both models.
#[test]
fn apart_members_have_the_frequencies_of_their_models() {
    let text = named_by_bodies("flexibility = \"modal\"");
    let text = text.replace("kind = \"revolute\"", "kind = \"fixed\"");
    let (head, rest) = text.split_once("[run]").unwrap();
    let (_, rest) = rest.split_once("[[body]]").unwrap();
    let text = format!("{head}[run]\nkind = \"eigen\"\n[[body]]{rest}");
    let text = text
        .replace("speed_rpm = -60.0\n", "")
        .replace("[[motion]]\njoint = \"pinion shaft\"\n", "");
    let (before, load) = text.split_once("[[load]]").unwrap();
    let (_, after) = load.split_once("[[gear_mesh]]").unwrap();
    let text = format!("{before}[[gear_mesh]]{after}");
    // Where the right flanks touch, and a little on the way that they push.
    let start = changed(&named_by_bodies(""), "end_s = 0.12", "end_s = 4e-4");
    let start = changed(&start, "step_s = 2e-4\nrho_infinity = 0.0", "step_s = 1e-5");
    let touching = run("touching", &start)
        .rows
        .read("bodies/gear/cardan_z_rad")
        .unwrap()[0];
    let apart = format!(
        "cardan_deg = [0.0, 90.0, {:?}]",
        touching.to_degrees() + 0.1
    );
    let result = run("apart", &changed(&text, "cardan_deg = [0.0, 90.0]", &apart));
    let found = result.eigen[0].modes.iter().map(|mode| mode.frequency_hz());
    let frequencies = |member: &str| model(member).modes.unwrap().frequencies_hz();
    let mut expected = [frequencies("pinion"), frequencies("gear")].concat();
    expected.sort_by(f64::total_cmp);
    let found: Vec<f64> = found.collect();
    assert_eq!(found.len(), expected.len(), "{found:?}");
    for (a, b) in found.iter().zip(&expected) {
        assert!((a / b - 1.0).abs() < 1e-6, "{a} Hz, {b} Hz");
    }
}

/// What does not fit is refused with what to do.
#[test]
fn bevel_bodies_that_do_not_fit_are_refused() {
    let own = named_by_bodies("flexibility = \"modal\"");
    let pair = "bevel_pair = \"bevel_13_35.toml\"\n";
    let twice = format!("{pair}bevel_models = [\"pinion.h5\", \"gear.h5\"]\n");
    let gear = "gear = \"gear.h5\"\nflexibility = \"modal\"\n";
    let stated = "mass_kg = 1.0\ninertia_kg_m2 = [5e-3, 5e-3, 1e-2]\n";
    let impact = "model = { kind = \"impact\", hertz = {} }\n";
    let model = own
        .lines()
        .find(|line| line.starts_with("model = "))
        .unwrap();
    for (name, text, parts) in [
        (
            "twice",
            changed(&own, pair, &twice),
            &["bevel_models", "remove one"][..],
        ),
        (
            "half",
            changed(&own, gear, stated),
            &["gear_2", "`gear` names no reduced"],
        ),
        (
            "other",
            changed(&own, "gear = \"gear.h5\"", "gear = \"pinion.h5\""),
            &["it is the pair's pinion"],
        ),
        (
            "stiff",
            changed(&own, &format!("{model}\n"), impact),
            &["flexibility", "hybrid"],
        ),
        (
            "file",
            changed(&own, "gear = \"pinion.h5\"", "gear = \"pinion.toml\""),
            &["body.0.gear", "gearmesh reduce"],
        ),
        (
            "far",
            changed(&own, gear, &format!("{gear}modes_up_to_Hz = 1e6\n")),
            &["modes_up_to_Hz"],
        ),
        (
            "space",
            changed(
                &own,
                "kind = \"hybrid\",",
                "kind = \"hybrid\", half_space = {},",
            ),
            &["half_space"],
        ),
    ] {
        let file = members().join(format!("refused_{name}.toml"));
        std::fs::write(&file, text).unwrap();
        refused(&gearmesh(&["check", argument(&file)]), 2, parts);
    }
}
