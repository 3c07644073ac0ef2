//! Joints that contradict each other or say the same, steps that are too large.

use crate::common::*;

/// A wheel that is welded cannot stand 5 degrees off.
#[test]
fn contradictory_joints_are_named() {
    let welded = "[[joint]]\nname = \"welded\"\nkind = \"fixed\"\nbody_2 = \"pinion\"\n[[motion]]";
    let scene = changed(&text("scene_two_wheels.toml"), "[[motion]]", welded);
    let scene = changed(&scene, "speed_rpm = -600.0", "angle_deg = 5.0");
    let complaint = build(&scene).err().unwrap().to_string();
    let place = format!("scene.toml:{}: motion.0: ", line_of(&scene, "[[motion]]"));
    for part in [
        place.as_str(),
        "contradict each other at t = 0 s",
        "\"drive\"",
        "\"welded\"",
    ] {
        assert!(complaint.contains(part), "`{part}` is not in\n{complaint}");
    }
}

/// A wheel held fixed is driven, too: places fit at the start, speeds do not, and the plan names both.
#[test]
fn contradictory_speeds_are_named() {
    let scene = changed(
        &text("scene_two_wheels.toml"),
        "[[motion]]",
        "[[joint]]\nname = \"welded\"\nkind = \"fixed\"\nbody_2 = \"pinion\"\n[[motion]]",
    );
    let complaint = plan(&scene).unwrap_err().to_string();
    assert!(
        complaint.contains("contradict each other")
            && complaint.contains("`welded`") | complaint.contains("\"welded\""),
        "{complaint}"
    );
}

#[test]
fn redundant_joints_are_reported_and_solved() {
    let scene = changed(
        &text("scene_pendulum.toml"),
        "[[joint]]",
        "[[joint]]\nname = \"guide\"\nkind = \"planar\"\nbody_2 = \"rod\"\n[[joint]]",
    );
    let built = build(&scene).unwrap();
    assert_eq!(built.system.mobility(), 1);
    let note = built
        .notes
        .iter()
        .find(|note| note.contains("follow from"))
        .unwrap();
    assert!(
        note.starts_with("joint `hinge`: 3 of its equations follow from `guide`"),
        "{note}"
    );
    assert!(plan(&scene).is_ok());
}

/// A step far beyond the frequency of a stiff, swinging spring is refused with advice, at the solver's table.
#[test]
fn a_step_that_is_too_large_is_refused_with_advice() {
    let scene = changed(
        &text("scene_pendulum.toml"),
        "step_s = 1e-3",
        "step_s = 0.1",
    );
    let scene = changed(
        &scene,
        "mass_kg = 3.0",
        "angular_velocity_rad_per_s = [0.0, 0.0, 30.0]\nmass_kg = 3.0",
    );
    let scene = changed(
        &scene,
        "[[joint]]",
        "[[spring]]\nname = \"stiff\"\nbody_2 = \"rod\"\nat_1_mm = [100.0, 700.0, 0.0]\nstiffness_N_per_mm = 1e4\n[[joint]]",
    );
    let complaint = plan(&scene).unwrap_err().to_string();
    let place = format!(
        "scene.toml:{}: solver: no convergence at t = ",
        line_of(&scene, "[solver]")
    );
    assert!(
        complaint.starts_with(&place)
            && complaint.contains("take a tenth of it, or an adaptive step"),
        "{complaint}"
    );
}
