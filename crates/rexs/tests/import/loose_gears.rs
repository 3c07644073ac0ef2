//! Gears that turn loose on their shafts, gears at the place of others, brakes, shafts that point against each other,
//! collars.

use crate::other_gearboxes::{Relation, component, demand_all_listed, model, shaft};
use crate::{file, read};
use gearmesh_rexs::Import;

/// Lines of a table of the scene, from its name on.
fn table<'a>(scene: &'a str, name: &str) -> Vec<&'a str> {
    let begin = format!("name = \"{name}\"");
    let lines = scene.lines().skip_while(|l| *l != begin);
    lines.take_while(|l| !l.is_empty()).collect()
}

fn told(made: &Import, subject: &str) -> String {
    let ledger = &made.ledger;
    let all = ledger.assumed.iter().chain(&ledger.not_represented);
    let mine = all.filter(|e| e.subject.contains(subject));
    mine.map(|e| e.text.as_str()).collect::<Vec<_>>().join("; ")
}

fn gear(id: usize, name: &str, teeth: &str, u: &str) -> String {
    let values = [
        ("number_of_teeth", "none", teeth),
        ("normal_module", "mm", "2"),
        ("normal_pressure_angle", "deg", "20"),
        ("face_width", "mm", "20"),
        ("u_coordinate_on_shaft", "mm", u),
    ];
    component(id, "cylindrical_gear", name, &values)
}

fn load(id: usize, name: &str, torque: Option<&str>) -> String {
    let mut values = vec![
        ("u_coordinate_on_shaft", "mm", "5"),
        ("transmits_torque", "none", "true"),
    ];
    values.extend(torque.map(|t| ("torque_around_u_axis", "N m", t)));
    component(id, "external_load", name, &values)
}

/// Two shafts with two pairs of gears, 20/40 at u = 60 and 30/30 at u = 120 mm; `further` components and relations, one
/// of which seats the wheels 22 and 23 on the second shaft.
fn two_pairs(
    gear_in_use: &str,
    u_second: &str,
    further: &str,
    relations: &[Relation<'_>],
) -> String {
    let unit = [
        ("number_of_gears", "none", "2"),
        ("gear_shift_index", "none", gear_in_use),
        ("support_vector", "mm", "0 0 0"),
    ];
    let speed = [("rotational_speed", "1 / min", "1000")];
    let origin = if u_second.starts_with('-') {
        "200 60.06 0"
    } else {
        "0 60.06 0"
    };
    let parts = component(1, "gear_unit", "unit", &unit)
        + &component(2, "gear_casing", "casing", &[])
        + &shaft(10, "in", "0 0 0", "1 0 0", &speed)
        + &shaft(11, "out", origin, u_second, &[])
        + &gear(20, "p1", "20", "50")
        + &gear(21, "p2", "30", "110")
        + &gear(22, "w1", "40", "50")
        + &gear(23, "w2", "30", "110")
        + &component(30, "cylindrical_stage", "low", &[])
        + &component(31, "cylindrical_stage", "high", &[])
        + &load(40, "motor", Some("30"))
        + further;
    let mut all: Vec<Relation<'_>> = vec![
        ("assembly", &[(10, "assembly"), (110, "part")]),
        ("assembly", &[(11, "assembly"), (111, "part")]),
        ("assembly", &[(10, "assembly"), (20, "part")]),
        ("assembly", &[(10, "assembly"), (21, "part")]),
        ("assembly", &[(10, "assembly"), (40, "part")]),
        ("stage", &[(30, "stage"), (20, "gear_1"), (22, "gear_2")]),
        ("stage", &[(31, "stage"), (21, "gear_1"), (23, "gear_2")]),
    ];
    all.extend(relations);
    model(&parts, &all, "")
}

const ON_OUT: [Relation<'_>; 2] = [
    ("assembly", &[(11, "assembly"), (22, "part")]),
    ("assembly", &[(11, "assembly"), (23, "part")]),
];

/// The gearbox with two speeds: a clutch for each wheel.
fn two_speeds(gear_in_use: &str, is_assembled: bool) -> Import {
    let clutch = |id, name, engaged| {
        let place = ("u_coordinate_on_shaft_inner_side", "mm", "60");
        let engaged = ("is_engaged", "none", engaged);
        component(id, "switchable_coupling", name, &[place, engaged])
    };
    let further = clutch(50, "clutch 1", "true false")
        + &clutch(51, "clutch 2", "false true")
        + &load(41, "machine", None);
    let mut relations: Vec<Relation<'_>> = vec![
        ("assembly", &[(11, "assembly"), (41, "part")]),
        (
            "side",
            &[(50, "assembly"), (11, "inner_part"), (22, "outer_part")],
        ),
        (
            "side",
            &[(51, "assembly"), (11, "inner_part"), (23, "outer_part")],
        ),
    ];
    if is_assembled {
        relations.extend(ON_OUT);
    }
    read(&two_pairs(gear_in_use, "1 0 0", &further, &relations))
}

