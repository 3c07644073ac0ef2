//! How planets share the load, against springs in closed form, and the effect of the meshes' phases on the sun.

use std::f64::consts::TAU;

use gearmesh_scene::system::planetary::layout::harmonic_shares;
use gearmesh_scene::system_run::SetFigures;

use super::*;

/// A set of 34, 26 and 86 teeth in equilibrium, one pin moved along the turn; `force_n`: mean force of its sun meshes.
fn shares(folder: &Path, (planets, moved_um): (usize, f64), force_n: f64, sun: &str) -> SetFigures {
    let torque_nm = planets as f64 * force_n * 51e-3 * 20f64.to_radians().cos() * 120.0 / 34.0;
    let carrier = &format!(
        "inertia_kg_m2 = [0.1, 0.1, 0.1]\ntorque_Nm = {:?}",
        -torque_nm
    );
    let planet =
        format!("count = {planets}\ndeviation = [{{ planet = 1, tangential_um = {moved_um:?} }}]");
    let sun = format!("{sun}\nspeed_rpm = 0.0");
    let text = scene(
        "kind = \"static\"",
        90.0,
        [&sun, "support = \"held\"", carrier, &planet, ""],
    );
    let result = run(&text, folder);
    result.sets().unwrap().remove(0)
}

/// One pin moved along the turn: with a sun on a fixed axis F_n = F + 2 K cos α (mean of t − t_n), K the two meshes of
/// a planet in series; a floating sun takes out what a sideways motion can, all of it with three planets
/// (docs/theory/planetary_sets.md). The misfit of 0.5 % of the mean force is for the change of the working pressure
/// angles by a displaced pin, e/a = 1e-3.
#[test]
fn planets_share_the_load_as_springs_do() {
    let folder = tempfile::tempdir().unwrap();
    write_gears(folder.path(), [34, 26], 20.0);
    let (stiffness, cos, force) = (2.5e8, 20f64.to_radians().cos(), 6e4);
    for planets in [3_usize, 4, 5, 6] {
        for moved_um in [-100.0, 10.0, 100.0] {
            for (sun, floats) in [
                ("support = \"turning\"", false),
                ("support = \"floating\"", true),
            ] {
                let figures = shares(folder.path(), (planets, moved_um), force, sun);
                let found = &figures.sun.as_ref().unwrap().mean;
                let step = 2.0 * stiffness * cos * 1e-6 * moved_um / force;
                for (n, found) in found.iter().enumerate() {
                    let psi = TAU * n as f64 / planets as f64;
                    let own = if n == 0 { 1.0 } else { 0.0 };
                    let taken = if floats { 1.0 + 2.0 * psi.cos() } else { 1.0 };
                    let expected = 1.0 - step * (own - taken / planets as f64);
                    // A planet without load is another case.
                    assert!(expected > 0.0, "{planets} {moved_um} {expected}");
                    assert!(
                        (found - expected).abs() < 5e-3,
                        "{planets} planets, {moved_um} um, floats {floats}, planet {}: {found} {expected}",
                        n + 1
                    );
                }
                let force_n = figures.ring.unwrap().normal_force_n.iter().sum::<f64>();
                assert!(
                    (force_n / (planets as f64 * force) - 1.0).abs() < 2e-3,
                    "{force_n}"
                );
            }
        }
    }
}

/// A set whose axis is not z: the same shares and pin forces.
#[test]
fn a_set_along_another_axis_is_the_same() {
    let folder = tempfile::tempdir().unwrap();
    write_gears(folder.path(), [34, 26], 20.0);
    let along = |axis: &str| {
        let planet = "count = 3\ndeviation = [{ planet = 2, tangential_um = 20.0, tilt_radial_mrad = 0.1 }]\nsupport = \"floating\"\nbearings = [{ model = { kind = \"linear\", radial_stiffness_N_per_mm = 1e5 } }]";
        let carrier = "inertia_kg_m2 = [0.1, 0.1, 0.1]\ntorque_Nm = -3000.0";
        let parts = [
            "speed_rpm = 0.0",
            "support = \"held\"",
            carrier,
            planet,
            axis,
        ];
        run(&scene("kind = \"static\"", 90.0, parts), folder.path())
            .sets()
            .unwrap()
            .remove(0)
    };
    let upright = along("");
    for axis in ["axis = [1.0, 0.0, 0.0]", "axis = [0.3, -2.0, -0.7]"] {
        let other = along(axis);
        let [shares, others] = [&upright, &other].map(|set| set.sun.clone().unwrap().mean);
        let [pins, other_pins] = [&upright, &other].map(|set| set.pin_force_n.clone().unwrap());
        assert!((shares[1] - 1.0).abs() > 0.01, "{shares:?}");
        for (a, b) in shares
            .iter()
            .chain(&pins)
            .zip(others.iter().chain(&other_pins))
        {
            assert!((a / b - 1.0).abs() < 1e-6, "{axis}: {a} {b}");
        }
    }
}

