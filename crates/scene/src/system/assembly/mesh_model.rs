//! The model of a gear mesh's teeth from its `[[gear_mesh]]` table: damping, friction, errors; the stiffness of the
//! simple models is in `mesh_stiffness.rs`.

use std::path::Path;
use std::sync::Arc;

use gearmesh_contact::{ContactError, SliceLayout};
use gearmesh_drivetrain::flank_contacts::FlankErrors;
use gearmesh_drivetrain::{
    BeamTeeth, BeamTooth, Damped, DrivetrainError, FlankError, Friction, GearMesh, MeshKinematics,
    PairCurve, PathEnds, ReducedTeeth, TeethModel,
};
use gearmesh_geometry::input::TableKeys;
use gearmesh_geometry::{Flank, GearPair, InputError};
use gearmesh_model::ReducedGear;

use super::gears::Gear;
use crate::system::tables::gear_mesh::{GearMeshTable, MeshModel, PathWord, TouchingFlanks};

/// Line load at which ISO 6336-1 takes the stiffness of teeth as constant; here the reference for loads that a scene
/// does not state.
pub(super) const REFERENCE_LINE_LOAD_N_PER_M: f64 = 1e5;

pub(super) fn refuse_unused(table: &GearMeshTable, keys: &TableKeys<'_>) -> Result<(), InputError> {
    let touching: &[&str] = &["impact", "iso6336", "analytic", "hybrid"];
    let elastic: &[&str] = &["iso6336", "analytic", "hybrid"];
    let single_teeth: &[&str] = &["impact", "analytic", "hybrid"];
    keys.refuse_unused(
        ("model", table.model.name()),
        &[
            ("flanks", table.flanks.is_some(), touching),
            ("path", table.path.is_some(), touching),
            ("slices", table.slices.is_some(), touching),
            (
                "stiffness_N_per_mm_e",
                table.stiffness_N_per_mm_e.is_some(),
                &["impact"],
            ),
            ("exponent", table.exponent.is_some(), &["impact"]),
            (
                "stiffness",
                table.stiffness.is_some(),
                &["impact", "iso6336"],
            ),
            (
                "damping_N_s_per_mm",
                table.damping_N_s_per_mm.is_some(),
                &["impact"],
            ),
            (
                "full_damping_depth_um",
                table.full_damping_depth_um.is_some(),
                &["impact"],
            ),
            (
                "stiffness_N_per_mm_um",
                table.stiffness_N_per_mm_um.is_some(),
                &["iso6336"],
            ),
            (
                "line_load_N_per_mm",
                table.line_load_N_per_mm.is_some(),
                &["iso6336"],
            ),
            (
                "stiffness_amplitude",
                table.stiffness_amplitude.is_some(),
                &["iso6336"],
            ),
            ("local", table.local.is_some(), &["hybrid"]),
            (
                "nominal_force_N",
                table.nominal_force_N.is_some(),
                &["hybrid"],
            ),
            ("damping", table.damping.is_some(), elastic),
            ("friction", table.friction.is_some(), touching),
            ("errors_1", !table.errors_1.is_empty(), single_teeth),
            ("errors_2", !table.errors_2.is_empty(), single_teeth),
            ("cracks_1", !table.cracks_1.is_empty(), &["analytic"]),
            ("cracks_2", !table.cracks_2.is_empty(), &["analytic"]),
            ("eccentricity_1", table.eccentricity_1.is_some(), touching),
            ("eccentricity_2", table.eccentricity_2.is_some(), touching),
        ],
    )
}

/// A table with all that its models are made from.
pub(super) struct SceneMesh<'a> {
    pub table: &'a GearMeshTable,
    pub keys: TableKeys<'a>,
    pub folder: &'a Path,
    pub gears: [&'a Arc<Gear>; 2],
    pub pair: &'a GearPair,
    /// Mid-face of gear 2 from that of gear 1 along the axes at the start \[m\].
    pub displacement_m: f64,
    /// The static curve of the pair where the stiffness comes from it.
    pub curve: Option<PairCurve>,
}

