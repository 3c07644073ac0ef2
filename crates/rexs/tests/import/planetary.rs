//! A planetary stage with a pinion on its carrier's shaft: what stands behind the stage turns and is loaded by Willis'
//! equation. Whole files are run by the program's tests.

use crate::other_gearboxes::{component, demand_all_listed, model, shaft};
use crate::{file, read};
use gearmesh_rexs::{Import, Meshes, Running, import_to_run};

/// Sun 20, three planets 22, ring 64, as an industry program writes them: pins without a relation of their own,
/// carriers in two halves. `brake` is what the ring's shaft is joined to: the casing, or nothing; `ring_load` a load on
/// that shaft.
fn gearbox(held: &str, loads: &[(&str, usize, &str)]) -> String {
    gearbox_of([0.0, 120.0, 240.0], held, loads)
}

/// The same with planets at other angles.
pub fn gearbox_of(planets_deg: [f64; 3], held: &str, loads: &[(&str, usize, &str)]) -> String {
    let gear = |teeth, width, place| {
        [
            ("number_of_teeth", "none", teeth),
            ("normal_module", "mm", "2"),
            ("face_width", "mm", width),
            ("u_coordinate_on_shaft", "mm", place),
        ]
    };
    let bearing = |place| {
        [
            ("u_coordinate_on_shaft_inner_side", "mm", place),
            ("axial_force_absorption", "none", "both_directions"),
            ("radial_stiffness", "N / m", "1e9"),
            ("axial_stiffness", "N / m", "1e9"),
        ]
    };
    let speed = [
        ("rotational_speed", "1 / min", "1500"),
        ("defines_speed", "none", "true"),
    ];
    let mut parts = component(1, "gear_unit", "unit", &[])
        + &component(2, "gear_casing", "casing", &[])
        + &shaft(10, "sun shaft", "0 0 0", "1 0 0", &speed)
        + &shaft(11, "carrier one", "200 0 0", "1 0 0", &[])
        + &shaft(12, "carrier two", "90 0 0", "1 0 0", &[])
        + &shaft(13, "ring shaft", "190 0 0", "1 0 0", &[])
        + &shaft(14, "output shaft", "200 90 0", "1 0 0", &[])
        + &component(20, "cylindrical_gear", "sun", &gear("20", "30", "160"))
        + &component(21, "ring_gear", "ring", &gear("-64", "30", "0"))
        + &component(22, "cylindrical_gear", "pinion", &gear("30", "20", "90"))
        + &component(23, "cylindrical_gear", "wheel", &gear("60", "20", "90"))
        + &component(30, "planetary_stage", "planets", &[])
        + &component(31, "planet_carrier", "carrier", &[])
        + &component(
            32,
            "cylindrical_stage",
            "output",
            &[("center_distance", "mm", "90")],
        );
    let mut relations: Vec<(&str, Vec<(usize, &str)>)> = vec![
        ("stage", vec![(22, "gear_1"), (32, "stage"), (23, "gear_2")]),
        (
            "central_shaft",
            vec![(30, "planetary_stage"), (10, "shaft")],
        ),
    ];
    for (whole, part) in [(10, 20), (13, 21), (11, 22), (14, 23), (31, 11), (31, 12)] {
        relations.push(("assembly", vec![(whole, "assembly"), (part, "part")]));
    }
    for carrier in [11, 12] {
        let refs = vec![(30, "planetary_stage"), (carrier, "shaft")];
        relations.push(("planet_carrier_shaft", refs));
    }
    for (i, on) in [10, 11, 14].into_iter().enumerate() {
        for (k, place) in ["20", "180"].into_iter().enumerate() {
            let id = 40 + 2 * i + k;
            parts += &component(
                id,
                "concept_bearing",
                &format!("bearing {id}"),
                &bearing(place),
            );
            let refs = vec![(id, "assembly"), (on, "inner_part"), (2, "outer_part")];
            relations.push(("side", refs));
        }
    }
    for (planet, angle_deg) in planets_deg.into_iter().enumerate() {
        let [on, pin, own, sun, ring] = [300, 310, 320, 330, 340].map(|base| base + planet);
        let (sin, cos) = angle_deg.to_radians().sin_cos();
        let place = format!("160 {:.4} {:.4}", 42.0 * sin, 42.0 * cos);
        parts += &shaft(on, &format!("planet shaft {planet}"), &place, "1 0 0", &[]);
        parts += &shaft(pin, &format!("pin {planet}"), "150 0 42", "1 0 0", &[]);
        parts += &component(
            own,
            "cylindrical_gear",
            &format!("planet {planet}"),
            &gear("22", "30", "0"),
        );
        for id in [sun, ring] {
            parts += &component(id, "cylindrical_stage", "", &[]);
            relations.push(("assembly", vec![(30, "assembly"), (id, "part")]));
        }
        relations.push(("assembly", vec![(on, "assembly"), (own, "part")]));
        relations.push(("assembly", vec![(31, "assembly"), (pin, "part")]));
        relations.push(("planet_shaft", vec![(30, "planetary_stage"), (on, "shaft")]));
        relations.push((
            "stage",
            vec![(20, "gear_1"), (sun, "stage"), (own, "gear_2")],
        ));
        relations.push((
            "stage",
            vec![(own, "gear_1"), (ring, "stage"), (21, "gear_2")],
        ));
    }
    if held == "brake" {
        parts += &component(
            60,
            "switchable_coupling",
            "brake",
            &[("is_engaged", "none", "true")],
        );
        let refs = vec![(60, "assembly"), (13, "inner_part"), (2, "outer_part")];
        relations.push(("side", refs));
    }
    for (i, (name, on, torque)) in loads.iter().enumerate() {
        let mut values = vec![
            ("u_coordinate_on_shaft", "mm", "10"),
            ("transmits_torque", "none", "true"),
        ];
        if !torque.is_empty() {
            values.push(("torque_around_u_axis", "N m", torque));
        }
        parts += &component(70 + i, "external_load", name, &values);
        relations.push(("assembly", vec![(*on, "assembly"), (70 + i, "part")]));
    }
    let relations: Vec<_> = relations
        .iter()
        .map(|(kind, list)| (*kind, &list[..]))
        .collect();
    model(&parts, &relations, "")
}

