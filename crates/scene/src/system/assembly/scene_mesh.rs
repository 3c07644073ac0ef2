//! A `[[gear_mesh]]` on its way to a mesh of forces: what the teeth of cylindrical and of bevel gears have in common.

use std::path::Path;

use gearmesh_drivetrain::errors::eccentricity::Eccentricity;
use gearmesh_drivetrain::{Damped, DrivetrainError, GearMesh, TeethModel};
use gearmesh_dynamics::{GROUND, Marker};
use gearmesh_geometry::input::TableKeys;
use gearmesh_geometry::{Flank, InputError};
use gearmesh_model::ReducedGear;
use gearmesh_specification::gear_tables::UM;
use gearmesh_specification::system::gear_mesh::{EccentricityTable, GearMeshTable, TeethTable};
use gearmesh_specification::system::mesh_model::DampingTable;

use super::gear_mesh::PreparedMesh;
use crate::system::built::BuiltMesh;

/// A table with all that its models are made from; `F`: what only flanks of one family need.
pub(super) struct SceneMesh<'a, F> {
    pub table: &'a GearMeshTable,
    pub teeth: TeethTable,
    pub keys: TableKeys<'a>,
    pub model_keys: TableKeys<'a>,
    pub teeth_keys: TableKeys<'a>,
    pub folder: &'a Path,
    pub flanks: F,
}

impl<'a> SceneMesh<'a, ()> {
    /// The table with the flanks that are found for it.
    pub(super) fn with<F>(self, flanks: F) -> SceneMesh<'a, F> {
        SceneMesh {
            table: self.table,
            teeth: self.teeth,
            keys: self.keys,
            model_keys: self.model_keys,
            teeth_keys: self.teeth_keys,
            folder: self.folder,
            flanks,
        }
    }
}

impl<F> SceneMesh<'_, F> {
    pub(super) fn fault(&self) -> impl Fn(DrivetrainError) -> InputError + '_ {
        |error| self.keys.error("", error)
    }

    /// The mesh without its teeth, and what follows from them.
    pub(super) fn prepared(
        &self,
        key: String,
        bodies: [usize; 2],
    ) -> Result<PreparedMesh, InputError> {
        let seat = |table: &Option<EccentricityTable>, key: &str| {
            let table = table.unwrap_or_default();
            let eccentricity = Eccentricity {
                offset_m: UM * table.offset_um,
                direction_rad: table.direction_deg.to_radians(),
                tilt_rad: 1e-3 * table.tilt_mrad,
                tilt_direction_rad: table.tilt_direction_deg.to_radians(),
            };
            let marker: Result<Marker, _> = eccentricity.marker(GROUND, 0.0, 0.0);
            marker.map_err(|e| self.teeth_keys.error(key, e))
        };
        Ok(PreparedMesh {
            key,
            built: BuiltMesh {
                name: self.table.name.clone(),
                gears: [self.table.gear_1.clone(), self.table.gear_2.clone()],
                model: self.table.model.kind().name(),
                ..BuiltMesh::default()
            },
            model: self.table.model.kind(),
            bodies,
            seats: [
                seat(&self.teeth.eccentricity_1, "eccentricity_1")?,
                seat(&self.teeth.eccentricity_2, "eccentricity_2")?,
            ],
            mesh: None,
            sides: self.teeth.flanks.flanks().to_vec(),
            touching_at_start: self.teeth.touching_at_start,
            slice_width_m: 0.0,
            models: None,
            tooth_pairs: None,
        })
    }

    /// The mesh of the teeth on all sides, with what the scene says of friction; `first` makes it of one side.
    pub(super) fn of_sides<T: Into<Box<dyn TeethModel>>>(
        &self,
        teeth: impl IntoIterator<Item = (Flank, T)>,
        first: impl FnOnce(Flank, T) -> Result<GearMesh, DrivetrainError>,
    ) -> Result<GearMesh, InputError> {
        let mut teeth = teeth.into_iter();
        let Some((side, model)) = teeth.next() else {
            return Err(self.teeth_keys.error("flanks", "names no flanks"));
        };
        let mut mesh = first(side, model).map_err(self.fault())?;
        for (side, model) in teeth {
            mesh = mesh.with_side(side, model).map_err(self.fault())?;
        }
        Ok(match &self.teeth.friction {
            None => mesh,
            Some(friction) => mesh.with_friction(friction.check(&self.teeth_keys)?),
        })
    }

    /// Lets the gears vibrate in so many of their modes.
    pub(super) fn with_modes(
        &self,
        mut mesh: GearMesh,
        models: [Option<&ReducedGear>; 2],
        modes: [usize; 2],
    ) -> Result<GearMesh, InputError> {
        for (gear, (model, count)) in models.into_iter().zip(modes).enumerate() {
            if let (Some(model), true) = (model, count > 0) {
                let vibrating = mesh.with_modes(gear + 1, model, count);
                mesh = vibrating.map_err(self.fault())?;
            }
        }
        Ok(mesh)
    }

    /// Teeth with the damping that the model states.
    pub(super) fn damped(
        &self,
        damping: &Option<DampingTable>,
        teeth: impl TeethModel + 'static,
        slices: usize,
    ) -> Result<Box<dyn TeethModel>, InputError> {
        let Some(damping) = damping else {
            return Ok(Box::new(teeth));
        };
        let damped = Damped::new(teeth, damping.damping(), slices);
        let damped = damped.map_err(|e| self.model_keys.error("damping", e))?;
        Ok(Box::new(damped))
    }

    /// Refuses a material in `tooth_pairs` of gears that have their own.
    pub(super) fn refuse_pair_material(&self) -> Result<(), InputError> {
        let table = self.table.tooth_pairs.as_ref();
        let stated = [
            (
                "tooth_pairs.young_GPa",
                table.is_some_and(|t| t.young_GPa.is_some()),
            ),
            (
                "tooth_pairs.poisson",
                table.is_some_and(|t| t.poisson.is_some()),
            ),
        ];
        let problem = "is not used: pressures follow from the materials that the model or the gears have; remove it";
        self.keys.refuse(&stated, problem)
    }
}
