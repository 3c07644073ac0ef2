//! Wrong input: what the program says.
//!
//! Exit code 2 means that the input is wrong. The message goes to standard error, standard
//! output stays empty; a message about a TOML file names file, line, key, what was found and what is allowed.
#![allow(clippy::unwrap_used, clippy::expect_used, missing_docs)]

mod common;

use common::{
    Answer, Desk, SOLID, THIN, argument, changed, gearmesh, line_of, refused, succeeds, workshop,
};
use std::path::Path;

/// `gearmesh check` refuses a gear file in which `from` became `to`, at the line of `at`.
fn gear_refused(text: &str, (from, to): (&str, &str), at: &str, parts: &[&str]) {
    let desk = Desk::new();
    let text = changed(text, from, to);
    let file = desk.file("gear.toml", &text);
    let answer = gearmesh(&["check", argument(&file)]);
    refused(&answer, 2, parts);
    let place = format!("{}:{}: ", file.display(), line_of(&text, at));
    assert!(
        answer.stderr.contains(&place),
        "`{place}` is not in {answer:#?}"
    );
    // The commands that work with a gear refuse it before anything is written.
    for command in ["mesh", "reduce"] {
        let output = desk.path("output.vtu");
        let same = gearmesh(&[command, argument(&file), "-o", argument(&output)]);
        refused(&same, 2, &[&place]);
        assert_eq!(desk.names(), ["gear.toml"]);
    }
}

/// `gearmesh plan` and `run` refuse a scene in which `from` became `to`, at the line of `at`.
fn scene_refused((from, to): (&str, &str), at: &str, parts: &[&str]) {
    let desk = Desk::new();
    let text = changed(&workshop().scene(""), from, to);
    let file = desk.file("scene.toml", &text);
    let place = format!("{}:{}: ", file.display(), line_of(&text, at));
    refused(&gearmesh(&["plan", argument(&file)]), 2, parts);
    let answer = gearmesh(&[
        "run",
        argument(&file),
        "-o",
        argument(&desk.path("result.h5")),
    ]);
    refused(&answer, 2, parts);
    assert!(
        answer.stderr.contains(&place),
        "`{place}` is not in {answer:#?}"
    );
    assert_eq!(desk.names(), ["scene.toml"]);
}

#[test]
fn an_unknown_key_is_answered_with_the_known_ones() {
    gear_refused(
        SOLID,
        ("poisson = 0.3", "poisson = 0.3\ndensity = 7850"),
        "density",
        &["unknown field `density`", "young_GPa", "poisson"],
    );
}

#[test]
fn a_wrong_unit_is_answered_with_the_right_key() {
    gear_refused(
        THIN,
        ("web_thickness_mm = 4.0", "web_thickness_m = 0.004"),
        "web_thickness_m ",
        &[
            "`web_thickness_m`",
            "did you mean `web_thickness_mm`? The unit is part of the key",
        ],
    );
}

#[test]
fn a_web_of_negative_thickness_is_refused() {
    gear_refused(
        THIN,
        ("web_thickness_mm = 4.0", "web_thickness_mm = -4.0"),
        "web_thickness_mm",
        &[
            "blank.web_thickness_mm",
            "found -4",
            "more than 0 and at most the face width, 12",
        ],
    );
}

/// Root diameter 3 (18 + 0.2 − 2.5) = 47.1 mm; one module less is allowed.
#[test]
fn a_rim_without_material_below_the_root_is_refused() {
    gear_refused(
        THIN,
        (
            "rim_inner_diameter_mm = 38.0",
            "rim_inner_diameter_mm = 46.0",
        ),
        "rim_inner_diameter_mm",
        &[
            "blank.rim_inner_diameter_mm",
            "found 46",
            "less than 44.1",
            "root diameter 47.1",
        ],
    );
}

#[test]
fn a_bore_larger_than_the_root_is_refused() {
    gear_refused(
        SOLID,
        ("bore_diameter_mm = 14.0", "bore_diameter_mm = 50.0"),
        "bore_diameter_mm",
        &[
            "blank.bore_diameter_mm",
            "found 50",
            "less than 44.1",
            "root diameter 47.1",
        ],
    );
}

