//! Stress over a cylindrical gear's whole cross-section, for report pages.

use crate::failure::Failure;
use crate::offline::{self, FieldCase};
use gearmesh_geometry::GearDefinition;
use gearmesh_reduction::GearBody;
use gearmesh_report::scene_page::GearPicture;
use gearmesh_scene::{LoadedScene, SceneResult};

/// A gear's von Mises stress at one position: the largest value over the width in each quad of the cross-section.
pub fn picture(
    loaded: &LoadedScene,
    result: &SceneResult,
    case: FieldCase,
    (definition, body): (&GearDefinition, &GearBody),
) -> Result<GearPicture, Failure> {
    let field = offline::field_of(loaded, result, definition, body, case)?;
    let section = &body.mesh.section;
    let values = (0..section.quads.len())
        .map(|quad| {
            let layers = 0..body.mesh.layers.count();
            layers
                .filter_map(|layer| body.mesh.element(quad, layer))
                .map(|element| field.von_mises_pa[element as usize] * 1e-6)
                .fold(0.0, f64::max)
        })
        .collect();
    Ok(GearPicture {
        title: format!(
            "{}, {} N m, driver angle {:.2} deg: largest von Mises stress over the width",
            definition.name,
            result.torque_nm[case.torque],
            result.angle_rad[case.angle].to_degrees()
        ),
        nodes_mm: section
            .nodes
            .iter()
            .map(|p| [p[0] * 1e3, p[1] * 1e3])
            .collect(),
        quads: section.quads.iter().map(|q| q.map(|n| n as u32)).collect(),
        von_mises_mpa: values,
    })
}
