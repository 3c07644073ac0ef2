//! A REXS file of two planetary stages (helical, spur) and a cylindrical one behind each other, from import to report:
//! bearings carry what statics by hand say.

use crate::common::{Desk, argument, gearmesh, succeeds};
use crate::planetary_rexs::{FIRST, INPUT, OUTPUT, SECOND, Stage, gearbox};
use crate::shipped_gearboxes::coarse;
use gearmesh_scene::system_run::SystemResult;

/// Bearings of the five shafts within 2 % of the larger one of their shaft by hand, those of suns and carriers within 2
/// % of the tooth forces and the axial one of itself: planets push sun and carrier sideways by
/// nothing, the helical sun along its axis by T tan β/r, pinion and wheel as in any cylindrical stage. Torques are
/// those of Willis' ratios, planet bearings carry both of a planet's meshes, and a page is written.
#[test]
fn a_gearbox_with_planetary_stages_is_imported_and_runs() {
    let desk = Desk::new();
    let file = desk.file("planets.rexs", gearbox(false));
    let out = desk.path("imported");
    let told = succeeds(&["import", argument(&file), "-o", argument(&out), "--json"]).json();
    assert_eq!(told["warnings"].as_array().unwrap().len(), 0, "{told}");
    let (scene, output) = (out.join("planets.toml"), desk.path("result.h5"));
    succeeds(&["run", argument(&scene), "-o", argument(&output)]);
    let result = SystemResult::open(&output).unwrap();
    let read = |name: &str| result.rows.read(name).unwrap()[0];
    let ratio = |stage: &Stage| 1.0 + f64::from(stage.teeth[2]) / f64::from(stage.teeth[0]);
    let at_pinion = INPUT.0 * ratio(&FIRST) * ratio(&SECOND);
    assert!((read("elements/held at motor/moment_z_Nm").abs() / INPUT.0 - 1.0).abs() < 1e-3);
    let (teeth, module, helix) = OUTPUT;
    let cos = helix.to_radians().cos();
    let radii_m = teeth.map(|z| 0.5e-3 * module * f64::from(z) / cos);
    let tangential = at_pinion / radii_m[0];
    let radial = tangential * 20f64.to_radians().tan() / cos;
    let axial = tangential * helix.to_radians().tan();
    let sun_radius_m =
        0.5e-3 * FIRST.module_mm * f64::from(FIRST.teeth[0]) / FIRST.helix_deg.to_radians().cos();
    let sun_axial = INPUT.0 / sun_radius_m * FIRST.helix_deg.to_radians().tan();
    // The middle of pinion and wheel is the middle of their bearings, 120 mm apart.
    let of_mesh = |radius_m: f64| {
        let tilt = axial * radius_m / 0.12;
        let mut both =
            [0.5 * radial - tilt, 0.5 * radial + tilt].map(|r| r.hypot(0.5 * tangential));
        both.sort_by(f64::total_cmp);
        both
    };
    let largest = of_mesh(radii_m[1])[1];
    for (shaft, radial, axial, size) in [
        (0, [0.0; 2], sun_axial, INPUT.0 / sun_radius_m),
        (1, [0.0; 2], 0.0, INPUT.0 * ratio(&FIRST) / 0.03),
        (2, [0.0; 2], 0.0, at_pinion / 0.0585),
        (3, of_mesh(radii_m[0]), axial, of_mesh(radii_m[0])[1]),
        (4, of_mesh(radii_m[1]), axial, largest),
    ] {
        let mut found = [0, 1].map(|side| read(&format!("elements/b{shaft}{side}/force_radial_N")));
        found.sort_by(f64::total_cmp);
        for (found, wanted) in found.iter().zip(radial) {
            assert!(
                (found - wanted).abs() < 0.02 * size,
                "shaft {shaft}: {found} {wanted}"
            );
        }
        let found = read(&format!("elements/b{shaft}0/force_shaft_z_N")).abs();
        assert!(
            (found - axial).abs() < 0.02 * if shaft == 0 { axial } else { size },
            "shaft {shaft}: {found} {axial}"
        );
    }
    let sets = result.sets().unwrap();
    for (set, stage, torque) in [
        (&sets[0], &FIRST, INPUT.0),
        (&sets[1], &SECOND, INPUT.0 * ratio(&FIRST)),
    ] {
        let shares = &set.sun.as_ref().unwrap().mean;
        assert!(shares.iter().all(|s| (s - 1.0).abs() < 0.02), "{shares:?}");
        let [z_s, z_p, _] = stage.teeth;
        let arm_m =
            0.5e-3 * stage.module_mm * f64::from(z_s + z_p) / stage.helix_deg.to_radians().cos();
        let pin = torque * ratio(stage) / 3.0 / arm_m;
        for found in set.pin_force_n.as_ref().unwrap() {
            assert!((found / pin - 1.0).abs() < 0.02, "{found} {pin}");
        }
    }
    let page = desk.path("page.html");
    succeeds(&["report", argument(&output), "-o", argument(&page)]);
    let page = std::fs::read_to_string(&page).unwrap();
    assert!(page.contains("set 200") && page.contains("set 300"));
}