fn slotted(count: usize, width_deg: f64) -> String {
    format!(
        "web_thickness_mm = 4.0\n[blank.slots]\ncount = {count}\ninner_radius_mm = 12.0\nouter_radius_mm = 17.0\n\
         width_deg = {width_deg}\nphase_deg = 10.0\ncorner_radius_mm = 0.8"
    )
}

#[test]
fn slots_that_meet_are_refused() {
    gear_refused(
        THIN,
        ("web_thickness_mm = 4.0", &slotted(3, 119.0)),
        "[blank.slots]",
        &[
            "blank.slots",
            "3 openings of 119.000 deg meet",
            "1.000 deg are left",
            "at least 14.324 deg",
        ],
    );
}

#[test]
fn slots_that_do_not_divide_the_teeth_work_with_a_warning() {
    let desk = Desk::new();
    let file = desk.file(
        "gear.toml",
        changed(THIN, "web_thickness_mm = 4.0", &slotted(5, 30.0)),
    );
    let answer = succeeds(&["check", argument(&file)]);
    assert!(answer.stdout.contains("sound"), "{answer:#?}");
    assert!(
        answer.stderr.contains("warning: ") && answer.stderr.contains("do not divide the teeth"),
        "{answer:#?}"
    );
    // Three slots repeat with the teeth: no warning.
    let file = desk.file(
        "gear.toml",
        changed(THIN, "web_thickness_mm = 4.0", &slotted(3, 30.0)),
    );
    assert_eq!(succeeds(&["check", argument(&file)]).stderr, "");
}

#[test]
fn a_torque_of_zero_is_refused() {
    scene_refused(
        ("[20.0, 60.0]", "[20.0, 0.0]"),
        "torques_Nm",
        &["run.torques_Nm.1", "found 0", "more than 0"],
    );
}

#[test]
fn an_unknown_gauge_is_answered_with_the_known_ones() {
    scene_refused(
        ("gear_2 = [\"tension\"]", "gear_2 = [\"tesnion\"]"),
        "tesnion\"",
        &[
            "gauges.gear_2.0",
            "no gauge `tesnion`",
            "it has: tension, compression",
        ],
    );
    scene_refused(
        ("gear_2 = [\"tension\"]", "gear_1 = [\"tension\"]"),
        "[\"tension\"]",
        &["gauges.gear_1.0", "it has: none"],
    );
}

#[test]
fn an_unknown_mesh_model_is_answered_with_the_known_ones() {
    scene_refused(
        ("\"hybrid\"", "\"hybird\""),
        "hybird",
        &["`hybird`", "expected `hybrid`"],
    );
}

#[test]
fn a_value_of_the_wrong_type_is_named_by_its_key() {
    gear_refused(
        SOLID,
        ("teeth = 18", "teeth = \"18\""),
        "teeth",
        &["tooth.teeth: "],
    );
    scene_refused(("\"hybrid\"", "\"hybird\""), "hybird", &["mesh.model: "]);
}

/// Base pitches agree, but the base circles already touch: 2 r_b = 50.74 mm.
#[test]
fn a_pair_that_cannot_run_is_refused() {
    let centre = "centre_distance_mm = 54.7";
    scene_refused(
        (centre, "centre_distance_mm = 50.0"),
        "[pair]",
        &["pair", "50.0000 mm", "sum of the base radii, 50.74"],
    );
    scene_refused(
        (centre, "centre_distance_mm = 53.9"),
        "[pair]",
        &["pair", "the teeth do not fit", "backlash -"],
    );
    scene_refused(
        (centre, "centre_distance_mm = 60.0"),
        "[pair]",
        &["pair", "contact ratio", "below 1"],
    );
    // The solid gear has been reduced for loads on its right flanks only.
    scene_refused(
        (centre, "centre_distance_mm = 54.7\nflank = \"left\""),
        "gear_1",
        &["pair.gear_1", "left"],
    );
}

#[test]
fn a_missing_file_is_named() {
    let desk = Desk::new();
    let missing = desk.path("missing");
    let (name, output) = (argument(&missing), desk.path("output.h5"));
    for command in ["mesh", "reduce", "run", "recover", "report"] {
        refused(
            &gearmesh(&[command, name, "-o", argument(&output)]),
            2,
            &[name, "No such file"],
        );
    }
    for command in ["check", "plan"] {
        refused(&gearmesh(&[command, name]), 2, &[name, "No such file"]);
    }
    refused(&compliance(&missing), 2, &[name, "No such file"]);
    assert!(desk.names().is_empty());
}

