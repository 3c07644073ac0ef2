//! Bearings known by their catalogue line: what is estimated, what is kept, what is refused, what is warned of.

use crate::common::close;
use gearmesh_bearings::bearing_file::BearingFromFile;
use gearmesh_bearings::definition::{Arrangement, BearingGeometry};
use gearmesh_bearings::designations;
use gearmesh_bearings::{QuasiStaticBearing, Ratings};
use gearmesh_geometry::input::InputDocument;

fn read(text: &str) -> Result<BearingFromFile, String> {
    BearingFromFile::from_document(&InputDocument::new("b.toml", text)).map_err(|e| e.to_string())
}

fn accepted(text: &str) -> BearingFromFile {
    read(text).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// A line of the file: type, bore, outside diameter, width, C, C₀ in N, and further lines.
fn line(kind: &str, sizes: [f64; 3], ratings: [f64; 2], more: &str) -> String {
    let ([bore, outside, width], [dynamic, rest]) = (sizes, ratings);
    format!(
        "name = \"x\"\nkind = \"catalogue\"\ntype = \"{kind}\"\nbore_mm = {bore}\noutside_diameter_mm = {outside}\nwidth_mm = {width}\n{more}\
         [ratings]\ndynamic_N = {dynamic}\nstatic_N = {rest}\n"
    )
}

const D6205: [f64; 3] = [25.0, 52.0, 15.0];

/// 6205 and 6203 of the test rig of Case Western Reserve University: 9 balls of 0.3126 in on 1.537 in, 8 balls of
/// 0.2656 in on 1.122 in.
#[test]
fn designations_give_the_known_inside() {
    for (name, balls, ball_in, pitch_in) in [("6205", 9, 0.3126, 1.537), ("6203", 8, 0.2656, 1.122)]
    {
        let found = accepted(&format!("kind = \"catalogue\"\ndesignation = \"{name}\"\n"));
        let estimate = found.estimate.unwrap();
        assert_eq!(estimate.elements, balls, "{name}");
        close(estimate.diameter_m, ball_in * 25.4e-3, 0.03);
        close(estimate.pitch_m, pitch_in * 25.4e-3, 0.02);
        assert!(estimate.poor_fit.is_none());
        assert_eq!(found.definition.name, name);
    }
}

/// A line with ratings gives an inside with these ratings.
#[test]
fn lines_with_ratings_are_met() {
    for (kind, sizes, ratings, more) in [
        ("deep-groove", D6205, [14.0e3, 7.85e3], ""),
        ("deep-groove", [40.0, 90.0, 23.0], [40.5e3, 24.0e3], ""),
        (
            "cylindrical-roller",
            [20.0, 47.0, 14.0],
            [25.7e3, 22.6e3],
            "",
        ),
        (
            "angular-contact",
            [50.0, 80.0, 16.0],
            [26.0e3, 21.9e3],
            "contact_angle_deg = 15.0\n",
        ),
        (
            "tapered-roller",
            [30.0, 62.0, 17.25],
            [40.0e3, 44.0e3],
            "contact_angle_deg = 14.04\n",
        ),
    ] {
        let found = accepted(&line(kind, sizes, ratings, more));
        let estimate = found.estimate.clone().unwrap();
        close(estimate.dynamic_ratio, 1.0, 0.12);
        close(estimate.static_ratio, 1.0, 0.08);
        let [low, high] = estimate.elements_spread;
        assert!(low <= estimate.elements && estimate.elements <= high);
        assert!(high - low <= 10, "{kind}: {estimate:?}");
        assert!(found.warnings.is_empty(), "{kind}: {:?}", found.warnings);
        QuasiStaticBearing::new(&found.definition).unwrap();
    }
}

/// What cannot be built is refused with figures and what is allowed.
#[test]
fn what_cannot_be_built_is_refused() {
    let ratings = [14.0e3, 7.85e3];
    let groove =
        |sizes: [f64; 3], ratings: [f64; 2], more: &str| line("deep-groove", sizes, ratings, more);
    for (text, parts) in [
        // kN for N: 52 balls of 1.985 mm once.
        (
            groove(D6205, [14.0, 7.85], ""),
            ["ratings.dynamic_N", "found 14,", "14 kN are 14000"],
        ),
        (
            groove(D6205, [14.0e3, 7.85], ""),
            ["ratings.static_N", "found 7.85,", "kN"],
        ),
        // Balls larger than the section.
        (
            groove(D6205, [60.0e3, 35.0e3], ""),
            ["ratings.dynamic_N", "found 60000", "bore of 25"],
        ),
        (
            groove([25.0, 52.0, 0.18], ratings, ""),
            ["width_mm", "found 0.18,", "6.75 to 32.4"],
        ),
        (
            groove([25.0, 52.0, 180.0], ratings, ""),
            ["width_mm", "found 180,", "6.75 to 32.4"],
        ),
        (
            groove([25.0, 250.0, 15.0], ratings, ""),
            ["outside_diameter_mm", "found 250", "125"],
        ),
        (
            groove(D6205, ratings, "ball_diameter_mm = 13.0\n"),
            ["ball_diameter_mm", "found 13,", "12.15"],
        ),
        (
            groove(D6205, ratings, "ball_diameter_mm = 2.0\n"),
            ["ball_diameter_mm", "found 2,", "4.05"],
        ),
        (
            groove(D6205, ratings, "balls = 12\nball_diameter_mm = 7.94\n"),
            ["balls", "found 12,", "3 to 9"],
        ),
        (
            groove(D6205, ratings, "pitch_diameter_mm = 30.0\n"),
            ["pitch_diameter_mm", "found 30,", "34.45 to 42.55"],
        ),
        (
            groove(D6205, ratings, "rollers = 9\n"),
            ["rollers", "not used", "deep-groove"],
        ),
        (
            line("tapered-roller", [30.0, 62.0, 17.25], [40.0e3, 44.0e3], ""),
            ["contact_angle_deg", "missing", "atan(e/1.5)"],
        ),
        (
            line(
                "cylindrical-roller",
                [20.0, 47.0, 14.0],
                [25.7e3, 22.6e3],
                "roller_length_mm = 14.0\n",
            ),
            ["roller_length_mm", "found 14,", "12.6"],
        ),
    ] {
        let found = read(&text)
            .err()
            .unwrap_or_else(|| panic!("accepted:\n{text}"));
        for part in parts {
            assert!(found.contains(part), "`{part}` is not in: {found}");
        }
    }
}

/// What is stated of the inside is kept; the rest is estimated about it.
#[test]
fn what_is_known_is_kept() {
    let text = line(
        "deep-groove",
        D6205,
        [14.0e3, 7.85e3],
        "balls = 9\npitch_diameter_mm = 39.04\n",
    );
    let found = accepted(&text);
    let BearingGeometry::Ball(geometry) = &found.definition.geometry else {
        panic!("no balls");
    };
    assert_eq!(geometry.balls, 9);
    close(geometry.pitch_diameter_m, 39.04e-3, 1e-12);
    close(geometry.ball_diameter_m, 7.94e-3, 0.01);
    let known = text.replace("balls = 9\n", "balls = 9\nball_diameter_mm = 7.94\n");
    let estimate = accepted(&known).estimate.unwrap();
    for size in estimate.diameter_spread_m {
        close(size, 7.94e-3, 1e-12);
    }
    assert_eq!(estimate.elements_spread, [9, 9]);
    let rollers = line(
        "cylindrical-roller",
        [20.0, 47.0, 14.0],
        [25.7e3, 22.6e3],
        "rollers = 12\nroller_diameter_mm = 7.5\nroller_length_mm = 9.0\npitch_diameter_mm = 34.0\n",
    );
    let BearingGeometry::Roller(geometry) = accepted(&rollers).definition.geometry else {
        panic!("no rollers");
    };
    assert_eq!(geometry.rollers, 12);
    close(geometry.diameter_m, 7.5e-3, 1e-12);
    close(geometry.length_m, 9e-3, 1e-12);
    close(geometry.pitch_diameter_m, 34e-3, 1e-12);
}

/// Ratings that contradict each other, or the section, are warned of with the spread.
#[test]
fn poor_fits_are_warned_of() {
    let found = accepted(&line("deep-groove", D6205, [8.0e3, 8.5e3], ""));
    let [warning] = &found.warnings[..] else {
        panic!("{:?}", found.warnings);
    };
    for part in [
        "fits no usual design",
        "spread",
        "C by ISO 281",
        "C0 by ISO 76",
        "C for",
        "C0 for",
        "the section for 8.10 mm",
    ] {
        assert!(warning.contains(part), "`{part}` is not in: {warning}");
    }
}

/// Every designation can be built; its ratings are those of its estimated inside, and lie where its number says: C
/// grows with bore and series.
#[test]
fn every_designation_can_be_built() {
    let mut count = 0;
    for name in designations::all() {
        let four_digits = name.len() == 4;
        let angle = match name.as_bytes()[0] {
            b'7' => "contact_angle_deg = 15.0\n",
            b'Q' => "contact_angle_deg = 35.0\n",
            b'3' if four_digits => "contact_angle_deg = 30.0\n",
            _ => "",
        };
        let found = accepted(&format!(
            "kind = \"catalogue\"\ndesignation = \"{name}\"\n{angle}"
        ));
        assert!(found.warnings.is_empty(), "{name}: {:?}", found.warnings);
        let estimate = found.estimate.unwrap();
        let ratings = Ratings::of(&found.definition);
        close(ratings.dynamic_n, estimate.dynamic_n, 1e-12);
        close(ratings.static_n, estimate.static_n, 1e-12);
        QuasiStaticBearing::new(&found.definition).unwrap();
        // Its own ratings as a maker's: the same inside.
        let text = format!(
            "kind = \"catalogue\"\ndesignation = \"{name}\"\n{angle}[ratings]\ndynamic_N = {}\nstatic_N = {}\n",
            ratings.dynamic_n, ratings.static_n
        );
        let again = accepted(&text);
        assert!(again.warnings.is_empty(), "{name}: {:?}", again.warnings);
        let again = again.estimate.unwrap();
        close(again.dynamic_ratio, 1.0, 0.06);
        close(again.static_ratio, 1.0, 0.06);
        // Another number may fit as well.
        close(again.diameter_m, estimate.diameter_m, 0.15);
        count += 1;
    }
    assert!(count > 200, "{count}");
    let of = |name: &str| {
        accepted(&format!("kind = \"catalogue\"\ndesignation = \"{name}\"\n"))
            .estimate
            .unwrap()
    };
    assert!(of("6205").dynamic_n < of("6206").dynamic_n);
    assert!(
        of("6005").dynamic_n < of("6205").dynamic_n && of("6205").dynamic_n < of("6305").dynamic_n
    );
    assert!(read("kind = \"catalogue\"\ndesignation = \"7205\"\n").is_err());
    assert_eq!(
        accepted("kind = \"catalogue\"\ndesignation = \"7205 b\"\n")
            .definition
            .name,
        "7205B"
    );
    for unknown in [
        "6299", "62", "6205-2RS", "6205B", "é205", "NU204é", "61819", "",
    ] {
        assert!(designations::find(unknown).is_none(), "{unknown}");
    }
}

/// Corners of the tables as two makers print them (Koyo, CAT. NO. B2001RUS; NSK, Rolling Bearings). Once the width of
/// 3200 was 14 mm, and 61819, which one of them has only, was listed.
#[test]
fn designations_have_the_dimensions_of_two_catalogues() {
    for (name, sizes) in [
        ("61818", [90.0, 115.0, 13.0]),
        ("6015", [75.0, 115.0, 20.0]),
        ("6220", [100.0, 180.0, 34.0]),
        ("6320", [100.0, 215.0, 47.0]),
        ("6412", [60.0, 150.0, 35.0]),
        ("3200", [10.0, 30.0, 14.3]),
        ("NU2320", [100.0, 215.0, 73.0]),
        ("30215", [75.0, 130.0, 27.25]),
        ("32315", [75.0, 160.0, 58.0]),
        ("51210", [50.0, 78.0, 22.0]),
    ] {
        let line = designations::find(name)
            .unwrap_or_else(|| panic!("{name}"))
            .line;
        for (found, mm) in [line.bore_m, line.outside_m, line.width_m]
            .into_iter()
            .zip(sizes)
        {
            close(found, 1e-3 * mm, 1e-12);
        }
    }
}

/// Ratings of a line are those of one bearing: a pair has more by ISO 281; two rows in one pair of rings have what the
/// line says.
#[test]
fn pairs_carry_more_than_their_line_says() {
    let sizes = [50.0, 80.0, 16.0];
    let one = line(
        "angular-contact",
        sizes,
        [26.0e3, 21.9e3],
        "contact_angle_deg = 15.0\n",
    );
    let rows = "arrangement = \"O\"\nrow_distance_mm = 16.0\n";
    let pair = one.replace("contact_angle_deg", &format!("{rows}contact_angle_deg"));
    let [one, pair] = [one, pair].map(|text| Ratings::of(&accepted(&text).definition));
    close(pair.dynamic_n, one.dynamic_n * 2.0_f64.powf(0.7), 1e-12);
    close(pair.static_n, 2.0 * one.static_n, 1e-12);
    let double = line(
        "angular-contact-double-row",
        [25.0, 52.0, 20.6],
        [21.0e3, 14.5e3],
        "contact_angle_deg = 30.0\n",
    );
    let found = accepted(&double);
    assert_eq!(Ratings::of(&found.definition).dynamic_n, 21.0e3);
    assert_eq!(
        found.definition.arrangement,
        Arrangement::O {
            distance_m: 10.3e-3
        }
    );
    let estimate = found.estimate.unwrap();
    close(estimate.dynamic_ratio, 1.0, 0.12);
    let x = double.replace(
        "contact_angle",
        "arrangement = \"X\"\nrow_distance_mm = 11.0\ncontact_angle",
    );
    assert_eq!(
        accepted(&x).definition.arrangement,
        Arrangement::X { distance_m: 11e-3 }
    );
    let tandem = x.replace("\"X\"", "\"tandem\"");
    assert!(read(&tandem).unwrap_err().contains("both ways"));
    let far = x.replace("11.0", "15.0");
    assert!(read(&far).unwrap_err().contains("row_distance_mm"));
}
