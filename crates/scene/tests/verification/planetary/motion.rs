//! Sets in motion: speeds at the start, energy, reversal of the torque, many planets.

use std::f64::consts::TAU;

use super::*;

/// Speeds at the start follow from any two of sun, ring and carrier, through two sets in series, too: Willis' equation.
#[test]
fn speeds_follow_from_any_two_members() {
    let folder = tempfile::tempdir().unwrap();
    write_gears(folder.path(), [24, 36], 20.0);
    let inertia = "inertia_kg_m2 = [0.1, 0.1, 0.1]";
    let run =
        "kind = \"transient\"\nend_s = 0.01\n[solver]\nstep_s = 1e-5\n[output]\ninterval_s = 1e-3";
    // z_r/z_s = 4: ω_s + 4 ω_r = 5 ω_c.
    for ([sun, ring, carrier], expected) in [
        (
            ["speed_rpm = 500.0", "support = \"held\"", ""],
            [500.0, 0.0, 100.0],
        ),
        (
            ["", "support = \"held\"", "speed_rpm = -100.0"],
            [-500.0, 0.0, -100.0],
        ),
        (
            ["support = \"held\"", "speed_rpm = 100.0", ""],
            [0.0, 100.0, 80.0],
        ),
        (
            ["speed_rpm = 400.0", "", "support = \"held\""],
            [400.0, -100.0, 0.0],
        ),
        (
            [
                "support = \"floating\"\nspeed_rpm = 300.0",
                "speed_rpm = 50.0",
                "",
            ],
            [300.0, 50.0, 100.0],
        ),
    ] {
        let carrier = format!("{inertia}\n{carrier}");
        let text = scene(run, 90.0, [sun, ring, &carrier, "count = 3", ""]);
        let built = build_in(&text, folder.path()).unwrap();
        for (member, expected) in ["sun", "ring", "carrier"].into_iter().zip(expected) {
            let found = crate::spin(&built, &format!("set {member}")) * 60.0 / TAU;
            assert!(
                (found - expected).abs() < 1e-9,
                "{member}: {found} {expected} in {text}"
            );
        }
    }
    let first = scene(
        run,
        90.0,
        [
            "speed_rpm = 500.0",
            "support = \"held\"",
            inertia,
            "count = 3",
            "",
        ],
    );
    let second = scene(
        "",
        90.0,
        [
            "",
            "support = \"held\"",
            &format!("{inertia}\ntorque_Nm = -50.0"),
            "count = 4",
            "position_mm = [0.0, 0.0, 100.0]",
        ],
    );
    let second = second
        .split_once("[[planetary]]")
        .unwrap()
        .1
        .replace("\"set\"", "\"second\"");
    let joined = format!(
        "{first}[[planetary]]{second}[[joint]]\nname = \"coupling\"\nkind = \"fixed\"\nbody_1 = \"set carrier\"\nbody_2 = \"second sun\"\n"
    );
    let joined = joined.replacen(
        "gear = \"sun.toml\"\n\n[planetary.ring]",
        "gear = \"sun.toml\"\nsupport = \"free\"\n[planetary.ring]",
        1,
    );
    let built = build_in(&joined, folder.path()).unwrap();
    let found = crate::spin(&built, "second carrier") * 60.0 / TAU;
    assert!((found - 20.0).abs() < 1e-9, "{found}");
}

/// In time: from an equilibrium with all planets in contact, energy balances, the ratio is kept, and a torque that
/// turns round goes through the backlash of all planets at once; each at two steps.
#[test]
fn a_set_in_time_balances_its_energy() {
    let folder = tempfile::tempdir().unwrap();
    write_gears(folder.path(), [24, 36], 20.0);
    for step_s in ["2e-5", "1e-5"] {
        let run_keys = format!(
            "kind = \"transient\"\nend_s = 0.06\n[solver]\nstep_s = {step_s}\nstart = \"equilibrium\"\n[output]\ninterval_s = 1e-4"
        );
        let torque =
            "torque_Nm = { step = { start_s = 0.02, from = -300.0, end_s = 0.022, to = 300.0 } }";
        let planet = "count = 4\ndeviation = [{ planet = 2, tangential_um = 0.5 }]";
        let text = scene(&run_keys, 90.0, ["speed_rpm = 500.0", "support = \"held\"", &format!("inertia_kg_m2 = [0.1, 0.1, 0.1]\n{torque}"), planet, ""])
            .replace("stiffness_N_per_mm_um = 20.0", "stiffness_N_per_mm_um = 20.0, damping = { kind = \"stiffness-proportional\", time_s = 2e-5, full_depth_um = 1.0 }");
        let result = run(&text, folder.path());
        let read = |name: &str| result.rows.read(name).unwrap();
        let forces = read("elements/set sun-planet 1/normal_force_left_N");
        // All planets carry from the first row on.
        for n in 1..=4 {
            assert!(
                read(&format!("elements/set sun-planet {n}/normal_force_left_N"))[0] > 100.0,
                "{step_s} {n}"
            );
        }
        assert!(forces.last().unwrap() < &1.0, "{step_s}");
        for n in 1..=4 {
            assert!(
                *read(&format!("elements/set sun-planet {n}/normal_force_right_N"))
                    .last()
                    .unwrap()
                    > 100.0,
                "{step_s} {n}"
            );
        }
        // Energy errors of runs with blows fall with the step; a thousandth of the work is what the other scenes are
        // held to.
        assert!(
            result.relative_energy_error().unwrap() < 1e-3,
            "{step_s}: {:?}",
            result.relative_energy_error()
        );
        // The carrier ends where the ratio has it, but for the backlash of both meshes, 0.4 mm on a circle of 90 mm.
        let turned = |body: &str| *read(&format!("bodies/set {body}/turn_rad")).last().unwrap();
        assert!(
            (turned("carrier") - turned("sun") / 5.0).abs() < 0.4 / 90.0,
            "{step_s}"
        );
    }
}