/// A pin that lags by more than the load presses together carries nothing; the others carry its share.
#[test]
fn a_planet_that_loses_contact_leaves_its_share_to_the_others() {
    let folder = tempfile::tempdir().unwrap();
    write_gears(folder.path(), [34, 26], 20.0);
    let figures = shares(folder.path(), (4, 90.0), 2e4, "support = \"turning\"");
    let found = figures.sun.unwrap();
    assert!(found.mean[0].abs() < 1e-9, "{:?}", found.mean);
    for share in &found.mean[1..] {
        assert!((share - 4.0 / 3.0).abs() < 1e-3, "{share}");
    }
    assert!((found.mesh_load_factor() - 4.0 / 3.0).abs() < 1e-3);
}

/// Whether the first harmonic of mesh stiffness turns the sun, pushes it or cancels, over five tooth combinations: as
/// the phases say, and as the equilibria over one mesh period do it.
#[test]
fn phases_of_the_meshes_say_what_they_excite() {
    for (teeth, planets, turns, pushes) in [
        ([24, 36], 3, true, false),
        ([25, 35], 3, false, true),
        ([22, 36], 4, false, false),
        ([25, 35], 4, false, true),
        ([37, 23], 5, false, false),
    ] {
        let folder = tempfile::tempdir().unwrap();
        write_gears(folder.path(), teeth, 20.0);
        let period_deg =
            360.0 / teeth[0] as f64 * (1.0 + teeth[0] as f64 / (teeth[0] + 2 * teeth[1]) as f64);
        let angles: Vec<String> = (0..12)
            .map(|i| format!("{:?}", period_deg * f64::from(i) / 12.0))
            .collect();
        let carrier = "inertia_kg_m2 = [0.1, 0.1, 0.1]\ntorque_Nm = -500.0";
        let kind = format!(
            "kind = \"static\"\nmotion = \"set sun speed\"\nangles_deg = [{}]",
            angles.join(", ")
        );
        let text = scene(
            &kind,
            1.5 * (teeth[0] + teeth[1]) as f64,
            [
                "speed_rpm = 0.0",
                "support = \"held\"",
                carrier,
                &format!("count = {planets}"),
                "",
            ],
        )
        // Sun and ring meshes that both vary cancel in some sets: the sun's alone.
        .replacen(
            "stiffness_N_per_mm_um = 20.0",
            "stiffness_N_per_mm_um = 20.0, stiffness_amplitude = 0.2",
            1,
        );
        let result = run(&text, folder.path());
        let set = &result.head.sets[0];
        let shares = harmonic_shares(1, &set.teeth.sun_phases(&set.angles_rad), &set.angles_rad);
        assert_eq!(
            [shares.turns > 0.0, shares.pushes > 0.0],
            [turns, pushes],
            "{teeth:?}"
        );
        let read = |name: &str| result.rows.read(name).unwrap();
        let first = |values: &[f64]| {
            let sum = values
                .iter()
                .enumerate()
                .fold([0.0; 2], |[c, s], (i, value)| {
                    let (sin, cos) = (TAU * i as f64 / 12.0).sin_cos();
                    [c + value * cos / 6.0, s + value * sin / 6.0]
                });
            sum[0].hypot(sum[1])
        };
        // 500 N m on N planets: a mesh force that is the scale of what pushes, the deflection under it that of what
        // turns.
        let force = 100.0 / planets as f64 / (1.5e-3 * teeth[0] as f64);
        let pushed = first(&read("joints/set sun axis/force_x_N"))
            .max(first(&read("joints/set sun axis/force_y_N")))
            / force;
        let [sun, carrier] =
            ["sun", "carrier"].map(|body| read(&format!("bodies/set {body}/turn_rad")));
        let share = teeth[0] as f64 / (2 * (teeth[0] + teeth[1])) as f64;
        let errors: Vec<f64> = carrier
            .iter()
            .zip(&sun)
            .map(|(c, s)| c - share * s)
            .collect();
        let te = first(&errors) * 1.5e-3 * (teeth[0] + teeth[1]) as f64 / (force / 5e8);
        assert_eq!(te > 0.05, turns, "{teeth:?}: {te}");
        assert!(turns || te < 5e-3, "{teeth:?}: {te}");
        assert_eq!(pushed > 0.05, pushes, "{teeth:?}: {pushed}");
        assert!(pushes || pushed < 5e-3, "{teeth:?}: {pushed}");
    }
}
