//! The model of a gear mesh's teeth from its `[[gear_mesh]]` table: damping, friction, errors; the stiffness of the
//! simple models is in `mesh_stiffness.rs`.

use std::sync::Arc;

use gearmesh_contact::{CondensedFlanks, ContactError, SliceLayout};
use gearmesh_drivetrain::flank_contacts::FlankErrors;
use gearmesh_drivetrain::{
    BeamTeeth, BeamTooth, FlankError, GearMesh, MeshKinematics, PairCurve, PathEnds, ReducedTeeth,
    SlicePressure, TeethModel, ToothPairs,
};
use gearmesh_geometry::point_contact::contact_modulus_pa;
use gearmesh_geometry::{Flank, GearPair, InputError, ToothGeometry};
use gearmesh_model::ReducedGear;
use gearmesh_specification::system::gear_mesh::{PathWord, TouchingFlanks};
use gearmesh_specification::system::mesh_model::{AnalyticTable, HybridTable, MeshKind, MeshModel};

use super::gears::Gear;
use super::scene_mesh::SceneMesh;
use crate::system::iso_stiffness::REFERENCE_LINE_LOAD_N_PER_M;

/// What the teeth of two cylindrical gears are made from.
pub(super) struct Involutes<'a, 'm> {
    pub gears: [&'m Arc<Gear>; 2],
    pub pair: &'a GearPair,
    /// Flanks of all meshes of the scene so far.
    pub condensed: &'a CondensedFlanks<'m>,
    /// Mid-face of gear 2 from that of gear 1 along the axes at the start \[m\].
    pub displacement_m: f64,
    /// The static curve of the pair where the stiffness comes from it.
    pub curve: Option<PairCurve>,
}

/// A mesh of cylindrical gears.
pub(super) type SceneInvolutes<'a, 'm> = SceneMesh<'a, Involutes<'a, 'm>>;

impl<'m> SceneInvolutes<'_, 'm> {
    /// Width of the contact zone at the start \[m\].
    pub(super) fn zone_width_m(&self) -> f64 {
        self.layout(1).reference.width_m
    }

    /// So many slices over the overlap of the faces at the start.
    pub(super) fn layout(&self, slices: usize) -> SliceLayout {
        let widths = self
            .flanks
            .gears
            .map(|gear| gear.definition.tooth.face_width_m);
        SliceLayout::new(widths, self.flanks.displacement_m, slices)
    }

    fn models(&self) -> Result<[&'m ReducedGear; 2], InputError> {
        let gears: [&'m Arc<Gear>; 2] = self.flanks.gears;
        let model = |i: usize| {
            gears[i].model.as_deref().ok_or_else(|| {
                let found = gears[i].file.display();
                let problem = format!("kind = \"hybrid\" needs reduced gears (.h5), found {found}");
                self.keys.error(["gear_1", "gear_2"][i], problem)
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
        for (gear, list) in self.flanks.gears.iter().zip(&mut errors) {
            // A curve of the pair holds it already.
            let in_curve = blind && self.flanks.curve.is_some();
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
        for (key, gear) in ["gear_1", "gear_2"].into_iter().zip(self.flanks.gears) {
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
            let gear = &self.flanks.gears[number].definition;
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
            let resolved =
                SliceLayout::resolved(self.models()?, self.flanks.displacement_m, stated);
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
        let gears = [
            self.flanks.pair.gear_1.clone(),
            self.flanks.pair.gear_2.clone(),
        ];
        let kinematics = MeshKinematics::new(
            gears,
            self.errors()?,
            self.flanks.pair.centre_distance_m,
            layout,
            ends,
        )
        .map_err(self.fault())?;
        self.of_sides(teeth, |side, model| GearMesh::new(kinematics, side, model))
    }

    /// Lets the gears vibrate in their modes. `iso6336` and `analytic` do not feel them.
    pub(super) fn modal(&self, mesh: GearMesh, modes: [usize; 2]) -> Result<GearMesh, InputError> {
        let models = self.flanks.gears.map(|gear| gear.model.as_deref());
        match self.table.model.kind() {
            MeshKind::Kinematic | MeshKind::Iso6336 | MeshKind::Analytic => Ok(mesh),
            MeshKind::Hybrid | MeshKind::NodeToSurface | MeshKind::Impact => {
                self.with_modes(mesh, models, modes)
            }
        }
    }

    fn beams(&self, model: &AnalyticTable, slices: usize) -> Result<BeamTeeth, InputError> {
        for (gear, key) in self.flanks.gears.iter().zip(["gear_1", "gear_2"]) {
            if gear.definition.blank.cut_into_shaft().is_some() {
                let problem = format!(
                    "`{}` is cut into its shaft; model.kind = \"analytic\" takes gears as discs held at a bore: choose \"hybrid\" or give the gear a bore",
                    gear.definition.name
                );
                return Err(self.keys.error(key, problem));
            }
        }
        let tooth = |i: usize| {
            let gear = &self.flanks.gears[i].definition;
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
        let teeth = ReducedTeeth::on_slices(
            self.flanks.pair,
            side,
            models,
            contact,
            nominal,
            self.flanks.condensed,
        );
        teeth.map_err(|error| {
            let hint = match self.teeth.flanks {
                TouchingFlanks::Both => "; both sides of the teeth can touch unless the mesh's teeth say flanks = \"right\" or \"left\"",
                _ => "",
            };
            self.keys.error("", format!("{} flanks: {error}{hint}", side.name()))
        })
    }

    /// How pairs of teeth have columns: the slices of each together, with Hertz' pressure by the gears' own materials.
    pub(super) fn tooth_pairs(&self) -> Result<Option<ToothPairs>, InputError> {
        if self.table.tooth_pairs.is_none() {
            return Ok(None);
        }
        let kind = self.table.model.kind();
        if matches!(kind, MeshKind::Kinematic | MeshKind::Iso6336) {
            let problem = format!(
                "is not used by kind = \"{}\", which knows no single teeth; remove it, or take another model",
                kind.name()
            );
            return Err(self.keys.error("tooth_pairs", problem));
        }
        self.refuse_pair_material()?;
        let definitions = self.flanks.gears.map(|gear| &gear.definition);
        let [first, second] =
            definitions.map(|gear| (gear.material.young_pa, gear.material.poisson));
        Ok(Some(ToothPairs::Slices {
            pressure: SlicePressure::Line(contact_modulus_pa(first, second)),
            face_widths_m: definitions.map(|gear| gear.tooth.face_width_m),
            ends: definitions.map(|gear| ends_of_flank(&gear.profile)),
        }))
    }
}

/// Roll angles between which a flank is \[rad\].
pub(super) fn ends_of_flank(gear: &ToothGeometry) -> [f64; 2] {
    [gear.form_roll_rad, gear.flank_end_roll_rad]
}