/// Ten planets under 1 N m, at rest and in time with two steps: all of them carry a tenth. Rounding of angles, 1e-13 m,
/// is the smallest part of deflections of 2e-9 m; vibrations of the start are below a hundredth.
#[test]
fn ten_planets_share_a_newton_metre() {
    let folder = tempfile::tempdir().unwrap();
    write_gears(folder.path(), [80, 20], 20.0);
    let carrier = "inertia_kg_m2 = [0.1, 0.1, 0.1]\ntorque_Nm = -1.0";
    let in_time = |step_s: &str| {
        format!(
            "kind = \"transient\"\nend_s = 0.004\n[solver]\nnewton_tolerance = 1e-12\nstep_s = {step_s}\nstart = \"equilibrium\"\n[output]\ninterval_s = 1e-4"
        )
    };
    for (run_keys, within) in [
        ("kind = \"static\"".to_owned(), 1e-3),
        (in_time("2e-5"), 1e-2),
        (in_time("1e-5"), 1e-2),
    ] {
        let text = scene(
            &run_keys,
            150.0,
            [
                "speed_rpm = 60.0",
                "support = \"held\"",
                carrier,
                "count = 10",
                "",
            ],
        );
        let result = run(&text, folder.path());
        let shares = result.sets().unwrap().remove(0).sun.unwrap();
        for share in shares.mean {
            assert!((share - 1.0).abs() < within, "{run_keys}: {share}");
        }
        // Row by row the shares of ten planets are ten, and the carrier turns 80 of 200 times as far as the sun.
        let rows: Vec<usize> = (0..result.rows.rows()).collect();
        let found = result.planet_shares(&rows).unwrap().remove(0);
        for shares in [found.sun.unwrap(), found.ring.unwrap()] {
            for row in 0..rows.len() {
                let sum: f64 = shares.iter().map(|own| own[row]).sum();
                assert!((sum - 10.0).abs() < 1e-9, "{run_keys}, row {row}: {sum}");
            }
        }
        if let (Some(turn), true) = (found.carrier_rad, rows.len() > 1) {
            let [first, last] = [turn[0], turn[rows.len() - 1]];
            let expected = 0.4 * TAU * 0.004;
            assert!(
                ((last - first).abs() / expected - 1.0).abs() < 1e-3,
                "{first} {last}"
            );
        }
    }
}

/// Effort, counted: four planets on springs, eight meshes by `impact`. A step takes a prediction and two corrections,
/// one more where flanks come or go, with factors that serve more than one step. The bound on equilibria is what was
/// counted, 15.2, so that it does not grow: three corrections would do for springs. Why it takes more is not known: a
/// force K δ^1.5 and steps of the series that are given up are possible.
#[test]
fn a_set_takes_few_iterations() {
    let folder = tempfile::tempdir().unwrap();
    write_gears(folder.path(), [24, 36], 20.0);
    let planets = "count = 4\nsupport = \"floating\"\nbearings = [{ model = { kind = \"linear\", radial_stiffness_N_per_mm = 2e5 } }]";
    let carrier = "inertia_kg_m2 = [0.1, 0.1, 0.1]\ntorque_Nm = -400.0";
    let of = |run_keys: &str, speed: &str| {
        let sun = format!("support = \"floating\"\nspeed_rpm = {speed}");
        let parts = [&*sun, "support = \"held\"", carrier, planets, ""];
        let text = scene(run_keys, 90.0, parts).replace(
            "{ kind = \"iso6336\", stiffness_N_per_mm_um = 20.0 }",
            "{ kind = \"impact\", stiffness_N_per_mm_e = 1e6, exponent = 1.5, damping_N_s_per_mm = 100.0, full_damping_depth_um = 5.0 }",
        );
        run(&text, folder.path())
    };
    let in_time = "kind = \"transient\"\nend_s = 0.01\n[solver]\nstep_s = 1e-5\nstart = \"equilibrium\"\n[output]\ninterval_s = 1e-3";
    let record = of(in_time, "600.0").record.unwrap();
    let [evaluations, factorisations] =
        [record.evaluations, record.factorisations].map(|count| count / record.steps);
    assert!(evaluations < 4.0, "{evaluations}");
    assert!(factorisations < 1.0, "{factorisations}");
    let period_deg = 360.0 / 24.0 * 1.25;
    let angles: Vec<String> = (0..60)
        .map(|i| format!("{:?}", period_deg * f64::from(i) / 60.0))
        .collect();
    let series = format!(
        "kind = \"static\"\nmotion = \"set sun speed\"\nangles_deg = [{}]",
        angles.join(", ")
    );
    let iterations = of(&series, "0.0").rows.read("iterations").unwrap();
    let mean = iterations.iter().sum::<f64>() / 60.0;
    assert!(mean < 16.0, "{mean}");
}