fn told<'a>(made: &'a Import, subject: &str) -> &'a str {
    let left = &made.ledger.not_represented;
    let found = left.iter().find(|e| e.subject.starts_with(subject));
    &found
        .unwrap_or_else(|| panic!("{subject} is not among {left:?}"))
        .text
}

/// 50 N m on the sun, ring held: carrier 1500·20/84 1/min and 50·84/20 = 210 N m, output wheel 420 N m.
#[test]
fn torque_passes_a_stage_whose_ring_stands() {
    for held in ["brake", "nothing"] {
        let text = gearbox(held, &[("motor", 10, "50"), ("machine", 14, "")]);
        let made = read(&text);
        demand_all_listed(&text, &made);
        let scene = file(&made, "box.toml");
        for words in [
            "speed_rpm = 1500.0",
            "[[planetary]]\nname = \"planets\"",
            "sun_torque = \"positive\"",
            "sun = { body = \"sun\" }",
            "support = \"held\"",
            "name = \"planets carrier on carrier one\"",
            "name = \"held at motor\"",
            "name = \"machine\"\nbody = \"output shaft/0\"\ntorque_Nm = 420.0",
        ] {
            assert!(scene.contains(words), "{held}: {words} is not in {scene}");
        }
        // Pins, the second half of the carrier and the ring's shaft carry nothing here.
        for name in ["pin 0", "carrier two", "ring shaft", "planet shaft 0"] {
            assert!(!scene.contains(name), "{held}: {name} is in {scene}");
        }
        let assumed = &made.ledger.assumed;
        let words = "3 planets, all as the first one; its ring stands";
        let of_set = |e: &gearmesh_rexs::Entry| e.subject.starts_with("planetary_stage");
        assert!(assumed.iter().any(|e| of_set(e) && e.text.contains(words)));
        assert!(file(&made, "box_ring.toml").contains("teeth = -64"));
        assert!(told(&made, "shaft 310 `pin 0`").contains("not in the scene"));
    }
}

