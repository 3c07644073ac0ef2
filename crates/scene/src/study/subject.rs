//! What a study computes again and again: a scene, a bevel pair, or a bearing under a load.

use std::path::Path;

use gearmesh_bearings::bearing_file::BearingFromFile;
use gearmesh_bevel::PairFile;
use gearmesh_geometry::InputError;
use gearmesh_geometry::input::InputDocument;
use gearmesh_specification::study::BearingOperation;
use gearmesh_specification::system::run::Run;

use crate::pair::{BevelScene, Scene};
use crate::scene_file::{InputKind, SceneFile};
use crate::system::SystemScene;

/// What is computed.
#[derive(Debug, Clone)]
pub enum Subject {
    /// A gear pair at rest, position by position.
    Pair(Box<Scene>),
    /// A multibody system.
    System(Box<SystemScene>),
    /// A bevel pair: its tooth contact analysis, with `[load]` under torques.
    Bevel(Box<BevelScene>),
    /// A bearing in equilibrium.
    Bearing(Box<BearingSubject>),
}

/// A bearing file and what the bearing carries.
#[derive(Debug, Clone)]
pub struct BearingSubject {
    /// What the file holds.
    pub found: BearingFromFile,
    /// Loads and speeds.
    pub operation: BearingOperation,
    /// The file with a table `operation` behind it.
    pub document: InputDocument,
}

/// What stands behind the keys of a bearing file while it is varied.
pub(super) const OPERATION: &str = "operation";

/// What the figures of a series are taken over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SeriesOver {
    /// The rows of a run in time.
    Time,
    /// The equilibria of a static run.
    Equilibria,
    /// The operating points of a run that seeks natural modes.
    OperatingPoints,
    /// The speeds of a sweep.
    Speeds,
    /// Nothing: what is looked at at rest has no series.
    Nothing,
}

impl Subject {
    /// What the figures of its series are taken over.
    #[must_use]
    pub fn series_over(&self) -> SeriesOver {
        let Self::System(scene) = self else {
            return SeriesOver::Nothing;
        };
        match scene.run {
            Run::Transient { .. } => SeriesOver::Time,
            Run::Static { .. } => SeriesOver::Equilibria,
            Run::Eigen { .. } => SeriesOver::OperatingPoints,
            Run::SpeedSweep(_) => SeriesOver::Speeds,
        }
    }

    /// Checks what is in memory; other files are relative to `folder`.
    ///
    /// # Errors
    /// [`InputError`] with file, line, key, what was found and what is allowed.
    pub fn from_document(document: InputDocument, folder: &Path) -> Result<Self, InputError> {
        if InputKind::of(&document)? == InputKind::Gear {
            if PairFile::recognises(&document)? {
                return Ok(Self::Bevel(Box::new(BevelScene::from_document(document)?)));
            }
            if is_bearing(&document)? {
                return Ok(Self::Bearing(Box::new(BearingSubject::from_document(
                    document,
                )?)));
            }
        }
        Ok(match SceneFile::from_document(document, folder)? {
            SceneFile::Pair(scene) => Self::Pair(scene),
            SceneFile::Bevel(scene) => Self::Bevel(scene),
            SceneFile::System(scene) => Self::System(scene),
        })
    }

    /// Where the files lie that it names; none of a bearing, which names none.
    #[must_use]
    pub fn folder(&self) -> Option<&Path> {
        match self {
            Self::Pair(scene) => Some(&scene.folder),
            Self::System(scene) => Some(&scene.folder),
            Self::Bevel(pair) => Some(pair.folder()),
            Self::Bearing(_) => None,
        }
    }

    /// Its text.
    #[must_use]
    pub fn document(&self) -> &InputDocument {
        match self {
            Self::Pair(scene) => &scene.document,
            Self::System(scene) => &scene.document,
            Self::Bevel(pair) => &pair.document,
            Self::Bearing(bearing) => &bearing.document,
        }
    }
}

/// Whether a document is a bearing file, with or without a table `operation`.
pub(super) fn is_bearing(document: &InputDocument) -> Result<bool, InputError> {
    let table = document.table()?;
    Ok(!table.contains_key("tooth") && BearingFromFile::recognises(document)?)
}

impl BearingSubject {
    fn from_document(document: InputDocument) -> Result<Self, InputError> {
        let mut table = document.table()?;
        let Some(stated) = table.remove(OPERATION) else {
            return Ok(Self {
                found: BearingFromFile::from_document(&document)?,
                operation: BearingOperation::default(),
                document,
            });
        };
        let text = toml::to_string(&table).map_err(|e| document.error("", e))?;
        let own = InputDocument::new(&document.file, text);
        // Its lines are not those of the user's file.
        let found = BearingFromFile::from_document(&own).map_err(|error| InputError {
            line: None,
            ..error
        })?;
        Ok(Self {
            found,
            operation: BearingOperation::from_value(&stated, &document)?,
            document,
        })
    }
}
