//! Stepped planets: speeds, torques, forces of both meshes and of the pin, places and phases.

use std::f64::consts::{PI, TAU};

use super::positions::{ALPHA_DEG, unit};
use super::*;

/// Sun 24, planets 36 and 24 teeth, ring 84, all of module 3 on 90 mm: i = −24·24/(36·84); the second gear 40 mm above.
const TEETH: [f64; 4] = [24.0, 36.0, 24.0, 84.0];
const SECOND: &str = "second = { gear = \"second.toml\", z_mm = 40.0 }";

fn write_stepped(folder: &Path) {
    write_gears(folder, [36, 24], ALPHA_DEG);
    std::fs::rename(folder.join("planet.toml"), folder.join("second.toml")).unwrap();
    let own = std::fs::read_to_string(folder.join("sun.toml")).unwrap();
    std::fs::write(
        folder.join("planet.toml"),
        own.replace("\"sun\"", "\"planet\""),
    )
    .unwrap();
    let sun = own.replace("teeth = 36", "teeth = 24");
    std::fs::write(folder.join("sun.toml"), sun).unwrap();
}

fn carrier_held_ratio() -> f64 {
    -TEETH[0] * TEETH[2] / (TEETH[1] * TEETH[3])
}

/// Willis' equation with the ratio of both steps, whichever member stands.
#[test]
fn speeds_of_stepped_planets_follow_willis() {
    let folder = tempfile::tempdir().unwrap();
    write_stepped(folder.path());
    let run =
        "kind = \"transient\"\nend_s = 0.01\n[solver]\nstep_s = 1e-5\n[output]\ninterval_s = 1e-3";
    let held = "support = \"held\"";
    for keys in [
        ["speed_rpm = 500.0", held, ""],
        [held, "", "speed_rpm = 100.0"],
        ["speed_rpm = 500.0", "", held],
    ] {
        let carrier = format!("inertia_kg_m2 = [0.1, 0.1, 0.1]\n{}", keys[2]);
        let planets = format!("count = 4\n{SECOND}");
        let text = scene(run, 90.0, [keys[0], keys[1], &carrier, &planets, ""]);
        let built = build_in(&text, folder.path()).unwrap();
        let [sun, ring, carrier, planet, second] =
            ["sun", "ring", "carrier", "planet 2", "planet 2 second"]
                .map(|part| crate::spin(&built, &format!("set {part}")));
        let off = (ring - carrier) - carrier_held_ratio() * (sun - carrier);
        assert!(off.abs() < 1e-9, "{keys:?}: {off}");
        let of_planet = carrier - TEETH[0] / TEETH[1] * (sun - carrier);
        assert!((planet - of_planet).abs() < 1e-9 && (second - of_planet).abs() < 1e-9);
        // Something turns.
        assert!(sun.abs() + carrier.abs() > 10.0);
    }
}

