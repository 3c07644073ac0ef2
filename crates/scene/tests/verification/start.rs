//! Places, angles and speeds at the start.

use std::f64::consts::{PI, TAU};
use std::ops::ControlFlow;

use gearmesh_dynamics::Simulation;
use gearmesh_dynamics::scheme::Params;
use gearmesh_geometry::{GearDefinition, involute};
use gearmesh_scene::system::Variation;

use crate::common::*;
use crate::{assert_labelled, body, spin};

/// T = 2π √(J/(m g l))/AGM(1, cos θ₀/2), to the second order of the step.
#[test]
fn the_pendulum_swings_with_its_period() {
    let (mut a, mut g) = (1.0f64, 30f64.to_radians().cos());
    for _ in 0..8 {
        (a, g) = (0.5 * (a + g), (a * g).sqrt());
    }
    let period = TAU * (1.0f64 / (3.0 * 9.81 * 0.5)).sqrt() / a;
    let error = |step_s: f64| {
        let built = build(&text("scene_pendulum.toml")).unwrap();
        assert_labelled(&built);
        assert_eq!(built.system.mobility(), 1);
        let params = Params {
            rho_infinity: 1.0,
            ..Params::fixed(step_s)
        };
        let mut run = Simulation::new(built.system, params).unwrap();
        // It stands still on the other side after half a period: the spin changes its sign.
        let (mut half, mut last) = (0.0, 0.0);
        run.run(1.5, |step| {
            let spin = step.to.velocity[5];
            if last < 0.0 && spin >= 0.0 {
                half = step.to.time_s - step_s * spin / (spin - last);
                return ControlFlow::Break(());
            }
            last = spin;
            ControlFlow::Continue(())
        })
        .unwrap();
        2.0 * half / period - 1.0
    };
    let [coarse, fine] = [4e-3, 1e-3].map(error);
    // Seen: 2.4e-6 at a millisecond.
    assert!(
        (coarse / fine / 16.0 - 1.0).abs() < 0.1 && fine.abs() < 4e-6,
        "{coarse:e} {fine:e}"
    );
}

/// A spring between a body that turns and one whose speed nobody states is reported; speeds that are stated are not.
#[test]
fn a_body_that_a_spring_will_jerk_is_told() {
    let scene = |speed: &str| {
        let mut text =
            "title = \"t\"\n[run]\nkind = \"transient\"\nend_s = 0.01\n[solver]\nstep_s = 1e-4\n[output]\ninterval_s = 1e-3\n"
                .to_owned();
        for (name, speed) in [("motor", ""), ("wheel", speed)] {
            text += &format!(
                "[[body]]\nname = \"{name}\"\nmass_kg = 1.0\ninertia_kg_m2 = [1.0, 1.0, 1.0]\n{speed}\
                 [[joint]]\nname = \"{name} axis\"\nkind = \"revolute\"\nbody_2 = \"{name}\"\n"
            );
        }
        text + "[[motion]]\njoint = \"motor axis\"\nspeed_rpm = 600.0\n\
            [[torsion_spring]]\nname = \"coupling\"\nbody_1 = \"motor\"\nbody_2 = \"wheel\"\nstiffness_Nm_per_rad = 100.0\n"
    };
    let told = |speed: &str| {
        let built = build(&scene(speed)).unwrap_or_else(|e| panic!("{e:?}"));
        let words = "body `wheel` starts at rest, and torsion spring `coupling` joins it to `motor`, which starts with 600.000000 rpm";
        built.notes.iter().any(|note| note.starts_with(words))
    };
    assert!(told(""));
    assert!(!told("speed_rpm = 600.0\n") && !told("speed_rpm = 0.0\n"));
}

