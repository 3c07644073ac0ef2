//! `[modes]`, `[hub]` and the density in a gear file.

use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{GearDefinition, HubSupport, ModeRange};

const DENSITY: &str = "density_kg_per_m3 = 7850.0";

fn gear(material: &str, tables: &str) -> Result<GearDefinition, String> {
    let text = format!(
        "name = \"gear\"\n[tooth]\nteeth = 50\nmodule_mm = 3.0\nface_width_mm = 10.0\n[blank]\nbore_diameter_mm = 60.0\n\
         kind = \"solid\"\n[material]\nyoung_GPa = 206.0\npoisson = 0.3\n{material}\n{tables}\n"
    );
    GearDefinition::from_document(&InputDocument::new("gear.toml", text)).map_err(|e| e.to_string())
}

#[test]
fn nothing_is_the_default() {
    let plain = gear("", "").unwrap();
    assert_eq!((plain.modes, plain.hub), (None, HubSupport::Fixed));
    assert_eq!(plain.material.density_kg_per_m3, None);
}

#[test]
fn what_is_asked_for_is_read() {
    let tables = "[modes]\nup_to_Hz = 20000\n[hub]\nsupport = \"reference-point\"";
    let asked = gear(DENSITY, tables).unwrap();
    assert_eq!(asked.modes, Some(ModeRange::UpToHz(20e3)));
    assert_eq!(asked.hub, HubSupport::ReferencePoint);
    assert_eq!(asked.material.density_kg_per_m3, Some(7850.0));
    let counted = gear(DENSITY, "[modes]\ncount = 40").unwrap();
    assert_eq!(counted.modes, Some(ModeRange::Count(40)));
    assert_eq!(counted.hub, HubSupport::Fixed);
}

#[test]
fn what_cannot_be_is_refused() {
    let plane = "[mesh]\nplane_strain = true\n";
    let point = "[hub]\nsupport = \"reference-point\"\n";
    for (material, tables, expected) in [
        (
            "",
            "[modes]\ncount = 3".to_string(),
            "add material.density_kg_per_m3",
        ),
        ("", point.to_string(), "add material.density_kg_per_m3"),
        (
            "density_kg_per_m3 = -1.0",
            String::new(),
            "material.density_kg_per_m3: found -1",
        ),
        (DENSITY, "[modes]".to_string(), "say which modes"),
        (
            DENSITY,
            "[modes]\ncount = 3\nup_to_Hz = 1e3".to_string(),
            "exclude each other",
        ),
        (
            DENSITY,
            "[modes]\ncount = 0".to_string(),
            "modes.count: found 0",
        ),
        (
            DENSITY,
            "[modes]\nup_to_Hz = 0".to_string(),
            "modes.up_to_Hz: found 0",
        ),
        (DENSITY, "[modes]\nshift = 3".to_string(), "shift"),
        (
            DENSITY,
            "[hub]\nsupport = \"glued\"".to_string(),
            "reference-point",
        ),
        (
            DENSITY,
            format!("{plane}[modes]\ncount = 3"),
            "plane strain has no natural modes",
        ),
        (DENSITY, format!("{plane}{point}"), "no six rigid motions"),
    ] {
        let text = gear(material, &tables).unwrap_err();
        assert!(text.contains(expected), "{tables}: {text}");
    }
}
