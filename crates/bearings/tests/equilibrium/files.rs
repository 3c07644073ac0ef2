//! Bad bearing files: each is answered with line, key, what was found and what is allowed.

use crate::ball_types::{FOUR_POINT, THRUST};
use crate::barrels::BARRELS;
use crate::common::{B218, B6205, ROLLERS, TAPERED};
use gearmesh_bearings::bearing_file::BearingFromFile;
use gearmesh_geometry::input::InputDocument;

fn complaint(text: &str) -> String {
    let document = InputDocument::new("b.toml", text);
    match BearingFromFile::from_document(&document) {
        Ok(found) => panic!("accepted: {:?}", found.definition),
        Err(error) => error.to_string(),
    }
}

fn refused(text: &str, (from, to): (&str, &str), parts: &[&str]) {
    assert!(text.contains(from), "{from}");
    let found = complaint(&text.replace(from, to));
    for part in parts {
        assert!(found.contains(part), "`{part}` is not in: {found}");
    }
}

/// Seed 000: raceways of 55 and 85 mm with balls of 9.525 mm.
#[test]
fn raceways_that_no_ball_touches_are_refused_with_the_numbers() {
    let text = "name = \"seed 000\"\nkind = \"angular-contact\"\nballs = 18\nball_diameter_mm = 9.525\npitch_diameter_mm = 70.0\n\
                inner_conformity = 0.52\nouter_conformity = 0.52\nraceway_diameters_mm = [55.0, 85.0]\n";
    let found = complaint(text);
    for part in [
        "b.toml:8: raceway_diameters_mm",
        "55 and 85",
        "10.9500 mm of play",
        "0.7620 mm",
        "contact_angle_deg",
    ] {
        assert!(found.contains(part), "`{part}` is not in: {found}");
    }
    // What docs/sources.md uses instead makes the stated contact angle.
    let sound = text.replace("[55.0, 85.0]", "[60.462, 79.538]");
    let document = InputDocument::new("b.toml", sound);
    let found = BearingFromFile::from_document(&document).unwrap();
    assert!(
        found.notes[0].contains("contact angle 15.0"),
        "{:?}",
        found.notes
    );
}

#[test]
fn keys_of_another_kind_are_refused() {
    refused(
        B6205,
        (
            "kind = \"deep-groove\"",
            "kind = \"deep-groove\"\ncontact_angle_deg = 15.0",
        ),
        &["contact_angle_deg", "belongs to", "angular-contact"],
    );
    refused(
        B218,
        ("balls = 16", "balls = 16\nrollers = 16"),
        &["rollers", "belongs to"],
    );
    refused(
        ROLLERS,
        ("rollers = 12", "rollers = 12\npreload_N = 5.0"),
        &["preload_N", "belongs to"],
    );
    refused(
        B218,
        ("balls = 16", "balls = 16\nrow_distance_mm = 5.0"),
        &["row_distance_mm", "single row"],
    );
    refused(
        B218,
        ("balls = 16", "balls = 16\nball_mass_kg = 5.0"),
        &["unknown field `ball_mass_kg`"],
    );
}