impl SceneMesh<'_> {
    pub(super) fn fault(&self) -> impl Fn(DrivetrainError) -> InputError + '_ {
        |error| self.keys.error("", error)
    }

    /// Width of the contact zone at the start \[m\].
    pub(super) fn zone_width_m(&self) -> f64 {
        self.layout(1).reference.width_m
    }

    /// So many slices over the overlap of the faces at the start.
    pub(super) fn layout(&self, slices: usize) -> SliceLayout {
        let widths = self.gears.map(|gear| gear.definition.tooth.face_width_m);
        SliceLayout::new(widths, self.displacement_m, slices)
    }

    fn models(&self) -> Result<[&ReducedGear; 2], InputError> {
        let model = |i: usize| {
            self.gears[i].model.as_deref().ok_or_else(|| {
                let key = ["gear_1", "gear_2"][i];
                self.keys.error(
                    key,
                    format!(
                        "model = \"hybrid\" needs reduced gears (.h5), found {}",
                        self.gears[i].file.display()
                    ),
                )
            })
        };
        Ok([model(0)?, model(1)?])
    }

    /// The microgeometry that acts.
    pub(super) fn microgeometry(&self) -> Result<[FlankErrors; 2], InputError> {
        let on = self.table.microgeometry.unwrap_or(true);
        let blind = matches!(self.table.model, MeshModel::Kinematic | MeshModel::Iso6336);
        let mut errors: [FlankErrors; 2] = [Vec::new(), Vec::new()];
        for (gear, list) in self.gears.iter().zip(&mut errors) {
            // A curve of the pair holds it already.
            let in_curve = blind && self.curve.is_some();
            if !on || !gear.has_microgeometry() || in_curve {
                continue;
            }
            if blind {
                let problem = format!(
                    "the gear of {} has microgeometry, which model = \"{}\" cannot feel: set microgeometry = false to leave it out, or take another model",
                    gear.file.display(),
                    self.table.model.name()
                );
                return Err(self.keys.error("microgeometry", problem));
            }
            list.push(Arc::new(gear.definition.microgeometry.clone()) as Arc<dyn FlankError>);
        }
        if blind && self.table.microgeometry == Some(true) {
            let problem = format!(
                "is true, but model = \"{}\" knows no flanks; remove it",
                self.table.model.name()
            );
            return Err(self.keys.error("microgeometry", problem));
        }
        Ok(errors)
    }

    /// A crack of a gear's file that the model would pass over in silence.
    pub(super) fn refuse_unfelt_cracks(&self) -> Result<(), InputError> {
        if self.table.model == MeshModel::Hybrid {
            return Ok(());
        }
        for (key, gear) in ["gear_1", "gear_2"].into_iter().zip(self.gears) {
            if gear.definition.crack.is_some() {
                let problem = format!(
                    "the gear of {} has a [crack], which only model = \"hybrid\" feels; take that model, or a gear without the crack \
                     (\"analytic\" has cracks_1 and cracks_2)",
                    gear.file.display()
                );
                return Err(self.keys.error(key, problem));
            }
        }
        Ok(())
    }

    fn errors(&self) -> Result<[FlankErrors; 2], InputError> {
        let mut errors = self.microgeometry()?;
        for (number, tables) in [&self.table.errors_1, &self.table.errors_2]
            .into_iter()
            .enumerate()
        {
            let gear = &self.gears[number].definition;
            for (i, table) in tables.iter().enumerate() {
                let key = format!("errors_{}.{i}", number + 1);
                let made = table.on_gear(
                    (&gear.profile, gear.tooth.face_width_m),
                    (&self.keys, &key),
                    self.folder,
                )?;
                errors[number].push(made);
            }
        }
        Ok(errors)
    }

    /// The slices: one where models state none.
    fn stated_layout(&self) -> Result<SliceLayout, InputError> {
        if self.table.model == MeshModel::Hybrid {
            let resolved =
                SliceLayout::resolved(self.models()?, self.displacement_m, self.table.slices);
            return resolved.map_err(|error| match error {
                ContactError::Slices { .. } => self.keys.error("slices", error),
                _ => self.keys.error("", error),
            });
        }
        let count = self.table.slices.unwrap_or(1);
        self.keys.require(
            "slices",
            count as f64,
            (1..=200).contains(&count),
            "1 to 200",
        )?;
        Ok(self.layout(count))
    }

    pub(super) fn mesh(&self, sides: &[Flank]) -> Result<GearMesh, InputError> {
        let mut teeth: Vec<(Flank, Box<dyn TeethModel>)> = Vec::new();
        let layout = self.stated_layout()?;
        let slices = layout.slices;
        match self.table.model {
            MeshModel::Kinematic | MeshModel::Impact => {
                let law = self.impact(slices)?;
                teeth.extend(
                    sides
                        .iter()
                        .map(|side| (*side, Box::new(law) as Box<dyn TeethModel>)),
                );
            }
            MeshModel::Iso6336 => {
                for side in sides {
                    let spring = self.spring(*side, &layout)?;
                    teeth.push((*side, self.damped(spring, slices)?));
                }
            }
            MeshModel::Analytic => {
                let beams = self.beams(slices)?;
                for side in sides {
                    teeth.push((*side, self.damped(beams.clone(), slices)?));
                }
            }
            MeshModel::Hybrid => {
                for side in sides {
                    let reduced = self.reduced(*side, layout)?;
                    teeth.push((*side, self.damped(reduced, slices)?));
                }
            }
        }
        let ends = match self.table.path.unwrap_or_default() {
            PathWord::LineOfAction => PathEnds::LineOfAction,
            PathWord::Extended => PathEnds::Extended,
        };
        let gears = [self.pair.gear_1.clone(), self.pair.gear_2.clone()];
        let kinematics = MeshKinematics::new(
            gears,
            self.errors()?,
            self.pair.centre_distance_m,
            layout,
            ends,
        )
        .map_err(self.fault())?;
        let mut teeth = teeth.into_iter();
        let Some((side, model)) = teeth.next() else {
            return Err(self.keys.error("flanks", "names no flanks"));
        };
        let mut mesh = GearMesh::new(kinematics, side, model).map_err(self.fault())?;
        for (side, model) in teeth {
            mesh = mesh.with_side(side, model).map_err(self.fault())?;
        }
        Ok(match self.friction()? {
            None => mesh,
            Some(friction) => mesh.with_friction(friction),
        })
    }

    /// Lets the gears vibrate in their modes. Other models than `hybrid` do not feel them.
    pub(super) fn modal(
        &self,
        mut mesh: GearMesh,
        modes: [usize; 2],
    ) -> Result<GearMesh, InputError> {
        if self.table.model != MeshModel::Hybrid {
            return Ok(mesh);
        }
        let models = self.models()?;
        for gear in 0..2 {
            if modes[gear] > 0 {
                mesh = mesh
                    .with_modes(gear + 1, models[gear], modes[gear])
                    .map_err(self.fault())?;
            }
        }
        Ok(mesh)
    }

    fn beams(&self, slices: usize) -> Result<BeamTeeth, InputError> {
        let tooth = |i: usize| {
            let gear = &self.gears[i].definition;
            BeamTooth {
                gear: i + 1,
                tooth: &gear.profile,
                material: gear.material,
                // Slices bend on their own: what stands beside the zone does not help.
                face_width_m: self.zone_width_m(),
                bore_radius_m: gear.blank.bore_radius_m,
            }
        };
        let cracks = [&self.table.cracks_1, &self.table.cracks_2];
        let [first, second] =
            cracks.map(|list| list.iter().map(|crack| crack.crack()).collect::<Vec<_>>());
        BeamTeeth::new([tooth(0), tooth(1)], slices, [&first, &second]).map_err(self.fault())
    }

    fn reduced(&self, side: Flank, layout: SliceLayout) -> Result<ReducedTeeth, InputError> {
        let models = self.models()?;
        let reference = REFERENCE_LINE_LOAD_N_PER_M * self.zone_width_m();
        let nominal = self.table.nominal_force_N.unwrap_or(reference);
        self.keys
            .require("nominal_force_N", nominal, nominal > 0.0, "more than 0")?;
        let local = self.table.local.unwrap_or_default();
        ReducedTeeth::on_slices(self.pair, side, models, (local, layout), nominal).map_err(|error| {
            let hint = match self.table.flanks.unwrap_or_default() {
                TouchingFlanks::Both => "; both sides of the teeth can touch unless the mesh says flanks = \"right\" or \"left\"",
                _ => "",
            };
            self.keys.error("", format!("{} flanks: {error}{hint}", side.name()))
        })
    }

    fn damped(
        &self,
        teeth: impl TeethModel + 'static,
        slices: usize,
    ) -> Result<Box<dyn TeethModel>, InputError> {
        let Some(damping) = &self.table.damping else {
            return Ok(Box::new(teeth));
        };
        let damping = damping.check(&self.keys)?;
        let damped =
            Damped::new(teeth, damping, slices).map_err(|e| self.keys.error("damping", e))?;
        Ok(Box::new(damped))
    }

    fn friction(&self) -> Result<Option<Friction>, InputError> {
        let table = self.table.friction.as_ref();
        table
            .map(|table| table.of_gear_mesh(&self.keys))
            .transpose()
    }
}
