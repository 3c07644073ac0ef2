//! Displacement and stress of a cylindrical gear at one position of a pair's result, and the picture of its whole
//! cross-section.

use crate::failure::{Failure, Result};
use gearmesh_geometry::GearDefinition;
use gearmesh_recovery::grid_forces;
use gearmesh_reduction::GearBody;
use gearmesh_reduction::field::{Field, FlankUnits, GridForce, LooseBore};
use gearmesh_report::scene_page::GearPicture;
use gearmesh_scene::{LoadedScene, SceneResult};

/// Said of pictures of whole cross-sections.
pub const CROSS_SECTION: &str = "Element stresses of the finite element model. Directly under the load they are those of the model's own load patches, not of the Hertz contact; the colour scale is \
     cut below them.";

/// Which computed position a field is made for.
#[derive(Debug, Clone, Copy)]
pub struct FieldCase {
    /// Gear 1 or 2.
    pub gear: usize,
    /// Index of the torque in the result.
    pub torque: usize,
    /// Index of the angle in the result.
    pub angle: usize,
}

impl FieldCase {
    /// The case that is asked for: the computed position nearest to a driver angle, where a pair of teeth carries most
    /// if none is named; the largest torque if none is named.
    ///
    /// # Errors
    /// [`Failure`] for a torque that was not computed.
    pub fn asked(
        result: &SceneResult,
        gear: usize,
        (angle_deg, torque_nm): (Option<f64>, Option<f64>),
    ) -> Result<Self> {
        let torque = asked_torque(result, "--field-torque-Nm", torque_nm)?;
        let most_n = |angle: usize| {
            let pairs = 0..result.lines.slots;
            let forces = pairs.map(|slot| result.forces(torque, angle, slot).iter().sum::<f64>());
            forces.fold(0.0, f64::max)
        };
        let angle = match angle_deg {
            Some(wanted) => nearest_angle(result, wanted),
            // The first of the largest: pitches may repeat.
            None => (0..result.angles())
                .rev()
                .max_by(|a, b| most_n(*a).total_cmp(&most_n(*b)))
                .unwrap_or_default(),
        };
        Ok(Self {
            gear,
            torque,
            angle,
        })
    }

    /// In words.
    #[must_use]
    pub fn words(&self, result: &SceneResult) -> String {
        format!(
            "{} N m, driver angle {:.2} deg",
            result.torque_nm[self.torque],
            result.angle_rad[self.angle].to_degrees()
        )
    }
}

/// Index of the torque that an option asks for; of the largest one if it names none.
pub(crate) fn asked_torque(
    result: &SceneResult,
    option: &str,
    torque_nm: Option<f64>,
) -> Result<usize> {
    let Some(wanted) = torque_nm else {
        return Ok(largest_torque(result));
    };
    let torques = &result.torque_nm;
    let near = |torque: &f64| (torque - wanted).abs() <= 1e-9 * wanted.abs();
    torques.iter().position(near).ok_or_else(|| {
        Failure::input(format!(
            "{option}: found {wanted}, the result has {torques:?}"
        ))
    })
}

/// Index of the torque that is largest by its amount.
#[must_use]
pub fn largest_torque(result: &SceneResult) -> usize {
    let torques = result.torque_nm.iter().enumerate();
    let largest = torques.max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
    largest.map_or(0, |(k, _)| k)
}

/// Index of the computed angle of the driver that is nearest.
#[must_use]
pub fn nearest_angle(result: &SceneResult, wanted_deg: f64) -> usize {
    let apart = |k: &usize| (result.angle_rad[*k].to_degrees() - wanted_deg).abs();
    let all = 0..result.angles();
    all.min_by(|a, b| apart(a).total_cmp(&apart(b)))
        .unwrap_or_default()
}

/// Displacement and stress of a gear at one position of a result.
///
/// # Errors
/// [`Failure`] where the field cannot be made.
pub fn field_of(
    loaded: &LoadedScene,
    result: &SceneResult,
    definition: &GearDefinition,
    body: &GearBody,
    case: FieldCase,
) -> Result<Field> {
    let model = &loaded.models[case.gear - 1];
    let slices = loaded.patches_at(result.angle_rad[case.angle]);
    let forces = result.position_forces(case.torque, case.angle);
    let loads = loaded.loaded_slices(case.gear, &slices, forces);
    let forces: Vec<GridForce> = grid_forces(&model.grid, &loaded.spreads[case.gear - 1], loads)
        .into_iter()
        .map(|f| GridForce {
            tooth: f.tooth,
            side: loaded.lines.pair.flank_of(case.gear - 1),
            load: f.load,
            normal_n: f.normal_n,
            tangential_n: f.tangential_n,
        })
        .collect();
    let side = loaded.lines.pair.flank_of(case.gear - 1);
    let units = FlankUnits::of_gear(definition, body, &[side])?;
    let bore = loaded.bores[case.gear - 1].as_deref();
    let bore = bore.map(|model| LooseBore {
        model,
        radial_m: &[],
    });
    let displacement_m = units.displacement_m(body, &forces, bore)?;
    Ok(Field::new(&body.model, &displacement_m)?)
}

/// A gear's von Mises stress at one position: the largest value over the width in each quad of the cross-section.
pub fn picture(
    loaded: &LoadedScene,
    result: &SceneResult,
    case: FieldCase,
    (definition, body): (&GearDefinition, &GearBody),
) -> Result<GearPicture> {
    let field = field_of(loaded, result, definition, body, case)?;
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
            "{}, {}: largest von Mises stress over the width",
            definition.name,
            case.words(result)
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
