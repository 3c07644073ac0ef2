//! A scene file of either kind, told apart by what it holds.

use std::path::Path;

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::InputDocument;

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
        let keys = document.top_keys()?;
        let has = |key: &&str| keys.contains(*key);
        let of: [(&[&str], Self); 6] = [
            (&["pair", "body", "shaft", "planetary"], Self::Scene),
            (&["tooth"], Self::Gear),
            (&["objective"], Self::Optimisation),
            (&["scene", "parameter"], Self::Study),
            (&["cycles", "stress_amplitude_MPa"], Self::SnTable),
            (&["angle_origin"], Self::Record),
        ];
        let found = of.iter().find(|(marks, _)| marks.iter().any(has));
        Ok(found.map_or(Self::Gear, |(_, kind)| *kind))
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
        let keys = document.top_keys()?;
        let has = |key: &str| keys.contains(key);
        let is_system = has("body") || has("shaft") || has("planetary");
        match (has("pair"), is_system) {
            (true, false) => Ok(Self::Pair(Box::new(Scene::from_document(document, folder)?))),
            (false, true) => Ok(Self::System(Box::new(SystemScene::from_document(document, folder)?))),
            (true, true) => Err(document.error(
                "body",
                "a scene has [pair] (one gear pair, static positions) or [[body]] and [[shaft]] (a multibody system), not both",
            )),
            (false, false) if has("bevel") => {
                Ok(Self::Bevel(Box::new(BevelScene::from_document(document.in_folder(folder))?)))
            }
            (false, false) if has("tooth") => {
                Err(document.error("tooth", "this is a gear file; a scene has [pair] or [[body]]"))
            }
            (false, false) => Err(document.error(
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