#[test]
fn a_missing_model_is_answered_with_the_command_that_makes_it() {
    let thin = argument(&workshop().thin);
    scene_refused(
        (thin, "missing.h5"),
        "gear_2",
        &[
            "pair.gear_2",
            "missing.h5 does not exist",
            "gearmesh reduce GEAR.toml -o",
        ],
    );
}

fn compliance(model: &Path) -> Answer {
    let load = [
        "--tooth",
        "0",
        "--radius-mm",
        "27",
        "--line-load-N-per-mm",
        "100",
        "--half-width-mm",
        "0.1",
    ];
    gearmesh(&[&["compliance", argument(model)], load.as_slice()].concat())
}

/// A model that no command accepts; `parts` is what each says.
fn model_refused(content: &[u8], parts: &[&str]) {
    let desk = Desk::new();
    let model = desk.file("model.h5", content);
    let named = [parts, &[argument(&model)]].concat();
    refused(&gearmesh(&["check", argument(&model)]), 2, &named);
    refused(&compliance(&model), 2, &named);
    let scene = changed(
        &workshop().scene(""),
        argument(&workshop().thin),
        argument(&model),
    );
    refused(
        &gearmesh(&["plan", argument(&desk.file("scene.toml", scene))]),
        2,
        &named,
    );
}

#[test]
fn a_model_cut_in_half_is_refused() {
    let sound = std::fs::read(&workshop().thin).unwrap();
    let (half, whole) = (sound.len() / 2, sound.len());
    model_refused(
        &sound[..half],
        &[
            "is truncated",
            &format!("{half} bytes, {whole} when it was written"),
        ],
    );
}

#[test]
fn a_model_with_a_flipped_byte_is_refused() {
    let mut bytes = std::fs::read(&workshop().thin).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 0x10;
    model_refused(&bytes, &["was altered or damaged after it was written"]);
}

#[test]
fn a_file_that_is_no_model_is_refused() {
    model_refused(b"time,strain\n0,1\n", &["was not written by gearmesh"]);
    model_refused(b"", &["was not written by gearmesh"]);
}

#[test]
fn a_model_is_no_result() {
    let output = Desk::new();
    let report = output.path("report.html");
    let answer = gearmesh(&[
        "report",
        argument(&workshop().thin),
        "-o",
        argument(&report),
    ]);
    refused(&answer, 2, &[argument(&workshop().thin), "gearmesh-result"]);
    assert!(output.names().is_empty());
}

#[test]
fn arguments_out_of_range_are_answered_with_the_range() {
    let model = argument(&workshop().thin);
    let with = |tooth: &str, radius: &str, load: &str| {
        gearmesh(&[
            "compliance",
            model,
            "--tooth",
            tooth,
            "--radius-mm",
            radius,
            "--line-load-N-per-mm",
            load,
            "--half-width-mm",
            "0.1",
        ])
    };
    refused(
        &with("18", "27", "100"),
        2,
        &["--tooth", "found 18", "0 to 17"],
    );
    refused(
        &with("0", "31", "100"),
        2,
        &["--radius-mm", "found 31", "allowed is"],
    );
    refused(
        &with("0", "27", "0"),
        2,
        &["--line-load-N-per-mm", "found 0", "more than 0"],
    );
}

/// An elastic, linear program must not keep quiet where steel would long have yielded.
#[test]
fn a_torque_that_breaks_the_assumptions_is_warned_about() {
    let desk = Desk::new();
    let scene = changed(&workshop().scene(""), "[20.0, 60.0]", "[20.0, 20000.0]");
    let file = desk.file("scene.toml", scene);
    let result = desk.path("result.h5");
    let answer = succeeds(&["run", argument(&file), "-o", argument(&result), "--json"]);
    for assumption in ["narrow contact", "elastic material", "small deflection"] {
        let warning = format!("warning: at 20000 N m: {assumption}");
        assert!(
            answer.stderr.contains(&warning),
            "`{warning}` is not in {answer:#?}"
        );
    }
    assert!(answer.json()["warnings"].as_array().unwrap().len() >= 3);
    // The warnings stay with the result.
    let report = desk.path("report.html");
    succeeds(&["report", argument(&result), "-o", argument(&report)]);
    assert!(
        std::fs::read_to_string(report)
            .unwrap()
            .contains("elastic material")
    );
    // A moderate load is not warned about.
    let file = desk.file("scene.toml", workshop().scene(""));
    let answer = succeeds(&["run", argument(&file), "-o", argument(&result), "--json"]);
    assert!(!answer.stderr.contains("warning"), "{answer:#?}");
}

