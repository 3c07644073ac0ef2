//! Bevel pairs between bodies whose axes meet: seed 001's pair in motion, other shaft angles, what is refused.

use std::f64::consts::TAU;

use gearmesh_scene::system_run::{RunJob, SystemResult};

use crate::common::*;
use crate::system_runs::Desk;

/// Seed 001's scene at its speed from the start.
fn at_speed() -> String {
    from_its_speed(&text("dynamics_bevel_20_20.toml"))
}

/// A scene of this pair without its run-up.
pub fn from_its_speed(scene: &str) -> String {
    let scene = changed(
        scene,
        "speed_rpm = { step = { start_s = 0.0, from = 0.0, end_s = 0.03, to = 3000.0 } }",
        "speed_rpm = 3000.0",
    );
    let scene = changed(&scene, "speed_rpm = 0.0\n", "");
    changed(
        &changed(
            &scene,
            "end_s = 0.01, to = 100.0",
            "end_s = 0.003, to = 100.0",
        ),
        "end_s = 0.08",
        "end_s = 0.026",
    )
}

fn run(scene: &str) -> SystemResult {
    Desk::new().run(RunJob::from_scene(load(scene, &fe_models()).unwrap()).unwrap())
}

/// Over the last revolution: forces by statics at the mean point, the mean ratio of speeds, mesh lines at 1000 Hz.
#[test]
fn seed_001_has_its_forces_ratio_and_mesh_lines() {
    let result = run(&at_speed());
    let read = |name: &str| result.rows.read(name).unwrap();
    let times = read("time_s");
    let last = times.len() - 1;
    let first = times
        .iter()
        .position(|t| t - (times[last] - 0.02) > -1e-9)
        .unwrap();
    let mean = |name: &str| {
        let values = &read(&format!("elements/mesh/{name}"))[first..last];
        values.iter().sum::<f64>() / values.len() as f64
    };
    let turned = |body: &str| {
        let turns = read(&format!("bodies/{body}/turn_rad"));
        turns[last] - turns[first]
    };
    assert!(
        (turned("pinion") - TAU).abs() < 1e-6,
        "{}",
        turned("pinion")
    );
    assert!((turned("gear") + TAU).abs() < 1e-4, "{}", turned("gear"));
    // At the mean point F_t is 3367 N; axial and radial 2725 and −609 N, by the hand and the direction.
    let [t, r, a] = [
        "tangential_force_1_N",
        "radial_force_1_N",
        "axial_force_1_N",
    ]
    .map(mean);
    for (found, expected) in [(t.abs(), 3367.0), (r, -609.0), (a, 2725.0)] {
        assert!(
            (found - expected).abs() < 0.03 * 3367.0,
            "{found}, {expected} N"
        );
    }
    assert_eq!(mean("apart"), 0.0);
    let pairs = read("elements/mesh/loaded_pairs");
    assert!(pairs[first..].iter().all(|n| (1.0..=3.0).contains(n)));
    let te = read("elements/mesh/transmission_error_m");
    // Orders of the pinion's revolution.
    let amplitude = |order: usize| {
        let (mut sine, mut cosine) = (0.0, 0.0);
        for (i, te) in te[first..last].iter().enumerate() {
            let angle = TAU * (order * i) as f64 / (last - first) as f64;
            sine += te * angle.sin();
            cosine += te * angle.cos();
        }
        2.0 * f64::hypot(sine, cosine) / (last - first) as f64
    };
    let mesh = amplitude(20);
    for order in (1..20).chain(21..40) {
        assert!(
            amplitude(order) < 0.05 * mesh,
            "{order}: {:e} of {mesh:e}",
            amplitude(order)
        );
    }
}

