//! What the file has and the scene does not: told before anything else, by the kind of the entry, not by its words.

use crate::{GEARBOX, changed, message, read, small};
use gearmesh_rexs::{Import, Meshes, Weight};

/// Lines of a weight.
fn lines(made: &Import, weight: Weight) -> Vec<String> {
    let found = made.ledger.of_weight(weight, Meshes::Iso6336);
    found
        .map(|e| format!("{}: {}", e.subject, e.text))
        .collect()
}

/// Demands warnings, one for each list of words.
fn warned(text: &str, words: &[&[&str]]) {
    let found = lines(&read(text), Weight::Warning);
    for all in words {
        let told = found.iter().any(|l| all.iter().all(|w| l.contains(w)));
        assert!(told, "{all:?} is not among {found:#?}");
    }
}

/// The relation of a number.
fn relation(id: u32) -> String {
    let start = GEARBOX.find(&format!("<relation id=\"{id}\"")).unwrap();
    let end = start + GEARBOX[start..].find("</relation>").unwrap() + "</relation>".len();
    GEARBOX[start..end].to_owned()
}

/// A box of which nothing is missing has no warning.
#[test]
fn a_whole_gearbox_has_no_warning() {
    for text in [GEARBOX.to_owned(), small()] {
        let found = lines(&read(&text), Weight::Warning);
        assert!(found.is_empty(), "{found:?}");
    }
    let made = read(GEARBOX);
    let sheet = &made.sheets[0];
    assert_eq!(
        (sheet.shafts.len(), sheet.meshes.len(), sheet.bearings.len()),
        (4, 3, 8)
    );
    let powers: Vec<f64> = (sheet.ports.iter())
        .map(|p| p.torque_nm * p.speed_rpm)
        .collect();
    assert!(
        (powers[0] + powers[1]).abs() < 1e-6 * powers[0] && powers[0] > 0.0,
        "{powers:?}"
    );
    assert_eq!(sheet.ports[0].spring.as_deref(), Some("held at motor"));
    assert_eq!(sheet.ports[1].spring, None);
}

#[test]
fn a_stage_that_is_missing_or_dangles_loses_the_load() {
    let stage = relation(70);
    let lost: [&[&str]; 3] = [
        &["motor", "-28.2068 N m does not act"],
        &["machine", "none comes to it"],
        &["second stage", "no relation names both of its gears"],
    ];
    warned(&changed(GEARBOX, &stage, ""), &lost);
    let dangling = stage.replace("id=\"23\" role=\"gear_2\"", "id=\"999\" role=\"gear_2\"");
    let text = changed(GEARBOX, &stage, &dangling);
    warned(&text, &lost);
    warned(&text, &[&["relation 70 (stage)", "component 999"]]);
    // Without the stage itself nothing but the torques tells.
    let text = changed(&text, &dangling, "");
    let text = text.replacen(
        "type=\"cylindrical_stage\" name=\"second stage\"",
        "type=\"oddity\"",
        1,
    );
    warned(&text, &lost[..2]);
}

#[test]
fn loads_bearings_and_gears_that_nothing_joins() {
    warned(
        &changed(GEARBOX, &relation(85), ""),
        &[&["motor", "on no shaft"]],
    );
    warned(
        &changed(GEARBOX, &relation(80), ""),
        &[&["bearing 2B", "no relation"]],
    );
    let gear = "<ref id=\"2\" role=\"assembly\"/><ref id=\"4\" role=\"part\"/>";
    warned(
        &changed(&small(), gear, "<ref id=\"2\" role=\"assembly\"/>"),
        &[
            &["pinion", "on no shaft"],
            &["stage", "does not have both"],
            &["in", "does not act"],
        ],
    );
}

#[test]
fn a_file_without_a_scene() {
    let mut text = GEARBOX.to_owned();
    while let Some(start) = text.find("<relation id=") {
        let end = start + text[start..].find("</relation>").unwrap() + "</relation>".len();
        text.replace_range(start..end, "");
    }
    let made = read(&text);
    assert!(made.scenes.is_empty() && made.gears.len() == 6);
    let found = lines(&made, Weight::Warning);
    assert!(found[0].contains("no scene"), "{found:?}");
}