#[test]
fn an_edge_radius_that_is_not_used_or_not_possible_is_refused() {
    scene_refused(
        (
            "model = \"hybrid\"",
            "model = \"hybrid\"\nedge_radius_um = 50",
        ),
        "edge_radius_um",
        &["mesh.edge_radius_um", "mesh.path = \"extended\""],
    );
    scene_refused(
        (
            "model = \"hybrid\"",
            "model = \"hybrid\"\npath = \"extended\"\nedge_radius_um = 0",
        ),
        "edge_radius_um",
        &["found 0", "1 to 1000"],
    );
}

/// What a contour may not be.
#[test]
fn a_contour_that_cannot_be_is_explained() {
    const CONTOUR: &str = "kind = \"contour\"
hub_z_mm = [-8.0, 6.0]
web = [{ diameter_mm = 20.0, z_mm = [-2.0, 2.0] }, { diameter_mm = 38.0, z_mm = [-1.0, 3.0] }]";
    let (without_mesh, _) = SOLID.split_once("[mesh]").unwrap();
    let sound = changed(without_mesh, "kind = \"solid\"", CONTOUR);
    for (change, at, parts) in [
        (
            ("[-1.0, 3.0]", "[-1.0, 7.0]"),
            "web =",
            &["blank.web.1.z_mm", "found 7", "-6 to 6 at the rim"][..],
        ),
        (
            ("diameter_mm = 38.0", "diameter_mm = 18.0"),
            "web =",
            &[
                "blank.web.0.diameter_mm",
                "more than 14.000 and less than 18.000",
            ],
        ),
        (
            ("[-2.0, 2.0]", "[2.0, -2.0]"),
            "web =",
            &["blank.web.0.z_mm", "back < front"],
        ),
        (
            ("[-8.0, 6.0]", "[-1.0, 6.0]"),
            "hub_z_mm",
            &["at or beyond the back of the web at the hub, -2"],
        ),
        (
            (
                "diameter_mm = 38.0, z_mm = [-1.0, 3.0]",
                "diameter_mm = 38.0, z_mm = [-1.0, 3.0], fillet_radius_mm = -1.0",
            ),
            "web =",
            &[
                "blank.web.1.fillet_radius_mm",
                "found -1",
                "0 (sharp corners) or more",
            ],
        ),
        (
            // The front: 3 mm of the rim's inner surface, a corner of 90 + atan(1/9) degrees.
            (
                "diameter_mm = 38.0, z_mm = [-1.0, 3.0]",
                "diameter_mm = 38.0, z_mm = [-1.0, 3.0], fillet_radius_mm = 4.5",
            ),
            "web =",
            &[
                "blank.web.1.fillet_radius_mm",
                "found 4.5000",
                "does not fit the corner at diameter 38.000 mm, z 3.000 mm",
                "at most 3.3518",
            ],
        ),
        (
            // Back and front without a kink at the middle point.
            (
                "{ diameter_mm = 38.0",
                "{ diameter_mm = 29.0, z_mm = [-1.5, 2.5], fillet_radius_mm = 2.0 }, { diameter_mm = 38.0",
            ),
            "web =",
            &[
                "blank.web.1.fillet_radius_mm",
                "found 2.0000",
                "no corner there",
            ],
        ),
        (
            (
                "{ diameter_mm = 38.0",
                "{ diameter_mm = 20.0, z_mm = [2.5, 4.0] }, { diameter_mm = 38.0",
            ),
            "web =",
            &["blank.web.1.z_mm", "leaves the web in one piece"],
        ),
        (
            (
                "[-1.0, 3.0] }]\nbore_diameter_mm = 14.0",
                "[-1.0, 3.0], fillet_radius_mm = 1.0 }]\nbore_diameter_mm = 14.0\n[mesh]\nelement = \"hex20\"",
            ),
            "element =",
            &[
                "mesh.element",
                "the contour has fillets",
                "remove the key or set it to \"tet10\"",
            ],
        ),
        (
            (
                "[-1.0, 3.0] }]\nbore_diameter_mm = 14.0",
                "[-1.0, 6.0] }]\nbore_diameter_mm = 14.0\n[mesh]\nelement = \"hex8\"",
            ),
            "element =",
            &[
                "mesh.element",
                "the web is flush with only one of rim and hub",
            ],
        ),
        (
            ("hub_z_mm = [-8.0, 6.0]\n", ""),
            "[blank]",
            &["blank.hub_z_mm: missing", "[back, front]"],
        ),
        (
            ("kind = \"contour\"", "kind = \"solid\""),
            "hub_z_mm",
            &["only a blank of kind = \"contour\" uses it"],
        ),
    ] {
        gear_refused(&sound, change, at, parts);
    }
    gear_refused(
        SOLID,
        ("axial_mm = 3.0", "element = \"tet10\"\nplane_strain = true"),
        "plane_strain",
        &["mesh.plane_strain", "meshed in quadrilaterals"],
    );
}

