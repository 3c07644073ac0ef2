//! Versions by the change logs, and the ways in which programs differ.

use crate::{GEARBOX, changed, demand_same, file, read, small};

#[test]
fn names_of_version_1_0_and_2_0_give_the_same_files() {
    let now = read(GEARBOX);
    let mut old = changed(GEARBOX, "version=\"1.7\"", "version=\"1.0\"");
    for (new, before) in [
        ("cylindrical_gear_flank", "flank_geometry"),
        ("cylindrical_stage_gear_data", "stage_gear_data"),
        ("radial_dynamic_load_rating", "dynamic_capacity"),
        ("radial_static_load_rating", "static_capacity"),
        ("id=\"catalogue_designation\"", "id=\"name\""),
        ("unit=\"deg\"", "unit=\"\u{b0}\""),
        ("N / m\"", "N/m\""),
        ("1 / min", "min^-1"),
    ] {
        old = changed(&old, new, before);
    }
    demand_same(&now, &read(&old));
    let mut new = changed(GEARBOX, "version=\"1.7\"", "version=\"2.0.0\"");
    for (before, after) in [
        (
            "\"tip_radius_factor\"",
            "\"tip_corner_radius_factor_reference_profile\"",
        ),
        ("N / mm^2", "MPa"),
        ("<model ", "<model xmlns=\"https://www.rexs.info\" "),
    ] {
        new = changed(&new, before, after);
    }
    demand_same(&now, &read(&new));
}

#[test]
fn other_units_are_converted() {
    let text = changed(
        &small(),
        "<attribute id=\"face_width\" unit=\"mm\">20<",
        "<attribute id=\"face_width\" unit=\"m\">0,02<",
    );
    let text = changed(&text, "unit=\"N m\">10<", "unit=\"kN m\">1e-2<");
    let text = changed(
        &text,
        "unit=\"1 / min\">1000<",
        "unit=\"rad / s\">104.719755119660<",
    );
    let (a, b) = (read(&small()), read(&text));
    demand_same(&a, &b);
    assert!(
        file(&a, "box.toml").contains("torque_Nm = 21.0"),
        "{}",
        file(&a, "box.toml")
    );
}

#[test]
fn a_unit_that_is_left_out_is_that_of_the_schema_and_told() {
    let text = changed(
        &small(),
        "id=\"normal_module\" unit=\"mm\"",
        "id=\"normal_module\" unit=\"\"",
    );
    let made = read(&text);
    demand_same(&read(&small()), &made);
    let told = |e: &gearmesh_rexs::Entry| e.text == "normal_module: no unit given, taken as mm";
    assert!(made.ledger.assumed.iter().any(told));
}

#[test]
fn shafts_without_vectors_are_placed_by_their_stages() {
    let given = read(GEARBOX);
    let mut text = String::new();
    for line in GEARBOX.lines() {
        // All vectors but those of the gear unit and the first shaft go.
        let is_vector = ["support_vector", "u_axis_vector", "w_axis_vector"]
            .iter()
            .any(|v| line.contains(v));
        let is_first = line.contains("<c>-30</c><c>0</c><c>0</c>") || !is_vector;
        if is_first
            || !text.contains("name=\"wheel 59\"")
                && text.lines().count() < 200
                && line.contains("<c>1</c>")
        {
            text.push_str(line);
        }
        text.push('\n');
    }
    let placed = read(&text);
    let places = |scene: &str| -> Vec<f64> {
        let lines = scene.lines().filter(|l| l.starts_with("origin_mm"));
        let numbers = lines.flat_map(|l| {
            l[13..l.len() - 1]
                .split(", ")
                .map(|n| n.parse().unwrap())
                .collect::<Vec<f64>>()
        });
        numbers.collect()
    };
    let (a, b) = (
        places(file(&given, "box.toml")),
        places(file(&placed, "box.toml")),
    );
    assert_eq!(a.len(), 12);
    for i in [1, 2, 4, 5, 7, 8, 10, 11] {
        assert!((a[i] - b[i]).abs() < 1e-4, "{a:?} and {b:?}");
    }
    // Faces in the middle of each other: the first wheel stands 1 mm off its pinion's middle in the file with vectors.
    assert!(
        (a[3] - b[3] - 1.0).abs() < 1e-4 && (a[9] - b[9] - 1.0).abs() < 1e-4,
        "{a:?} and {b:?}"
    );
}