/// The shipped scene in slices: the forces of statics, the load over the slices, the transmission error of the pair at
/// rest.
#[test]
fn slices_of_seed_001_carry_its_load() {
    let scene = changed(
        &text("dynamics_bevel_20_20_slices.toml"),
        "end_s = 0.06",
        "end_s = 0.03",
    );
    let result = run(&scene);
    let read = |name: &str| result.rows.read(name).unwrap();
    let times = read("time_s");
    let first = times.iter().position(|t| *t > 0.02 - 1e-9).unwrap();
    let last = times.len() - 1;
    let mean = |name: &str| {
        let values = &read(&format!("elements/mesh/{name}"))[first..last];
        values.iter().sum::<f64>() / values.len() as f64
    };
    // On the pinion where the contact is in the mean, which lies a little off the mean point: 3367, −609, 2725 N there.
    let forces = [
        "tangential_force_1_N",
        "radial_force_1_N",
        "axial_force_1_N",
    ]
    .map(mean);
    for (found, expected) in [
        (forces[0].abs(), 3367.0),
        (forces[1], -609.0),
        (forces[2], 2725.0),
    ] {
        assert!((found - expected).abs() < 0.06 * 3367.0, "{forces:?}");
    }
    let slices: Vec<f64> = (1..=15)
        .map(|k| mean(&format!("line_load_slice_{k}_N_per_m")))
        .collect();
    let most = (0..15)
        .max_by(|a, b| slices[*a].total_cmp(&slices[*b]))
        .unwrap();
    assert!((6..10).contains(&most), "{slices:?}");
    assert!(slices[0] == 0.0 && slices[14] < 0.01 * slices[most]);
    assert_eq!(mean("apart"), 0.0);
    // At rest 604 µrad over a lever of 23 mm.
    let te = 1e6 * mean("transmission_error_m");
    assert!((-15.0..-11.0).contains(&te), "{te}");
}

#[test]
fn a_pair_of_another_shaft_angle_turns_at_its_ratio() {
    let folder = tempfile::tempdir().unwrap();
    let pair = changed(
        &text("bevel_20_20.toml"),
        "teeth = [20, 20]",
        "teeth = [20, 20]\nshaft_angle_deg = 70.0",
    );
    std::fs::write(folder.path().join("bevel_20_20.toml"), pair).unwrap();
    let scene = changed(
        &at_speed(),
        "cardan_deg = [0.0, 90.0]",
        "cardan_deg = [0.0, 70.0]",
    );
    let scene = changed(&scene, "end_s = 0.026", "end_s = 0.01");
    let loaded = load(&scene, folder.path()).unwrap();
    let result = Desk::new().run(RunJob::from_scene(loaded).unwrap());
    let read = |name: &str| result.rows.read(name).unwrap();
    let gear = read("bodies/gear/turn_rad");
    let turned = gear[gear.len() - 1] - gear[0];
    // Less what the teeth deflect under the load, 33 um over a lever of 25 mm.
    assert!((turned + 0.5 * TAU).abs() < 3e-3, "{turned}");
    assert!(
        read("elements/mesh/apart")
            .iter()
            .all(|apart| *apart == 0.0)
    );
}

/// The pinion as facets: the same motion however fine they are. Tips carry here; facets end there, so that the pair
/// sinks in deeper than the smooth one, whose contact counts as a whole ellipse.
#[test]
fn flanks_as_facets_run_like_smooth_ones() {
    let smooth = changed(&at_speed(), "end_s = 0.026", "end_s = 0.004");
    let on = |kind: &str, [along, up]: [f64; 2]| {
        let surface = format!(
            "bevel_pair = \"bevel_20_20.toml\"\nbevel_surface = {{ kind = \"{kind}\", along_um = {along}, up_um = {up} }}"
        );
        changed(&smooth, "bevel_pair = \"bevel_20_20.toml\"", &surface)
    };
    let mean = |scene: &str| {
        let result = run(scene);
        ["tangential_force_1_N", "transmission_error_m"].map(|name| {
            let values = result.rows.read(&format!("elements/mesh/{name}")).unwrap();
            let last = &values[values.len() / 2..];
            last.iter().sum::<f64>() / last.len() as f64
        })
    };
    let expected = mean(&smooth);
    let found = [
        mean(&on("triangles", [1000.0, 250.0])),
        mean(&on("quadrilaterals", [700.0, 175.0])),
    ];
    for [force, error] in found {
        assert!(
            (force / expected[0] - 1.0).abs() < 0.02,
            "{expected:?} {found:?}"
        );
        assert!(
            (1.0..1.3).contains(&(error / expected[1])),
            "{expected:?} {found:?}"
        );
        assert!((force / found[1][0] - 1.0).abs() < 2e-4, "{found:?}");
        assert!((error / found[1][1] - 1.0).abs() < 5e-4, "{found:?}");
    }
}

