//! `kind = "hybrid"` of a bevel mesh: flanks in slices, reduced gears or rigid ones whose surfaces deflect.

use std::sync::Arc;

use gearmesh_drivetrain::{BevelSlices, GearMesh, ReducedTeeth, TeethModel};
use gearmesh_geometry::{Flank, InputError};
use gearmesh_model::{ReducedGear, read_reduced_gear};
use gearmesh_specification::system::mesh_model::{HybridTable, MeshModel};

use super::bevel_mesh::{SceneBevel, material};
use super::bodies::Bodies;
use crate::system::iso_stiffness::REFERENCE_LINE_LOAD_N_PER_M;

/// Slices where neither the scene nor models say how many.
const SLICES: usize = 15;

/// The reduced gears of a mesh.
pub(super) type BevelModels = [Arc<ReducedGear>; 2];

impl SceneBevel<'_> {
    /// The models of both members: those that the bodies name as their gears, else those that the mesh names; none
    /// where neither names any.
    pub(super) fn models(
        &self,
        bodies: &Bodies,
        numbers: [usize; 2],
    ) -> Result<Option<BevelModels>, InputError> {
        let placed = numbers.map(|number| &bodies.list[number]);
        let (own, files) = (placed.map(|body| body.bevel()), &self.table.bevel_models);
        let named = (0..2).find(|i| own[*i].is_some());
        if let (Some(i), Some(_)) = (named, files) {
            let problem = format!(
                "is not used: body `{}` names its reduced gear itself; remove one of the two",
                placed[i].body.name
            );
            return Err(self.keys.error("bevel_models", problem));
        }
        match (own, files) {
            ([Some(first), Some(second)], _) => Ok(Some([Arc::clone(first), Arc::clone(second)])),
            (_, Some(files)) => {
                let read = |i: usize| {
                    let key = format!("bevel_models.{i}");
                    let model = read_reduced_gear(&self.folder.join(&files[i]));
                    model.map(Arc::new).map_err(|e| self.keys.error(&key, e))
                };
                Ok(Some([read(0)?, read(1)?]))
            }
            ([Some(_), None] | [None, Some(_)], None)
                if matches!(self.table.model, MeshModel::Hybrid(_)) =>
            {
                let without = usize::from(own[0].is_some());
                let names = [without, 1 - without].map(|i| &placed[i].body.name);
                let problem = format!(
                    "body `{}` names no reduced bevel gear, but `{}` does; \"hybrid\" takes both or none: give it `gear = \"...h5\"` in its [[body]]",
                    names[0], names[1]
                );
                Err(self.keys.error(["gear_1", "gear_2"][without], problem))
            }
            _ => Ok(None),
        }
    }

    /// Slices along the teeth.
    pub(super) fn slices(
        &self,
        model: &HybridTable,
        models: Option<&BevelModels>,
    ) -> Result<usize, InputError> {
        // A model tells its own slices apart, shorter ones not.
        let own = models.map(|models| models[0].grid.slices.min(models[1].grid.slices).max(3));
        let count = model.slices.unwrap_or(own.unwrap_or(SLICES));
        let most = own.unwrap_or(100);
        let allowed = format!("3 to {most}");
        let ok = (3..=most).contains(&count);
        self.model_keys
            .require("slices", count as f64, ok, &allowed)?;
        Ok(count)
    }

    /// The mesh of both sides' teeth.
    pub(super) fn hybrid(
        &self,
        kinematics: BevelSlices,
        (model, models, modes): (&HybridTable, Option<&BevelModels>, [usize; 2]),
        sides: &[Flank],
    ) -> Result<GearMesh, InputError> {
        let face_width_m =
            gearmesh_drivetrain::FlankKinematics::layout(&kinematics).face_widths_m[0];
        let nominal =
            (model.nominal_force_N).map_or(REFERENCE_LINE_LOAD_N_PER_M * face_width_m, f64::from);
        let slices = gearmesh_drivetrain::FlankKinematics::layout(&kinematics).slices;
        let teeth = |side: Flank| -> Result<(Flank, Box<dyn TeethModel>), InputError> {
            let teeth = match (models, &model.half_space) {
                (Some(models), None) => {
                    let models = [&*models[0], &*models[1]];
                    let local = (model.local.unwrap_or_default(), nominal);
                    let made = kinematics.reduced_teeth(side, models, local);
                    let files = self.table.bevel_models.as_ref();
                    let key = files.map_or("", |_| "bevel_models");
                    made.map_err(|e| self.keys.error(key, e))?
                }
                (_, stated) => {
                    let material = material(stated.as_ref());
                    let contact = kinematics.surface_contact([material; 2]);
                    ReducedTeeth::of_flanks(contact, nominal).map_err(self.fault())?
                }
            };
            Ok((side, self.damped(&model.damping, teeth, slices)?))
        };
        let teeth: Vec<_> = sides
            .iter()
            .map(|side| teeth(*side))
            .collect::<Result<_, _>>()?;
        let flanks = Box::new(kinematics.clone());
        let mesh = self.of_sides(teeth, |side, teeth| {
            GearMesh::of_flanks(flanks, side, teeth)
        })?;
        let models = [0, 1].map(|gear: usize| models.map(|models| &*models[gear]));
        self.with_modes(mesh, models, modes)
    }

    /// What the model needs and what it does not use; `of_bodies`: whether a body names its reduced gear.
    pub(super) fn check_hybrid(
        &self,
        model: &HybridTable,
        of_bodies: bool,
    ) -> Result<(), InputError> {
        let keys = &self.model_keys;
        let reduced = of_bodies || self.table.bevel_models.is_some();
        match (reduced, &model.half_space) {
            (true, Some(_)) => {
                let problem = "is not used with `bevel_models` or bodies that name reduced gears, whose materials count; remove one of the two";
                Err(keys.error("half_space", problem))
            }
            (false, None) => {
                let problem = "missing: kind = \"hybrid\" needs the reduced gears of both members, `gear = \"...h5\"` of both bodies or here `bevel_models = [\"pinion.h5\", \"gear.h5\"]`, \
                               or `half_space = {}` in its model for rigid gears whose surfaces deflect";
                Err(self.keys.error("bevel_models", problem))
            }
            (false, Some(_)) if model.local.is_some() => {
                let problem =
                    "is not used with `half_space`, which has no model to complete; remove it";
                Err(keys.error("local", problem))
            }
            _ => Ok(()),
        }
    }
}
