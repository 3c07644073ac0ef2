//! What was named on the command line. Nothing else is read.

use std::path::Path;

use gearmesh_scene::system_run::ResultKind;
use gearmesh_scene::{ResultFile, SceneFile};

use crate::beginning::{self, NewFiles};
use crate::choice::{FolderSession, SceneSession};
use crate::columns::ColumnsSession;
use crate::modes::ModesSession;
use crate::pair::PairSession;
use crate::problem::Problem;

/// A file that has been opened.
#[derive(Debug)]
pub enum Opened {
    /// A gear pair: from its scene, or from the scene inside its result.
    Pair(Box<PairSession>),
    /// The result of a multibody scene.
    Columns(Box<ColumnsSession>),
    /// Natural modes of a multibody scene.
    Modes(Box<ModesSession>),
    /// A multibody scene that is run next.
    Scene(Box<SceneSession>),
    /// A folder from which something is chosen.
    Folder(FolderSession),
    /// Something new, or begun already: what is made of it is opened next.
    New(Option<Box<NewFiles>>),
}

impl Opened {
    /// Opens a scene (`.toml`), a result (`.h5`) or a folder with some.
    ///
    /// # Errors
    /// [`Problem`] for a file of another kind, and for one that is wrong.
    pub fn named(path: &Path) -> Result<Self, Problem> {
        let shown = path.display();
        if path.is_dir() {
            return Ok(Self::Folder(FolderSession::new(path)?));
        }
        if path.extension().is_some_and(|ending| ending == "h5") {
            return match ResultFile::open(path)? {
                ResultFile::Pair(result) if result.bevel.is_some() => Err(Problem::Input(format!(
                    "{shown}: is the result of a bevel pair; `gearmesh report {shown} -o page.html` shows it"
                ))),
                ResultFile::Pair(result) => {
                    Ok(Self::Pair(Box::new(PairSession::of_result(path, &result)?)))
                }
                ResultFile::System(result) if result.kind == ResultKind::Eigen => {
                    Ok(Self::Modes(Box::new(ModesSession::new(path, *result)?)))
                }
                ResultFile::System(result) => {
                    Ok(Self::Columns(Box::new(ColumnsSession::new(path, *result)?)))
                }
            };
        }
        match SceneFile::read(path)? {
            SceneFile::Pair(_) => Ok(Self::Pair(Box::new(PairSession::read(path)?))),
            SceneFile::Bevel(_) => Ok(Self::New(Some(Box::new(beginning::bevel_pair(path)?)))),
            SceneFile::System(scene) => Ok(Self::Scene(Box::new(SceneSession::new(path, *scene)))),
        }
    }

    /// The result of a multibody scene with another one beside it.
    ///
    /// # Errors
    /// As [`Opened::named`] of the other one, and for results that run over different quantities.
    pub fn beside(self, other: &Path) -> Result<Self, Problem> {
        match (self, Self::named(other)?) {
            (Self::Columns(first), Self::Columns(second)) => {
                Ok(Self::Columns(Box::new(first.with_beside(*second)?)))
            }
            _ => Err(Problem::Input(format!(
                "--beside {}: allowed are two results of multibody scenes in time or at rest; states of a pair are compared by *Pin* on its page",
                other.display()
            ))),
        }
    }

    /// What kind of page it needs.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Pair(_) => "pair",
            Self::Columns(_) => "columns",
            Self::Modes(_) => "modes",
            Self::Scene(_) => "scene",
            Self::Folder(_) => "folder",
            Self::New(_) => "new",
        }
    }

    /// What is begun already.
    pub fn begun(&self) -> Option<&NewFiles> {
        match self {
            Self::New(begun) => begun.as_deref(),
            _ => None,
        }
    }

    /// The pair.
    ///
    /// # Errors
    /// [`Problem::Absent`] where it is none.
    pub fn pair(&self) -> Result<&PairSession, Problem> {
        match self {
            Self::Pair(pair) => Ok(pair),
            _ => Err(Problem::Absent),
        }
    }

    /// The scene.
    ///
    /// # Errors
    /// [`Problem::Absent`] where it is something else.
    pub fn scene(&self) -> Result<&SceneSession, Problem> {
        match self {
            Self::Scene(scene) => Ok(scene),
            _ => Err(Problem::Absent),
        }
    }

    /// The folder.
    ///
    /// # Errors
    /// [`Problem::Absent`] where it is something else.
    pub fn folder(&self) -> Result<&FolderSession, Problem> {
        match self {
            Self::Folder(folder) => Ok(folder),
            _ => Err(Problem::Absent),
        }
    }

    /// The modes.
    ///
    /// # Errors
    /// [`Problem::Absent`] where it is something else.
    pub fn modes(&self) -> Result<&ModesSession, Problem> {
        match self {
            Self::Modes(modes) => Ok(modes),
            _ => Err(Problem::Absent),
        }
    }

    /// The columns.
    ///
    /// # Errors
    /// [`Problem::Absent`] where it is something else.
    pub fn columns(&self) -> Result<&ColumnsSession, Problem> {
        match self {
            Self::Columns(columns) => Ok(columns),
            _ => Err(Problem::Absent),
        }
    }
}
