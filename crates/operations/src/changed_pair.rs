//! A gear pair whose scene is changed again and again: models are read once, flanks condensed once for each number of
//! slices, and a changed body is reduced once for each of its states.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use gearmesh_geometry::GearDefinition;
use gearmesh_geometry::input::InputDocument;
use gearmesh_model::ReducedGear;
use gearmesh_scene::ModelShelf;
use gearmesh_scene::pair::{PairWatch, run_watched};
use gearmesh_scene::study::{BaseScene, MadeFile, MadeFiles, Subject, VaryError};
use gearmesh_scene::{LoadedScene, Scene, SceneResult, load_from, named_files, renamed_files};
use gearmesh_specification::study::{Case, Setting};

use crate::failure::{Failure, Result};
use crate::gear_file::{AnyGear, GearFile};
use crate::reduce::{Reduction, reduce_to};
use crate::scratch::Scratch;
use crate::watch::Watch;

/// States of bodies whose gears are remembered.
const MOST_BODIES: usize = 32;

/// Keys of a scene that name the gears.
pub const GEARS: [&str; 2] = ["pair.gear_1", "pair.gear_2"];

/// A pair scene and its models, in memory.
#[derive(Debug)]
pub struct ChangedPair {
    base: BaseScene,
    /// As the file has it, files by their absolute names: what is saved works from any folder.
    names: BTreeMap<String, String>,
    shelf: ModelShelf,
    /// Where changed bodies are kept. It goes with the pair.
    scratch: Scratch,
    /// Changed bodies by their settings: reading the gear inside a model takes longer than solving a pair.
    bodies: Mutex<BTreeMap<String, Bodies>>,
}

/// Models in the place of those that the scene names, by its keys, and the gears of those that have to be made.
#[derive(Debug, Clone, Default)]
struct Bodies {
    models: Vec<(String, String)>,
    gears: Vec<(PathBuf, GearDefinition)>,
}

impl ChangedPair {
    /// Reads a pair scene.
    ///
    /// # Errors
    /// [`Failure`] for a scene that is wrong.
    pub fn read(path: &Path) -> Result<Self> {
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::new(InputDocument::read(path)?, folder)
    }

    /// The scene of a result; its models stand where the result says.
    ///
    /// # Errors
    /// As [`ChangedPair::read`].
    pub fn of_result(shown: &Path, result: &SceneResult) -> Result<Self> {
        let scene = InputDocument::new(
            shown.display().to_string(),
            result.source.scene_toml.clone(),
        );
        let table = scene.table()?;
        let models = result.source.model_files.clone();
        let names = ["gear_1", "gear_2"].into_iter().zip(models);
        let names = names.filter_map(|(gear, model)| {
            let named = table.get("pair")?.get(gear)?.as_str()?;
            Some((named.to_owned(), model))
        });
        let text = renamed_files(&scene.text, &names.collect()).map_err(Failure::input)?;
        Self::new(InputDocument::new(scene.file, text), Path::new(""))
    }

    fn new(document: InputDocument, folder: &Path) -> Result<Self> {
        let named = named_files(&document.text, folder).into_iter();
        let names = named.map(|(name, path)| {
            let path = std::path::absolute(&path).unwrap_or(path);
            (name, path.display().to_string())
        });
        // A key of each gear begins its whole microgeometry.
        let begun = [
            "gear_1.microgeometry.tip_relief_um",
            "gear_2.microgeometry.tip_relief_um",
        ];
        Ok(Self {
            names: names.collect(),
            base: BaseScene::from_document(document, folder, begun.into_iter(), None)?,
            shelf: ModelShelf::default(),
            scratch: Scratch::new()?,
            bodies: Mutex::default(),
        })
    }

    /// The scene as the file has it.
    #[must_use]
    pub fn base(&self) -> &BaseScene {
        &self.base
    }

    /// The changed scene with its models.
    ///
    /// # Errors
    /// [`Failure`] for what the scene refuses, and for bodies that are not reduced yet.
    pub fn loaded(&self, case: &Case) -> Result<LoadedScene> {
        Ok(load_from(self.scene(case)?, &self.shelf)?)
    }

    /// Solves a changed scene.
    ///
    /// # Errors
    /// [`Failure`] where a position has no solution, and once `watch` stops it.
    pub fn solve(loaded: &LoadedScene, watch: &PairWatch) -> Result<SceneResult> {
        Ok(run_watched(loaded, &|_, _| (), watch)?)
    }

    /// Names of the gears whose changed bodies are not reduced yet.
    ///
    /// # Errors
    /// [`Failure`] for a body that its file refuses.
    pub fn unreduced(&self, case: &Case) -> Result<Vec<String>> {
        let bodies = self.bodies(case)?;
        let missing = bodies.gears.iter().filter(|(path, _)| !path.exists());
        Ok(missing.map(|(_, gear)| gear.name.clone()).collect())
    }

    /// The gears of a case, reduced or not.
    ///
    /// # Errors
    /// As [`ChangedPair::unreduced`].
    pub fn gears(&self, case: &Case) -> Result<[GearDefinition; 2]> {
        let bodies = self.bodies(case)?;
        let scene = self.scene(case)?;
        let gear = |path: &Path| -> Result<GearDefinition> {
            match bodies.gears.iter().find(|(made, _)| made == path) {
                Some((_, gear)) => Ok(gear.clone()),
                None => Ok(definition(&*self.model(path)?, path)?.clone()),
            }
        };
        let [gear_1, gear_2] = &scene.gears;
        Ok([gear(&gear_1.model)?, gear(&gear_2.model)?])
    }