/// A multibody scene that is wrong or that its first steps refuse: exit code 2 from `plan`, place and cause on standard error. What else a scene
/// can get wrong is in crates/scene/tests/bad_scenes.rs.
#[test]
fn a_multibody_scene_that_cannot_be_is_explained() {
    const SWING: &str = r#"title = "swing"
[run]
kind = "transient"
end_s = 1.0
[solver]
step_s = 1e-3
[output]
interval_s = 0.1
[[body]]
name = "beam"
mass_kg = 1.0
inertia_kg_m2 = [0.1, 0.1, 0.1]
[[joint]]
name = "hinge"
kind = "revolute"
body_2 = "beam"
"#;
    let desk = Desk::new();
    let sound = desk.file("sound.toml", SWING);
    let answer = succeeds(&["check", argument(&sound)]);
    assert!(
        answer
            .stdout
            .contains("scene `swing`, sound: 1 bodies, 1 joints and motions, 0 force elements"),
        "{answer:#?}"
    );
    assert!(
        succeeds(&["plan", argument(&sound)])
            .stdout
            .contains("1 degrees of freedom left")
    );
    let further = |text: &str| format!("{SWING}{text}\n");
    for (scene, at, parts) in [
        (
            changed(SWING, "body_2 = \"beam\"", "body_2 = \"bean\""),
            "bean",
            &["there is no body `bean`; did you mean `beam`?"][..],
        ),
        (
            changed(SWING, "[0.1, 0.1, 0.1]", "[0.1, 0.1, -0.1]"),
            "inertia",
            &["a moment of inertia is zero or negative"],
        ),
        (
            changed(SWING, "mass_kg = 1.0", "gear = \"none.h5\""),
            "gear =",
            &["none.h5 does not exist", "gearmesh reduce"],
        ),
        (
            further(
                "[[joint]]\nname = \"weld\"\nkind = \"fixed\"\nbody_2 = \"beam\"\n[[motion]]\njoint = \"hinge\"\nspeed_rpm = 6.0",
            ),
            "",
            &["contradict each other", "motion of hinge"],
        ),
        (
            further(
                "[[load]]\nbody = \"beam\"\ntorque_Nm = { table = { file = \"t.csv\", column = \"y\" } }",
            ),
            "",
            &["t.csv:4: time_s: found 1 after 2"],
        ),
    ] {
        desk.file("t.csv", "time_s,y\n0,0\n2,1\n1,2\n");
        let file = desk.file("scene.toml", &scene);
        let answer = gearmesh(&["plan", argument(&file)]);
        refused(&answer, 2, parts);
        if !at.is_empty() {
            let place = format!("{}:{}: ", file.display(), line_of(&scene, at));
            assert!(
                answer.stderr.contains(&place),
                "`{place}` is not in {answer:#?}"
            );
        }
    }
}
