//! Bearings that several tests use.

use gearmesh_bearings::QuasiStaticBearing;
use gearmesh_bearings::bearing_file::BearingFromFile;
use gearmesh_bearings::definition::BearingDefinition;
use gearmesh_geometry::input::InputDocument;

/// REFERENCES §2: Z 16, D 22.23, f 0.5232, 40°, E 206 GPa.
pub const B218: &str = r#"
name = "218"
kind = "angular-contact"
balls = 16
ball_diameter_mm = 22.23
pitch_diameter_mm = 125.3
inner_conformity = 0.5232
outer_conformity = 0.5232
contact_angle_deg = 40.0
"#;

/// A 6205 without clearance; `radial_clearance_um` may be put behind it.
pub const B6205: &str = r#"
name = "6205"
kind = "deep-groove"
balls = 9
ball_diameter_mm = 7.938
pitch_diameter_mm = 39.04
inner_conformity = 0.52
outer_conformity = 0.53
"#;

/// Two 7010 C back to back, pressed in by 5 µm each.
pub const PAIR: &str = r#"
name = "7010 C pair"
kind = "angular-contact"
balls = 19
ball_diameter_mm = 8.731
pitch_diameter_mm = 65.0
inner_conformity = 0.52
outer_conformity = 0.53
contact_angle_deg = 15.0
arrangement = "O"
row_distance_mm = 16.0
preload_um = 5.0
"#;

/// A cylindrical roller bearing.
pub const ROLLERS: &str = r#"
name = "NU 204"
kind = "cylindrical-roller"
rollers = 12
roller_diameter_mm = 7.5
roller_length_mm = 9.0
pitch_diameter_mm = 33.5
radial_clearance_um = 10.0
"#;

/// A tapered roller bearing.
pub const TAPERED: &str = r#"
name = "30206"
kind = "tapered-roller"
rollers = 17
roller_diameter_mm = 7.2
roller_length_mm = 10.5
pitch_diameter_mm = 46.0
contact_angle_deg = 14.04
"#;

pub fn definition(text: &str) -> BearingDefinition {
    let document = InputDocument::new("bearing.toml", text);
    BearingFromFile::from_document(&document)
        .unwrap_or_else(|e| panic!("{e}"))
        .definition
}

pub fn bearing(text: &str) -> QuasiStaticBearing {
    QuasiStaticBearing::new(&definition(text)).unwrap()
}

#[track_caller]
pub fn close(found: f64, expected: f64, relative: f64) {
    assert!(
        (found - expected).abs() <= relative * expected.abs(),
        "found {found}, expected {expected} within {relative:e}: {:e} off",
        found / expected - 1.0
    );
}
