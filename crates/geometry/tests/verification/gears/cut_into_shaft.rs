//! Gears without bore: where they are held, and what cannot be.

use gearmesh_geometry::GearDefinition;
use gearmesh_geometry::input::InputDocument;

/// Root diameter 48 mm: 54 + 2 · 3 · (0.25 − 1.25).
fn gear(blank: &str, more: &str) -> Result<GearDefinition, String> {
    let text = format!(
        "name = \"cut\"\n[tooth]\nteeth = 18\nmodule_mm = 3.0\nprofile_shift = 0.25\nface_width_mm = 20.0\n[blank]\nkind = \"solid\"\n{blank}\n\
         [material]\nyoung_GPa = 210.0\npoisson = 0.3\n{more}"
    );
    GearDefinition::from_document(&InputDocument::new("gear.toml", text)).map_err(|e| e.to_string())
}

#[test]
fn it_is_held_at_its_faces() {
    let found = gear("bore_diameter_mm = 0\nshaft_diameter_mm = [0, 30]", "").unwrap();
    let shaft = found.blank.cut_into_shaft().unwrap();
    assert_eq!(shaft.end_radii_m, [0.0, 0.015]);
    assert!((shaft.hole_radius_m - 0.024 / 40.0).abs() < 1e-12);
    assert_eq!(
        (found.blank.bore_radius_m(), found.blank.edge_radius_m()),
        (0.0, shaft.hole_radius_m)
    );
    // As thick as the root diameter less three modules.
    gear("bore_diameter_mm = 0\nshaft_diameter_mm = [39, 39]", "").unwrap();
}

#[test]
fn what_cannot_be_is_told() {
    let cut = "bore_diameter_mm = 0\nshaft_diameter_mm = [0, 30]";
    for (blank, more, expected) in [
        (
            "bore_diameter_mm = 0",
            "",
            "needs shaft_diameter_mm = [back, front]",
        ),
        (
            "bore_diameter_mm = 0\nshaft_diameter_mm = [0, 0]",
            "",
            "held nowhere",
        ),
        (
            "bore_diameter_mm = 0\nshaft_diameter_mm = [40, 0]",
            "",
            "shaft_diameter_mm.0: found 40, allowed is 0 where the shaft does not go on, or 4.800 to 39.000",
        ),
        (
            "bore_diameter_mm = 0\nshaft_diameter_mm = [0, 3]",
            "",
            "shaft_diameter_mm.1: found 3",
        ),
        (
            "bore_diameter_mm = 20\nshaft_diameter_mm = [0, 30]",
            "",
            "is not used with a bore",
        ),
        (
            "bore_diameter_mm = -1",
            "",
            "blank.bore_diameter_mm: found -1",
        ),
        (
            "bore_diameter_mm = 0\nshaft_diameter_mm = [0, 30]\nholes = { count = 6, pitch_circle_diameter_mm = 30, diameter_mm = 3, phase_deg = 0 }",
            "",
            "a gear cut into its shaft has no openings",
        ),
        (
            cut,
            "[mesh]\nplane_strain = true\n",
            "held at its end faces, of which plane strain has none",
        ),
        (
            cut,
            "[mesh]\nelement = \"tet10\"\n",
            "is meshed in hexahedra",
        ),
    ] {
        let found = gear(blank, more).unwrap_err();
        assert!(
            found.contains(expected) && found.contains("gear.toml:"),
            "{found}"
        );
    }
}
