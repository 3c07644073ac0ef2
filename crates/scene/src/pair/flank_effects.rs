//! `gear_1.microgeometry` and `gear_2.microgeometry`; `errors_1`, `errors_2`, `eccentricity_1` and `eccentricity_2`
//! in `mesh.teeth` of a pair: the tables are those of gear meshes.

use std::sync::Arc;

use gearmesh_contact::{FlankDeviations, GearSeat, Runout};
use gearmesh_geometry::flank_error::FlankError;
use gearmesh_geometry::input::TableKeys;
use gearmesh_geometry::{GearDefinition, GearPair, InputError};
use gearmesh_specification::gear_tables::UM;
use gearmesh_specification::gear_tables::seat::EccentricityTable;

use super::scene_file::Scene;
use crate::microgeometry_words::microgeometry_words;

impl Scene {
    /// Puts the scene's microgeometry of a gear (1 or 2) in the place of that of its file; what acts, in words.
    ///
    /// # Errors
    /// [`InputError`] at the key, or in a file.
    pub(crate) fn modify_flanks(
        &self,
        number: usize,
        gear: &mut GearDefinition,
    ) -> Result<String, InputError> {
        let stated = &self.gears[number - 1].microgeometry;
        if let Some(table) = stated {
            let path = format!("gear_{number}.microgeometry");
            let teeth = (&gear.profile, gear.tooth.face_width_m);
            gear.microgeometry = table.check((&self.document, &path), teeth, Some(&self.folder))?;
        }
        Ok(microgeometry_words(gear, stated.is_some()))
    }
}

/// Errors and faults of both gears.
///
/// # Errors
/// [`InputError`] at the key, or in a file.
pub(crate) fn deviations(
    scene: &Scene,
    gears: [&GearDefinition; 2],
) -> Result<FlankDeviations, InputError> {
    let keys = TableKeys::new(&scene.document, "mesh.teeth");
    let mut made: [Vec<Arc<dyn FlankError>>; 2] = [Vec::new(), Vec::new()];
    for (number, (stated, gear)) in scene.gears.iter().zip(gears).enumerate() {
        for (i, table) in stated.errors.iter().enumerate() {
            let key = format!("errors_{}.{i}", number + 1);
            let teeth = (&gear.profile, gear.tooth.face_width_m);
            made[number].push(table.on_gear(teeth, (&keys, &key), &scene.folder)?);
        }
    }
    Ok(FlankDeviations::new(made))
}

/// Places of the gears on their bodies; none where both stand on their axes.
///
/// # Errors
/// [`InputError`] for an offset that leaves no line of action.
pub(crate) fn runout(scene: &Scene, pair: &GearPair) -> Result<Option<Runout>, InputError> {
    let stated = scene.gears.each_ref().map(|gear| gear.eccentricity);
    if stated.iter().all(Option::is_none) {
        return Ok(None);
    }
    let tables = stated.map(Option::unwrap_or_default);
    let keys = TableKeys::new(&scene.document, "mesh.teeth");
    // Half of what the line of action leaves, for each gear.
    let least_m = pair.circles().sum_m().abs();
    let most_um = 0.25 * (pair.centre_distance_m - least_m) / UM;
    for (number, table) in [1, 2].into_iter().zip(&tables) {
        keys.require(
            &format!("eccentricity_{number}.offset_um"),
            table.offset_um,
            table.offset_um.abs() <= most_um,
            &format!("-{most_um:.0} to {most_um:.0}, a quarter of the centre distance less its smallest value, the sum (with a ring the difference) of the base radii"),
        )?;
    }
    Ok(Some(Runout::new(pair, tables.map(seat))))
}

fn seat(table: EccentricityTable) -> GearSeat {
    GearSeat {
        offset_m: UM * table.offset_um,
        direction_rad: table.direction_deg.to_radians(),
        tilt_rad: 1e-3 * table.tilt_mrad,
        tilt_direction_rad: table.tilt_direction_deg.to_radians(),
    }
}
