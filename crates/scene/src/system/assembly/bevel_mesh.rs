//! `[[gear_mesh]]` with `bevel_pair`: flanks from a pair file between two bodies whose axes meet.

use gearmesh_geometry::given;
use gearmesh_specification::gear_tables::{MM, UM};
use gearmesh_specification::system::gear_mesh::{BevelSurfaceTable, PathWord, TouchingFlanks};
use gearmesh_specification::system::mesh_model::{HertzTable, ImpactTable, MeshModel};
use std::path::Path;

use gearmesh_bevel::PairFile;
use gearmesh_drivetrain::{
    BevelMesh, BevelSlices, DrivetrainError, FacetKind, FacetSize, FlankKinematics, GearMesh,
    PowerStiffness, SlicePressure, ToothPairs,
};
use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::point_contact::contact_modulus_pa;
use gearmesh_geometry::{Flank, InputError};

use super::bevel_hybrid::BevelModels;
use super::bodies::Bodies;
use super::gear_mesh::PreparedMesh;
use super::mesh_stiffness::{impact_law, stated_impact};
use super::parts::Parts;
use super::scene_mesh::SceneMesh;

/// A mesh of bevel gears, with the file of their pair.
pub(super) type SceneBevel<'a> = SceneMesh<'a, &'a Path>;