#[test]
fn what_bevel_pairs_do_not_know_is_refused() {
    let scene = text("dynamics_bevel_20_20.toml").replace("tooth_pairs = {}\n", "");
    let stiff = "model = { kind = \"impact\", stiffness_N_per_mm_e = 7.2e5, exponent = 1.5, damping_N_s_per_mm = 1.0, full_damping_depth_um = 1.0 }";
    for (from, to, at, parts) in [
        (
            stiff,
            "model = { kind = \"iso6336\" }",
            "kind = \"iso6336\"",
            &[
                "found \"iso6336\"",
                "allowed for a bevel pair are \"impact\", \"node-to-surface\" and \"hybrid\"",
            ][..],
        ),
        (
            "cardan_deg = [0.0, 90.0]",
            "cardan_deg = [0.0, 80.0]",
            "gear_2 = ",
            &["stand at 80.0000 degrees", "made for 90.0000"],
        ),
        (
            "gear_2 = \"gear\"\n",
            "gear_2 = \"gear\"\nmicrogeometry = true\n",
            "microgeometry = true",
            &["is not used by a bevel pair; remove it"],
        ),
        (
            "exponent = 1.5",
            "exponent = 1.5, hertz = {}",
            "hertz = {}",
            &["stiffness_N_per_mm_e", "is not used with `hertz`"],
        ),
        (
            "stiffness_N_per_mm_e = 7.2e5, exponent = 1.5",
            "hertz = { poisson = 0.5 }",
            "poisson = 0.5",
            &["0 up to, not including, 0.5"],
        ),
        (
            stiff,
            "model = { kind = \"hybrid\" }",
            "[[gear_mesh]]",
            &["bevel_models", "missing", "half_space = {}"],
        ),
        (
            stiff,
            "model = { kind = \"hybrid\", half_space = {}, local = \"none\" }",
            "local = ",
            &["is not used with `half_space`"],
        ),
        (
            stiff,
            "model = { kind = \"hybrid\", half_space = { poisson = 0.5 } }",
            "poisson = 0.5",
            &["half_space.poisson", "0 up to, not including, 0.5"],
        ),
        (
            stiff,
            "model = { kind = \"hybrid\", half_space = {}, slices = 2 }",
            "slices = 2",
            &["found 2", "3 to 100"],
        ),
        (
            stiff,
            "bevel_models = [\"a.h5\", \"b.h5\"]\nmodel = { kind = \"hybrid\", half_space = {} }",
            "half_space = {}",
            &["is not used with `bevel_models` or bodies that name reduced gears"],
        ),
        (
            stiff,
            "bevel_models = [\"a.h5\", \"b.h5\"]\nmodel = { kind = \"hybrid\" }",
            "bevel_models",
            &["a.h5"],
        ),
        (
            "bevel_pair = \"bevel_20_20.toml\"",
            "bevel_pair = \"bevel_20_20.toml\"\nbevel_models = [\"a.h5\", \"b.h5\"]",
            "bevel_models",
            &["is not used by kind = \"impact\""],
        ),
        (
            "bevel_pair = \"bevel_20_20.toml\"",
            "bevel_pair = \"bevel_20_20.toml\"\nbevel_surface = { kind = \"triangles\", along_um = 500.0, up_um = 2000.0 }",
            "bevel_surface",
            &["longest edge up the flank", "at most an eighth"],
        ),
        (
            stiff,
            "bevel_surface = { kind = \"triangles\", along_um = 500.0, up_um = 100.0 }\nmodel = { kind = \"hybrid\", half_space = {} }",
            "bevel_surface",
            &["belongs to kind = \"impact\""],
        ),
        (
            "bevel_pair = \"bevel_20_20.toml\"",
            "bevel_pair = \"nowhere.toml\"",
            "",
            &["nowhere.toml"],
        ),
    ] {
        let wrong = changed(&scene, from, to);
        let complaint = build(&wrong).err().unwrap().to_string();
        if !at.is_empty() {
            let place = format!("scene.toml:{}: ", line_of(&wrong, at));
            assert!(complaint.contains(&place), "{place} is not in {complaint}");
        }
        for part in parts {
            assert!(complaint.contains(part), "`{part}` is not in {complaint}");
        }
    }
}