#[test]
fn a_u_coordinate_that_is_the_middle_is_seen_by_the_support_vector() {
    // Pinion 17: middle of the face at u = 60 mm of its shaft, width 24 mm.
    let start = "id=\"u_coordinate_on_shaft\" unit=\"mm\">48<";
    let text = changed(
        GEARBOX,
        start,
        "id=\"u_coordinate_on_shaft\" unit=\"mm\">60<",
    );
    assert_eq!(GEARBOX.matches(start).count(), 1);
    demand_same(&read(GEARBOX), &read(&text));
}

#[test]
fn din_3967_codes_thin_the_teeth() {
    let with = changed(
        &small(),
        "<attribute id=\"number_of_teeth\" unit=\"none\">20<",
        "<attribute id=\"tooth_thickness_deviation_tolerance_series_din_3967_1978\">c25</attribute><attribute id=\"number_of_teeth\" unit=\"none\">20<",
    );
    // Reference diameter 40 mm: upper allowance -65 um, tolerance 30 um; the middle is 80 um.
    let made = read(&with);
    assert!(
        file(&made, "box_pinion.toml").contains("thickness_allowance_mm = 0.08\n"),
        "{}",
        file(&made, "box_pinion.toml")
    );
    assert!(!file(&made, "box_wheel.toml").contains("thickness_allowance_mm"));
    // Allowances of the chordal thickness, normal and transverse.
    for kind in ["", "transverse_"] {
        let ends = [("upper", "-0.06"), ("lower", "-0.1")];
        let both = ends.map(|(end, mm)| {
            format!("<attribute id=\"chordal_{kind}tooth_thickness_{end}_deviation\" unit=\"mm\">{mm}</attribute>")
        });
        let teeth = "<attribute id=\"number_of_teeth\" unit=\"none\">20<";
        let made = read(&changed(
            &small(),
            teeth,
            &format!("{}{teeth}", both.concat()),
        ));
        let gear = file(&made, "box_pinion.toml");
        assert!(gear.contains("thickness_allowance_mm = 0.08\n"), "{gear}");
    }
}

#[test]
fn rigid_bearings_and_pinions_cut_into_the_shaft_are_told() {
    let made = read(GEARBOX);
    let is_rigid = |e: &gearmesh_rexs::Entry| e.text.contains("stands for rigid");
    assert_eq!(
        made.ledger.assumed.iter().filter(|e| is_rigid(e)).count(),
        2
    );
    assert!(file(&made, "box.toml").contains("radial_stiffness_N_per_mm = 10000000.0"));
    let cut = changed(
        GEARBOX,
        "id=\"outer_diameter_begin\" unit=\"mm\">26<",
        "id=\"outer_diameter_begin\" unit=\"mm\">34<",
    );
    let cut = changed(
        &cut,
        "id=\"inner_diameter\" unit=\"mm\">18<",
        "id=\"inner_diameter\" unit=\"mm\">0<",
    );
    let told = |e: &gearmesh_rexs::Entry| {
        e.subject.contains("pinion 17") && e.text.contains("cut into its shaft")
    };
    let made = read(&cut);
    assert!(made.ledger.assumed.iter().any(told));
    let pinion = file(&made, "box_pinion_17.toml");
    let faces = "bore_diameter_mm = 0.0\nshaft_diameter_mm = [";
    assert!(pinion.contains(faces), "{pinion}");
    // The shaft goes on at both faces.
    let line = pinion
        .lines()
        .find(|line| line.starts_with("shaft_diameter_mm"))
        .unwrap();
    assert!(!line.contains("[0.0") && !line.contains(" 0.0]"), "{line}");
}

