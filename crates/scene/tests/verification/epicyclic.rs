//! Gears on axes that a carrier takes round, against Willis' equation: z_s (ω_s − ω_c) + z_p (ω_p − ω_c) = 0.

use std::f64::consts::TAU;

use gearmesh_scene::system_run::{RunJob, SystemResult};

use crate::common::*;
use crate::spin;
use crate::system_runs::Desk;

const RPM: f64 = TAU / 60.0;
/// Centre distance \[m\].
const ARM: f64 = 55.05e-3;
/// Teeth of sun and planet.
const TEETH: [f64; 2] = [25.0, 30.0];

/// A sun and one planet on a carrier; `mesh` says how they touch, `more` what drives them.
fn scene(mesh: &str, more: &str) -> String {
    format!(
        r#"title = "Sun and planet"
[run]
kind = "transient"
end_s = 0.05
[solver]
step_s = 1e-5
newton_tolerance = 1e-12
[output]
interval_s = 1e-4
[[body]]
name = "carrier"
mass_kg = 1.0
inertia_kg_m2 = [1e-3, 1e-3, 2e-3]
[[body]]
name = "sun"
gear = "pinion_25_m2.toml"
[[body]]
name = "planet"
gear = "wheel_30_m2.toml"
position_mm = [55.05, 0.0, 0.0]
[[joint]]
name = "carrier axis"
kind = "revolute"
body_2 = "carrier"
[[joint]]
name = "sun axis"
kind = "revolute"
body_2 = "sun"
[[joint]]
name = "pin"
kind = "revolute"
body_1 = "carrier"
body_2 = "planet"
[[gear_mesh]]
name = "mesh"
gear_1 = "sun"
gear_2 = "planet"
{mesh}
{more}"#
    )
}

const KINEMATIC: &str = "model.kind = \"kinematic\"";
const IMPACT: &str = "model.kind = \"impact\"\nmodel.stiffness_N_per_mm_e = 1e6\nmodel.exponent = 1.5\nmodel.damping_N_s_per_mm = 100.0\nmodel.full_damping_depth_um = 5.0";

fn motion(joint: &str, speed_rpm: f64) -> String {
    format!("[[motion]]\njoint = \"{joint}\"\nspeed_rpm = {speed_rpm:?}\n")
}

/// Willis' equation for the planet's speed.
fn planet(sun: f64, carrier: f64) -> f64 {
    carrier - (sun - carrier) * TEETH[0] / TEETH[1]
}

fn run(scene: &str) -> SystemResult {
    Desk::new().run(RunJob::from_scene(load(scene, &fe_models()).unwrap()).unwrap())
}

/// Speeds that nobody states follow on a turning carrier, whichever two of the three are known; the mesh frequency is
/// that of the sun against the carrier.
#[test]
fn speeds_and_mesh_frequency_are_those_against_the_carrier() {
    for (more, [sun, carrier]) in [
        (
            motion("sun axis", -600.0) + &motion("carrier axis", 100.0),
            [-600.0, 100.0],
        ),
        (
            motion("sun axis", 0.0) + &motion("carrier axis", 100.0),
            [0.0, 100.0],
        ),
        // The planet turns at 60 rpm against the carrier.
        (
            motion("pin", 60.0) + &motion("carrier axis", -90.0),
            [-90.0 - 60.0 * 1.2, -90.0],
        ),
        // Nobody drives the carrier: it stands.
        (motion("sun axis", -600.0), [-600.0, 0.0]),
    ] {
        for mesh in [KINEMATIC, IMPACT] {
            let built = build(&scene(mesh, &more)).unwrap();
            for (name, expected) in [
                ("sun", sun),
                ("carrier", carrier),
                ("planet", planet(sun, carrier)),
            ] {
                let found = spin(&built, name) / RPM;
                assert!(
                    (found - expected).abs() < 1e-9,
                    "{name}: {found}, {expected} rpm"
                );
            }
            let velocity = crate::body(&built, "planet").velocity_m_per_s;
            assert!((velocity[1] - carrier * RPM * ARM).abs() < 1e-12 && velocity[0].abs() < 1e-12);
            let expected = TEETH[0] * (sun - carrier).abs() / 60.0;
            let found = built.meshes[0].frequency_hz;
            assert!((found - expected).abs() < 1e-9, "{found} {expected}");
        }
    }
}

