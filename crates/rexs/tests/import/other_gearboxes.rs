//! Gearboxes that differ from the shipped one: a bevel and a cylindrical stage behind a coupling, with a load spectrum;
//! a planetary stage. Every value of each file stands in one of the three lists.

use crate::{GEARBOX, file, names, read};
use gearmesh_rexs::{Entry, Import};

/// A component with its attributes: id, unit, value; several numbers make an array.
pub fn component(id: usize, kind: &str, name: &str, attributes: &[(&str, &str, &str)]) -> String {
    let mut text = format!("<component id=\"{id}\" type=\"{kind}\" name=\"{name}\">\n");
    for (key, unit, value) in attributes {
        let cells: Vec<String> = value.split(' ').map(|c| format!("<c>{c}</c>")).collect();
        let value = match &cells[..] {
            [_] => (*value).to_owned(),
            _ => format!("<array>{}</array>", cells.concat()),
        };
        text += &format!("<attribute id=\"{key}\" unit=\"{unit}\">{value}</attribute>\n");
    }
    text + "</component>\n"
}

/// Type and references by id and role.
pub type Relation<'a> = (&'a str, &'a [(usize, &'a str)]);

/// A file of components, relations (type, references by id and role) and what follows them.
pub fn model(parts: &str, relations: &[Relation<'_>], after: &str) -> String {
    let relation = |(i, (kind, references)): (usize, &Relation<'_>)| {
        let references: String = (references.iter())
            .map(|(id, role)| format!("<ref id=\"{id}\" role=\"{role}\"/>"))
            .collect();
        format!(
            "<relation id=\"{}\" type=\"{kind}\">{references}</relation>\n",
            i + 1
        )
    };
    let relations: String = relations.iter().enumerate().map(relation).collect();
    format!(
        "<model version=\"1.7\" applicationId=\"test\" applicationVersion=\"1\" date=\"2026-11-23T12:00:00+00:00\">\n\
         <relations>\n{relations}</relations>\n<components>\n{parts}</components>\n{after}</model>\n"
    )
}

const SECTION: [(&str, &str, &str); 5] = [
    ("length", "mm", "200"),
    ("outer_diameter_begin", "mm", "40"),
    ("outer_diameter_end", "mm", "40"),
    ("inner_diameter_begin", "mm", "0"),
    ("inner_diameter_end", "mm", "0"),
];

/// A shaft at a place, along u, from the unit's frame.
pub fn shaft(
    id: usize,
    name: &str,
    place: &str,
    u: &str,
    further: &[(&str, &str, &str)],
) -> String {
    let mut attributes = vec![
        ("reference_component_for_position", "none", "1"),
        ("support_vector", "mm", place),
        ("u_axis_vector", "mm", u),
        ("w_axis_vector", "mm", "0 0 1"),
    ];
    attributes.extend(further);
    component(id, "shaft", name, &attributes) + &component(id + 100, "shaft_section", "", &SECTION)
}

/// Every attribute of the text is told about its component: taken, assumed or not represented.
pub fn demand_all_listed(text: &str, made: &Import) {
    let ledger = &made.ledger;
    let all: Vec<&Entry> = (ledger.taken.iter())
        .chain(&ledger.assumed)
        .chain(&ledger.not_represented)
        .collect();
    let between = |line: &str, begin: &str| -> Option<String> {
        let rest = line.split_once(begin)?.1;
        Some(rest.split_once('"')?.0.to_owned())
    };
    let (mut subject, mut count) = (String::new(), 0);
    for part in text.split('<') {
        if part.starts_with("component ") {
            let [id, kind] = ["id=\"", "type=\""].map(|key| between(part, key).unwrap());
            subject = format!("{kind} {id}");
        }
        if part.starts_with("attribute ") {
            // A name of an earlier version is told as the one that took its place.
            let key = between(part, "id=\"").unwrap();
            let key = match &key[..] {
                "tip_radius_factor" => "tip_corner_radius_factor_reference_profile",
                key => key,
            };
            let of =
                |e: &&&Entry| e.subject == subject || e.subject.starts_with(&format!("{subject} "));
            let found = all.iter().filter(of).any(|e| e.text.contains(key));
            assert!(found, "{key} of {subject} is in no list");
            count += 1;
        }
    }
    assert!(count > 30, "{count}");
}

/// Motor - coupling - bevel pair 20/20 - pinion 18 and wheel 54 - machine; two load cases.
fn bevel_and_cylindrical() -> String {
    let load = |place| {
        [
            ("u_coordinate_on_shaft", "mm", place),
            ("transmits_torque", "none", "true"),
        ]
    };
    let bevel = |hand| {
        [
            ("number_of_teeth", "none", "20"),
            ("u_coordinate_on_shaft", "mm", "22.1985"),
            ("face_width", "mm", "15"),
            ("outer_pitch_diameter", "mm", "70"),
            ("mean_spiral_angle", "deg", "35"),
            ("spiral_angle_pitch_direction", "none", hand),
            ("bevel_cone_orientation", "none", "negative"),
        ]
    };
    let gear = |teeth, place| {
        [
            ("number_of_teeth", "none", teeth),
            ("normal_module", "mm", "2.5"),
            ("normal_pressure_angle", "deg", "20"),
            ("face_width", "mm", "25"),
            ("u_coordinate_on_shaft", "mm", place),
        ]
    };
    let bearing = |place, axial| {
        [
            ("u_coordinate_on_shaft_inner_side", "mm", place),
            ("axial_force_absorption", "none", axial),
            ("radial_force_absorption", "none", "true"),
            ("radial_stiffness", "N / mm", "1e6"),
        ]
    };
    let mut parts = component(
        1,
        "gear_unit",
        "unit",
        &[("account_for_gravity", "none", "false")],
    ) + &component(2, "gear_casing", "casing", &[])
        + &shaft(
            10,
            "motor shaft",
            "210 0 0",
            "1 0 0",
            &[("rotational_speed", "1 / min", "1500")],
        )
        + &shaft(11, "pinion shaft", "0 0 0", "1 0 0", &[])
        + &shaft(12, "middle shaft", "0 0 0", "0 1 0", &[])
        + &shaft(13, "output shaft", "90 0 0", "0 1 0", &[])
        + &component(20, "bevel_gear", "bevel pinion", &bevel("left"))
        + &component(21, "bevel_gear", "bevel gear", &bevel("right"))
        + &component(22, "cylindrical_gear", "pinion", &gear("18", "100"))
        + &component(23, "cylindrical_gear", "wheel", &gear("54", "100"))
        + &component(
            30,
            "bevel_stage",
            "bevel stage",
            &[
                ("shaft_angle", "deg", "90"),
                ("nominal_design_pressure_angle_on_drive_side", "deg", "20"),
            ],
        )
        + &component(
            31,
            "cylindrical_stage",
            "cylindrical stage",
            &[("center_distance", "mm", "90")],
        )
        + &component(
            40,
            "coupling",
            "coupling",
            &[
                ("u_coordinate_on_shaft_inner_side", "mm", "200"),
                ("u_coordinate_on_shaft_outer_side", "mm", "10"),
                ("rotational_stiffness", "N mm / rad", "2e7"),
                ("radial_stiffness", "N / mm", "5000"),
                ("damping_ratio", "none", "0.1"),
            ],
        )
        + &component(
            41,
            "additional_mass",
            "half coupling",
            &[
                ("u_coordinate_on_shaft", "mm", "195"),
                ("mass_of_component", "kg", "1.5"),
                ("moment_of_inertia_u_axis", "kg m^2", "0.002"),
                ("colour", "none", "grey"),
            ],
        )
        + &component(
            50,
            "external_load",
            "motor",
            &[&load("190")[..], &[("torque_around_u_axis", "N m", "100")]].concat(),
        )
        + &component(51, "external_load", "machine", &load("190"));
    let mut relations: Vec<(&str, Vec<(usize, &str)>)> = vec![
        (
            "side",
            vec![(40, "assembly"), (11, "inner_part"), (10, "outer_part")],
        ),
        ("stage", vec![(30, "stage"), (20, "gear_1"), (21, "gear_2")]),
        ("stage", vec![(31, "stage"), (22, "gear_1"), (23, "gear_2")]),
    ];
    for (whole, part) in [
        (1, 2),
        (1, 10),
        (1, 11),
        (1, 12),
        (1, 13),
        (1, 30),
        (1, 31),
        (11, 20),
        (12, 21),
        (12, 22),
        (13, 23),
        (11, 41),
        (10, 50),
        (13, 51),
        (10, 110),
        (11, 111),
        (12, 112),
        (13, 113),
    ] {
        relations.push(("assembly", vec![(whole, "assembly"), (part, "part")]));
    }
    for (i, on) in [10, 11, 12, 13].into_iter().enumerate() {
        for (k, (place, axial)) in [("60", "both_directions"), ("160", "no")]
            .into_iter()
            .enumerate()
        {
            let id = 60 + 2 * i + k;
            parts += &component(
                id,
                "concept_bearing",
                &format!("bearing {on} {place}"),
                &bearing(place, axial),
            );
            relations.push((
                "side",
                vec![(id, "assembly"), (on, "inner_part"), (2, "outer_part")],
            ));
        }
    }
    let relations: Vec<_> = relations
        .iter()
        .map(|(kind, list)| (*kind, &list[..]))
        .collect();
    let case = |id: usize, share: &str, torque: &str| {
        let unit = component(
            1,
            "gear_unit",
            "",
            &[("operating_time_fraction", "%", share)],
        );
        let load = component(
            50,
            "external_load",
            "",
            &[("torque_around_u_axis", "N m", torque)],
        );
        format!("<load_case id=\"{id}\">\n{unit}{load}</load_case>\n")
    };
    let cases = case(1, "70", "100") + &case(2, "30", "40");
    model(
        &parts,
        &relations,
        &format!("<load_spectrum id=\"1\">\n{cases}</load_spectrum>\n"),
    )
}

#[test]
fn nothing_is_dropped_in_silence() {
    demand_all_listed(GEARBOX, &read(GEARBOX));
    let text = bevel_and_cylindrical();
    let made = read(&text);
    demand_all_listed(&text, &made);
    assert_eq!(made.scenes.len(), 2, "{:?}", names(&made));
    let scene = file(&made, "box.toml");
    for words in [
        "name = \"coupling\"",
        "[[bushing]]",
        "kind = \"iso6336\"",
        "mass_kg = 1.5, inertia_kg_m2 = [0.0, 0.0, 0.002]",
    ] {
        assert!(scene.contains(words), "{words} is not in {scene}");
    }
    assert!(file(&made, "box_case_2.toml").contains("30.0000 % of the time"));
    let left = &made.ledger.not_represented;
    for words in ["damping_ratio", "colour"] {
        assert!(left.iter().any(|e| e.text.contains(words)), "{words}");
    }
}

/// Sun 20, planets 22, ring 64: planetary stages are not represented; what is not is told value by value, and what
/// there is beside them is imported.
#[test]
fn of_a_planetary_stage_everything_is_told() {
    let gear = |teeth, place| {
        [
            ("number_of_teeth", "none", teeth),
            ("normal_module", "mm", "2"),
            ("face_width", "mm", "30"),
            ("u_coordinate_on_shaft", "mm", place),
        ]
    };
    let parts = component(1, "gear_unit", "unit", &[("gear_shift_index", "none", "1")])
        + &component(2, "gear_casing", "casing", &[("comment", "none", "ribbed")])
        + &shaft(
            10,
            "sun shaft",
            "0 0 0",
            "1 0 0",
            &[("rotational_speed", "1 / min", "900")],
        )
        + &shaft(11, "carrier shaft", "150 0 0", "1 0 0", &[])
        + &shaft(12, "planet pin", "100 0 42", "1 0 0", &[])
        + &component(20, "cylindrical_gear", "sun", &gear("20", "100"))
        + &component(21, "cylindrical_gear", "planet", &gear("22", "0"))
        + &component(22, "ring_gear", "ring", &gear("64", "100"))
        + &component(
            23,
            "planet_carrier",
            "carrier",
            &[("number_of_planets", "none", "3")],
        )
        + &component(
            30,
            "planetary_stage",
            "stage",
            &[("number_of_planets", "none", "3")],
        )
        + &component(
            31,
            "cylindrical_stage",
            "sun and planet",
            &[("center_distance", "mm", "42")],
        )
        + &component(
            32,
            "cylindrical_stage",
            "planet and ring",
            &[("center_distance", "mm", "42")],
        )
        + &component(
            50,
            "external_load",
            "in",
            &[
                ("torque_around_u_axis", "N m", "20"),
                ("u_coordinate_on_shaft", "mm", "10"),
            ],
        );
    let relations: [(&str, &[(usize, &str)]); 13] = [
        ("assembly", &[(1, "assembly"), (10, "part")]),
        ("assembly", &[(1, "assembly"), (11, "part")]),
        ("assembly", &[(10, "assembly"), (20, "part")]),
        ("assembly", &[(12, "assembly"), (21, "part")]),
        ("assembly", &[(10, "assembly"), (110, "part")]),
        ("assembly", &[(11, "assembly"), (111, "part")]),
        ("assembly", &[(12, "assembly"), (112, "part")]),
        ("planet_pin", &[(30, "stage"), (12, "shaft")]),
        ("planet_carrier_shaft", &[(30, "stage"), (11, "shaft")]),
        ("stage", &[(31, "stage"), (20, "gear_1"), (21, "gear_2")]),
        ("stage", &[(32, "stage"), (21, "gear_1"), (22, "gear_2")]),
        ("assembly", &[(30, "assembly"), (31, "part")]),
        ("assembly", &[(10, "assembly"), (50, "part")]),
    ];
    let text = model(&parts, &relations, "");
    let made = read(&text);
    demand_all_listed(&text, &made);
    let left = &made.ledger.not_represented;
    for subject in ["planetary_stage 30", "ring_gear 22", "shaft 12"] {
        let told = left.iter().any(|e| e.subject.starts_with(subject));
        assert!(told, "{subject} is not among {left:?}");
    }
}
