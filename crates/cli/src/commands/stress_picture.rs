//! Stress over a gear's cross-section, for report pages.

use crate::console::StageBar;
use crate::failure::Failure;
use crate::offline::{self, FieldCase};
use gearmesh_geometry::{Element, GearDefinition};
use gearmesh_reduction::GearBody;
use gearmesh_report::scene_page::GearPicture;
use gearmesh_scene::{LoadedScene, SceneResult};

/// Pictures of both gears of a result, which are meshed again for it; of gears that have no cross-section of
/// quadrilaterals none, with the reason.
pub fn pictures(
    loaded: &LoadedScene,
    result: &SceneResult,
) -> Result<(Vec<GearPicture>, Vec<String>), Failure> {
    let (mut pictures, mut left_out) = (Vec::new(), Vec::new());
    for gear in [1, 2] {
        let definition = result.gears[gear - 1].definition_in("the result")?;
        if definition.blank.meshed().is_some() || definition.mesh.element == Element::Tet10 {
            left_out.push(format!(
                "{}: its mesh has no cross-section of quadrilaterals; `gearmesh recover --field-gear {gear}` writes the whole field",
                definition.name
            ));
            continue;
        }
        let bar = StageBar::new(&definition.name);
        let body = GearBody::new(definition, &offline::python()?, &bar)?;
        bar.finish();
        pictures.push(picture(loaded, result, (gear, definition, &body))?);
    }
    Ok((pictures, left_out))
}

/// A gear's von Mises stress at the largest torque, first position: the largest value over the width in each
/// quad of the cross-section.
pub fn picture(
    loaded: &LoadedScene,
    result: &SceneResult,
    (gear, definition, body): (usize, &GearDefinition, &GearBody),
) -> Result<GearPicture, Failure> {
    let torque = result.torque_nm.len() - 1;
    let case = FieldCase {
        gear,
        torque,
        angle: 0,
    };
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
            result.torque_nm[torque],
            result.angle_rad[0].to_degrees()
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