#[test]
fn power_that_does_not_balance() {
    // 20 and 42 teeth: 10 N m come out as 21.
    let state = |torque: &str| {
        changed(
            &small(),
            "<attribute id=\"transmits_torque\" unit=\"none\">true</attribute>",
            &format!("<attribute id=\"torque_around_u_axis\" unit=\"N m\">{torque}</attribute>"),
        )
    };
    warned(
        &state("15"),
        &[&[
            "in",
            "do not balance by",
            "7.1429 N m about u in place of 10.0000 N m",
        ]],
    );
    let balanced = read(&state("21.05"));
    assert!(lines(&balanced, Weight::Warning).is_empty());
    // A torque that is stated, but does not define.
    let text = changed(
        &small(),
        "<attribute id=\"transmits_torque\" unit=\"none\">true</attribute>",
        "<attribute id=\"transmits_torque\" unit=\"none\">true</attribute><attribute id=\"defines_torque\" unit=\"none\">false</attribute>\
         <attribute id=\"torque_around_u_axis\" unit=\"N m\">15</attribute>",
    );
    let heavy = lines(&read(&text), Weight::Heavy);
    assert!(
        heavy
            .iter()
            .any(|l| l.contains("15.0000 N m is stated") && l.contains("21.0000 N m follow")),
        "{heavy:?}"
    );
}

#[test]
fn shafts_and_speeds_that_no_gearbox_has() {
    let place = "<attribute id=\"u_coordinate_on_shaft_inner_side\" unit=\"mm\">90</attribute>";
    let far = GEARBOX.replacen(place, &place.replace("90", "9000"), 1);
    warned(
        &far,
        &[
            &["input shaft", "beyond its sections", "8910"],
            &["input shaft", "9000 mm long"],
        ],
    );
    // A millimetre beyond the end is none.
    let near = GEARBOX.replacen(place, &place.replace("90", "91"), 1);
    assert!(lines(&read(&near), Weight::Warning).is_empty());
    let speed = |rpm: &str| {
        changed(
            GEARBOX,
            "unit=\"1 / min\">-1500<",
            &format!("unit=\"1 / min\">{rpm}<"),
        )
    };
    let found = message(speed("1e30").into_bytes());
    assert!(
        found.contains("line 125")
            && found.contains("rotational_speed")
            && found.contains("up to 1e6"),
        "{found}"
    );
    let found = message(changed(GEARBOX, "\"N m\">-28.2067720372<", "\"N m\">1e30<").into_bytes());
    assert!(
        found.contains("torque_around_u_axis: 1e30") && found.contains("up to 1e9"),
        "{found}"
    );
    // Through three stages the wrong way round.
    let fast = changed(&small(), "\"1 / min\">1000<", "\"1 / min\">1e6<").replace(
        "number_of_teeth\" unit=\"none\">20<",
        "number_of_teeth\" unit=\"none\">142<",
    );
    warned(&fast, &[&["two", "turns at"]]);
}

/// The page and the console begin with what weighs most.
#[test]
fn the_list_is_in_the_order_of_weight() {
    let made = read(&changed(GEARBOX, &relation(70), ""));
    let page = made.ledger.page("Import", Meshes::Iso6336);
    let place = |head: &str| {
        page.find(head)
            .unwrap_or_else(|| panic!("no {head} in {page}"))
    };
    assert!(place("## Warnings") < place("## More than 1 %"));
    assert!(place("## More than 1 %") < place("## Not represented"));
    assert!(place("no axial_stiffness given") < place("## Not represented"));
    assert!(place("no tooth thickness allowance") > place("## Assumed"));
    // Flank modifications weigh where meshes feel them.
    let of = |with| {
        made.ledger
            .of_weight(Weight::Heavy, with)
            .filter(|e| e.subject.contains("helix_slope"))
            .count()
    };
    assert!(of(Meshes::Iso6336) == 0 && of(Meshes::Hybrid) > 0);
}