#[test]
fn the_gear_of_an_open_clutch_turns_loose_and_bears_nothing() {
    for is_assembled in [true, false] {
        for (in_use, fixed, loose, torque) in [("1", "w1", "w2", "60.0"), ("2", "w2", "w1", "30.0")]
        {
            let made = two_speeds(in_use, is_assembled);
            let scene = file(&made, "box.toml");
            assert!(table(scene, "machine").contains(&&*format!("torque_Nm = {torque}")));
            let shaft = table(scene, "out").join("\n");
            assert!(shaft.contains(fixed) && !shaft.contains(loose), "{shaft}");
            let body = table(scene, loose).join("\n");
            assert!(body.contains("position_mm = [") && body.contains("cardan_deg = [0.0, 90.0]"));
            let held = table(scene, &format!("{loose} on out")).join("\n");
            assert!(held.contains("body_1 = \"w") && held.contains("body_2 = \"out/"));
            assert!(held.contains("tilt_stiffness_Nm_per_rad"), "{held}");
            assert!(told(&made, &format!("`{loose}`")).contains("turns loose on out"));
            assert!(!told(&made, "gear_unit").contains("loops"));
        }
    }
}

/// Without clutches the two pairs lock each other.
#[test]
fn a_gearbox_that_is_locked_is_told() {
    let relations = [ON_OUT[0], ON_OUT[1]];
    let made = read(&two_pairs("1", "1 0 0", "", &relations));
    let words = told(&made, "`high`");
    assert!(
        words.contains("LOCKED") && words.contains("-1.000000") && words.contains("-0.500000"),
        "{words}"
    );
}

#[test]
fn a_bearing_inside_a_gear_carries_it_on_the_shaft() {
    let place = [
        ("u_coordinate_on_shaft_inner_side", "mm", "120"),
        ("radial_stiffness", "N / m", "1e9"),
    ];
    let further = component(60, "concept_bearing", "needle", &place);
    let mut relations: Vec<Relation<'_>> = ON_OUT.to_vec();
    relations.push((
        "side",
        &[(60, "assembly"), (11, "inner_part"), (23, "outer_part")],
    ));
    let text = two_pairs("1", "1 0 0", &further, &relations);
    let made = read(&text);
    demand_all_listed(&text, &made);
    let bearing = table(file(&made, "box.toml"), "needle").join("\n");
    for words in [
        "body_1 = \"w2\"",
        "body_2 = \"out/",
        "radial_stiffness_N_per_mm = 1000000.0",
    ] {
        assert!(bearing.contains(words), "{words} is not in {bearing}");
    }
    // Inside of a gear that a feather key holds it carries nothing.
    let key = further + &component(61, "feather_key_connection", "key", &[]);
    relations.push((
        "side",
        &[(61, "assembly"), (11, "inner_part"), (23, "outer_part")],
    ));
    let made = read(&two_pairs("1", "1 0 0", &key, &relations));
    assert!(table(file(&made, "box.toml"), "needle").is_empty());
    assert!(told(&made, "`needle`").contains("carries nothing"));
}

#[test]
fn a_brake_bears_what_the_loads_leave() {
    let further = component(70, "coupling", "brake", &[]);
    let relations = [
        ON_OUT[0],
        (
            "side",
            &[(70, "assembly"), (2, "inner_part"), (11, "outer_part")][..],
        ),
    ];
    let made = read(&two_pairs("1", "1 0 0", &further, &relations));
    let scene = file(&made, "box.toml");
    assert!(table(scene, "brake").contains(&"torque_Nm = 60.0"));
    assert!(told(&made, "`brake`").contains("a brake"));
}

