//! Planets on bearings: what they carry, at rest and with the centrifugal force of planets that go round.

use std::f64::consts::TAU;

use gearmesh_bearings::bearing_file::BearingFromFile;
use gearmesh_bearings::{AppliedBearingLoad, Operation, QuasiStaticBearing, TiltCondition};
use gearmesh_geometry::input::InputDocument;
use nalgebra::Vector2;

use super::positions::{ALPHA_DEG, unit};
use super::*;

const ROLLERS: &str = "name = \"rollers\"\nkind = \"deep-groove\"\nballs = 9\nball_diameter_mm = 9.0\npitch_diameter_mm = 40.0\ninner_conformity = 0.52\nouter_conformity = 0.53\n";
/// Carrier's torque \[N m\].
const TORQUE_NM: f64 = 600.0;

fn floating(run: &str, sun: &str, bearing: &str) -> String {
    let carrier = format!(
        "inertia_kg_m2 = [0.1, 0.1, 0.1]\ntorque_Nm = {:?}",
        -TORQUE_NM
    );
    let planets =
        format!("count = 3\nsupport = \"floating\"\nbearings = [{{ model = {{ {bearing} }} }}]");
    scene(
        run,
        90.0,
        [sun, "support = \"held\"", &carrier, &planets, ""],
    )
}

/// Force of the planet's bearing on it, in directions out and on, in a row.
fn in_carrier(result: &SystemResult, planet: usize, row: usize) -> Vector2<f64> {
    let read = |name: &str| result.rows.read(name).unwrap()[row];
    let psi = TAU * (planet - 1) as f64 / 3.0 + read("bodies/set carrier/turn_rad");
    let force = ["x", "y"].map(|axis| {
        read(&format!(
            "elements/set planet {planet} bearing 1/force_world_{axis}_N"
        ))
    });
    let (force, out) = (Vector2::from(force), unit(psi));
    Vector2::new(force.dot(&out), force.dot(&Vector2::new(-out.y, out.x)))
}

/// Planets with play on cylindrical rollers stand loose between sun, ring and pins, from where Newton's method goes to
/// and fro between states of contact: the equilibrium is found all the same, and each pin carries its third.
#[test]
fn planets_with_play_on_rollers_find_their_equilibrium() {
    let folder = tempfile::tempdir().unwrap();
    let (ring, wide) = (
        "-75\naddendum = 0.8",
        "kind = \"ring\"\nouter_diameter_mm = 182.0",
    );
    let solid = "kind = \"solid\"\nbore_diameter_mm = 20.0";
    for (name, teeth, blank) in [
        ("sun", "27", solid),
        ("planet", "24", solid),
        ("ring", ring, wide),
    ] {
        let text = format!(
            "name = \"{name}\"\n[tooth]\nteeth = {teeth}\nmodule_mm = 2.0\nthickness_allowance_mm = 0.05\nface_width_mm = 25.0\n[blank]\n{blank}\n\
             [material]\nyoung_GPa = 206.0\npoisson = 0.3\ndensity_kg_per_m3 = 7850.0\n"
        );
        std::fs::write(folder.path().join(format!("{name}.toml")), text).unwrap();
    }
    let rollers = "name = \"rollers\"\nkind = \"cylindrical-roller\"\nrollers = 12\nroller_diameter_mm = 5.0\nroller_length_mm = 12.0\n\
                   pitch_diameter_mm = 20.0\nradial_clearance_um = 10.0\n";
    std::fs::write(folder.path().join("rollers.toml"), rollers).unwrap();
    let carrier = "inertia_kg_m2 = [6e-3, 6e-3, 9e-3]\ntorque_Nm = -400.0";
    let planets = "count = 3\nsupport = \"floating\"\nbearings = [{ model = { kind = \"quasi-static\", file = \"rollers.toml\" } }]";
    let text = scene(
        "kind = \"static\"\nmotion = \"set sun speed\"\nangles_deg = [0.0]",
        51.0,
        [
            "speed_rpm = 600.0",
            "support = \"held\"",
            carrier,
            planets,
            "",
        ],
    )
    .replace("stiffness_N_per_mm_um = 20.0", "stiffness_amplitude = 0.1");
    // Without what holds them along their pins no equilibrium was found, after half a minute.
    let refused = build_in(&text.replace("support = \"floating\"\n", ""), folder.path());
    let message = refused.map(|_| ()).unwrap_err().to_string();
    assert!(
        message.contains("nothing else holds `set planet 1` there"),
        "{message}"
    );
    let result = run(&text, folder.path());
    for planet in 1..=3 {
        let force = in_carrier(&result, planet, 0);
        let pins_n = 400.0 / 3.0 / 0.051;
        // Places of the planets beside their own, some 20 um on 51 mm, are left out.
        assert!(
            (force.y / -pins_n - 1.0).abs() < 1e-3 && force.x.abs() < 1e-3 * pins_n,
            "{force}"
        );
    }
}

