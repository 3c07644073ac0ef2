//! The gears that bodies name: teeth, body and, for models, static patterns; of bevel gears the model, whose teeth are
//! those of their meshes.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use gearmesh_bevel::BevelGear;
use gearmesh_drivetrain::{DrivetrainError, GearInertia, gear_body};
use gearmesh_dynamics::Body;
use gearmesh_geometry::gear_file::MicrogeometryTable;
use gearmesh_geometry::input::{InputDocument, TableKeys};
use gearmesh_geometry::{GearDefinition, InputError, Material};
use gearmesh_model::{RadialMotions, ReducedGear};
use gearmesh_specification::system::body::{BoreHold, Flexibility};
use gearmesh_specification::system::gear_mesh::GearMeshTable;
use gearmesh_specification::system::mesh_model::MeshKind;
use nalgebra::{Matrix3, Vector3};

use super::cut_into_shaft::OnFaces;
use crate::microgeometry_words::microgeometry_words;
use crate::model_shelf::ModelShelf;
use crate::system::scene::SystemScene;

/// A gear from a gear file or a model.
#[derive(Debug)]
pub(super) struct Gear {
    pub file: PathBuf,
    pub definition: GearDefinition,
    pub model: Option<Arc<ReducedGear>>,
    /// Whether the scene states the microgeometry of the definition, not the gear's file.
    pub microgeometry_of_scene: bool,
    /// The faces of a gear that is cut into a beam shaft, where they are joined one by one; the model is then that of
    /// [`OnFaces::gear`].
    pub on_faces: Option<OnFaces>,
    /// Radial motions of a bore that rollers press on; the model is then that of one that slides.
    pub bore_motions: Option<Arc<RadialMotions>>,
    /// The model with all motions of its bore, where that is not held; `model` states what the flanks feel of it.
    pub bore: Option<Arc<ReducedGear>>,
}

/// A reduced bevel gear.
#[derive(Debug)]
pub(super) struct ReducedBevel {
    pub file: PathBuf,
    pub model: Arc<ReducedGear>,
}

/// What a body names as its gear.
#[derive(Debug, Clone)]
pub(super) enum BodyGear {
    Cylindrical(Arc<Gear>),
    Bevel(Arc<ReducedBevel>),
}

impl BodyGear {
    /// A gear on parallel axes.
    pub(super) fn cylindrical(&self) -> Option<&Arc<Gear>> {
        match self {
            Self::Cylindrical(gear) => Some(gear),
            Self::Bevel(_) => None,
        }
    }

    /// The reduced gear, where it is one.
    pub(super) fn model(&self) -> Option<&Arc<ReducedGear>> {
        match self {
            Self::Cylindrical(gear) => gear.model.as_ref(),
            Self::Bevel(gear) => Some(&gear.model),
        }
    }

    pub(super) fn file(&self) -> &Path {
        match self {
            Self::Cylindrical(gear) => &gear.file,
            Self::Bevel(gear) => &gear.file,
        }
    }

    pub(super) fn material(&self) -> Material {
        match self {
            Self::Cylindrical(gear) => gear.definition.material,
            Self::Bevel(gear) => Material {
                young_pa: gear.model.young_pa,
                poisson: gear.model.poisson,
                density_kg_per_m3: None,
            },
        }
    }

    /// Mass and inertia: of the model's mesh, or in closed form.
    pub(super) fn body(&self, keys: &TableKeys<'_>) -> Result<Body, InputError> {
        match self {
            Self::Cylindrical(gear) => gear.body(keys),
            Self::Bevel(gear) => gear_body(&gear.model).map_err(|error| instead(keys, &error)),
        }
    }

    /// Numbers of its gear file that look like those of another unit; those of a model were reported when it was
    /// reduced.
    pub(super) fn unit_slips(&self) -> Vec<InputError> {
        self.cylindrical()
            .map_or_else(Vec::new, |gear| gear.unit_slips())
    }

    /// Where it comes from, in words.
    pub(super) fn source(&self) -> String {
        match self {
            Self::Cylindrical(gear) => gear.source(),
            Self::Bevel(gear) => {
                let (file, model) = (gear.file.display(), &gear.model);
                format!("bevel model {file}, z {}", model.teeth)
            }
        }
    }
}

/// A fault of the gear's body, with what may be stated in its place.
fn instead(keys: &TableKeys<'_>, error: &DrivetrainError) -> InputError {
    let problem =
        format!("{error} (mass_kg and inertia_kg_m2 of this table take the place of the gear's)");
    keys.error("gear", problem)
}

/// Gears by file, so that each is read once.
#[derive(Debug, Default)]
pub(super) struct GearFiles {
    read: BTreeMap<PathBuf, BodyGear>,
    /// Models with bores that slide, and the bores' radial motions.
    sliding: BTreeMap<PathBuf, (Arc<ReducedGear>, Arc<RadialMotions>)>,
}

