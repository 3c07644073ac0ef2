//! The cases of what is studied at rest, a gear pair, a bevel pair or a bearing: all columns of each in a small file,
//! so that a further column asks for no further computation, and models that are read and condensed once.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::sync::{Mutex, PoisonError};

use gearmesh_model::{FileError, bytes_digest, file_digest, write_text};
use gearmesh_specification::study::Study;

use super::cases::{Found, Selected, SelectedValue, StudyError};
use super::evaluate::{Clock, Effort};
use super::figure::Wanted;
use super::loaded_columns;
use super::pair_columns::{PairColumns, RestColumn, columns, place, unit_of};
use super::rest_columns;
use super::subject::Subject;
use crate::model_shelf::ModelShelf;
use crate::named_files_and_theirs;
use crate::pair::warnings::{ColumnPressure, yielding};
use crate::pair::{LoadedScene, RunError, Scene, run};
use crate::pair_load::load_from;

/// Digits of the digest in a file's name.
const NAME_DIGITS: usize = 16;

/// How the file of a case begins; the identity of the case follows.
const HEAD: &str = "# figures at rest, all they depend on: ";

/// All columns of a case.
#[derive(Debug, Clone, PartialEq)]
pub struct RestFigures {
    /// Torques on gear 2 \[N·m\]; none of bearings and of bevel pairs without `[load]`.
    pub torques_nm: Vec<f64>,
    /// The columns, a number for each torque, or a single one without.
    pub columns: Vec<RestColumn>,
}

impl RestFigures {
    /// The columns of these names, torque by torque.
    ///
    /// # Errors
    /// What to say of a name that is not there.
    pub fn selected(&self, wanted: &[Wanted]) -> Result<Vec<Selected>, String> {
        let known: Vec<String> = self.columns.iter().map(|c| c.name.clone()).collect();
        let places = wanted.iter().map(|one| place(&one.column, &known));
        let places = places.collect::<Result<Vec<usize>, String>>()?;
        let of_row = |k: usize| {
            let torque_nm = self.torques_nm.get(k).copied();
            let one = |place: &usize| {
                let RestColumn { name, values } = &self.columns[*place];
                Selected {
                    column: name.clone(),
                    unit: unit_of(name).to_owned(),
                    torque_nm,
                    value: SelectedValue::Single(values[k]),
                }
            };
            places.iter().map(one).collect::<Vec<_>>()
        };
        Ok((0..self.rows()).flat_map(of_row).collect())
    }

    /// What a study takes from them.
    pub(super) fn found(&self, study: &Study) -> Found {
        Found {
            figures: self.selected(&Wanted::of_study(study)),
            yielding: self.yielding(),
        }
    }

    /// The column with the largest pressure, where steel yields under it.
    pub fn yielding(&self) -> Option<ColumnPressure> {
        let of_pressure =
            |one: &&RestColumn| one.name.contains("pressure") && unit_of(&one.name) == "MPa";
        yielding(self.columns.iter().filter(of_pressure).map(|one| {
            let largest_mpa = one.values.iter().copied().fold(0.0, f64::max);
            (one.name.clone(), 1e6 * largest_mpa)
        }))
    }

    /// Numbers of a column.
    fn rows(&self) -> usize {
        self.torques_nm.len().max(1)
    }

    fn to_text(&self, identity: &str) -> String {
        let heads = self
            .columns
            .iter()
            .map(|c| format!(",{}", c.name))
            .collect::<String>();
        let row = |k: usize| {
            let torque = self.torques_nm.get(k);
            let torque = torque.map_or_else(String::new, |torque| format!("{torque:e}"));
            let values = self.columns.iter().map(|c| format!(",{:e}", c.values[k]));
            format!("{torque}{}\n", values.collect::<String>())
        };
        let rows: String = (0..self.rows()).map(row).collect();
        format!("{HEAD}{identity}\ntorque_Nm{heads}\n{rows}")
    }

    /// What a file says, if it is whole and that of this case.
    fn from_text(text: &str, identity: &str) -> Option<Self> {
        let mut lines = text.strip_prefix(HEAD)?.lines();
        if lines.next()? != identity {
            return None;
        }
        let names: Vec<&str> = lines.next()?.split(',').skip(1).collect();
        let column = |name: &&str| RestColumn {
            name: (*name).to_owned(),
            values: Vec::new(),
        };
        let mut found = Self {
            torques_nm: Vec::new(),
            columns: names.iter().map(column).collect(),
        };
        for line in lines {
            let (torque, values) = line.split_once(',')?;
            if !torque.is_empty() {
                found.torques_nm.push(torque.parse().ok()?);
            }
            let values: Vec<f64> = (values.split(','))
                .map(str::parse)
                .collect::<Result<_, _>>()
                .ok()?;
            if values.len() != found.columns.len() {
                return None;
            }
            found
                .columns
                .iter_mut()
                .zip(values)
                .for_each(|(c, v)| c.values.push(v));
        }
        Some(found)
    }
}

/// All columns of a case, and whether they had to be computed.
pub(super) struct FoundFigures {
    pub figures: RestFigures,
    pub computed: bool,
}

/// What the cases share. Threads may share it.
#[derive(Debug, Default)]
pub struct RestCases {
    shelf: ModelShelf,
    digests: Mutex<BTreeMap<PathBuf, String>>,
}

impl RestCases {
    /// The scene with its models, each read once.
    ///
    /// # Errors
    /// As [`crate::load`].
    pub fn load(&self, scene: &Scene) -> Result<LoadedScene, RunError> {
        load_from(scene.clone(), &self.shelf)
    }