impl SceneBevel<'_> {
    /// The mesh of two bodies.
    pub(super) fn prepare(
        &self,
        mut prepared: PreparedMesh,
        bodies: &Bodies,
        parts: &mut Parts,
    ) -> Result<PreparedMesh, InputError> {
        let numbers = prepared.bodies;
        self.refuse_unused(bodies, numbers)?;
        prepared.models = self.models(bodies, numbers)?;
        let models = prepared.models.as_ref();
        let document = InputDocument::read(self.flanks)?;
        let file = PairFile::from_document(&document)?;
        let (design, _) = (file.checked_design(&document))
            .map_err(|error| self.keys.error("bevel_pair", error))?;
        let at_start = prepared.pose(bodies);
        let misplaced = |error| self.keys.error("gear_2", error);
        let fault = |error: DrivetrainError| match error {
            DrivetrainError::Bevel(error) => {
                self.keys.error("bevel_pair", error.in_file(&document))
            }
            error => self.keys.error("bevel_pair", error),
        };
        let smooth = || BevelMesh::new(&file.blank, &design).map_err(fault);
        let (modes, sides) = (
            numbers.map(|number| bodies.list[number].modes),
            &prepared.sides,
        );
        prepared.tooth_pairs = self.tooth_pairs(models, file.blank.data.face_width_m)?;
        let (levers_m, corners, mesh) = match &self.table.model {
            MeshModel::Hybrid(model) => {
                let slices = self.slices(model, models)?;
                let made = BevelSlices::new(&file.blank, &design, slices);
                let mut flanks = made.map_err(|e| match e {
                    DrivetrainError::Value { .. } => self.model_keys.error("slices", e),
                    _ => fault(e),
                })?;
                flanks.locate(&at_start).map_err(misplaced)?;
                prepared.slice_width_m = flanks.layout().width_m();
                let (levers_m, corners) =
                    (flanks.pair().levers_m(), flanks.pair().flank_corners_m());
                let mesh = self.hybrid(flanks, (model, models, modes), sides)?;
                (levers_m, corners, mesh)
            }
            MeshModel::NodeToSurface(model) => {
                let mut flanks = smooth()?;
                flanks.locate(&at_start).map_err(misplaced)?;
                self.check_models(&flanks, bodies, numbers)?;
                let (levers_m, corners) = (flanks.levers_m(), flanks.flank_corners_m());
                let made = self.node_surfaces(flanks, (model, models, modes), sides)?;
                prepared.slice_width_m = made.slice_width_m;
                prepared.tooth_pairs = made.tooth_pairs;
                (levers_m, corners, made.mesh)
            }
            MeshModel::Impact(model) => {
                let mut flanks = smooth()?;
                if let Some(surface) = self.table.bevel_surface {
                    let divided = flanks.with_facets(facets(surface));
                    flanks = divided.map_err(|e| self.keys.error("bevel_surface", e))?;
                }
                flanks.locate(&at_start).map_err(misplaced)?;
                self.check_models(&flanks, bodies, numbers)?;
                prepared.slice_width_m = flanks.layout().width_m();
                let (levers_m, corners) = (flanks.levers_m(), flanks.flank_corners_m());
                (levers_m, corners, self.mesh(flanks, model, sides)?)
            }
            _ => return Err(self.other_model()),
        };
        let backlash_m = design.backlash_m(&file.blank);
        self.effects((&file, backlash_m, models.is_some()), parts);
        prepared.built.teeth = file.blank.data.teeth;
        prepared.built.base_radii_m = levers_m;
        prepared.built.flank_corners_m = corners.into_iter().flatten().flatten().collect();
        prepared.mesh = Some(mesh);
        Ok(prepared)
    }

    /// Whether the reduced gears of the bodies are those of the pair.
    fn check_models(
        &self,
        flanks: &BevelMesh,
        bodies: &Bodies,
        numbers: [usize; 2],
    ) -> Result<(), InputError> {
        for (gear, number) in numbers.into_iter().enumerate() {
            if let Some(model) = bodies.list[number].bevel() {
                let fits = flanks.check_model(gear, model);
                let key = ["gear_1", "gear_2"][gear];
                fits.map_err(|e| self.keys.error(key, e))?;
            }
        }
        Ok(())
    }

    /// A model that knows no bevel flanks.
    fn other_model(&self) -> InputError {
        let problem = format!(
            "found \"{}\", allowed for a bevel pair are \"impact\", \"node-to-surface\" and \"hybrid\"; the other kinds are for cylindrical gears",
            self.table.model.kind().name()
        );
        self.model_keys.error("kind", problem)
    }

    /// What of the table bevel flanks do not use.
    fn refuse_unused(&self, bodies: &Bodies, numbers: [usize; 2]) -> Result<(), InputError> {
        const UNUSED: &str = "is not used by a bevel pair; remove it";
        let surface = given!(self.table; bevel_surface);
        let models = given!(self.table; bevel_models);
        match &self.table.model {
            MeshModel::Impact(model) => {
                (self.model_keys).refuse(&given!(model; stiffness, slices), UNUSED)?;
                let problem = "is not used by kind = \"impact\"; remove it, or take \"hybrid\"";
                self.keys.refuse(&models, problem)?;
            }
            MeshModel::NodeToSurface(_) => {
                let problem =
                    "belongs to kind = \"impact\"; patches are stated in the model, remove it";
                self.keys.refuse(&surface, problem)?;
                let problem = "is not used by kind = \"node-to-surface\"; name the models as `gear` of bodies with flexibility = \"modal\", or remove it";
                self.keys.refuse(&models, problem)?;
            }
            MeshModel::Hybrid(model) => {
                let problem = "belongs to kind = \"impact\"; slices cut smooth flanks, remove it";
                self.keys.refuse(&surface, problem)?;
                let of_bodies = numbers.iter().any(|i| bodies.list[*i].bevel().is_some());
                self.check_hybrid(model, of_bodies)?;
            }
            _ => return Err(self.other_model()),
        }
        let microgeometry = given!(self.table; microgeometry);
        self.keys.refuse(&microgeometry, UNUSED)?;
        let errors = [
            ("errors_1", !self.teeth.errors_1.is_empty()),
            ("errors_2", !self.teeth.errors_2.is_empty()),
        ];
        self.teeth_keys.refuse(&errors, UNUSED)?;
        if self.teeth.path == PathWord::LineOfAction {
            let problem =
                "found \"line-of-action\"; the edges of bevel teeth always touch, remove it";
            return Err(self.teeth_keys.error("path", problem));
        }
        for (key, number) in ["gear_1", "gear_2"].into_iter().zip(numbers) {
            let body = &bodies.list[number];
            if body.cylindrical().is_some() {
                let problem = format!(
                    "body `{}` is a cylindrical gear; the teeth of this mesh come from bevel_pair: name the reduced bevel gear as `gear` of its [[body]], \
                     or remove `gear` and state mass_kg and inertia_kg_m2",
                    body.body.name
                );
                return Err(self.keys.error(key, problem));
            }
        }
        Ok(())
    }

    fn mesh(
        &self,
        mut kinematics: BevelMesh,
        model: &ImpactTable,
        sides: &[Flank],
    ) -> Result<GearMesh, InputError> {
        let law = |stiffness| impact_law(model, &self.model_keys, stiffness, 1);
        let laws = match self.hertz(model)? {
            Some(modulus_pa) => {
                kinematics = kinematics.with_hertz();
                Flank::ALL.map(|side| {
                    let k = kinematics.hertz_stiffness(side, modulus_pa);
                    law(PowerStiffness::n_per_m_e(k, 1.5))
                })
            }
            None => {
                let (k, e) = stated_impact(model, &self.model_keys)?;
                Flank::ALL.map(|_| law(PowerStiffness::n_per_mm_e(k, e)))
            }
        };
        let [right, left] = laws;
        let laws = [right?, left?];
        let teeth = sides.iter().map(|side| (*side, laws[*side as usize]));
        let flanks = Box::new(kinematics);
        self.of_sides(teeth, |side, law| GearMesh::of_flanks(flanks, side, law))
    }

    /// How pairs of teeth have columns: one contact each, or their slices together.
    fn tooth_pairs(
        &self,
        models: Option<&BevelModels>,
        face_widths_m: [f64; 2],
    ) -> Result<Option<ToothPairs>, InputError> {
        let Some(table) = &self.table.tooth_pairs else {
            return Ok(None);
        };
        let MeshModel::Hybrid(model) = &self.table.model else {
            let contact_modulus_pa = contact_modulus(table);
            return Ok(Some(ToothPairs::Points { contact_modulus_pa }));
        };
        self.refuse_pair_material()?;
        let materials = match models {
            Some(models) => [0, 1].map(|gear: usize| (models[gear].young_pa, models[gear].poisson)),
            None => [material(model.half_space.as_ref()); 2],
        };
        Ok(Some(ToothPairs::Slices {
            pressure: SlicePressure::Line(contact_modulus_pa(materials[0], materials[1])),
            face_widths_m,
            // Bevel flanks count their height in shares.
            ends: [[0.0, 1.0]; 2],
        }))
    }

    /// E* of both gears \[Pa\] where the law follows Hertz.
    fn hertz(&self, model: &ImpactTable) -> Result<Option<f64>, InputError> {
        let Some(table) = &model.hertz else {
            return Ok(None);
        };
        self.model_keys.refuse(
            &given!(model; stiffness_N_per_mm_e, exponent),
            "is not used with `hertz`, which gives K and e = 1.5 from the curvatures; remove one of the two",
        )?;
        Ok(Some(contact_modulus(table)))
    }

    /// What is computed, in words for the plan.
    fn effects(&self, (file, backlash_m, reduced): (&PairFile, f64, bool), parts: &mut Parts) {
        let name = |what: &str| format!("mesh `{}`: {what}", self.table.name);
        let both = self.teeth.flanks == TouchingFlanks::Both;
        let backlash = format!(
            "both sides, {:.1} um of normal backlash at the mean point",
            backlash_m / UM
        );
        parts.effect(name("backlash"), both.then_some(backlash));
        match &self.table.model {
            MeshModel::Impact(model) => {
                if model.hertz.is_some() {
                    let law = "F = K d^1.5, K from the curvatures at each contact";
                    parts.effect(name("hertz"), Some(law.to_string()));
                }
                if let Some(surface) = self.table.bevel_surface {
                    parts.effect(name("flanks of the pinion"), Some(words(surface)));
                }
            }
            MeshModel::NodeToSurface(model) => {
                let what = format!(
                    "nodes of the pinion against patches of the gear, edges up to {:.0} um along the face and {:.0} um up the flank",
                    *model.along_um, *model.up_um
                );
                parts.effect(name("flanks"), Some(what));
            }
            _ => {
                let what = match reduced {
                    true => "reduced gears in slices along the teeth",
                    false => "rigid gears, surfaces in slices along the teeth",
                };
                parts.effect(name("teeth"), Some(what.to_string()));
            }
        }
        parts.effect(name("damping"), self.table.model.damping_in_words());
        let friction = self.teeth.friction.as_ref();
        let rubs = "`coulomb`, regularised, along the sliding in the tangent plane";
        parts.effect(name("friction"), friction.map(|_| rubs.to_string()));
        let [pinion, gear] = &file.blank.members;
        parts.notes.push(format!(
            "mesh `{}`: bevel pair {}, {}/{} teeth, mean cone distance {:.4} mm",
            self.table.name,
            self.flanks.display(),
            pinion.teeth,
            gear.teeth,
            file.blank.mean_cone_m / MM
        ));
    }
}