#[test]
fn values_out_of_range_are_answered_with_the_range() {
    refused(
        B218,
        ("balls = 16", "balls = 18"),
        &["balls", "found 18", "3 to 17"],
    );
    refused(B218, ("balls = 16\n", ""), &["balls", "missing"]);
    refused(
        B218,
        ("inner_conformity = 0.5232", "inner_conformity = 0.5"),
        &["found 0.5", "more than 0.5"],
    );
    refused(
        B218,
        ("contact_angle_deg = 40.0", "contact_angle_deg = 0.0"),
        &["contact_angle_deg", "found 0"],
    );
    refused(
        B218,
        ("contact_angle_deg = 40.0", "contact_angle_deg = nan"),
        &["found NaN"],
    );
    refused(
        B218,
        ("pitch_diameter_mm = 125.3", "pitch_diameter_mm = 20.0"),
        &["pitch_diameter_mm", "22.23"],
    );
    refused(
        B6205,
        ("balls = 9", "balls = 9\nradial_clearance_um = -80.0"),
        &["found -80", "-79.4"],
    );
    refused(
        B6205,
        ("balls = 9", "balls = 9\nradial_clearance_um = 900.0"),
        &["793.8"],
    );
    // The limit itself is excluded, whatever 0.52 + 0.53 - 1 is to the last digit.
    for key in [
        "radial_clearance_um = 794.0",
        "raceway_diameters_mm = [31.1, 47.774]",
    ] {
        refused(
            &B6205.replace("7.938", "7.94"),
            ("balls = 9", &format!("balls = 9\n{key}")),
            &["no ball touches both"],
        );
    }
    refused(
        B6205,
        ("balls = 9", "balls = 9\nshoulder_heights_mm = [1.5, 4.0]"),
        &["shoulder_heights_mm", "found 4", "3.969"],
    );
    refused(
        ROLLERS,
        (
            "rollers = 12",
            "rollers = 12\nshoulder_heights_mm = [1.5, 1.5]",
        ),
        &["shoulder_heights_mm", "deep-groove"],
    );
    refused(
        B6205,
        ("balls = 9", "balls = 9\nbore_mm = 32.0"),
        &["bore_mm", "31.1", "inner race"],
    );
    refused(
        B218,
        (
            "balls = 16",
            "balls = 16\npreload_N = 5.0\npreload_um = 5.0",
        ),
        &["preload_um", "remove one"],
    );
    refused(
        B218,
        ("balls = 16", "balls = 16\narrangement = \"O\""),
        &["row_distance_mm", "missing"],
    );
    refused(
        ROLLERS,
        ("rollers = 12", "rollers = 12\nlaminae = 1"),
        &["laminae", "2 to 1000"],
    );
    refused(
        ROLLERS,
        (
            "rollers = 12",
            "rollers = 12\nprofile = { kind = \"crowned\" }",
        ),
        &["profile.radius_mm", "missing"],
    );
    refused(
        TAPERED,
        ("contact_angle_deg = 14.04", "contact_angle_deg = 80.0"),
        &["5 to 45"],
    );
    refused(
        TAPERED,
        ("rollers = 17", "rollers = 17\nrib_height_mm = 9.0"),
        &["rib_height_mm", "large end"],
    );
    // Found by fuzzing: so many balls ended in an allocation of 128 GB.
    let grains = B6205.replace("ball_diameter_mm = 7.938", "ball_diameter_mm = 7.938e-10");
    refused(
        &grains,
        ("balls = 9", "balls = 4294967296"),
        &["balls", "found 4294967296", "3 to 1000"],
    );
    // So few rollers on so large a ring took minutes to be found without equilibrium.
    refused(
        TAPERED,
        ("pitch_diameter_mm = 46.0", "pitch_diameter_mm = 1000.0"),
        &["rollers", "found 17", "44 to 436"],
    );
}

/// Keys of four-point, thrust and spherical roller bearings.
#[test]
fn other_types_are_checked() {
    refused(
        FOUR_POINT,
        ("contact_angle_deg = 35.0\n", ""),
        &["contact_angle_deg", "missing"],
    );
    refused(
        FOUR_POINT,
        ("radial_clearance_um = 20.0", "radial_clearance_um = 1100.0"),
        &["radial_clearance_um", "found 1100", "1040.3"],
    );
    for (text, kind) in [(FOUR_POINT, "four-point"), (THRUST, "thrust-ball")] {
        let pair = format!("{text}arrangement = \"O\"\nrow_distance_mm = 20.0\n");
        let found = complaint(&pair);
        assert!(
            found.contains("arrangement") && found.contains(kind) && found.contains("belongs to"),
            "{found}"
        );
        let faulty =
            format!("{text}[[fault]]\nkind = \"off-size-ball\"\nball = 1\noversize_um = 1.0\n");
        let found = complaint(&faulty);
        assert!(
            found.contains("fault.0.kind") && found.contains("misaligned-ring"),
            "{found}"
        );
    }
    // A fuzzed disc of 1e-11 mm took minutes.
    for length in ["1e-11", "800.0"] {
        refused(
            TAPERED,
            (
                "roller_length_mm = 10.5",
                &format!("roller_length_mm = {length}"),
            ),
            &[
                "roller_length_mm",
                "0.7200 to 720.0000",
                "a tenth to a hundred times",
            ],
        );
    }
    refused(
        THRUST,
        ("balls = 14", "balls = 14\ncontact_angle_deg = 90.0"),
        &["contact_angle_deg", "belongs to"],
    );
    refused(
        BARRELS,
        ("roller_length_mm = 17.0", "roller_length_mm = 19.0"),
        &["roller_length_mm", "found 19", "18.8", "middle plane"],
    );
    refused(
        BARRELS,
        (
            "rollers = 19",
            "rollers = 19\nroller_profile_radius_mm = 90.0",
        ),
        &["roller_profile_radius_mm", "found 90", "82.37", "sphere"],
    );
    refused(
        BARRELS,
        (
            "rollers = 19",
            "rollers = 19\ninner_groove_radius_mm = 70.0",
        ),
        &["inner_groove_radius_mm", "found 70", "profile"],
    );
    refused(
        BARRELS,
        ("rollers = 19", "rollers = 19\nrow_distance_mm = 22.0"),
        &["row_distance_mm", "belongs to"],
    );
    refused(
        BARRELS,
        ("rollers = 19", "rollers = 19\npreload_N = 22.0"),
        &["preload_N", "belongs to"],
    );
}

