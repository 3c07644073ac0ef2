//! Files that lack places, bearings or stiffnesses: what is made of them runs, and says what was assumed.

use crate::{changed, file, read, small};
use gearmesh_rexs::Import;

fn assumed(made: &Import, words: &str) -> bool {
    made.ledger.assumed.iter().any(|e| e.text.contains(words))
}

/// Load and bearing at a place where a gear sits: the gear's body is that of the station.
#[test]
fn what_stands_in_the_middle_of_a_gear_acts_on_the_gear() {
    let at = |text: String, from: &str| changed(&text, from, &from.replace(">10<", ">40<"));
    let place = "<attribute id=\"u_coordinate_on_shaft_inner_side\" unit=\"mm\">10</attribute>";
    let made = read(&at(small(), place));
    let scene = file(&made, "box.toml");
    for words in ["body_2 = \"pinion\"", "body_2 = \"wheel\""] {
        assert!(scene.contains(words), "{words} is not in {scene}");
    }
}

/// Two shafts with teeth and loads, and no bearing: both are held at both ends, which is reported.
#[test]
fn shafts_without_bearings_are_held() {
    let text = changed(&small(), "type=\"concept_bearing\"", "type=\"seal\"");
    let made = read(&text);
    let scene = file(&made, "box.toml");
    assert_eq!(scene.matches("[[bearing]]").count(), 4, "{scene}");
    assert_eq!(scene.matches("axial_stiffness").count(), 2, "{scene}");
    assert!(assumed(&made, "no bearing and no coupling holds it"));
}

/// A gear without a place stands face to face with its mate.
#[test]
fn gears_without_a_place_face_their_mates() {
    let place = "<attribute id=\"u_coordinate_on_shaft\" unit=\"mm\">30</attribute>";
    let text = small();
    let (first, second) = text.split_once("name=\"wheel\"").unwrap();
    let made = read(&format!(
        "{first}name=\"wheel\"{}",
        changed(second, place, "")
    ));
    assert!(assumed(
        &made,
        "its face in the middle of its mate's, the middle of the face at u = 40.0000 mm"
    ));
    let both = read(&changed(&text, place, ""));
    assert!(assumed(
        &both,
        "from u = 0 on, the middle of the face at u = 10.0000 mm"
    ));
}

/// Stage and shafts that state different centre distances are reported.
#[test]
fn a_centre_distance_that_the_shafts_do_not_have_is_told() {
    let made = read(&changed(&small(), "unit=\"mm\">62<", "unit=\"mm\">63<"));
    assert!(assumed(
        &made,
        "center_distance is 63 mm, but the shafts stand 62.0000 mm apart"
    ));
    assert!(!assumed(&read(&small()), "but the shafts stand"));
}

/// A stiffness of a sign that none has is not "not given".
#[test]
fn stiffnesses_below_zero_are_named() {
    let place = "<attribute id=\"u_coordinate_on_shaft_inner_side\" unit=\"mm\">10</attribute>";
    let stiff = "<attribute id=\"radial_stiffness\" unit=\"N / m\">-1e9</attribute>";
    let made = read(&changed(&small(), place, &format!("{place}{stiff}")));
    assert!(assumed(
        &made,
        "radial_stiffness is -1e6 N/mm, which no bearing has: 5e5 N/mm"
    ));
}