    /// How many models were read.
    #[must_use]
    pub fn models(&self) -> usize {
        self.shelf.count()
    }

    /// How many pairs of models were condensed to the slices of a contact.
    #[must_use]
    pub fn condensed(&self) -> usize {
        self.shelf.condensed_count()
    }

    /// Names of the columns of what is at rest; none of a multibody scene.
    ///
    /// # Errors
    /// As [`Self::load`].
    pub fn names(&self, subject: &Subject) -> Result<Option<Vec<String>>, StudyError> {
        Ok(match subject {
            Subject::Pair(scene) => Some(PairColumns::of_scene(&self.load(scene)?).names()),
            Subject::Bevel(pair) => Some(loaded_columns::names(pair, &self.shelf)?),
            Subject::Bearing(bearing) => Some(rest_columns::bearing_names(bearing)),
            Subject::System(_) => None,
        })
    }

    /// Computes all columns of what is at rest, and what that took.
    ///
    /// # Errors
    /// [`StudyError`] for what cannot be loaded or solved, and for a multibody scene.
    pub fn figures(&self, subject: &Subject) -> Result<(RestFigures, Effort), StudyError> {
        let clock = Clock::start();
        let single = |names: Vec<String>, values: Vec<f64>| {
            let column = |(name, value)| RestColumn {
                name,
                values: vec![value],
            };
            RestFigures {
                torques_nm: Vec::new(),
                columns: names.into_iter().zip(values).map(column).collect(),
            }
        };
        match subject {
            Subject::Pair(scene) => {
                let loaded = self.load(scene)?;
                // Without the models' reading.
                let clock = Clock::start();
                let result = run(&loaded, &|_, _| ())?;
                let effort = Effort {
                    states: (loaded.lines.most_pairs() * loaded.layout.slices) as f64,
                    calls: (result.torque_nm.len() * result.angle_rad.len()) as f64,
                    iterations: result
                        .solution
                        .iterations
                        .iter()
                        .map(|n| f64::from(*n))
                        .sum(),
                    ..clock.effort()
                };
                let figures = RestFigures {
                    columns: columns(&result),
                    torques_nm: result.torque_nm,
                };
                Ok((figures, effort))
            }
            Subject::Bevel(pair) => {
                let going = AtomicBool::new(false);
                let (figures, _) = RestFigures::solved_bevel(pair, &self.shelf, &going)?;
                Ok((figures, clock.effort()))
            }
            Subject::Bearing(bearing) => {
                let values = rest_columns::of_bearing(bearing)?;
                let figures = single(rest_columns::bearing_names(bearing), values);
                Ok((figures, clock.effort()))
            }
            Subject::System(scene) => {
                let problem = "a multibody scene is not at rest";
                Err(scene.document.error("", problem).into())
            }
        }
    }

    /// The same from the file that a folder has of it, which is written where there is none.
    ///
    /// # Errors
    /// [`StudyError`] as [`Self::figures`], and where the file cannot be written.
    pub(super) fn figures_in(
        &self,
        subject: &Subject,
        folder: &Path,
    ) -> Result<(PathBuf, RestFigures), StudyError> {
        let identity = self.identity(subject)?;
        let found = self.figures_as(subject, &identity, folder)?;
        Ok((folder.join(Self::file_name(&identity)), found.figures))
    }

    /// The same for what has its identity already.
    pub(super) fn figures_as(
        &self,
        subject: &Subject,
        identity: &str,
        folder: &Path,
    ) -> Result<FoundFigures, StudyError> {
        let file = folder.join(Self::file_name(identity));
        if let Some(figures) = Self::stored(&file, identity) {
            let computed = false;
            return Ok(FoundFigures { figures, computed });
        }
        let (figures, _) = self.figures(subject)?;
        write_text(&file, &figures.to_text(identity))?;
        let computed = true;
        Ok(FoundFigures { figures, computed })
    }

    /// Name of a case's file.
    pub(super) fn file_name(identity: &str) -> String {
        let digits: String = identity.chars().take(NAME_DIGITS).collect();
        format!("{digits}.csv")
    }

    /// What a file says, if it is there, whole, and that of this case.
    pub(super) fn stored(file: &Path, identity: &str) -> Option<RestFigures> {
        RestFigures::from_text(&std::fs::read_to_string(file).ok()?, identity)
    }

    /// Digest of the scene, of all files that it names and of the program's version.
    pub(super) fn identity(&self, subject: &Subject) -> Result<String, FileError> {
        let text = &subject.document().text;
        let mut parts = vec![text.clone(), env!("CARGO_PKG_VERSION").to_owned()];
        if let Some(folder) = subject.folder() {
            for path in named_files_and_theirs(text, folder).into_values() {
                parts.push(self.digest(path)?);
            }
        }
        Ok(bytes_digest(parts.join("\0").as_bytes()))
    }

    fn digest(&self, path: PathBuf) -> Result<String, FileError> {
        let mut digests = self.digests.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(digest) = digests.get(&path) {
            return Ok(digest.clone());
        }
        let digest = if path.extension().is_some_and(|e| e == "h5") {
            file_digest(&path)?
        } else {
            let bytes = std::fs::read(&path).map_err(|source| FileError::Io {
                path: path.clone(),
                action: "read",
                source,
            })?;
            bytes_digest(&bytes)
        };
        digests.insert(path, digest.clone());
        Ok(digest)
    }
}