impl GearFiles {
    /// The gear of a file.
    pub(super) fn get(
        &mut self,
        path: &Path,
        keys: &TableKeys<'_>,
        models: &ModelShelf,
    ) -> Result<BodyGear, InputError> {
        if let Some(gear) = self.read.get(path) {
            return Ok(gear.clone());
        }
        let gear = BodyGear::read(path, keys, models)?;
        self.read.insert(path.to_path_buf(), gear.clone());
        Ok(gear)
    }

    /// The gear of a body with the bore that the body states.
    ///
    /// # Errors
    /// [`InputError`] at the key, where nothing would feel it, or where the model has no motions of its bore.
    pub(super) fn with_own_bore(
        &mut self,
        gear: Option<BodyGear>,
        scene: &SystemScene,
        body: usize,
    ) -> Result<Option<BodyGear>, InputError> {
        let table = &scene.tables.body[body];
        let Some(bore) = table.bore else {
            return Ok(gear);
        };
        let keys = TableKeys::new(&scene.document, format!("body.{body}"));
        let is_hybrid = |mesh: &&GearMeshTable| {
            let own = mesh.gear_1 == table.name || mesh.gear_2 == table.name;
            own && mesh.model.kind() == MeshKind::Hybrid
        };
        let cylindrical = gear.as_ref().and_then(BodyGear::cylindrical);
        let reduced = cylindrical.and_then(|gear| Some((gear, gear.model.as_ref()?)));
        let problem = match reduced {
            None => "is not used: it is of cylindrical reduced gears (.h5); remove it",
            Some(_) if !scene.tables.gear_mesh.iter().any(|mesh| is_hybrid(&mesh)) => {
                "is not used: the body is in no hybrid mesh; remove it"
            }
            Some(_) if table.flexibility == Some(Flexibility::Modal) => {
                "is not used with flexibility = \"modal\", whose modes are those of a held bore; remove one of the two"
            }
            Some(_) if bore == BoreHold::Bonded => return Ok(gear),
            Some((gear, model)) => {
                let (released, motions) = match self.sliding.get(&gear.file) {
                    Some(known) => known.clone(),
                    None => {
                        let made = model.with_sliding_bore();
                        let made = made.map_err(|e| keys.error("bore", e))?;
                        let both = (Arc::new(made.gear), Arc::new(made.radial));
                        self.sliding.insert(gear.file.clone(), both.clone());
                        both
                    }
                };
                return Ok(Some(BodyGear::Cylindrical(Arc::new(Gear {
                    bore_motions: (bore == BoreHold::Rollers).then_some(motions),
                    bore: Some(Arc::clone(model)),
                    ..gear.with_model(released)
                }))));
            }
        };
        Err(keys.error("bore", problem))
    }
}

impl BodyGear {
    fn read(path: &Path, keys: &TableKeys<'_>, models: &ModelShelf) -> Result<Self, InputError> {
        let shown = path.display();
        let gear = match path.extension().and_then(|e| e.to_str()) {
            Some("toml") => {
                if !path.exists() {
                    return Err(keys.error("gear", format!("the gear file {shown} does not exist")));
                }
                let document = InputDocument::read(path)?;
                if BevelGear::recognises(&document)? {
                    let problem = format!(
                        "{shown} is the file of a bevel gear, which a body takes reduced only; make a model of it with `gearmesh reduce {shown} -o GEAR.h5`"
                    );
                    return Err(keys.error("gear", problem));
                }
                Gear::new(path, GearDefinition::read(path)?, None)
            }
            ending if ending == Some("h5") || models.knows(path) && !path.exists() => {
                if !models.knows(path) {
                    let problem = format!(
                        "the model {shown} does not exist; make it with `gearmesh reduce GEAR.toml -o {shown}`"
                    );
                    return Err(keys.error("gear", problem));
                }
                let shelved = models.model(path).map_err(|e| keys.error("gear", e))?;
                let model = shelved.model;
                if model.bevel.is_some() {
                    let file = path.to_path_buf();
                    return Ok(Self::Bevel(Arc::new(ReducedBevel { file, model })));
                }
                let definition = model.input.definition_in(shown)?.clone();
                Gear::new(path, definition, Some(model))
            }
            _ => {
                let problem = format!(
                    "found {shown}, allowed is a gear file (.toml) or a reduced gear (.h5)"
                );
                return Err(keys.error("gear", problem));
            }
        };
        Ok(Self::Cylindrical(Arc::new(gear)))
    }
}

impl Gear {
    /// The gear of a file, as the file has it.
    fn new(file: &Path, definition: GearDefinition, model: Option<Arc<ReducedGear>>) -> Self {
        Self {
            file: file.to_path_buf(),
            definition,
            model,
            microgeometry_of_scene: false,
            on_faces: None,
            bore_motions: None,
            bore: None,
        }
    }

