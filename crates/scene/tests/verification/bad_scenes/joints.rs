//! Joints that contradict each other or say the same, steps that are too large.

use gearmesh_scene::system_run::RunJob;

use crate::common::*;
use crate::system_runs::Desk;

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

/// With ρ∞ = 1 nothing damps errors of joint forces: the hinge of the pendulum, which carries 10 to 60 N, had 3e4 N
/// after 9 s, and the run broke down at 11 s. It is refused; with 0.99 the force stays what the swing asks for: at most
/// m (g + ω² r) with ω² = 2 g (1 − cos 60°) m r/J, J about the hinge.
#[test]
fn joints_ask_for_damping_of_their_errors() {
    let pendulum = text("scene_pendulum.toml");
    let undamped = changed(&pendulum, "rho_infinity = 0.99", "rho_infinity = 1.0");
    let complaint = build(&undamped).err().unwrap().to_string();
    for part in ["solver.rho_infinity", "found 1", "less than 1", "0.99"] {
        assert!(complaint.contains(part), "`{part}` is not in\n{complaint}");
    }
    let long = changed(&pendulum, "end_s = 2.0", "end_s = 20.0");
    let job = RunJob::from_scene(load(&long, &fe_models()).unwrap()).unwrap();
    let result = Desk::new().run(job);
    let force = ["x", "y"].map(|axis| {
        let name = format!("joints/hinge/force_world_{axis}_N");
        result.rows.read(&name).unwrap()
    });
    let largest = force[0].iter().zip(&force[1]).map(|(x, y)| x.hypot(*y));
    let largest = largest.fold(0.0, f64::max);
    let (mass, lever, inertia) = (3.0, 0.5, 0.25 + 3.0 * 0.25);
    let square = 2.0 * 9.81 * 0.5 * mass * lever / inertia;
    let expected = mass * (9.81 + square * lever);
    // Rows every 10 ms: the largest lies within 5 ms of one, (ω t)²/2 = 2e-4 of it below.
    assert!(
        (largest / expected - 1.0).abs() < 1e-3,
        "{largest} {expected} N"
    );
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

/// A body that lies on its side cannot spin about its own z on a hinge along the world's: the speed would be dropped at
/// the start.
#[test]
fn a_speed_across_its_joints_axis_is_refused() {
    let scene = |kind: &str, axis: &str, cardan: &str| {
        format!(
            "title = \"t\"\n[run]\nkind = \"transient\"\nend_s = 0.1\n[solver]\nstep_s = 1e-3\n[output]\ninterval_s = 1e-2\n\
             [[body]]\nname = \"rotor\"\nmass_kg = 2.0\ninertia_kg_m2 = [0.02, 0.02, 0.03]\nspeed_rpm = 300.0\ncardan_deg = {cardan}\n\
             [[joint]]\nname = \"hinge\"\nkind = \"{kind}\"\nbody_2 = \"rotor\"\n{axis}"
        )
    };
    let complaint = |kind, axis, cardan| {
        let text = scene(kind, axis, cardan);
        let found = build(&text).err().map(|error| error.to_string());
        let place = format!(
            "scene.toml:{}: body.0.speed_rpm: ",
            line_of(&text, "speed_rpm")
        );
        if let Some(found) = &found {
            assert!(found.starts_with(&place), "{found}");
        }
        found
    };
    let upright = "[0.0, 0.0, 0.0]";
    let z = "axis = [0.0, 0.0, 1.0]\n";
    for (kind, axis, cardan, part) in [
        ("revolute", z, "[90.0, 0.0, 0.0]", "turns by 300.000000 rpm"),
        (
            "cylindrical",
            "axis = [1.0, 0.0, 0.0]\n",
            upright,
            "joint `hinge` (cylindrical)",
        ),
        ("revolute", z, "[1.0, 0.0, 0.0]", "turns by 5.235722 rpm"),
        ("fixed", "", upright, "does not let it turn"),
        ("prismatic", "", upright, "does not let it turn"),
    ] {
        let found = complaint(kind, axis, cardan).unwrap();
        assert!(found.contains(part), "`{part}` is not in\n{found}");
    }
    for (kind, axis, cardan) in [
        ("revolute", "", "[90.0, 0.0, 0.0]"),
        ("revolute", "axis = [0.0, 0.0, -1.0]\n", upright),
        // A milliradian is no contradiction.
        ("revolute", z, "[0.05, 0.0, 0.0]"),
        ("spherical", "", "[90.0, 0.0, 0.0]"),
    ] {
        assert_eq!(
            complaint(kind, axis, cardan),
            None,
            "{kind} {axis} {cardan}"
        );
    }
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
