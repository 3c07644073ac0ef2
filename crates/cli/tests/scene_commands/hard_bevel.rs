//! Loaded bevel pairs under assembly errors, and their reduced members in motion where it is hard.

use gearmesh_scene::SceneResult;
use gearmesh_scene::system_run::SystemResult;

use super::bevel::shipped;
use super::loaded_bevel::{at_rest, forces, loaded, members, numbers, scene, tca};
use crate::common::{argument, changed, succeeds};

/// Where the force of a loaded pair lies on the gear's flank in the mean over a pitch: along the face, up the flank.
fn centre(result: &SceneResult) -> [f64; 2] {
    let all = result
        .even_positions_of(0)
        .flat_map(|position| forces(result, position, 1));
    let sums = all.fold([0.0; 3], |[f, s, v], (force, at)| {
        [f + force, s + force * at[0], v + force * at[1]]
    });
    [sums[1] / sums[0], sums[2] / sums[0]]
}

/// Assembly errors move the loaded pattern along the tooth and up the flank in the directions in which the tooth
/// contact analysis moves the mean contact without load, both ways; of rigid gears whose surfaces deflect, and of
/// reduced ones.
#[test]
fn assembly_errors_move_the_loaded_pattern() {
    const ERRORS: [(&str, &str, f64); 4] = [
        ("offset_um", "offset, mm per mm", 20.0),
        ("pinion_axial_um", "pinion axial, mm per mm", 20.0),
        ("gear_axial_um", "gear axial, mm per mm", 40.0),
        ("shaft_angle_mrad", "shaft angle, mm per mrad", 0.6),
    ];
    let rigid = |name: &str| {
        let text = std::fs::read_to_string(shipped(name)).unwrap();
        let text = changed(&text, "[50.0, 100.0, 200.0]", "[20.0]");
        changed(
            &text,
            "positions_per_pitch = 16",
            "positions_per_pitch = 12",
        )
    };
    let reduced = changed(
        // Seven slices tell where a light load lies by steps only.
        &loaded("[100.0]", ""),
        "positions_per_pitch = 16",
        "positions_per_pitch = 12",
    );
    for (pair, text, face_mm, errors) in [
        (
            "20/20, rigid",
            rigid("bevel_20_20_loaded.toml"),
            15.0,
            &ERRORS[..],
        ),
        (
            "13/35, rigid",
            rigid("bevel_13_35_loaded.toml"),
            28.0,
            &ERRORS[..],
        ),
        ("13/35, reduced", reduced, 28.0, &ERRORS[..1]),
    ] {
        let at = |key: &str, error: f64| {
            let text = format!("{text}\n[tca]\npositions_per_pitch = 8\n{key} = {error:?}\n");
            (centre(&at_rest(&text)), text)
        };
        let (centred, as_designed) = at("offset_um", 0.0);
        let as_designed = tca(&as_designed);
        let (mut parts, mut least) = (Vec::new(), f64::INFINITY);
        for (key, name, error) in errors {
            let [plus, minus] = [*error, -error].map(|error| at(key, error).0);
            let told = numbers(&as_designed["sensitivity"][name]);
            for way in 0..2 {
                let [there, back] = [plus[way] - centred[way], minus[way] - centred[way]];
                let sign = told[way].signum();
                assert!(
                    sign * there > 0.0 && sign * back < 0.0,
                    "{key}: {there} and {back}, told {told:?}"
                );
                least = least.min(sign * there).min(-sign * back);
            }
            // It goes some way with the mean contact: along the tooth 5 to 100 % of what that does.
            let moved_mm = 0.5 * (plus[0] - minus[0]) * face_mm;
            let scale = if *key == "shaft_angle_mrad" {
                1.0
            } else {
                1e-3
            };
            let part = moved_mm / (told[0] * scale * error);
            assert!((0.05..1.0).contains(&part), "{key}: {part}");
            parts.push(format!("{part:.2} at {key} = {error}"));
        }
        println!(
            "{pair}: movement along the tooth over that of the contact without load (allowed 0.05 to 1): {}; least movement in the expected direction \
             {least:.1e} of the face or the flank's height (more than 0)",
            parts.join(", ")
        );
    }
}