/// At rest a quasi-static bearing carries both mesh forces, 2 F cos α against the turn; its ring stands where the
/// bearing alone has it under that force; and a linear bearing of the same force over displacement leaves sun and
/// carrier where it does.
#[test]
fn a_quasi_static_planet_bearing_carries_both_mesh_forces() {
    let folder = tempfile::tempdir().unwrap();
    write_gears(folder.path(), [24, 36], ALPHA_DEG);
    std::fs::write(folder.path().join("rollers.toml"), ROLLERS).unwrap();
    let pins_n = TORQUE_NM / 3.0 / 0.09;
    let text = floating(
        "kind = \"static\"",
        "speed_rpm = 0.0",
        "kind = \"quasi-static\", file = \"rollers.toml\"",
    );
    let built = build_in(&text, folder.path()).unwrap();
    let result = run(&text, folder.path());
    let read = |result: &SystemResult, name: &str| result.rows.read(name).unwrap()[0];
    let document = InputDocument::new("rollers.toml", ROLLERS);
    let definition = BearingFromFile::from_document(&document)
        .unwrap()
        .definition;
    let alone = QuasiStaticBearing::new(&definition).unwrap();
    let turn = read(&result, "bodies/set carrier/turn_rad");
    let mut stiffness = 0.0;
    for planet in 1..=3 {
        let force = in_carrier(&result, planet, 0);
        // The place of the planet, some 20 um beside its own on 90 mm, is left out.
        assert!(
            (force.y / -pins_n - 1.0).abs() < 1e-3 && force.x.abs() < 1e-3 * pins_n,
            "{force}"
        );
        // Axes of the bearing are those of the planet at the start, on the carrier.
        let start = crate::body(&built, &format!("set planet {planet}"));
        let axes = nalgebra::Rotation2::new(-turn - start.orientation.scaled_axis().z);
        let of = |columns: [String; 2]| Vector2::from(columns.map(|column| read(&result, &column)));
        let place = of(["x", "y"].map(|axis| format!("bodies/set planet {planet}/{axis}_m")));
        let moved = axes * (place - nalgebra::Rotation2::new(turn) * start.position_m.xy());
        let bearing = format!("elements/set planet {planet} bearing 1");
        let load = axes * -of(["x", "y"].map(|axis| format!("{bearing}/force_world_{axis}_N")));
        let applied = AppliedBearingLoad {
            force_n: [load.x, load.y, 0.0],
            tilt: TiltCondition::Held([0.0; 2]),
        };
        let pose = alone.equilibrium(&applied, &Operation::default()).unwrap();
        let apart = (moved - pose.centre_m.xy()).norm() / moved.norm();
        assert!(apart < 1e-3, "{planet}: {apart} {moved} {}", pose.centre_m);
        stiffness += load.norm() / moved.norm() / 3.0;
    }
    let linear = format!(
        "kind = \"linear\", radial_stiffness_N_per_mm = {:?}",
        1e-3 * stiffness
    );
    let linear = run(
        &floating("kind = \"static\"", "speed_rpm = 0.0", &linear),
        folder.path(),
    );
    let other = read(&linear, "bodies/set carrier/turn_rad");
    // Balls stand otherwise about each planet's load: the mean stiffness is within a percent of each.
    assert!((other / turn - 1.0).abs() < 1e-2, "{other} {turn}");
}

/// In motion the centrifugal force m ω² a comes to it, outwards: planets of 10 500 rpm of the sun.
#[test]
fn planet_bearings_carry_the_centrifugal_force() {
    let folder = tempfile::tempdir().unwrap();
    write_gears(folder.path(), [24, 36], ALPHA_DEG);
    std::fs::write(folder.path().join("rollers.toml"), ROLLERS).unwrap();
    let in_time = "kind = \"transient\"\nend_s = 0.02\n[solver]\nstep_s = 2e-5\nstart = \"equilibrium\"\n[output]\ninterval_s = 1e-4";
    for bearing in [
        "kind = \"linear\", radial_stiffness_N_per_mm = 1e5, radial_damping_N_s_per_mm = 20.0",
        "kind = \"quasi-static\", file = \"rollers.toml\", radial_damping_N_s_per_mm = 20.0",
    ] {
        let text = floating(in_time, "speed_rpm = 10500.0", bearing).replace(
            "stiffness_N_per_mm_um = 20.0",
            "stiffness_N_per_mm_um = 20.0, damping = { kind = \"stiffness-proportional\", time_s = 2e-5, full_depth_um = 1.0 }",
        );
        let built = build_in(&text, folder.path()).unwrap();
        let result = run(&text, folder.path());
        let rows = result.rows.read("time_s").unwrap().len();
        let omega = 10500.0 / 5.0 * TAU / 60.0;
        for planet in 1..=3 {
            let mass = crate::body(&built, &format!("set planet {planet}")).mass_kg;
            let own = mass * omega * omega * 0.09;
            let settled = rows / 2..rows;
            let mean = settled
                .clone()
                .map(|row| in_carrier(&result, planet, row))
                .sum::<Vector2<f64>>()
                / settled.len() as f64;
            assert!(own > 1000.0, "{own}");
            assert!(
                (mean.x / -own - 1.0).abs() < 0.01,
                "{bearing}: {mean} {own}"
            );
            let pins_n = TORQUE_NM / 3.0 / 0.09;
            assert!(
                (mean.y / -pins_n - 1.0).abs() < 0.01,
                "{bearing}: {mean} {pins_n}"
            );
        }
    }
}
