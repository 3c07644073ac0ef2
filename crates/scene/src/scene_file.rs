//! A scene file of either kind, told apart by what it holds.

use std::path::Path;

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::InputDocument;
use serde::Deserialize;
use serde::de::IgnoredAny;

use crate::pair::{BevelScene, Scene};
use crate::system::SystemScene;

/// A scene that has been read and checked.
#[derive(Debug, Clone)]
pub enum SceneFile {
    /// One gear pair, static positions.
    Pair(Box<Scene>),
    /// A bevel pair under the torques of its `[load]`.
    Bevel(Box<BevelScene>),
    /// A multibody system.
    System(Box<SystemScene>),
}

/// The tables and keys that tell the kinds of files apart.
#[derive(Deserialize)]
#[allow(non_snake_case)]
struct Marks {
    pair: Option<IgnoredAny>,
    bevel: Option<IgnoredAny>,
    body: Option<IgnoredAny>,
    shaft: Option<IgnoredAny>,
    planetary: Option<IgnoredAny>,
    tooth: Option<IgnoredAny>,
    scene: Option<IgnoredAny>,
    parameter: Option<IgnoredAny>,
    objective: Option<IgnoredAny>,
    cycles: Option<IgnoredAny>,
    stress_amplitude_MPa: Option<IgnoredAny>,
    angle_origin: Option<IgnoredAny>,
}

/// What a TOML file is meant as; the kind decides which complaints its reader sees.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InputKind {
    /// Has `[pair]`, `[[body]]`, `[[shaft]]` or `[[planetary]]`.
    Scene,
    /// Has `[[objective]]`.
    Optimisation,
    /// Has `scene` or `[[parameter]]`.
    Study,
    /// Has `cycles` or `stress_amplitude_MPa`.
    SnTable,
    /// Description of a reference record: has `angle_origin`.
    Record,
    /// Anything else.
    Gear,
}

impl InputKind {
    /// Tells a document's kind.
    ///
    /// # Errors
    /// [`InputError`] for a document that is no TOML.
    pub fn of(document: &InputDocument) -> Result<Self, InputError> {
        let marks: Marks = document.glance()?;
        let any = |marks: &[&Option<IgnoredAny>]| marks.iter().any(|mark| mark.is_some());
        Ok(
            if any(&[&marks.pair, &marks.body, &marks.shaft, &marks.planetary]) {
                Self::Scene
            } else if any(&[&marks.tooth]) {
                Self::Gear
            } else if any(&[&marks.objective]) {
                Self::Optimisation
            } else if any(&[&marks.scene, &marks.parameter]) {
                Self::Study
            } else if any(&[&marks.cycles, &marks.stress_amplitude_MPa]) {
                Self::SnTable
            } else if any(&[&marks.angle_origin]) {
                Self::Record
            } else {
                Self::Gear
            },
        )
    }
}

impl SceneFile {
    /// Reads and checks a scene file.
    ///
    /// # Errors
    /// [`InputError`] with file, line, key, what was found and what is allowed.
    pub fn read(path: &Path) -> Result<Self, InputError> {
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::from_document(InputDocument::read(path)?, folder)
    }

    /// Checks a scene that is already in memory; other files are relative to `folder`.
    ///
    /// # Errors
    /// As [`SceneFile::read`].
    pub fn from_document(document: InputDocument, folder: &Path) -> Result<Self, InputError> {
        let marks: Marks = document.glance()?;
        match (marks.pair, marks.body.or(marks.shaft).or(marks.planetary)) {
            (Some(_), None) => Ok(Self::Pair(Box::new(Scene::from_document(document, folder)?))),
            (None, Some(_)) => Ok(Self::System(Box::new(SystemScene::from_document(document, folder)?))),
            (Some(_), Some(_)) => Err(document.error(
                "body",
                "a scene has [pair] (one gear pair, static positions) or [[body]] and [[shaft]] (a multibody system), not both",
            )),
            (None, None) if marks.bevel.is_some() => {
                Ok(Self::Bevel(Box::new(BevelScene::from_document(document.in_folder(folder))?)))
            }
            (None, None) if marks.tooth.is_some() => {
                Err(document.error("tooth", "this is a gear file; a scene has [pair] or [[body]]"))
            }
            (None, None) => Err(document.error(
                "",
                "no scene: it has neither [pair] (one gear pair, static positions) nor [[body]] or [[shaft]] (a multibody system)",
            )),
        }
    }

    /// Title in prints and reports.
    pub fn title(&self) -> &str {
        match self {
            Self::Pair(scene) => &scene.title,
            Self::Bevel(scene) => &scene.file.title,
            Self::System(scene) => &scene.title,
        }
    }
}
