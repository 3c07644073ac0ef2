//! The model of a gear mesh's teeth from its `[[gear_mesh]]` table: damping, friction, errors; the stiffness of the
//! simple models is in `mesh_stiffness.rs`.

use std::path::Path;
use std::sync::Arc;

use gearmesh_contact::{CondensedFlanks, ContactError, SliceLayout};
use gearmesh_drivetrain::flank_contacts::FlankErrors;
use gearmesh_drivetrain::{
    BeamTeeth, BeamTooth, Damped, DrivetrainError, FlankError, Friction, GearMesh, MeshKinematics,
    PairCurve, PathEnds, ReducedTeeth, SlicePressure, TeethModel, ToothPairs,
};
use gearmesh_geometry::input::TableKeys;
use gearmesh_geometry::point_contact::contact_modulus_pa;
use gearmesh_geometry::{Flank, GearDefinition, GearPair, InputError};
use gearmesh_model::ReducedGear;

use super::gears::Gear;
use crate::system::iso_stiffness::REFERENCE_LINE_LOAD_N_PER_M;
use crate::system::tables::gear_mesh::{GearMeshTable, PathWord, TeethTable, TouchingFlanks};
use crate::system::tables::mesh_model::{
    AnalyticTable, DampingTable, HertzTable, HybridTable, MeshKind, MeshModel,
};

/// A table with all that its models are made from.
pub(super) struct SceneMesh<'a, 'm> {
    pub table: &'a GearMeshTable,
    pub teeth: TeethTable,
    pub keys: TableKeys<'a>,
    pub model_keys: TableKeys<'a>,
    pub teeth_keys: TableKeys<'a>,
    pub folder: &'a Path,
    pub gears: [&'m Arc<Gear>; 2],
    pub pair: &'a GearPair,
    /// Flanks of all meshes of the scene so far.
    pub condensed: &'a CondensedFlanks<'m>,
    /// Mid-face of gear 2 from that of gear 1 along the axes at the start \[m\].
    pub displacement_m: f64,
    /// The static curve of the pair where the stiffness comes from it.
    pub curve: Option<PairCurve>,
}

impl<'m> SceneMesh<'_, 'm> {
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