    fn model(&self, path: &Path) -> Result<Arc<ReducedGear>> {
        let found = self.shelf.model(path);
        Ok(found.map_err(|error| Failure::of_input(&error))?.model)
    }

    /// Reduces the changed bodies of a case that are not reduced yet, without an estimate of their errors: that takes
    /// as long once more.
    ///
    /// # Errors
    /// [`Failure`] for a body that cannot be meshed or held, where memory is short, and once `watch` stops it.
    pub fn reduce(&self, case: &Case, watch: &Watch<'_>) -> Result<()> {
        for (path, gear) in self.bodies(case)?.gears {
            if path.exists() {
                continue;
            }
            let folder = path.parent().unwrap_or(Path::new(""));
            std::fs::create_dir_all(folder)
                .map_err(|cause| Failure::work(format!("{}: {cause}", folder.display())))?;
            let of = GearFile {
                file: gear.name.clone(),
                gear: AnyGear::Cylindrical(Box::new(gear)),
            };
            let how = Reduction {
                estimate_error: false,
                even_if_memory_is_short: false,
            };
            reduce_to(&of, how, &path, watch)?;
        }
        Ok(())
    }

    /// The changed scene as a file. Bodies that were changed are kept as models in `models` beside it.
    ///
    /// # Errors
    /// [`Failure`] for what the scene refuses, and for models that cannot be copied.
    pub fn toml(&self, case: &Case, models: &Path) -> Result<String> {
        let mut names = self.names.clone();
        for (path, _) in self.bodies(case)?.gears {
            let kept = models.join(path.file_name().unwrap_or_default());
            let failed = |cause| Failure::work(format!("{}: {cause}", kept.display()));
            std::fs::create_dir_all(models).map_err(failed)?;
            // Its name is the digest of its gear: what is there is the same.
            if !kept.exists() {
                std::fs::copy(&path, &kept).map_err(failed)?;
            }
            names.insert(path.display().to_string(), kept.display().to_string());
        }
        renamed_files(&self.scene(case)?.document.text, &names).map_err(Failure::work)
    }

    /// The changed scene as a file, its models where they are now: they go with the pair.
    ///
    /// # Errors
    /// [`Failure`] for what the scene refuses.
    pub fn text(&self, case: &Case) -> Result<String> {
        renamed_files(&self.scene(case)?.document.text, &self.names).map_err(Failure::work)
    }

    fn scene(&self, case: &Case) -> Result<Scene> {
        let [_, mut of_scene] = parted(case);
        for (key, model) in self.bodies(case)?.models {
            of_scene.settings.push(Setting::of(&key, model));
        }
        Ok(*self.varied(&of_scene, &mut MadeFiles::new())?)
    }

    /// The changed bodies of a case.
    fn bodies(&self, case: &Case) -> Result<Bodies> {
        let [of_bodies, _] = parted(case);
        if of_bodies.settings.is_empty() {
            return Ok(Bodies::default());
        }
        let name = of_bodies.name();
        let known = || self.bodies.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(found) = known().get(&name) {
            return Ok(found.clone());
        }
        let mut files = MadeFiles::new();
        let scene = self.varied(&of_bodies, &mut files)?;
        let models = GEARS
            .iter()
            .zip(scene.gears.each_ref().map(|gear| &gear.model));
        let models = models.filter(|(_, path)| files.contains_key(*path));
        let models = models.map(|(key, path)| ((*key).to_owned(), path.display().to_string()));
        let models = models.collect();
        let gears = files.into_iter().filter_map(|(path, made)| match made {
            MadeFile::Model(gear) => Some((path, *gear)),
            MadeFile::Text(_) => None,
        });
        let found = Bodies {
            models,
            gears: gears.collect(),
        };
        let mut known = known();
        if known.len() >= MOST_BODIES {
            known.clear();
        }
        known.insert(name, found.clone());
        Ok(found)
    }

    fn varied(&self, case: &Case, files: &mut MadeFiles) -> Result<Box<Scene>> {
        let subject = self.base.scene(case, files, self.scratch.path());
        let subject = subject.map_err(|error| match error {
            VaryError::Key { problem, .. } => Failure::input(problem),
            VaryError::Scene(error) => error.into(),
        })?;
        match subject {
            Subject::Pair(scene) => Ok(scene),
            _ => Err(Failure::work("the changed scene is no pair any more")),
        }
    }
}

/// The settings of bodies, and those of the scene.
fn parted(case: &Case) -> [Case; 2] {
    let is_of_body = |setting: &&Setting| setting.keys.iter().any(|key| key.contains(':'));
    let (of_bodies, of_scene) = case.settings.iter().partition::<Vec<_>, _>(is_of_body);
    let owned = |settings: Vec<&Setting>| settings.into_iter().cloned().collect();
    let mut of_scene = Case::of(owned(of_scene));
    of_scene.removed.clone_from(&case.removed);
    [Case::of(owned(of_bodies)), of_scene]
}

/// The gear that a model was made of.
fn definition<'a>(model: &'a ReducedGear, path: &Path) -> Result<&'a GearDefinition> {
    Ok(model.input.definition_in(path.display())?)
}