/// An ideal ratio holds on the moving axes over more than one turn of every part, and its reaction balances powers:
/// with a torque T on the planet, T z_s/z_p on the sun's drive and −T (1 + z_s/z_p) on the carrier's.
#[test]
fn a_kinematic_planet_obeys_willis() {
    let torque = 3.0;
    let (sun, carrier) = (-2400.0, 1500.0);
    let load = format!("[[load]]\nbody = \"planet\"\ntorque_Nm = {torque:?}\n");
    let drives = motion("sun axis", sun) + &motion("carrier axis", carrier);
    let result = run(&scene(KINEMATIC, &(load + &drives)));
    let read = |name: &str| result.rows.read(name).unwrap();
    let times = read("time_s");
    let turns = read("bodies/planet/turn_rad");
    let (x, y) = (read("bodies/planet/x_m"), read("bodies/planet/y_m"));
    for (k, time) in times.iter().enumerate() {
        let expected = planet(sun, carrier) * RPM * time;
        assert!(
            (turns[k] - expected).abs() < 1e-7 * expected.abs().max(1.0),
            "{} {expected}",
            turns[k]
        );
        let (sin, cos) = (carrier * RPM * time).sin_cos();
        assert!((x[k] - ARM * cos).abs() < 1e-8 && (y[k] - ARM * sin).abs() < 1e-8);
    }
    assert!(turns.last().unwrap().abs() > TAU);
    // The first rows hold the start of the integrator.
    let mean = |name: &str| {
        let values = &read(name)[100..];
        values.iter().sum::<f64>() / values.len() as f64
    };
    let ratio = TEETH[0] / TEETH[1];
    for (joint, expected) in [
        ("motion of sun axis", torque * ratio),
        ("motion of carrier axis", -torque * (1.0 + ratio)),
    ] {
        let found = mean(&format!("joints/{joint}/moment_z_Nm"));
        assert!(
            (found - expected).abs() < 1e-5 * torque,
            "{joint}: {found} {expected}"
        );
    }
}

/// Teeth on a moving carrier: the planet's mean speed is that of the ratio, and the start is no shock.
#[test]
fn a_planet_with_teeth_runs_at_willis_speed() {
    let (sun, carrier) = (-600.0, 100.0);
    let drives = motion("sun axis", sun) + &motion("carrier axis", carrier);
    let load = "[[load]]\nbody = \"planet\"\ntorque_Nm = -5.0\n";
    let result = run(&scene(IMPACT, &format!("{load}{drives}")));
    let turn = *result
        .rows
        .read("bodies/planet/turn_rad")
        .unwrap()
        .last()
        .unwrap();
    let expected = planet(sun, carrier) * RPM * 0.05;
    assert!((turn - expected).abs() < 1e-3, "{turn} {expected}");
    let apart = result.rows.read("elements/mesh/apart").unwrap();
    assert!(apart.iter().all(|&mark| mark == 0.0));
    let forces = result
        .rows
        .read("elements/mesh/normal_force_right_N")
        .unwrap();
    let mean = forces[200..].iter().sum::<f64>() / (forces.len() - 200) as f64;
    let base = 15.0 * 2e-3 * 20f64.to_radians().cos();
    assert!((mean * base / 5.0 - 1.0).abs() < 0.02, "{mean}");
}

/// Speeds on both gears that miss the ratio would be overridden: they are refused, with the speed that fits.
#[test]
fn speeds_that_miss_a_kinematic_ratio_are_refused() {
    let text = scene(KINEMATIC, &motion("carrier axis", 100.0));
    let stated = |name: &str, text: &str, rpm: f64| {
        changed(
            text,
            &format!("name = \"{name}\"\ngear"),
            &format!("name = \"{name}\"\nspeed_rpm = {rpm:?}\ngear"),
        )
    };
    let wrong = stated("planet", &stated("sun", &text, -600.0), 500.0);
    let complaint = build(&wrong).err().unwrap().to_string();
    for part in [
        &format!("scene.toml:{}: ", line_of(&wrong, "gear_2"))[..],
        "`planet` turns at 500.000000 rpm",
        "`sun` at -600.000000 rpm and the line of centres at 100.000000 rpm",
        "asks for 683.333333 rpm",
    ] {
        assert!(complaint.contains(part), "`{part}` is not in {complaint}");
    }
    build(&stated("planet", &stated("sun", &text, -600.0), 683.333333)).unwrap();
}

/// What a reader of the result sees of the mesh is counted against the carrier, as before the run: the sun passes
/// z_s |ω_s − ω_c|/2π teeth a second, and the planet makes its revolutions in the carrier.
#[test]
fn passed_teeth_of_a_result_are_counted_against_the_carrier() {
    let (sun, carrier) = (-2400.0, 1500.0);
    let drives = motion("sun axis", sun) + &motion("carrier axis", carrier);
    let result = run(&scene(KINEMATIC, &drives));
    let passing = &result.mesh_passings().unwrap()[0];
    let expected = TEETH[0] * (carrier - sun) / 60.0;
    // The first rows hold the start of the integrator; the carrier's turn is summed over rows.
    assert!(
        (passing.frequency_hz / expected - 1.0).abs() < 1e-6,
        "{}",
        passing.frequency_hz
    );
    for (gear, (teeth, found)) in TEETH.into_iter().zip(passing.revolutions).enumerate() {
        let turns = expected / teeth * 0.05;
        assert!((found / turns - 1.0).abs() < 1e-6, "{found} {turns}");
        assert!(
            passing.is_whole(gear + 1)
                && !passing.leaves_incomplete("elements/mesh/strain_gear1_root")
        );
    }
    let drives = motion("sun axis", -600.0) + &motion("carrier axis", 0.0);
    let result = run(&scene(KINEMATIC, &drives));
    let passing = &result.mesh_passings().unwrap()[0];
    assert!(passing.leaves_incomplete("elements/mesh/strain_gear2_root_method1_ustrain"));
    assert!(!passing.leaves_incomplete("elements/mesh/transmission_error_m"));
    assert!(
        passing
            .in_words()
            .contains("0.417 of `planet`; less than a revolution of `sun` and `planet`")
    );
}