#[test]
fn flanks_that_differ_and_tips_that_cannot_be_are_listed() {
    let text = changed(
        GEARBOX,
        "tip_diameter\" unit=\"mm\">41.38",
        "tip_diameter\" unit=\"mm\">1.38",
    );
    let made = read(&text);
    let listed = |words: &str| {
        made.ledger
            .not_represented
            .iter()
            .any(|e| e.text.contains(words))
    };
    assert!(
        listed("which teeth of module 2 mm cannot have"),
        "{:#?}",
        made.ledger.not_represented
    );
    let one = changed(
        &small(),
        "</relations>",
        "<relation id=\"9\" type=\"flank\"><ref id=\"4\" role=\"gear\"/><ref id=\"50\" role=\"left\"/><ref id=\"51\" role=\"right\"/></relation></relations>",
    );
    let flank = |id: u32, x: f64| {
        format!(
            "<component id=\"{id}\" type=\"cylindrical_gear_flank\"><attribute id=\"addendum_modification_coefficient\">{x}</attribute></component>"
        )
    };
    let one = changed(
        &one,
        "</components>",
        &format!("{}{}</components>", flank(50, 0.1), flank(51, 0.2)),
    );
    let made = read(&one);
    assert!(file(&made, "box_pinion.toml").contains("profile_shift = 0.2\n"));
    let told = |e: &gearmesh_rexs::Entry| {
        e.text
            .starts_with("addendum_modification_coefficient of left flanks, 0.1")
    };
    assert!(made.ledger.not_represented.iter().any(told));
}

#[test]
fn teeth_without_backlash_get_a_little() {
    // 20 and 42 teeth of module 2 at their reference distance, without an allowance: rounding would decide.
    let made = read(&small());
    for name in ["box_pinion.toml", "box_wheel.toml"] {
        assert!(
            file(&made, name).contains("thickness_allowance_mm = 0.02\n"),
            "{}",
            file(&made, name)
        );
    }
    assert!(made.ledger.assumed.iter().any(|e| {
        e.text
            .starts_with("no backlash at a centre distance of 62.0000 mm")
    }));
    // At 62.1 mm there is backlash; at 61 mm they jam by far more than rounding, which the scene tells.
    for distance in ["62.1", "61"] {
        let text = changed(&small(), "<c>62</c>", &format!("<c>{distance}</c>"));
        assert!(
            !file(&read(&text), "box_pinion.toml").contains("thickness_allowance_mm"),
            "{distance}"
        );
    }
}

#[test]
fn shafts_that_point_against_each_other_share_one_direction() {
    // The second shaft from its other end: u = -x from x = 80 mm on, its gear in the same place.
    let vectors = "<c>80</c><c>0</c><c>62</c></array></attribute>\
        <attribute id=\"u_axis_vector\" unit=\"mm\"><array><c>-1</c><c>0</c><c>0</c></array></attribute>\
        <attribute id=\"w_axis_vector\" unit=\"mm\"><array><c>0</c><c>0</c><c>1</c>";
    let text = changed(&small(), "<c>0</c><c>0</c><c>62</c>", vectors);
    let scene = read(&text);
    let scene = file(&scene, "box.toml");
    assert_eq!(
        scene.matches("axis = [1.0, 0.0, 0.0]\n").count(),
        2,
        "{scene}"
    );
    assert!(scene.contains("origin_mm = [80.0, 0.0, 62.0]"), "{scene}");
    // About x the wheel turns the other way, and its load acts the same way as before.
    let straight = read(&small());
    let load = |text: &str| {
        text.split("[[load]]")
            .nth(1)
            .unwrap()
            .split("\n\n")
            .next()
            .unwrap()
            .to_owned()
    };
    assert!(load(scene).contains("torque_Nm = 21.0"), "{scene}");
    assert!(load(file(&straight, "box.toml")).contains("torque_Nm = 21.0"));
    let flanks = |text: &str| {
        text.lines()
            .find(|l| l.starts_with("teeth = "))
            .unwrap()
            .to_owned()
    };
    assert_eq!(flanks(scene), flanks(file(&straight, "box.toml")));
}