/// Reduced members where it is hard: the contact at toe and heel, teeth that lift off and strike both sides, a torque
/// that changes its sign. All numbers are finite, energies balance.
#[test]
fn reduced_members_where_it_is_hard() {
    let run = |name: &str, text: &str, most_error: f64| {
        let file = members().join(format!("{name}.toml"));
        std::fs::write(&file, text).unwrap();
        let output = members().join(format!("{name}.h5"));
        succeeds(&["run", argument(&file), "-o", argument(&output)]);
        let result = SystemResult::open(&output).unwrap();
        for column in result.rows.columns() {
            let values = result.rows.read(&column.name).unwrap();
            assert!(
                values.iter().all(|v| v.is_finite()),
                "{name} {}",
                column.name
            );
        }
        let error = result.relative_energy_error().unwrap();
        assert!(error < most_error, "{name}: energy error {error:e}");
        result
    };
    // At 600 rpm, both sides of the teeth.
    let slow = changed(&scene(), "teeth = { flanks = \"right\" }\n", "");
    let fast = slow
        .replace("speed_rpm = -60.0", "speed_rpm = -600.0")
        .replace("step_s = 2e-4", "step_s = 2e-5")
        .replace("interval_s = 4e-4", "interval_s = 4e-5")
        .replace("end_s = 0.18", "end_s = 0.03");
    let pinion = "name = \"pinion\"\nmass_kg = 1.0\ninertia_kg_m2 = [3e-4, 3e-4, 3e-4]\nposition_mm = [0.0, 0.0, 0.0]";
    for (name, offset, at_heel) in [("heel", 0.45, true), ("toe", -0.45, false)] {
        let moved = pinion.replace("[0.0, 0.0, 0.0]", &format!("[0.0, {offset:?}, 0.0]"));
        let result = run(name, &changed(&fast, pinion, &moved), 1e-4);
        let loads: Vec<f64> = (1..=7)
            .map(|slice| {
                let name = format!("elements/mesh/line_load_slice_{slice}_N_per_m");
                let loads = result.rows.read(&name).unwrap();
                loads.iter().fold(0.0_f64, |most, q| most.max(*q))
            })
            .collect();
        let most = loads.iter().copied().fold(0.0, f64::max);
        let end = if at_heel { loads[6] } else { loads[0] };
        assert!(end > 0.2 * most, "{name}: {loads:?}");
        println!(
            "slice at the {name} carries up to {:.0} N/mm (at least a fifth of the largest, {:.0} N/mm), energy error {:.1e} of the work (allowed 1e-4)",
            1e-3 * end,
            1e-3 * most,
            result.relative_energy_error().unwrap()
        );
    }
    let brake = "torque_Nm = { step = { start_s = 0.0, from = 0.0, end_s = 0.01, to = -100.0 } }";
    let sides = ["right", "left"];
    let force = |result: &SystemResult, side: &str| {
        let name = format!("elements/mesh/normal_force_{side}_N");
        result.rows.read(&name).unwrap()
    };
    // The drive shakes at 400 Hz.
    let shaking = changed(&fast, brake, "torque_Nm = -3.0");
    let shaking = changed(&shaking, "step_s = 2e-5", "step_s = 1e-5");
    let shaking = changed(
        &shaking,
        "joint = \"pinion shaft\"\nspeed_rpm = -600.0",
        "joint = \"pinion shaft\"\nspeed_rpm = { sum = [-600.0, { sine = { amplitude = 60.0, frequency_Hz = 400.0 } }] }",
    );
    // Strikes of 10 kN: what the energies miss, 2e-4 of the work, does not depend on the step; forces at half the step
    // are the same within 0.2 %.
    let result = run("shaking", &shaking, 5e-4);
    let both = sides.map(|side| force(&result, side));
    assert!(both.iter().all(|force| force.iter().any(|f| *f > 200.0)));
    let free = (0..both[0].len())
        .filter(|row| both[0][*row] + both[1][*row] == 0.0)
        .count();
    assert!(free > both[0].len() / 4);
    let most = |force: &[f64]| force.iter().fold(0.0_f64, |most, f| most.max(*f));
    println!(
        "shaking: no force {:.0} % of the time (at least 25 %), largest force {:.0} N on the right, {:.0} N on the left flanks (at least 200 N), \
         energy error {:.1e} of the work (allowed 5e-4)",
        100.0 * free as f64 / both[0].len() as f64,
        most(&both[0]),
        most(&both[1]),
        result.relative_energy_error().unwrap()
    );
    // From brake to drive.
    let turning =
        "torque_Nm = { step = { start_s = 0.005, from = -50.0, end_s = 0.02, to = 50.0 } }";
    let result = run("turning", &changed(&fast, brake, turning), 1e-4);
    let [right, left] = sides.map(|side| force(&result, side));
    let last = right.len() - 1;
    assert!(right[..last / 6].iter().any(|f| *f > 0.0) && left[last] > 0.0 && right[last] == 0.0);
    println!(
        "turning: right flanks up to {:.0} N in the first sixth, {:.0} N at the end, left ones {:.0} N; energy error {:.1e} of the work \
         (allowed 1e-4)",
        most(&right[..last / 6]),
        right[last].abs(),
        left[last],
        result.relative_energy_error().unwrap()
    );
}
