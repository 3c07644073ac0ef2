//! `mesh.plane_strain` in a gear file: its defaults, and the keys that contradict it.

use gearmesh_geometry::GearDefinition;
use gearmesh_geometry::input::InputDocument;

const WEB: &str = "\nhub_diameter_mm = 70.0\nrim_inner_diameter_mm = 130.0\nweb_thickness_mm = 5.0";

fn gear(kind: &str, mesh: &str, reduction: &str) -> Result<GearDefinition, String> {
    let text = format!(
        "name = \"plane\"\n[tooth]\nteeth = 50\nmodule_mm = 3.0\nface_width_mm = 10.0\n[blank]\nbore_diameter_mm = 60.0\n\
         kind = {kind}\n[material]\nyoung_GPa = 206.0\npoisson = 0.3\n[mesh]\nplane_strain = true\n{mesh}\n\
         [reduction]\n{reduction}\n"
    );
    GearDefinition::from_document(&InputDocument::new("plane.toml", text))
        .map_err(|e| e.to_string())
}

#[test]
fn one_slice_is_the_default() {
    let gear = gear("\"solid\"", "", "").unwrap();
    assert!(gear.mesh.plane_strain);
    assert_eq!(gear.reduction.slices, 1);
}

#[test]
fn keys_that_contradict_it_are_refused() {
    let web = format!("\"thin-rim\"{WEB}");
    for (kind, mesh, reduction, expected) in [
        (
            "\"solid\"",
            "axial_mm = 2.0",
            "",
            "mesh.axial_mm: plane strain has one layer",
        ),
        (
            "\"solid\"",
            "",
            "slices = 5",
            "reduction.slices: found 5, allowed is 1 in plane strain",
        ),
        (
            "\"solid\"",
            "",
            "bore = { harmonics = 8, along = 2 }",
            "reduction.bore.along: found 2, allowed is 1 in plane strain",
        ),
        (
            web.as_str(),
            "",
            "",
            "mesh.plane_strain: plane strain knows the cross-section only",
        ),
    ] {
        let text = gear(kind, mesh, reduction).unwrap_err();
        assert!(text.contains(expected), "{text}");
    }
}
