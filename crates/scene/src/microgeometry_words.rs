//! The microgeometry of a gear in words, and where it is stated.

use gearmesh_geometry::GearDefinition;

/// For plans, results and reports: `tip relief 20 um linear from 170 mm (scene)`.
pub(crate) fn microgeometry_words(gear: &GearDefinition, by_scene: bool) -> String {
    let laws = gear.microgeometry.description(gear.profile.base_radius_m);
    match (laws, by_scene) {
        (Some(laws), true) => format!("{laws} (scene)"),
        (Some(laws), false) => format!("{laws} (gear file)"),
        (None, true) => "unmodified (scene)".to_owned(),
        (None, false) => "unmodified".to_owned(),
    }
}
