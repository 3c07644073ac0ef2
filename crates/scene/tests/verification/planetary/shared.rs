//! Two sets that share members by `body`: speeds and torques as of the whole.

use std::f64::consts::TAU;

use super::*;

/// The table of the second of two sets, 100 mm above the first, and called `second`.
fn second(distance_mm: f64, parts: [&str; 5]) -> String {
    let text = scene("", distance_mm, parts);
    let (_, table) = text.split_once("[[planetary]]").unwrap();
    format!("[[planetary]]{}", table.replace("\"set\"", "\"second\""))
}

/// Simpson's train: suns of two sets of 24/36/96 teeth on one shaft, the first carrier on the second ring, the second
/// carrier held. ω_s + 4 ω_in = 5 ω_out and ω_s + 4 ω_out = 0: out over in 4/9; so the torques, and the held carrier
/// takes the rest.
#[test]
fn two_sets_on_one_sun_shaft_are_simpsons_train() {
    let folder = tempfile::tempdir().unwrap();
    write_gears(folder.path(), [24, 36], 20.0);
    let inertia = "inertia_kg_m2 = [0.1, 0.1, 0.1]";
    let coupled = |run: &str, driven: &str| {
        let carrier = format!("{inertia}\ntorque_Nm = -90.0");
        let first = scene(run, 90.0, ["", driven, &carrier, "count = 3", ""]);
        let held = format!("{inertia}\nsupport = \"held\"");
        let free = "support = \"free\"";
        let place = "position_mm = [0.0, 0.0, 100.0]\nsun_torque = \"negative\"";
        let other = second(90.0, [free, free, &held, "count = 4", place]);
        let joint = |one: &str, two: &str| {
            format!(
                "[[joint]]\nname = \"{one} on {two}\"\nkind = \"fixed\"\nbody_1 = \"{one}\"\nbody_2 = \"{two}\"\n"
            )
        };
        let joints = joint("set carrier", "second ring") + &joint("set sun", "second sun");
        format!("{first}{other}{joints}")
    };
    let in_time =
        "kind = \"transient\"\nend_s = 0.01\n[solver]\nstep_s = 1e-5\n[output]\ninterval_s = 1e-3";
    let built = build_in(&coupled(in_time, "speed_rpm = 90.0"), folder.path()).unwrap();
    for (part, expected_rpm) in [
        ("set carrier", 40.0),
        ("second sun", -160.0),
        ("set sun", -160.0),
        ("second ring", 40.0),
    ] {
        let found = crate::spin(&built, part) * 60.0 / TAU;
        assert!((found - expected_rpm).abs() < 1e-9, "{part}: {found}");
    }
    let kind = "kind = \"static\"\nmotion = \"set ring speed\"\nangles_deg = [0.0, 1.3, 7.0]";
    let result = run(&coupled(kind, "speed_rpm = 0.0"), folder.path());
    let read = |name: &str| result.rows.read(name).unwrap();
    // Ring and first sun 40 and 10 N m, carrier −50 and with the second ring's 40 the 90 of the load.
    for (joint, expected) in [("second carrier axis", 50.0), ("set ring speed", 40.0)] {
        for found in read(&format!("joints/{joint}/moment_z_Nm")) {
            assert!((found / expected - 1.0).abs() < 1e-6, "{joint}: {found}");
        }
    }
    for (set, planets, torque) in [("set", 3, -10.0), ("second", 4, 10.0)] {
        for n in 1..=planets {
            for found in read(&format!("elements/{set} sun-planet {n}/moment_1_Nm")) {
                assert!(
                    (found * f64::from(planets) / torque - 1.0).abs() < 1e-6,
                    "{set} {n}: {found}"
                );
            }
        }
    }
    assert_eq!(result.sets().unwrap().len(), 2);
}

/// One carrier for a set of 24/36/96 and one of 30/30/90 teeth whose suns and rings differ: the first ring and the
/// second sun are held, ω_r2 = 4/3 ω_c = 4/15 ω_s1, and torques are as the speeds.
#[test]
fn two_sets_on_one_carrier() {
    let folder = tempfile::tempdir().unwrap();
    write_gears(folder.path(), [24, 36], 20.0);
    let others = folder.path().join("other");
    std::fs::create_dir(&others).unwrap();
    write_gears(&others, [30, 30], 20.0);
    let text = |run: &str, driven: &str| {
        let first = scene(
            run,
            90.0,
            [
                driven,
                "support = \"held\"",
                "inertia_kg_m2 = [0.1, 0.1, 0.1]",
                "count = 3",
                "",
            ],
        );
        let other = second(
            90.0,
            [
                "support = \"held\"",
                "torque_Nm = -150.0",
                "body = \"set carrier\"",
                "count = 3",
                "position_mm = [0.0, 0.0, 100.0]",
            ],
        );
        let other = changed(&other, "mass_kg = 5.43\n", "");
        first
            + &["sun", "ring", "planet"].iter().fold(other, |text, gear| {
                changed(
                    &text,
                    &format!("\"{gear}.toml\""),
                    &format!("\"other/{gear}.toml\""),
                )
            })
    };
    let in_time =
        "kind = \"transient\"\nend_s = 0.01\n[solver]\nstep_s = 1e-5\n[output]\ninterval_s = 1e-3";
    let built = build_in(&text(in_time, "speed_rpm = 150.0"), folder.path()).unwrap();
    let found = crate::spin(&built, "second ring") * 60.0 / TAU;
    assert!((found - 40.0).abs() < 1e-9, "{found}");
    let kind = "kind = \"static\"\nmotion = \"set sun speed\"\nangles_deg = [0.0, 2.3, 250.0]";
    let result = run(&text(kind, "speed_rpm = 0.0"), folder.path());
    let read = |name: &str| result.rows.read(name).unwrap();
    // 150 N m on the second ring: 40 N m at the first sun; the ring that is held takes 4 times that, the second sun 50.
    for (joint, expected) in [
        ("set sun speed", 40.0),
        ("set ring axis", 160.0),
        ("second sun axis", -50.0),
    ] {
        for found in read(&format!("joints/{joint}/moment_z_Nm")) {
            assert!((found / expected - 1.0).abs() < 1e-6, "{joint}: {found}");
        }
    }
}