    fn models(&self) -> Result<[&'m ReducedGear; 2], InputError> {
        let gears: [&'m Arc<Gear>; 2] = self.gears;
        let model = |i: usize| {
            gears[i].model.as_deref().ok_or_else(|| {
                let key = ["gear_1", "gear_2"][i];
                self.keys.error(
                    key,
                    format!(
                        "kind = \"hybrid\" needs reduced gears (.h5), found {}",
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
        let kind = self.table.model.kind();
        let blind = matches!(kind, MeshKind::Kinematic | MeshKind::Iso6336);
        let mut errors: [FlankErrors; 2] = [Vec::new(), Vec::new()];
        for (gear, list) in self.gears.iter().zip(&mut errors) {
            // A curve of the pair holds it already.
            let in_curve = blind && self.curve.is_some();
            if !on || !gear.has_microgeometry() || in_curve {
                continue;
            }
            if blind {
                let problem = format!(
                    "the gear of {} has microgeometry, which kind = \"{}\" cannot feel: set microgeometry = false to leave it out, or take another model",
                    gear.file.display(),
                    kind.name()
                );
                return Err(self.keys.error("microgeometry", problem));
            }
            list.push(Arc::new(gear.definition.microgeometry.clone()) as Arc<dyn FlankError>);
        }
        if blind && self.table.microgeometry == Some(true) {
            let problem = format!(
                "is true, but kind = \"{}\" knows no flanks; remove it",
                kind.name()
            );
            return Err(self.keys.error("microgeometry", problem));
        }
        Ok(errors)
    }

    /// A crack of a gear's file that the model would pass over in silence.
    pub(super) fn refuse_unfelt_cracks(&self) -> Result<(), InputError> {
        if self.table.model.kind() == MeshKind::Hybrid {
            return Ok(());
        }
        for (key, gear) in ["gear_1", "gear_2"].into_iter().zip(self.gears) {
            if gear.definition.crack.is_some() {
                let problem = format!(
                    "the gear of {} has a [crack], which only kind = \"hybrid\" feels; take that model, or a gear without the crack \
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
        for (number, tables) in [&self.teeth.errors_1, &self.teeth.errors_2]
            .into_iter()
            .enumerate()
        {
            let gear = &self.gears[number].definition;
            for (i, table) in tables.iter().enumerate() {
                let key = format!("errors_{}.{i}", number + 1);
                let made = table.on_gear(
                    (&gear.profile, gear.tooth.face_width_m),
                    (&self.teeth_keys, &key),
                    self.folder,
                )?;
                errors[number].push(made);
            }
        }
        Ok(errors)
    }

    /// The slices: one where models state none.
    fn stated_layout(&self) -> Result<SliceLayout, InputError> {
        let stated = self.table.model.slices();
        if self.table.model.kind() == MeshKind::Hybrid {
            let resolved = SliceLayout::resolved(self.models()?, self.displacement_m, stated);
            return resolved.map_err(|error| match error {
                ContactError::Slices { .. } => self.model_keys.error("slices", error),
                _ => self.keys.error("", error),
            });
        }
        Ok(self.layout(stated.unwrap_or(1)))
    }

    pub(super) fn mesh(&self, sides: &[Flank]) -> Result<GearMesh, InputError> {
        let mut teeth: Vec<(Flank, Box<dyn TeethModel>)> = Vec::new();
        let layout = self.stated_layout()?;
        let slices = layout.slices;
        match &self.table.model {
            // An ideal ratio has no forces of its own; neither is made here.
            MeshModel::Kinematic {} | MeshModel::NodeToSurface(_) => {}
            MeshModel::Impact(model) => {
                let law = self.impact(model, slices)?.on_modes();
                teeth.extend(
                    sides
                        .iter()
                        .map(|side| (*side, Box::new(law) as Box<dyn TeethModel>)),
                );
            }
            MeshModel::Iso6336(model) => {
                for side in sides {
                    let spring = self.spring(model, *side, &layout)?;
                    teeth.push((*side, self.damped(&model.damping, spring, slices)?));
                }
            }
            MeshModel::Analytic(model) => {
                let beams = self.beams(model, slices)?;
                for side in sides {
                    teeth.push((*side, self.damped(&model.damping, beams.clone(), slices)?));
                }
            }
            MeshModel::Hybrid(model) => {
                for side in sides {
                    let reduced = self.reduced(model, *side, layout)?;
                    teeth.push((*side, self.damped(&model.damping, reduced, slices)?));
                }
            }
        }
        let ends = match self.teeth.path {
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
            return Err(self.keys.error("teeth.flanks", "names no flanks"));
        };
        let mut mesh = GearMesh::new(kinematics, side, model).map_err(self.fault())?;
        for (side, model) in teeth {
            mesh = mesh.with_side(side, model).map_err(self.fault())?;
        }
        self.with_friction(mesh)
    }

    /// Adds what the teeth say of friction.
    pub(super) fn with_friction(&self, mesh: GearMesh) -> Result<GearMesh, InputError> {
        Ok(match self.friction()? {
            None => mesh,
            Some(friction) => mesh.with_friction(friction),
        })
    }

    /// Lets the gears vibrate in their modes. `iso6336` and `analytic` do not feel them.
    pub(super) fn modal(
        &self,
        mut mesh: GearMesh,
        modes: [usize; 2],
    ) -> Result<GearMesh, InputError> {
        let kind = self.table.model.kind();
        if !matches!(
            kind,
            MeshKind::Hybrid | MeshKind::NodeToSurface | MeshKind::Impact
        ) {
            return Ok(mesh);
        }
        for (gear, count) in modes.into_iter().enumerate() {
            if let (Some(model), true) = (&self.gears[gear].model, count > 0) {
                mesh = mesh
                    .with_modes(gear + 1, model, count)
                    .map_err(self.fault())?;
            }
        }
        Ok(mesh)
    }

    fn beams(&self, model: &AnalyticTable, slices: usize) -> Result<BeamTeeth, InputError> {
        for (gear, key) in self.gears.iter().zip(["gear_1", "gear_2"]) {
            if gear.definition.blank.cut_into_shaft().is_some() {
                let problem = format!(
                    "`{}` is cut into its shaft; model.kind = \"analytic\" takes gears as discs held at a bore: choose \"hybrid\" or give the gear a bore",
                    gear.definition.name
                );
                return Err(self.keys.error(key, problem));
            }
        }
        let tooth = |i: usize| {
            let gear = &self.gears[i].definition;
            BeamTooth {
                gear: i + 1,
                tooth: &gear.profile,
                material: gear.material,
                // Slices bend on their own: what stands beside the zone does not help.
                face_width_m: self.zone_width_m(),
                bore_radius_m: gear.blank.bore_radius_m(),
            }
        };
        let cracks = [&model.cracks_1, &model.cracks_2];
        let [first, second] =
            cracks.map(|list| list.iter().map(|crack| crack.crack()).collect::<Vec<_>>());
        BeamTeeth::new([tooth(0), tooth(1)], slices, [&first, &second]).map_err(self.fault())
    }

    fn reduced(
        &self,
        model: &HybridTable,
        side: Flank,
        layout: SliceLayout,
    ) -> Result<ReducedTeeth, InputError> {
        let models = self.models()?;
        let reference = REFERENCE_LINE_LOAD_N_PER_M * self.zone_width_m();
        let nominal = model.nominal_force_N.map_or(reference, f64::from);
        let contact = (model.local.unwrap_or_default(), layout);
        let teeth =
            ReducedTeeth::on_slices(self.pair, side, models, contact, nominal, self.condensed);
        teeth.map_err(|error| {
            let hint = match self.teeth.flanks {
                TouchingFlanks::Both => "; both sides of the teeth can touch unless the mesh's teeth say flanks = \"right\" or \"left\"",
                _ => "",
            };
            self.keys.error("", format!("{} flanks: {error}{hint}", side.name()))
        })
    }

    fn damped(
        &self,
        damping: &Option<DampingTable>,
        teeth: impl TeethModel + 'static,
        slices: usize,
    ) -> Result<Box<dyn TeethModel>, InputError> {
        let Some(damping) = damping else {
            return Ok(Box::new(teeth));
        };
        let damping = damping.damping();
        let damped =
            Damped::new(teeth, damping, slices).map_err(|e| self.model_keys.error("damping", e))?;
        Ok(Box::new(damped))
    }

    /// How pairs of teeth have columns: the slices of each together, with Hertz' pressure by the gears' own materials.
    pub(super) fn tooth_pairs(&self) -> Result<Option<ToothPairs>, InputError> {
        let Some(table) = &self.table.tooth_pairs else {
            return Ok(None);
        };
        let kind = self.table.model.kind();
        if matches!(kind, MeshKind::Kinematic | MeshKind::Iso6336) {
            let problem = format!(
                "is not used by kind = \"{}\", which knows no single teeth; remove it, or take another model",
                kind.name()
            );
            return Err(self.keys.error("tooth_pairs", problem));
        }
        refuse_material(table, &self.keys)?;
        let [first, second] = self.gears.map(|gear| &gear.definition);
        let material = |gear: &GearDefinition| (gear.material.young_pa, gear.material.poisson);
        let ends =
            |gear: &GearDefinition| [gear.profile.form_roll_rad, gear.profile.flank_end_roll_rad];
        Ok(Some(ToothPairs::Slices {
            pressure: SlicePressure::Line(contact_modulus_pa(material(first), material(second))),
            face_widths_m: [first.tooth.face_width_m, second.tooth.face_width_m],
            ends: [ends(first), ends(second)],
        }))
    }

    fn friction(&self) -> Result<Option<Friction>, InputError> {
        let table = self.teeth.friction.as_ref();
        table.map(|table| table.check(&self.teeth_keys)).transpose()
    }
}

/// A material in `tooth_pairs` of gears that have their own.
pub(super) fn refuse_material(table: &HertzTable, keys: &TableKeys<'_>) -> Result<(), InputError> {
    let stated = [
        ("tooth_pairs.young_GPa", table.young_GPa.is_some()),
        ("tooth_pairs.poisson", table.poisson.is_some()),
    ];
    let Some((key, _)) = stated.into_iter().find(|(_, is_stated)| *is_stated) else {
        return Ok(());
    };
    let problem = "is not used: pressures follow from the materials that the model or the gears have; remove it";
    Err(keys.error(key, problem))
}