fn facets(surface: BevelSurfaceTable) -> FacetSize {
    let (kind, along_um, up_um) = match surface {
        BevelSurfaceTable::Triangles { along_um, up_um } => (FacetKind::Triangles, along_um, up_um),
        BevelSurfaceTable::Quadrilaterals { along_um, up_um } => {
            (FacetKind::Quadrilaterals, along_um, up_um)
        }
    };
    FacetSize {
        kind,
        along_m: UM * along_um,
        up_m: UM * up_um,
    }
}

fn words(surface: BevelSurfaceTable) -> String {
    let size = facets(surface);
    let kind = match size.kind {
        FacetKind::Triangles => "triangles",
        FacetKind::Quadrilaterals => "quadrilaterals",
    };
    let [along, up] = [size.along_m, size.up_m].map(|edge| edge / UM);
    format!("{kind}, edges up to {along:.0} um along the face and {up:.0} um up the flank")
}

/// E* of both gears of a material \[Pa\].
fn contact_modulus(table: &HertzTable) -> f64 {
    let both = material(Some(table));
    contact_modulus_pa(both, both)
}

/// Young's modulus \[Pa\] and Poisson's ratio of a table, steel where it says nothing.
pub(super) fn material(table: Option<&HertzTable>) -> (f64, f64) {
    let young = table.and_then(|table| table.young_GPa);
    let poisson = table.and_then(|table| table.poisson);
    (
        1e9 * young.map_or(206.0, f64::from),
        poisson.map_or(0.3, f64::from),
    )
}
