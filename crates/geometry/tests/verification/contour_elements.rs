//! Which element a contour gets where the gear file leaves it open, and why.

use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{Element, GearDefinition};

fn element(web: &str, more: &str) -> (Element, Option<&'static str>) {
    let text = format!(
        "name = \"g\"\n[tooth]\nteeth = 30\nmodule_mm = 3.0\nface_width_mm = 20.0\n[material]\nyoung_GPa = 210.0\npoisson = 0.3\n\
         [blank]\nkind = \"contour\"\nbore_diameter_mm = 20.0\nhub_z_mm = [-12.0, 9.0]\nweb = [{web}]\n{more}"
    );
    let gear = GearDefinition::from_document(&InputDocument::new("g.toml", text)).unwrap();
    (gear.mesh.element, gear.mesh.chosen_because)
}

const HUB: &str = "{ diameter_mm = 32.0, z_mm = [-3.0, 3.0] }";
const RIM: &str = "{ diameter_mm = 70.0, z_mm = [-2.0, 4.0] }";

#[test]
fn layers_are_taken_where_they_follow_the_contour() {
    let found = element(&format!("{HUB}, {RIM}"), "");
    assert_eq!(found, (Element::Hex8Incompatible, None));
    // 45 degrees.
    let steep =
        "{ diameter_mm = 60.0, z_mm = [-2.0, 4.0] }, { diameter_mm = 62.0, z_mm = [-3.0, 3.0] }";
    let found = element(&format!("{HUB}, {steep}, {RIM}"), "");
    assert_eq!(found, (Element::Hex8Incompatible, None));
}

#[test]
fn tetrahedra_are_taken_elsewhere_and_the_reason_is_told() {
    let fillet = RIM.replace("] }", "], fillet_radius_mm = 2.0 }");
    let step =
        "{ diameter_mm = 50.0, z_mm = [-3.0, 3.0] }, { diameter_mm = 50.0, z_mm = [-2.0, 4.0] }";
    let steep =
        "{ diameter_mm = 60.0, z_mm = [-2.0, 4.0] }, { diameter_mm = 61.0, z_mm = [-3.0, 3.0] }";
    let flush = RIM.replace("4.0]", "10.0]");
    let holes = "holes = { count = 6, pitch_circle_diameter_mm = 50.0, diameter_mm = 8.0, phase_deg = 6.0 }\n";
    let kink = "{ diameter_mm = 52.0, z_mm = [-3.0, 4.0] }";
    for (web, more, reason) in [
        (format!("{HUB}, {fillet}"), "", "the contour has fillets"),
        (format!("{HUB}, {step}, {RIM}"), "", "the web has a step"),
        (
            format!("{HUB}, {steep}, {RIM}"),
            "",
            "a face of the web is steeper than 60 degrees",
        ),
        (
            format!("{HUB}, {flush}"),
            "",
            "the web is flush with only one of rim and hub",
        ),
        (
            format!("{HUB}, {kink}, {RIM}"),
            holes,
            "a point of the contour lies among the openings",
        ),
    ] {
        assert_eq!(element(&web, more), (Element::Tet10, Some(reason)), "{web}");
    }
    // Asked for, it needs no reason.
    let asked = element(&format!("{HUB}, {RIM}"), "[mesh]\nelement = \"tet10\"\n");
    assert_eq!(asked, (Element::Tet10, None));
}