/// Speeds and angles that the scene leaves open: gear 2 turns at the ratio, and its teeth touch where the closed form
/// says.
#[test]
fn gears_start_touching_at_the_right_speeds() {
    let scene = changed(
        &text("scene_two_wheels.toml"),
        "gear_2 = \"wheel\"",
        "gear_2 = \"wheel\"\nmicrogeometry = false",
    );
    let built = build(&scene).unwrap();
    assert_labelled(&built);
    let speed = -600.0 * TAU / 60.0;
    assert!(
        (spin(&built, "pinion") - speed).abs() < 1e-12
            && (spin(&built, "wheel") + speed).abs() < 1e-12
    );
    assert!((built.meshes[0].frequency_hz - 570.0).abs() < 1e-9);
    assert!(
        built
            .notes
            .iter()
            .any(|note| note.contains("`wheel` starts with 600.000000 rpm")),
        "{:?}",
        built.notes
    );
    let gear = GearDefinition::read(&fe_models().join("gear1.toml"))
        .unwrap()
        .profile;
    let alpha = (2.0 * gear.base_radius_m / 0.15).acos();
    // Half the angle of a tooth on the working pitch circle; right flanks touch on the line of centres when gear 1's
    // tooth 0 stands turned back by it, and gear 2's space in front of it.
    let half = gear.base_half_angle_rad - involute::involute_function(alpha);
    let expected = PI + half + half;
    let found = body(&built, "wheel").orientation.scaled_axis();
    assert!(found[0].hypot(found[1]) < 1e-15);
    let pitch = TAU / 57.0;
    let off = (found[2] - expected).rem_euclid(pitch);
    assert!(off.min(pitch - off) < 1e-11, "{found:?} {expected}");
    // At any orientation of the whole scene, and with gear 1 turned: the least gap is zero.
    let turned = changed(
        &scene,
        "name = \"pinion\"\n",
        "name = \"pinion\"\ncardan_deg = [0.0, 0.0, 1.7]\n",
    );
    let built = build(&turned).unwrap();
    let found = body(&built, "wheel").orientation.scaled_axis()[2];
    let off = (found - expected + 1.7f64.to_radians()).rem_euclid(pitch);
    assert!(off.min(pitch - off) < 1e-11, "{found} {expected}");
}

/// Stated angles stay, and the plan says how the teeth stand.
#[test]
fn stated_angles_stay() {
    let scene = changed(
        &text("scene_two_wheels.toml"),
        "position_mm = [150.0, 0.0, 0.0]",
        "position_mm = [150.0, 0.0, 0.0]\ncardan_deg = [0.0, 0.0, 0.05]",
    );
    let scene = changed(
        &scene,
        "[[body]]\nname = \"pinion\"",
        "[[body]]\nname = \"pinion\"\ncardan_deg = [0.0, 0.0, 0.0]",
    );
    let built = build(&scene).unwrap();
    assert!(
        (body(&built, "wheel").orientation.scaled_axis()[2] - 0.05f64.to_radians()).abs() < 1e-15
    );
    assert!(
        built
            .notes
            .iter()
            .any(|note| note.contains("starts as the bodies stand")),
        "{:?}",
        built.notes
    );
}

/// A series of systems from one scene: other motions, other loads.
#[test]
fn systems_can_be_varied() {
    use gearmesh_dynamics::{Motion, TimeFunction};
    let loaded = load(&text("scene_two_wheels.toml"), &fe_models()).unwrap();
    let speed = Motion::Speed(TimeFunction::Constant(-5.0));
    let varied = loaded
        .build_varied(&Variation {
            motions: vec![("drive".to_string(), speed)],
            load_factor: 0.5,
        })
        .unwrap();
    assert!(
        (spin(&varied, "pinion") + 5.0).abs() < 1e-15
            && (spin(&varied, "wheel") - 5.0).abs() < 1e-15
    );
}

/// The mirror image of a scene, driven in the other sense on its left flanks, has the same transmission error: zero at
/// first touch, negative under load, without the backlash in it.
#[test]
fn a_mirrored_scene_has_the_same_transmission_error() {
    // Steps of 20 us do not follow the friction of this scene.
    let text = text("dynamics_25_30.toml");
    let (smooth, _) = text.split_once("[gear_mesh.teeth.friction]").unwrap();
    let right = changed(
        smooth,
        "torque_Nm = { step = { start_s = 0.0, from = 0.0, end_s = 0.1, to = -72.0 } }",
        "torque_Nm = -10.0",
    );
    let left = right
        .replace("speed_rpm = -600.0", "speed_rpm = 600.0")
        .replace("torque_Nm = -10.0", "torque_Nm = 10.0");
    assert_ne!(right, left);
    let curve = |scene: &str, side: &str| {
        let mut system = build(scene).unwrap().system;
        let mut run = Simulation::new(build(scene).unwrap().system, Params::fixed(2e-5)).unwrap();
        let mut found = Vec::new();
        run.run(8e-3, |step| {
            let outputs = Outputs::at(&mut system, step.to);
            assert!(
                found.len() < 100 || outputs.value("mesh", side) > 0.0,
                "{side}"
            );
            found.push(outputs.value("mesh", "transmission_error_m"));
            ControlFlow::Continue(())
        })
        .unwrap();
        found
    };
    let of_right = curve(&right, "normal_force_right_N");
    let of_left = curve(&left, "normal_force_left_N");
    assert_eq!(of_right.len(), of_left.len());
    let deepest = of_right.iter().fold(0.0, |least: f64, te| least.min(*te));
    assert!(deepest < -1e-7, "{deepest:e}");
    for (a, b) in of_right.iter().zip(&of_left) {
        assert!((a - b).abs() < 1e-4 * -deepest, "{a:e} {b:e}");
    }
}
