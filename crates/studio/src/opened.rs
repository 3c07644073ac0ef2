//! What was named on the command line. Nothing else is read.

use std::path::Path;

use gearmesh_scene::{ResultFile, SceneFile};

use crate::columns::ColumnsSession;
use crate::pair::PairSession;
use crate::problem::Problem;

/// A file that has been opened.
#[derive(Debug)]
pub enum Opened {
    /// A gear pair: from its scene, or from the scene inside its result.
    Pair(Box<PairSession>),
    /// The result of a multibody scene.
    Columns(Box<ColumnsSession>),
    /// Nothing yet: what is made new is opened next.
    New,
}

impl Opened {
    /// Opens a pair scene (`.toml`) or a result (`.h5`).
    ///
    /// # Errors
    /// [`Problem`] for a file of another kind, and for one that is wrong.
    pub fn named(path: &Path) -> Result<Self, Problem> {
        let shown = path.display();
        if path.is_dir() {
            let problem =
                format!("{shown}: is a folder; name a pair scene (.toml) or a result (.h5) in it");
            return Err(Problem::Input(problem));
        }
        if path.extension().is_some_and(|ending| ending == "h5") {
            return match ResultFile::open(path)? {
                ResultFile::Pair(result) if result.bevel.is_some() => Err(Problem::Input(format!(
                    "{shown}: is the result of a bevel pair; `gearmesh report {shown} -o page.html` shows it"
                ))),
                ResultFile::Pair(result) => {
                    Ok(Self::Pair(Box::new(PairSession::of_result(path, &result)?)))
                }
                ResultFile::System(result) => {
                    Ok(Self::Columns(Box::new(ColumnsSession::new(path, *result)?)))
                }
            };
        }
        match SceneFile::read(path)? {
            SceneFile::Pair(_) => Ok(Self::Pair(Box::new(PairSession::read(path)?))),
            SceneFile::Bevel(_) => Err(Problem::Input(format!(
                "{shown}: is a bevel pair; `gearmesh tca {shown} --report page.html` shows its contact, `gearmesh run` what it is under load"
            ))),
            SceneFile::System(_) => Err(Problem::Input(format!(
                "{shown}: is a multibody scene, which runs for minutes; run it with `gearmesh run {shown} -o result.h5` and open the result"
            ))),
        }
    }

    /// What kind of page it needs.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Pair(_) => "pair",
            Self::Columns(_) => "columns",
            Self::New => "new",
        }
    }

    /// The pair.
    ///
    /// # Errors
    /// [`Problem::Absent`] where it is none.
    pub fn pair(&self) -> Result<&PairSession, Problem> {
        match self {
            Self::Pair(pair) => Ok(pair),
            Self::Columns(_) | Self::New => Err(Problem::Absent),
        }
    }

    /// The columns.
    ///
    /// # Errors
    /// [`Problem::Absent`] where it is a pair.
    pub fn columns(&self) -> Result<&ColumnsSession, Problem> {
        match self {
            Self::Columns(columns) => Ok(columns),
            Self::Pair(_) | Self::New => Err(Problem::Absent),
        }
    }
}
