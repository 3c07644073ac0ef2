//! What files of programs hold besides what the schema shows: values that were not computed, empty arrays, comments,
//! infinite stiffness, packed arrays, containers of several files, load cases of several spectra.

use crate::containers::zipped;
use crate::{GEARBOX, changed, demand_same, file, message, names, read, small};
use gearmesh_rexs::model::Value;
use gearmesh_rexs::{Import, Meshes, import, xml};

fn left_out(made: &Import, words: &str) -> bool {
    let left = &made.ledger.not_represented;
    left.iter().any(|e| e.text.contains(words))
}

fn assumed(made: &Import, words: &str) -> bool {
    made.ledger.assumed.iter().any(|e| e.text.contains(words))
}

const PRESSURE_ANGLE: &str = "<attribute id=\"normal_module\"";

/// Values that a program has not computed stand as NaN, or as arrays of nothing: they count as not given, and are
/// listed.
#[test]
fn values_that_are_none() {
    let plain = read(&small());
    for (value, told) in [
        (
            "<attribute id=\"tip_diameter\" unit=\"mm\">NaN</attribute>",
            true,
        ),
        ("<attribute id=\"tip_diameter\" unit=\"mm\"/>", false),
        (
            "<attribute id=\"support_vector\" unit=\"mm\"><array><c>NaN</c><c>NaN</c><c>NaN</c></array></attribute>",
            true,
        ),
        (
            "<attribute id=\"support_vector\" unit=\"mm\"><array><c/><c/><c/></array></attribute>",
            false,
        ),
        (
            "<attribute id=\"support_vector\" unit=\"mm\"><array/></attribute>",
            false,
        ),
        (
            "<attribute id=\"support_vector\" unit=\"mm\"><matrix rows=\"0\" columns=\"0\"/></attribute>",
            false,
        ),
    ] {
        let text = changed(
            &small(),
            PRESSURE_ANGLE,
            &format!("{value}{PRESSURE_ANGLE}"),
        );
        let made = read(&text);
        demand_same(&plain, &made);
        assert_eq!(
            left_out(&made, "NaN: as if it were not given"),
            told,
            "{value}"
        );
    }
    // One of three is no vector, and a number that must be there is missed.
    let one = "<attribute id=\"support_vector\" unit=\"mm\"><array><c>0</c><c>NaN</c><c>0</c></array></attribute>";
    let found =
        message(changed(&small(), PRESSURE_ANGLE, &format!("{one}{PRESSURE_ANGLE}")).into_bytes());
    assert!(found.contains("`NaN` is no number"), "{found}");
    let width = "<attribute id=\"face_width\" unit=\"mm\">20<";
    let found = message(changed(&small(), width, &width.replace("20", "nan")).into_bytes());
    assert!(found.contains("face_width is missing"), "{found}");
}

#[test]
fn an_infinite_stiffness_is_rigid() {
    let stiff = "<attribute id=\"bending_stiffness\"";
    for word in ["Infinity", "INF", "1e22"] {
        let text = changed(
            &small(),
            stiff,
            &format!("<attribute id=\"radial_stiffness\" unit=\"N / m\">{word}</attribute>{stiff}"),
        );
        let made = read(&text);
        assert!(assumed(&made, "stands for rigid"), "{word}");
        assert!(file(&made, "box.toml").contains("radial_stiffness_N_per_mm = 10000000.0"));
    }
    let width = "<attribute id=\"face_width\" unit=\"mm\">20<";
    let found = message(changed(&small(), width, &width.replace("20", "INF")).into_bytes());
    assert!(found.contains("allowed is a finite number"), "{found}");
}

#[test]
fn comments_sections_and_spellings_in_values() {
    let plain = read(&small());
    for (from, to) in [
        (">1000<", "><!-- rpm -->1000<!-- at the motor --><"),
        (">1000<", "><![CDATA[1000]]><"),
        (
            "unit=\"1 / min\">1000<",
            "unit=\"min\u{207b}\u{b9}\">\n 1000.0\n<",
        ),
        ("unit=\"N m\">10<", "unit=\"N\u{b7}m\">1.0E1<"),
        (
            "<model ",
            "<rexs:model xmlns:rexs=\"https://www.rexs.info\" xmlns=\"https://www.rexs.info\" ",
        ),
    ] {
        let mut text = changed(&small(), from, to);
        if to.starts_with("<rexs") {
            text = changed(&text, "</model>", "</rexs:model>");
        }
        demand_same(&plain, &read(&text));
    }
}

/// Relations in another order, and the roles in one: nothing hangs on either.
#[test]
fn relations_in_another_order() {
    let plain = small();
    let from = plain.find("<relations>").unwrap() + "<relations>".len();
    let to = plain.find("</relations>").unwrap();
    let turned: Vec<String> = plain[from..to]
        .lines()
        .rev()
        .map(|line| {
            match (
                line.find("<ref "),
                line.rfind("<ref "),
                line.find("</relation>"),
            ) {
                (Some(first), Some(last), Some(end)) if last > first => {
                    format!(
                        "{}{}{}{}",
                        &line[..first],
                        &line[last..end],
                        &line[first..last],
                        &line[end..]
                    )
                }
                _ => line.to_owned(),
            }
        })
        .collect();
    let text = format!("{}{}{}", &plain[..from], turned.join("\n"), &plain[to..]);
    demand_same(&read(&plain), &read(&text));
}