/// Torque on the ring, sun held: the carrier turns 64/84 times as fast, with 84/64 of the torque.
#[test]
fn torque_passes_a_stage_whose_sun_stands() {
    let loads = [("ring motor", 13, "64"), ("machine", 14, "")];
    let made = read(&gearbox("nothing", &loads));
    let words = told(&made, "planetary_stage");
    assert!(
        words.contains("its sun stands, carrier turns 0.761905 times as fast as ring"),
        "{words}"
    );
    let scene = file(&made, "box.toml");
    for words in [
        "name = \"torque at ring of planets\"",
        "name = \"machine\"\nbody = \"output shaft/0\"\ntorque_Nm = 168.0",
    ] {
        assert!(scene.contains(words), "{words} is not in {scene}");
    }
}

/// Three members that turn are told, and pass nothing on.
#[test]
fn three_turning_members_pass_nothing() {
    let loads = [
        ("motor", 10, "50"),
        ("ring motor", 13, "20"),
        ("machine", 14, ""),
    ];
    let made = read(&gearbox("nothing", &loads));
    let words = told(&made, "planetary_stage");
    assert!(words.contains("do not pass through"), "{words}");
    assert!(words.contains("sun, ring, carrier"), "{words}");
}

/// Planets stay where the file has them, but for its rounding. Teeth of 20 and 64 fit every 360/84 deg; a planet
/// between two such places is moved to the nearer one, and the import says so.
#[test]
fn planets_that_are_moved_are_named() {
    let loads = [("motor", 10, "50"), ("machine", 14, "")];
    for (off_deg, told) in [(0.0, None), (1.0, Some("moved by up to 1.000 deg"))] {
        let made = read(&gearbox_of([0.0, 120.0 + off_deg, 240.0], "brake", &loads));
        let of_set = |e: &&gearmesh_rexs::Entry| {
            e.subject.starts_with("planetary_stage") && e.text.contains("moved")
        };
        let found = made.ledger.assumed.iter().find(of_set);
        match told {
            None => assert!(found.is_none(), "{found:?}"),
            Some(words) => assert!(found.is_some_and(|e| e.text.contains(words)), "{found:?}"),
        }
        let scene = file(&made, "box.toml");
        let angles = scene.split_once("angles_deg = [").unwrap().1;
        let angles: Vec<f64> = (angles.split_once(']').unwrap().0.split(','))
            .map(|angle| angle.trim().parse().unwrap())
            .collect();
        for apart in [angles[1] - angles[0], angles[2] - angles[1]] {
            let off = apart.rem_euclid(120.0);
            assert!(off.min(120.0 - off) < 1e-6, "{angles:?}");
        }
    }
}

/// Planets swing between sun and ring faster than their teeth come: with steps of a twentieth of a mesh period, which
/// trains of cylindrical gears have, sets lost their teeth within milliseconds.
#[test]
fn sets_in_time_have_steps_that_follow_their_planets() {
    let set = gearbox("brake", &[("motor", 10, "50"), ("machine", 14, "")]);
    for (text, steps) in [(&*set, "a 100th"), (crate::GEARBOX, "a 20th")] {
        let bytes = text.as_bytes().to_vec();
        let made = import_to_run(bytes, "box", Meshes::Iso6336, Running::InTime).unwrap();
        let scene = file(&made, "box.toml");
        assert!(scene.contains(&format!("# {steps} of a period")), "{scene}");
    }
}