#[test]
fn catalogue_lines_are_checked() {
    let found = complaint("kind = \"catalogue\"\ndesignation = \"6299\"\n");
    assert!(
        found.contains("found \"6299\"") && found.contains("6205"),
        "{found}"
    );
    let found = complaint("kind = \"catalogue\"\ndesignation = \"6205\"\nbore_mm = 25.0\n");
    assert!(
        found.contains("bore_mm") && found.contains("remove one"),
        "{found}"
    );
    let found = complaint(
        "name = \"x\"\nkind = \"catalogue\"\ntype = \"deep-groove\"\nbore_mm = 25.0\noutside_diameter_mm = 52.0\nwidth_mm = 15.0\n",
    );
    assert!(
        found.contains("ratings.dynamic_N") && found.contains("missing"),
        "{found}"
    );
}

/// Faults: each is answered with its number, key, what was found and what is allowed.
#[test]
fn bad_faults_are_refused() {
    let fault = |lines: &str| format!("{B6205}[[fault]]\n{lines}");
    let spall = "kind = \"race-spall\"\nrace = \"outer\"\nangle_deg = 0.0\nlength_mm = 1.0\ndepth_um = 5.0\n";
    for (text, parts) in [
        (
            fault("kind = \"spall\"\n"),
            vec!["fault.0.kind", "race-spall", "ball-spall"],
        ),
        (fault("race = \"outer\"\n"), vec!["fault.0", "kind"]),
        (
            fault(&format!("{spall}ball = 3\n")),
            vec!["fault.0", "`ball` belongs to", "race-spall"],
        ),
        (
            fault(&format!("{spall}row = 2\n")),
            vec!["fault.0.row", "found 2", "1 to 1"],
        ),
        (
            fault(&spall.replace("outer", "middle")),
            vec!["fault.0.race", "inner"],
        ),
        (
            fault(&spall.replace("length_mm = 1.0", "length_mm = 0.0")),
            vec!["fault.0.length_mm", "found 0"],
        ),
        (
            fault(&spall.replace("depth_um = 5.0", "depth_um = -1.0")),
            vec!["fault.0.depth_um", "found -1", "0 or more"],
        ),
        (
            fault(&spall.replace("depth_um = 5.0", "depth_um = 800.0")),
            vec!["fault.0.depth_um", "found 800", "794"],
        ),
        (
            fault(&spall.replace("depth_um = 5.0", "depth_um = nan")),
            vec!["fault.0.depth_um", "NaN"],
        ),
        (
            fault(&spall.replace("depth_um = 5.0\n", "")),
            vec!["fault.0", "depth_um"],
        ),
        (
            fault("kind = \"ball-spall\"\nball = 10\ndiameter_mm = 1.0\ndepth_um = 5.0\n"),
            vec!["fault.0.ball", "found 10", "1 to 9"],
        ),
        (
            fault("kind = \"ball-spall\"\nball = 1\ndiameter_mm = 9.0\ndepth_um = 5.0\n"),
            vec!["fault.0.diameter_mm", "found 9", "7.938"],
        ),
        (
            fault("kind = \"waviness\"\nrace = \"inner\"\norder = 0\nradial_um = 1.0\n"),
            vec!["fault.0.order", "1 to 1000"],
        ),
        (
            fault("kind = \"waviness\"\nrace = \"inner\"\norder = 3\n"),
            vec!["fault.0", "radial_um", "axial_um"],
        ),
        (
            fault("kind = \"off-size-ball\"\nball = 0\noversize_um = 1.0\n"),
            vec!["fault.0.ball", "found 0", "1 to 9"],
        ),
        (
            fault("kind = \"off-size-ball\"\nball = 1\noversize_um = 100.0\n"),
            vec!["fault.0.oversize_um", "found 100", "79.4"],
        ),
        (
            fault("kind = \"misaligned-ring\"\nring = \"inner\"\n"),
            vec!["fault.0", "tilt_mrad", "offset_um"],
        ),
        (
            fault("kind = \"misaligned-ring\"\nring = \"inner\"\ntilt_mrad = [0.0, 200.0]\n"),
            vec!["fault.0.tilt_mrad", "found 200", "100"],
        ),
        (
            fault(
                "kind = \"misaligned-ring\"\nring = \"inner\"\ntilt_mrad = [1.0, 0.0]\n[[fault]]\nkind = \"misaligned-ring\"\nring = \
                 \"inner\"\ntilt_mrad = [2.0, 0.0]\n",
            ),
            vec!["fault.1.ring", "same ring"],
        ),
        (
            format!("{ROLLERS}[[fault]]\n{spall}"),
            vec!["fault.0.kind", "ball bearings", "misaligned-ring"],
        ),
    ] {
        let found = complaint(&text);
        for part in parts {
            assert!(found.contains(part), "`{part}` is not in: {found}\n{text}");
        }
    }
}