/// With `--reduced` sets have reduced gears: those that the command names, of planets the first of each set. Reduced on
/// coarse meshes, with the file's modifications, they run; the pins carry what statics by hand say, in the mean over
/// the planets, which mesh one after another.
#[test]
fn a_gearbox_with_planetary_stages_of_reduced_gears_runs() {
    let desk = Desk::new();
    let file = desk.file("planets.rexs", gearbox(true));
    let out = desk.path("imported");
    let answer = gearmesh(&["import", argument(&file), "-o", argument(&out), "--reduced"]);
    assert_eq!(answer.code, Some(0), "{answer:?}");
    let wanted = { answer.stderr.lines() }.filter_map(|line| {
        let gear = line.strip_prefix("next: gearmesh reduce ")?;
        Some(gear.split_once(" -o ")?.0.to_owned())
    });
    let wanted: Vec<String> = wanted.collect();
    let names: Vec<String> = { wanted.iter() }
        .map(|gear| {
            let name = gear.rsplit('/').next().unwrap();
            name.trim_start_matches("planets_")
                .trim_end_matches(".toml")
                .to_owned()
        })
        .collect();
    let mut sorted = names.clone();
    sorted.sort_unstable();
    let expected = [
        "pinion",
        "planet_230",
        "planet_330",
        "ring_200",
        "ring_300",
        "sun_200",
        "sun_300",
        "wheel",
    ];
    assert_eq!(sorted, expected);
    for (gear, name) in wanted.iter().zip(&names) {
        let text = std::fs::read_to_string(gear).unwrap();
        let is_modified = !["pinion", "wheel"].contains(&&name[..]);
        assert_eq!(text.contains("[microgeometry]"), is_modified, "{text}");
        let text = coarse(&text);
        let text = text.replace("flanks = [\"right\"]", "flanks = [\"right\", \"left\"]");
        std::fs::write(gear, text).unwrap();
        let model = gear.replace(".toml", ".h5");
        succeeds(&["reduce", "--no-error-estimate", gear, "-o", &model]);
    }
    let (scene, output) = (out.join("planets.toml"), desk.path("result.h5"));
    let text = std::fs::read_to_string(&scene).unwrap();
    assert!(text.contains("kind = \"hybrid\"") && !text.contains("microgeometry"));
    succeeds(&["run", argument(&scene), "-o", argument(&output)]);
    let result = SystemResult::open(&output).unwrap();
    let ratio = |stage: &Stage| 1.0 + f64::from(stage.teeth[2]) / f64::from(stage.teeth[0]);
    for (set, stage, torque) in [
        (&result.sets().unwrap()[0], &FIRST, INPUT.0),
        (&result.sets().unwrap()[1], &SECOND, INPUT.0 * ratio(&FIRST)),
    ] {
        let [z_s, z_p, _] = stage.teeth;
        let arm_m =
            0.5e-3 * stage.module_mm * f64::from(z_s + z_p) / stage.helix_deg.to_radians().cos();
        let pin = torque * ratio(stage) / 3.0 / arm_m;
        let forces = set.pin_force_n.as_ref().unwrap();
        let mean = forces.iter().sum::<f64>() / 3.0;
        assert!((mean / pin - 1.0).abs() < 0.02, "{forces:?} {pin}");
    }
}