/// At rest all planets carry the same (their phases fit), sun and ring mesh as F_s z_1 = F_r z_2, and the pin what is
/// left of both with their moment. Planets are one part: the step between their gears is the same but for teeth that
/// are alike, 2π/72.
#[test]
fn forces_of_stepped_planets_are_in_equilibrium() {
    let folder = tempfile::tempdir().unwrap();
    write_stepped(folder.path());
    let (cos, base_m) = (ALPHA_DEG.to_radians().cos(), 36e-3);
    let torque_nm = 400.0;
    for planets in [3_usize, 4] {
        let kind =
            "kind = \"static\"\nmotion = \"set sun speed\"\nangles_deg = [0.0, 3.1, 100.0, 481.7]";
        let sun_nm = torque_nm / (1.0 - 1.0 / carrier_held_ratio());
        let carrier = format!(
            "inertia_kg_m2 = [0.1, 0.1, 0.1]\ntorque_Nm = {:?}",
            -torque_nm
        );
        let count = format!("count = {planets}\n{SECOND}");
        let parts = [
            "speed_rpm = 0.0",
            "support = \"held\"",
            &carrier,
            &count,
            "",
        ];
        let text = scene(kind, 90.0, parts);
        let built = build_in(&text, folder.path()).unwrap();
        let result = run(&text, folder.path());
        let angle = |name: String| crate::body(&built, &name).orientation.scaled_axis().z;
        let read = |name: &str| result.rows.read(name).unwrap();
        let force = sun_nm / (planets as f64 * base_m * cos);
        let at_ring = force * TEETH[1] / TEETH[2];
        let carrier_turns = read("bodies/set carrier/turn_rad");
        for (row, carrier_rad) in carrier_turns.iter().enumerate() {
            for n in 1..=planets {
                let found = read(&format!("elements/set sun-planet {n}/normal_force_left_N"))[row];
                assert!(
                    (found / force - 1.0).abs() < 1e-6,
                    "{n} {row}: {found} {force}"
                );
                let found = read(&format!(
                    "elements/set planet {n}-ring/normal_force_right_N"
                ))[row];
                assert!(
                    (found / at_ring - 1.0).abs() < 1e-6,
                    "{n} {row}: {found} {at_ring}"
                );
                let out = unit(TAU * (n - 1) as f64 / planets as f64 + carrier_rad);
                let on = nalgebra::Vector2::new(-out.y, out.x);
                let sin = ALPHA_DEG.to_radians().sin();
                let from_sun = force * (cos * on + sin * out);
                let from_ring = at_ring * (cos * on - sin * out);
                let pin = |part: &str| read(&format!("joints/set planet {n} pin/{part}"))[row];
                let found = ["x", "y"].map(|axis| pin(&format!("force_world_{axis}_N")));
                let rest = nalgebra::Vector2::from(found) + from_sun + from_ring;
                assert!(rest.norm() < 1e-6 * at_ring, "{n} {row}: {rest}");
                // e_z × F at 40 mm, in the axes of the marker on the carrier, which are the planet's at the start.
                let moment = 40e-3 * nalgebra::Vector2::new(-from_ring.y, from_ring.x);
                let turned =
                    nalgebra::Rotation2::new(-carrier_rad - angle(format!("set planet {n}")))
                        * moment;
                let found = ["x", "y"].map(|axis| pin(&format!("moment_{axis}_Nm")));
                let rest = nalgebra::Vector2::from(found) + turned;
                assert!(rest.norm() < 1e-6 * moment.norm(), "{n} {row}: {rest}");
            }
            let ring = read("joints/set ring axis/moment_z_Nm")[row];
            assert!((ring / (torque_nm - sun_nm) - 1.0).abs() < 1e-6, "{ring}");
        }
        let step =
            |n: usize| angle(format!("set planet {n} second")) - angle(format!("set planet {n}"));
        for n in 2..=planets {
            let pitches = (step(n) - step(1)) / (TAU / 72.0);
            assert!(
                (pitches - pitches.round()).abs() < 1e-6,
                "{planets}: {pitches}"
            );
        }
    }
}

/// 300 places around, of which a planet stands at each 72nd of the ring's or sun's pitch only: between them it does not
/// fit, and the places are named.
#[test]
fn stepped_planets_stand_where_both_gears_fit() {
    let folder = tempfile::tempdir().unwrap();
    write_stepped(folder.path());
    let built = |angle_deg: f64| {
        let planets = format!("angles_deg = [0.0, {angle_deg:?}]\n{SECOND}");
        let carrier = "inertia_kg_m2 = [0.1, 0.1, 0.1]\ntorque_Nm = -5.0";
        let parts = ["", "support = \"held\"", carrier, &planets, ""];
        build_in(&scene("kind = \"static\"", 90.0, parts), folder.path())
    };
    for k in 97..100 {
        assert!(built(1.2 * f64::from(k)).is_ok(), "{k}");
        let refusal = built(1.2 * (f64::from(k) + 0.5)).err().unwrap().to_string();
        assert!(refusal.contains("360/300 deg"), "{refusal}");
    }
    // By hand: a planet that the sun turns as it is taken round by ψ fits the ring where its second gear is beside a
    // tooth space by a common pitch of both gears.
    let fits = |psi: f64| {
        let off = psi * (TEETH[0] / TEETH[1] + TEETH[3] / TEETH[2]);
        let pitches = off / (PI / 36.0);
        (pitches - pitches.round()).abs() < 1e-9
    };
    let places = (0..3600)
        .filter(|k| fits(TAU * f64::from(*k) / 3600.0))
        .count();
    assert_eq!(places, 300);
}