    /// The same gear with another model.
    pub(super) fn with_model(&self, model: Arc<ReducedGear>) -> Self {
        Self {
            microgeometry_of_scene: self.microgeometry_of_scene,
            ..Self::new(&self.file, self.definition.clone(), Some(model))
        }
    }

    /// Mass and inertia: of the model's mesh, or in closed form.
    pub(super) fn body(&self, keys: &TableKeys<'_>) -> Result<Body, InputError> {
        let hint = |error: DrivetrainError| instead(keys, &error);
        if let Some(model) = &self.model {
            return gear_body(model).map_err(hint);
        }
        let gear = &self.definition;
        let Some(density) = gear.material.density_kg_per_m3 else {
            let problem = format!(
                "{} has no density, hence no mass: give material.density_kg_per_m3 there, or mass_kg and inertia_kg_m2 here",
                self.file.display()
            );
            return Err(keys.error("gear", problem));
        };
        let found = GearInertia::new(&gear.profile, &gear.blank, gear.tooth.face_width_m, density)
            .map_err(hint)?;
        let [x, y] = found.centre_xy_m;
        let centre = Vector3::new(x, y, found.centre_z_m);
        let about_origin = Vector3::new(found.across_kg_m2, found.across_kg_m2, found.polar_kg_m2);
        let steiner = found.mass_kg
            * (centre.norm_squared() * Matrix3::identity() - centre * centre.transpose());
        Ok(Body {
            center_of_mass_m: centre,
            inertia_kg_m2: Matrix3::from_diagonal(&about_origin) - steiner,
            ..Body::rigid(&gear.name, found.mass_kg, [1.0; 3])
        })
    }

    /// The gear with the microgeometry that a body's table states; `at`: the table's document, path and folder.
    pub(super) fn with_microgeometry(
        &self,
        table: &MicrogeometryTable,
        (document, path, folder): (&InputDocument, &str, &Path),
    ) -> Result<Self, InputError> {
        let mut definition = self.definition.clone();
        let teeth = (&definition.profile, definition.tooth.face_width_m);
        definition.microgeometry = table.check((document, path), teeth, Some(folder))?;
        Ok(Self {
            microgeometry_of_scene: true,
            ..Self::new(&self.file, definition, self.model.clone())
        })
    }

    /// Whether any flank has microgeometry.
    pub(super) fn has_microgeometry(&self) -> bool {
        !self.definition.microgeometry.is_none()
    }

    /// Its microgeometry in words, and where it is stated.
    pub(super) fn microgeometry_in_words(&self) -> String {
        microgeometry_words(&self.definition, self.microgeometry_of_scene)
    }

    /// Numbers of its gear file that look like those of another unit; those of a model were reported when it was
    /// reduced.
    pub(super) fn unit_slips(&self) -> Vec<InputError> {
        if self.model.is_some() {
            return Vec::new();
        }
        let file = self.file.display().to_string();
        InputDocument::new(file, self.definition.source.clone()).unit_slips()
    }

    /// Where it comes from, in words.
    pub(super) fn source(&self) -> String {
        let kind = match self.model {
            Some(_) => "model",
            None => "gear file",
        };
        let faces = match &self.on_faces {
            Some(_) => ", cut into its shaft at both faces",
            None => "",
        };
        format!(
            "{kind} {}, z {}{faces}",
            self.file.display(),
            self.definition.profile.teeth
        )
    }
}

/// The gear of a body, with the microgeometry that the body states where it does.
///
/// # Errors
/// [`InputError`] at the key, in a file, and where nothing would feel it.
pub(super) fn with_own_microgeometry(
    gear: Option<BodyGear>,
    scene: &SystemScene,
    body: usize,
) -> Result<Option<BodyGear>, InputError> {
    let Some(table) = &scene.tables.body[body].microgeometry else {
        return Ok(gear);
    };
    let path = format!("body.{body}.microgeometry");
    let name = &scene.tables.body[body].name;
    let own =
        (scene.tables.gear_mesh.iter()).filter(|mesh| mesh.gear_1 == *name || mesh.gear_2 == *name);
    let problem = match gear {
        None => "is not used by a body without gear; remove it, or name its `gear`",
        Some(BodyGear::Bevel(_)) => {
            "is not used by a bevel gear, whose flanks are those of its pair file; remove it"
        }
        Some(_) if own.clone().count() == 0 => {
            "is not used: the body is in no gear_mesh; remove it"
        }
        Some(BodyGear::Cylindrical(gear))
            if own.clone().any(|mesh| mesh.microgeometry.unwrap_or(true)) =>
        {
            let at = (&scene.document, &path[..], scene.folder.as_path());
            let own = Arc::new(gear.with_microgeometry(table, at)?);
            return Ok(Some(BodyGear::Cylindrical(own)));
        }
        Some(_) => {
            "is not used: microgeometry = false in all gear meshes of the body; remove one of the two"
        }
    };
    Err(scene.document.error(&path, problem))
}
