//! Nodes against patches in scenes: seed 001's pair in motion, seed 003's spur pair beside `impact`, what is refused.

use gearmesh_scene::system_run::{RunJob, SystemResult};

use crate::bevel_pairs::from_its_speed;
use crate::common::*;
use crate::system_runs::Desk;

fn run(scene: &str) -> SystemResult {
    Desk::new().run(RunJob::from_scene(load(scene, &fe_models()).unwrap()).unwrap())
}

/// Mean of a column of the mesh over the second half of the run.
fn mean(result: &SystemResult, name: &str) -> f64 {
    let values = result.rows.read(&format!("elements/mesh/{name}")).unwrap();
    let half = &values[values.len() / 2..];
    half.iter().sum::<f64>() / half.len() as f64
}

/// Forces of statics at the mean point, as the same pair with one contact for each pair of teeth has them; pairs of
/// teeth add up to the whole.
#[test]
fn seed_001_on_nodes_has_its_forces() {
    let mut scene = from_its_speed(&text("dynamics_bevel_20_20_nodes.toml"));
    for (from, to) in [
        ("end_s = 0.026", "end_s = 0.008"),
        ("along_um = 400.0", "along_um = 800.0"),
        ("up_um = 100.0", "up_um = 200.0"),
    ] {
        scene = changed(&scene, from, to);
    }
    // Statics know no friction.
    let friction = scene.find("[gear_mesh.teeth.friction]").unwrap();
    scene.truncate(friction);
    scene.push_str("[gear_mesh.teeth]\nflanks = \"left\"\n");
    let found = run(&scene);
    let [t, r, a] = [
        "tangential_force_1_N",
        "radial_force_1_N",
        "axial_force_1_N",
    ]
    .map(|name| mean(&found, name));
    for (found, expected) in [(t.abs(), 3367.0), (r, -609.0), (a, 2725.0)] {
        // The contact is not in the mean point, as with `impact`.
        assert!(
            (found - expected).abs() < 0.03 * 3367.0,
            "{found}, {expected} N"
        );
    }
    let normal = mean(&found, "normal_force_left_N");
    let pairs: f64 = (1..=4)
        .map(|pair| mean(&found, &format!("pair_{pair}_force_N")))
        .sum();
    assert!(
        (pairs - normal).abs() < 1e-9 * normal,
        "{pairs}, {normal} N"
    );
}

/// Seed 003's pair at 500 rpm: the mean force of statics, and the transmission error of about one law whatever the
/// contact is made of. The pair carries 3831 N
/// with one or two pairs, to which its K belongs at that force.
#[test]
fn seed_003_on_nodes_has_the_deflection_of_its_law() {
    let steady = changed(
        &text("dynamics_17_25_steady.toml"),
        "end_s = 0.5",
        "end_s = 0.03",
    );
    let start = steady.find("kind = \"impact\"").unwrap();
    let on_nodes = format!(
        "{}kind = \"node-to-surface\"\nalong_um = 20000.0\nup_um = 250.0\nweights = {{ kind = \"area\", nominal_force_N = 3831.0 }}\n{}",
        &steady[..start],
        &steady[start + "kind = \"impact\"\n".len()..]
    );
    let [impact, nodes] = [&steady, &on_nodes].map(|scene| {
        let result = run(scene);
        let forces = ["normal_force_right_N", "normal_force_left_N"].map(|n| mean(&result, n));
        [forces[0] + forces[1], mean(&result, "transmission_error_m")]
    });
    assert!(
        (impact[0] / nodes[0] - 1.0).abs() < 0.02,
        "{impact:?}, {nodes:?}"
    );
    // Nodes are softer where two pairs share the load, F going with δ² and not with δ^1.5 (12 %), and where a tip
    // cuts the contact: 1.6 were it half of it everywhere.
    let ratio = nodes[1] / impact[1];
    assert!((1.0..1.6).contains(&ratio), "{impact:?}, {nodes:?}");
}

#[test]
fn what_nodes_do_not_use_is_refused() {
    let scene = text("dynamics_bevel_20_20_nodes.toml");
    let refused =
        |from: &str, to: &str| build(&changed(&scene, from, to)).err().unwrap().to_string();
    for (from, to, expected) in [
        (
            "tooth_pairs = {}",
            "bevel_surface = { kind = \"triangles\", along_um = 500.0, up_um = 100.0 }",
            "belongs to kind = \"impact\"",
        ),
        (
            "along_um = 400.0",
            "along_um = 9000.0",
            "quarter of the flank",
        ),
        ("along_um = 400.0", "along_um = 400.0\nslices = 5", "slices"),
        (
            "weights = { kind = \"area\", nominal_force_N = 2200.0 }",
            "weights = { kind = \"none\" }",
            "no pressure",
        ),
        (
            "weights = { kind = \"area\", nominal_force_N = 2200.0 }",
            "weights = { kind = \"area\", nominal_force_N = -1.0 }",
            "nominal_force_N",
        ),
        ("full_damping_depth_um = 1.0\n", "", "full_damping_depth_um"),
    ] {
        let message = refused(from, to);
        assert!(message.contains(expected), "{message}");
    }
}
