//! The cases of a study of a gear pair: all columns of each in a small file, so that a further column asks for no
//! further computation, and models that are read once.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use gearmesh_model::{FileError, bytes_digest, file_digest, write_text};

use super::cases::{Selected, SelectedValue, StudyError};
use super::pair_columns::{PairColumn, columns, place, unit_of};
use crate::named_files;
use crate::pair::{LoadedScene, ModelShelf, RunError, Scene, load_from, run};

/// Digits of the digest in a file's name.
const NAME_DIGITS: usize = 16;

/// How the file of a case begins; the identity of the case follows.
const HEAD: &str = "# figures of a gear pair, all it depends on: ";

/// All columns of a case.
#[derive(Debug, Clone, PartialEq)]
pub struct PairFigures {
    /// Torques on gear 2 \[N·m\].
    pub torques_nm: Vec<f64>,
    /// The columns, a number for each torque.
    pub columns: Vec<PairColumn>,
}

impl PairFigures {
    /// The columns of these names, torque by torque.
    ///
    /// # Errors
    /// What to say of a name that is not there.
    pub fn selected(&self, names: &[String]) -> Result<Vec<Selected>, String> {
        let known: Vec<String> = self.columns.iter().map(|c| c.name.clone()).collect();
        let places = names.iter().map(|name| place(name, &known));
        let places = places.collect::<Result<Vec<usize>, String>>()?;
        let of_torque = |(k, torque): (usize, &f64)| {
            let torque_nm = Some(*torque);
            let one = |place: &usize| {
                let PairColumn { name, values } = &self.columns[*place];
                Selected {
                    column: name.clone(),
                    unit: unit_of(name).to_owned(),
                    torque_nm,
                    value: SelectedValue::Single(values[k]),
                }
            };
            places.iter().map(one).collect::<Vec<_>>()
        };
        Ok(self
            .torques_nm
            .iter()
            .enumerate()
            .flat_map(of_torque)
            .collect())
    }

    fn to_text(&self, identity: &str) -> String {
        let heads = self
            .columns
            .iter()
            .map(|c| format!(",{}", c.name))
            .collect::<String>();
        let row = |(k, torque): (usize, &f64)| {
            let values = self.columns.iter().map(|c| format!(",{:e}", c.values[k]));
            format!("{torque:e}{}\n", values.collect::<String>())
        };
        let rows: String = self.torques_nm.iter().enumerate().map(row).collect();
        format!("{HEAD}{identity}\ntorque_Nm{heads}\n{rows}")
    }

    /// What a file says, if it is whole and that of this case.
    fn from_text(text: &str, identity: &str) -> Option<Self> {
        let mut lines = text.strip_prefix(HEAD)?.lines();
        if lines.next()? != identity {
            return None;
        }
        let names: Vec<&str> = lines.next()?.split(',').skip(1).collect();
        let column = |name: &&str| PairColumn {
            name: (*name).to_owned(),
            values: Vec::new(),
        };
        let mut found = Self {
            torques_nm: Vec::new(),
            columns: names.iter().map(column).collect(),
        };
        for line in lines {
            let numbers: Vec<f64> = line
                .split(',')
                .map(str::parse)
                .collect::<Result<_, _>>()
                .ok()?;
            let (torque, values) = numbers.split_first()?;
            if values.len() != found.columns.len() {
                return None;
            }
            found.torques_nm.push(*torque);
            found
                .columns
                .iter_mut()
                .zip(values)
                .for_each(|(c, v)| c.values.push(*v));
        }
        Some(found)
    }
}

/// All columns of a case, and whether they had to be computed.
pub(super) struct FoundFigures {
    pub figures: PairFigures,
    pub computed: bool,
}

/// What the cases of a pair share. Threads may share it.
#[derive(Debug, Default)]
pub struct PairCases {
    shelf: ModelShelf,
    digests: Mutex<BTreeMap<PathBuf, String>>,
}

impl PairCases {
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

    /// Computes all columns of a scene.
    ///
    /// # Errors
    /// [`RunError`] for a scene that cannot be loaded or solved.
    pub fn figures(&self, scene: &Scene) -> Result<PairFigures, RunError> {
        let loaded = self.load(scene)?;
        let result = run(&loaded, &|_, _| ())?;
        Ok(PairFigures {
            columns: columns(&loaded, &result),
            torques_nm: result.torque_nm,
        })
    }

    /// The same from the file that a folder has of it, which is written where there is none.
    ///
    /// # Errors
    /// [`StudyError`] as [`Self::figures`], and where the file cannot be written.
    pub(super) fn figures_in(
        &self,
        scene: &Scene,
        folder: &Path,
    ) -> Result<(PathBuf, PairFigures), StudyError> {
        let identity = self.identity(scene)?;
        let found = self.figures_as(scene, &identity, folder)?;
        Ok((folder.join(Self::file_name(&identity)), found.figures))
    }

    /// The same for a scene whose identity is known already.
    pub(super) fn figures_as(
        &self,
        scene: &Scene,
        identity: &str,
        folder: &Path,
    ) -> Result<FoundFigures, StudyError> {
        let file = folder.join(Self::file_name(identity));
        if let Some(figures) = Self::stored(&file, identity) {
            let computed = false;
            return Ok(FoundFigures { figures, computed });
        }
        let figures = self.figures(scene)?;
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
    pub(super) fn stored(file: &Path, identity: &str) -> Option<PairFigures> {
        PairFigures::from_text(&std::fs::read_to_string(file).ok()?, identity)
    }

    /// Digest of the scene, of all files that it names and of the program's version.
    pub(super) fn identity(&self, scene: &Scene) -> Result<String, FileError> {
        let mut parts = vec![
            scene.document.text.clone(),
            env!("CARGO_PKG_VERSION").to_owned(),
        ];
        for path in named_files(&scene.document.text, &scene.folder).into_values() {
            parts.push(self.digest(path)?);
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