/// A matrix may state its rows alone; columns follow.
#[test]
fn packed_matrices() {
    use base64::Engine;
    let bytes: Vec<u8> = (0..6i32).flat_map(|k| k.to_le_bytes()).collect();
    let packed = base64::engine::general_purpose::STANDARD.encode(bytes);
    let matrix = |sizes: &str| {
        let text = format!(
            "<model version=\"1.4\"><components><component id=\"1\" type=\"gear_unit\"><attribute id=\"a\"><matrix code=\"int32\" {sizes}>{packed}</matrix></attribute></component></components></model>"
        );
        xml::read(&text).map(|model| model.components[0].attributes[0].value.clone())
    };
    let rows = |width: usize| {
        let all: Vec<String> = (0..6).map(|k| k.to_string()).collect();
        Value::Rows(all.chunks(width).map(<[String]>::to_vec).collect())
    };
    assert_eq!(matrix("rows=\"2\" columns=\"3\"").unwrap(), rows(3));
    assert_eq!(matrix("rows=\"2\"").unwrap(), rows(3));
    assert_eq!(matrix("columns=\"2\"").unwrap(), rows(2));
    let found = matrix("").unwrap_err().to_string();
    assert!(found.contains("`columns` is missing"), "{found}");
    let found = matrix("rows=\"two\"").unwrap_err().to_string();
    assert!(found.contains("allowed is a whole number"), "{found}");
}

/// The model lies on top of a container, what it refers to below it.
#[test]
fn containers_of_several_files() {
    let whole = read(GEARBOX);
    let below = small();
    let members: [(&str, &[u8]); 4] = [
        ("bearings/6206.rexs", below.as_bytes()),
        ("gearbox.rexs", GEARBOX.as_bytes()),
        ("pictures/housing.png", b"not read"),
        ("__MACOSX/._gearbox.rexs", b"not read"),
    ];
    let made = import(zipped(&members), "box", Meshes::Iso6336).unwrap();
    demand_same(&whole, &made);
    for (name, _) in members.iter().filter(|m| m.0 != "gearbox.rexs") {
        assert!(left_out(&made, &format!("member {name}")), "{name}");
    }
    // Encrypted: bit 0 of the flags in both headers of the member.
    let mut locked = zipped(&[("gearbox.rexs", GEARBOX.as_bytes())]);
    let central = locked.windows(4).position(|w| w == b"PK\x01\x02").unwrap();
    locked[6] |= 1;
    locked[central + 8] |= 1;
    let found = message(locked).to_lowercase();
    assert!(found.contains("password"), "{found}");
}

#[test]
fn places_from_components_that_are_not_there_are_told() {
    let vector = "<attribute id=\"support_vector\"";
    let at = small().find(vector).unwrap();
    let mut text = small();
    text.insert_str(
        at,
        "<attribute id=\"reference_component_for_position\">77</attribute>",
    );
    let made = read(&text);
    demand_same(&read(&small()), &made);
    assert!(assumed(
        &made,
        "from component 77, which is not in the file"
    ));
}

/// Two spectra whose cases have the same numbers: a scene for each case, and values of components that are not there
/// are reported.
#[test]
fn cases_of_several_spectra() {
    let case = |id: usize, torque: &str| {
        format!(
            "<load_case id=\"{id}\"><component id=\"10\" type=\"external_load\"><attribute id=\"torque_around_u_axis\" unit=\"N m\">{torque}</attribute></component>\
             <component id=\"999\" type=\"shaft\"><attribute id=\"length\" unit=\"mm\">1</attribute></component></load_case>"
        )
    };
    let spectra = format!(
        "<load_spectrum id=\"1\">{}{}</load_spectrum><load_spectrum id=\"2\">{}{}</load_spectrum></model>",
        case(1, "10"),
        case(2, "20"),
        case(1, "30"),
        case(2, "40")
    );
    let made = read(&changed(&small(), "</model>", &spectra));
    assert_eq!(made.scenes.len(), 4, "{:?}", names(&made));
    let mut torques: Vec<&str> = (made.scenes.iter())
        .filter_map(|scene| {
            file(&made, scene)
                .lines()
                .find(|l| l.starts_with("torque_Nm = "))
        })
        .collect();
    torques.sort_unstable();
    torques.dedup();
    assert_eq!(torques.len(), 4, "{torques:?}");
    assert!(left_out(&made, "values of component 999"));
}

/// A mass on a shaft, as the published schema calls it, stands on its station with its inertia.
#[test]
fn added_masses_stand_in_the_scene() {
    let text = changed(
        &small(),
        "</components>",
        "<component id=\"70\" type=\"additional_mass\" name=\"disc\"><attribute id=\"u_coordinate_on_shaft\" unit=\"mm\">75</attribute>\
         <attribute id=\"mass_of_component\" unit=\"kg\">2.5</attribute><attribute id=\"moment_of_inertia_u_axis\" unit=\"kg m^2\">0.002</attribute></component></components>",
    );
    let text = changed(
        &text,
        "</relations>",
        "<relation id=\"70\" type=\"assembly\"><ref id=\"3\" role=\"assembly\"/><ref id=\"70\" role=\"part\"/></relation></relations>",
    );
    let made = read(&text);
    let scene = file(&made, "box.toml");
    let part = scene
        .lines()
        .find(|l| l.starts_with("part = "))
        .unwrap_or_default();
    assert!(
        part.contains("mass_kg = 2.5, inertia_kg_m2 = [0.0, 0.0, 0.002]"),
        "{scene}"
    );
}
