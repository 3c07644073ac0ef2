//! Gears that leave each other, and loads that their teeth cannot carry: a result is sound or there is none.

use std::sync::atomic::AtomicBool;

use gearmesh_scene::system_run::{RunJob, SystemResult, SystemRunError, run};

use crate::common::*;
use crate::system_runs::Desk;

fn job(scene: &str) -> RunJob {
    RunJob::from_scene(load(scene, &fe_models()).unwrap()).unwrap()
}

fn failure(scene: &str) -> SystemRunError {
    let desk = Desk::new();
    let error = run(job(scene), &desk.options(&AtomicBool::new(false))).unwrap_err();
    assert!(!desk.output.exists());
    error
}

fn assert_all_finite(result: &SystemResult) {
    for column in result.rows.columns() {
        let values = result.rows.read(&column.name).unwrap();
        assert!(values.iter().all(|x| x.is_finite()), "{}", column.name);
    }
    for figures in &result.statistics {
        for value in [
            figures.mean,
            figures.deviation,
            figures.least,
            figures.largest,
        ] {
            assert!(value.is_finite());
        }
    }
}

/// The wheel slides out of mesh at 0.2 m/s. The tip circles touch at a = 57 · 2.6 + 2 · 2.6 (1 + 0.33) mm: from there
/// on the gears are apart, and every number of the result is one.
#[test]
fn a_gear_that_drifts_out_of_mesh_is_marked_as_apart() {
    let scene = changed(
        &text("scene_two_wheels.toml"),
        "name = \"axle 2\"\nkind = \"revolute\"",
        "name = \"axle 2\"\nkind = \"planar\"",
    );
    let scene = changed(
        &scene,
        "position_mm = [150.0, 0.0, 0.0]",
        "position_mm = [150.0, 0.0, 0.0]\nvelocity_mm_per_s = [200.0, 0.0, 0.0]",
    );
    let scene = changed(&scene, "to = -100.0", "to = 0.0");
    let result = Desk::new().run(job(&scene));
    assert_all_finite(&result);
    let read = |name: &str| result.rows.read(name).unwrap();
    let apart = read("elements/mesh/apart");
    let (te, pairs) = (
        read("elements/mesh/transmission_error_m"),
        read("elements/mesh/loaded_pairs"),
    );
    let distance: Vec<f64> = read("bodies/wheel/x_m");
    let first = apart.iter().position(|&mark| mark == 1.0).unwrap();
    assert!(first > 0 && apart[..first].iter().all(|&mark| mark == 0.0));
    assert!(apart[first..].iter().all(|&mark| mark == 1.0));
    let tips_m = 1e-3 * (57.0 * 2.6 + 2.0 * 2.6 * 1.33);
    assert!(
        (0.0..5e-6).contains(&(distance[first] - tips_m)),
        "{} {tips_m}",
        distance[first]
    );
    assert!(pairs[first..].iter().all(|&pairs| pairs == 0.0));
    // Continued flanks are at most half a base pitch off.
    let pitch = std::f64::consts::PI * 2.6e-3 * 20f64.to_radians().cos();
    assert!(te.iter().all(|te| te.abs() <= 0.5 * pitch));
}

/// A load of the other sign on a mesh of right flanks, driven: the teeth do not pass through each other.
#[test]
fn a_load_against_the_only_flanks_ends_the_run() {
    let scene = changed(&text("scene_two_wheels.toml"), "to = -100.0", "to = 100.0");
    let scene = changed(
        &scene,
        "gear_2 = \"wheel\"",
        "gear_2 = \"wheel\"\nteeth = { flanks = \"right\" }",
    );
    let error = failure(&scene);
    assert!(!error.is_input(), "{error}");
    let message = error.to_string();
    for word in [
        "`mesh`",
        "left flanks",
        "torques negative about z",
        "flanks = \"left\" or \"both\"",
    ] {
        assert!(message.contains(word), "`{word}` is not in {message}");
    }
}

/// Gears that run up under their loads until the step passes teeth by.
#[test]
fn a_step_that_becomes_too_long_ends_the_run() {
    let scene = changed(
        &text("scene_two_wheels.toml"),
        "[[motion]]\nname = \"drive\"\njoint = \"axle 1\"\nspeed_rpm = -600.0\n",
        "",
    );
    let scene = changed(&scene, "body = \"wheel\"", "body = \"pinion\"");
    let scene = changed(&scene, "step_s = 2e-6", "step_s = 5e-5");
    let scene = changed(&scene, "interval_s = 2e-5", "interval_s = 1e-3");
    let scene = changed(&scene, "\nend_s = 0.05", "\nend_s = 5.0");
    let SystemRunError::StepPassesTeeth {
        frequency_hz,
        step_s,
        ..
    } = failure(&scene)
    else {
        panic!("accepted");
    };
    assert!((step_s - 5e-5).abs() < 1e-12);
    assert!(
        (frequency_hz * step_s * 8.0 - 1.0).abs() < 1e-2,
        "{frequency_hz}"
    );
}
