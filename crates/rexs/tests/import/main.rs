//! REXS files in all containers, versions and states of repair. The gearbox is the shipped one, whose bearing forces
//! are known by hand; the program's tests run what is imported here.
#![allow(clippy::unwrap_used, clippy::expect_used, missing_docs)]

mod bad_files;
mod bevel_force;
mod containers;
mod dialects;
mod incomplete;
mod large_files;
mod loose_gears;
mod lost_loads;
mod other_gearboxes;
mod planetary;
mod planetary_flanks;
mod power;
mod real_files;

use gearmesh_rexs::{Import, Meshes, import};

/// The shipped gearbox, REXS 1.7.
pub const GEARBOX: &str = include_str!("../../../../fe_models/gearbox_three_stage.rexs");

/// Imports a text.
pub fn read(text: &str) -> Import {
    import(text.as_bytes().to_vec(), "box", Meshes::Iso6336).unwrap()
}

/// A file that was made.
pub fn file<'a>(made: &'a Import, name: &str) -> &'a str {
    let found = made.files.iter().find(|f| f.name == name);
    &found
        .unwrap_or_else(|| panic!("no {name} among {:?}", names(made)))
        .text
}

/// Names of the files that were made.
pub fn names(made: &Import) -> Vec<&str> {
    made.files.iter().map(|f| f.name.as_str()).collect()
}

/// A text with something replaced that must be in it.
pub fn changed(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "{from} is not in the text");
    text.replace(from, to)
}

/// Demands that two imports have made the same files; the version in their heads may differ.
pub fn demand_same(a: &Import, b: &Import) {
    assert_eq!(names(a), names(b));
    for (one, other) in a.files.iter().zip(&b.files) {
        let lines = |text: &str| -> Vec<String> {
            let all = text.lines().filter(|l| !l.starts_with("# Imported"));
            all.map(str::to_owned).collect()
        };
        let (one_lines, other_lines) = (lines(&one.text), lines(&other.text));
        for (x, y) in one_lines.iter().zip(&other_lines) {
            assert_eq!(x, y, "in {}", one.name);
        }
        assert_eq!(one_lines.len(), other_lines.len(), "in {}", one.name);
    }
}

/// The message of a file that cannot be read.
pub fn message(bytes: Vec<u8>) -> String {
    import(bytes, "box", Meshes::Iso6336)
        .unwrap_err()
        .to_string()
}

/// A gear unit with two shafts, a spur stage and nothing else, for changes.
pub fn small() -> String {
    let mut text = String::from(
        "<model version=\"1.4\" applicationId=\"t\" applicationVersion=\"1\" date=\"\"><relations>",
    );
    for (id, kind, references) in [
        (
            1,
            "assembly",
            "<ref id=\"2\" role=\"assembly\"/><ref id=\"4\" role=\"part\"/>",
        ),
        (
            2,
            "assembly",
            "<ref id=\"3\" role=\"assembly\"/><ref id=\"5\" role=\"part\"/>",
        ),
        (
            3,
            "stage",
            "<ref id=\"6\" role=\"stage\"/><ref id=\"4\" role=\"gear_1\"/><ref id=\"5\" role=\"gear_2\"/>",
        ),
        (
            4,
            "side",
            "<ref id=\"7\" role=\"assembly\"/><ref id=\"2\" role=\"inner_part\"/><ref id=\"9\" role=\"outer_part\"/>",
        ),
        (
            5,
            "side",
            "<ref id=\"8\" role=\"assembly\"/><ref id=\"3\" role=\"inner_part\"/><ref id=\"9\" role=\"outer_part\"/>",
        ),
        (
            6,
            "assembly",
            "<ref id=\"2\" role=\"assembly\"/><ref id=\"10\" role=\"part\"/>",
        ),
        (
            7,
            "assembly",
            "<ref id=\"3\" role=\"assembly\"/><ref id=\"11\" role=\"part\"/>",
        ),
    ] {
        text.push_str(&format!(
            "<relation id=\"{id}\" type=\"{kind}\">{references}</relation>\n"
        ));
    }
    text.push_str("</relations><components>\n");
    let a = |id: &str, unit: &str, value: &str| {
        format!("<attribute id=\"{id}\" unit=\"{unit}\">{value}</attribute>")
    };
    let gear = |teeth: &str| {
        [
            a("number_of_teeth", "none", teeth),
            a("normal_module", "mm", "2"),
            a("face_width", "mm", "20"),
            a("u_coordinate_on_shaft", "mm", "30"),
        ]
        .concat()
    };
    let bearing = [
        a("u_coordinate_on_shaft_inner_side", "mm", "10"),
        a("bending_stiffness", "N mm / rad", "1e9"),
    ]
    .concat();
    let vector = "<attribute id=\"support_vector\" unit=\"mm\"><array><c>0</c><c>0</c><c>0</c></array></attribute>";
    for (id, kind, name, attributes) in [
        (1, "gear_unit", "unit", String::new()),
        (
            2,
            "shaft",
            "one",
            [vector.to_owned(), a("rotational_speed", "1 / min", "1000")].concat(),
        ),
        (
            3,
            "shaft",
            "two",
            vector.replacen("<c>0</c></array>", "<c>62</c></array>", 1),
        ),
        (4, "cylindrical_gear", "pinion", gear("20")),
        (5, "cylindrical_gear", "wheel", gear("42")),
        (
            6,
            "cylindrical_stage",
            "stage",
            a("center_distance", "mm", "62"),
        ),
        (7, "concept_bearing", "left", bearing.clone()),
        (8, "concept_bearing", "right", bearing),
        (9, "gear_casing", "casing", String::new()),
        (
            10,
            "external_load",
            "in",
            a("torque_around_u_axis", "N m", "10"),
        ),
        (
            11,
            "external_load",
            "out",
            a("transmits_torque", "none", "true"),
        ),
    ] {
        text.push_str(&format!(
            "<component id=\"{id}\" type=\"{kind}\" name=\"{name}\">{attributes}</component>\n"
        ));
    }
    text + "</components></model>"
}