/// A slope towards one face and left and right flanks are the same whichever way the shaft points.
#[test]
fn modifications_follow_the_direction_of_the_shaft() {
    let slope = |flank, datum| {
        let further = component(80, "cylindrical_gear_flank", "", &[])
            + &component(81, "cylindrical_gear_flank", "", &[])
            + &component(82, "helix_slope", "", &[("helix_slope", "mm", "0.01")]);
        let role = |id, role| (id, role);
        let relations = [
            ON_OUT[0],
            (
                "flank",
                &[(22, "gear"), role(80, "left"), role(81, "right")][..],
            ),
            ("reference", &[(flank, "origin"), (82, "referenced")][..]),
        ];
        let u = if datum == "negative" {
            "1 0 0"
        } else {
            "-1 0 0"
        };
        let text = two_pairs("1", u, &further, &relations);
        let at = format!(
            "name=\"w1\">\n<attribute id=\"datum_face_orientation\" unit=\"none\">{datum}</attribute>"
        );
        let made = read(&text.replace("name=\"w1\">", &at));
        let gear = file(&made, "box_w1.toml");
        gear.split_once("[microgeometry").unwrap().1.to_owned()
    };
    // The same face and the same flank: seen from the other end of the shaft left is right.
    assert_eq!(slope(80, "negative"), ".left]\nflank_angle_um = 10.0\n");
    assert_eq!(slope(81, "positive"), ".left]\nflank_angle_um = 10.0\n");
}

#[test]
fn a_collar_over_a_section_ends_nothing() {
    let collar = [
        ("u_coordinate_on_shaft", "mm", "90"),
        ("length", "mm", "20"),
        ("outer_diameter_begin", "mm", "50"),
    ];
    let further = component(90, "shaft_section", "collar", &collar);
    let relations = [
        ON_OUT[0],
        ("assembly", &[(10, "assembly"), (90, "part")][..]),
    ];
    let made = read(&two_pairs("1", "1 0 0", &further, &relations));
    let shaft = table(file(&made, "box.toml"), "in").join("\n");
    for words in [
        "90.0, 110.0, 120.0, 200.0]",
        "outer_diameters_mm = [40.0, 40.0, 40.0, 50.0, 40.0, 40.0]",
    ] {
        assert!(shaft.contains(words), "{words} is not in {shaft}");
    }
    assert!(told(&made, "`in`").contains("sections overlap"));
}

#[test]
fn a_second_gear_at_the_place_of_another_is_fixed_to_it() {
    let text = two_pairs("1", "1 0 0", "", &[ON_OUT[0]]);
    let text = text.replace(
        "<attribute id=\"u_coordinate_on_shaft\" unit=\"mm\">110</attribute>",
        "<attribute id=\"u_coordinate_on_shaft\" unit=\"mm\">50</attribute>",
    );
    let made = read(&text);
    let scene = file(&made, "box.toml");
    let joint = table(scene, "p2 on p1");
    assert_eq!(
        joint[1..],
        ["kind = \"fixed\"", "body_1 = \"p1\"", "body_2 = \"p2\""]
    );
    assert!(table(scene, "p2").contains(&"position_mm = [60.0, 0.0, 0.0]"));
    assert!(told(&made, "`p2`").contains("stands at the place of p1"));
}

#[test]
fn torques_that_do_not_balance_are_mended_where_power_goes_in() {
    let further = load(41, "machine", Some("50"));
    let relations = [
        ON_OUT[0],
        ("assembly", &[(11, "assembly"), (41, "part")][..]),
    ];
    let made = read(&two_pairs("1", "1 0 0", &further, &relations));
    let words = told(&made, "`motor`");
    assert!(
        words.contains("25.0000 N m about u in place of 30.0000 N m here"),
        "{words}"
    );
    assert!(table(file(&made, "box.toml"), "machine").contains(&"torque_Nm = 50.0"));
}

#[test]
fn one_place_that_holds_a_shaft_keeps_it_from_tilting() {
    for places in [vec!["60"], vec!["60", "60.01"], vec!["60", "160"]] {
        let mut further = String::new();
        let mut relations: Vec<Relation<'_>> = vec![ON_OUT[0]];
        let sides = [
            [(65, "assembly"), (11, "inner_part"), (2, "outer_part")],
            [(66, "assembly"), (11, "inner_part"), (2, "outer_part")],
        ];
        for (i, u) in places.iter().enumerate() {
            let values = [("u_coordinate_on_shaft_inner_side", "mm", *u)];
            further += &component(65 + i, "concept_bearing", &format!("b{i}"), &values);
            relations.push(("side", &sides[i]));
        }
        let made = read(&two_pairs("1", "1 0 0", &further, &relations));
        let first = table(file(&made, "box.toml"), "b0").join("\n");
        let is_held = places != ["60", "160"];
        assert_eq!(first.contains("tilt_stiffness"), is_held, "{first}");
        assert_eq!(told(&made, "`b0`").contains("against tilting"), is_held);
    }
}
