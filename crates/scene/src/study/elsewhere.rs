//! The cases of a study for computers that have only what they are sent, and the table of what came back.
//!
//! One computer lists the cases ([`StudyCases`]); each has the name of the file that the study will look for. Others
//! run them ([`CaseRunner`]), where the files that a scene names may lie elsewhere. [`gather_study`] makes the table of
//! what lies in the folder then. A case has the same file, byte by byte as far as it can, as if [`super::run_study`]
//! had made it.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::InputDocument;
use gearmesh_specification::study::Study;
use rayon::prelude::*;

use super::cases::{Found, StudyError, StudyOutcome, StudyScenes, finished, make_folder};
use super::rest_cases::RestCases;
use super::subject::Subject;
use super::system_cases;
use super::varied_scene::{MadeFile, MadeFiles};
use crate::{named_files, renamed_files};

/// A case that can be sent.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SentCase {
    /// Name of its file in the study's folder.
    pub file: String,
    /// Digest of all that it depends on.
    pub identity: String,
    /// The scene.
    pub text: String,
    /// The scene's name in complaints.
    pub title: String,
    /// Files that the scene names: as it writes them, and where they are here.
    pub named: Vec<(String, PathBuf)>,
    /// Names and digests of the files of a multibody scene, as its result states them; empty for what is at rest.
    pub inputs: Vec<String>,
}

/// The cases of a study, each scene once.
pub struct StudyCases {
    /// Files that they need and that the study makes, in its folder.
    pub files: MadeFiles,
    scenes: Vec<Subject>,
    rest: RestCases,
}

impl StudyCases {
    /// Makes the scenes of all cases and checks columns and keys. `out`: the folder of the study.
    ///
    /// # Errors
    /// As [`super::run_study`] before its first case.
    pub fn new(study: &Study, out: &Path) -> Result<Self, StudyError> {
        let scenes = StudyScenes::new(study, out)?;
        let rest = RestCases::default();
        scenes.check_columns(study, &rest)?;
        Ok(Self {
            files: scenes.files,
            scenes: scenes.scenes,
            rest,
        })
    }

    /// The files that are not there yet.
    #[must_use]
    pub fn missing(&self) -> Vec<(&Path, &MadeFile)> {
        let files = self.files.iter();
        let missing = files.filter(|(path, _)| !path.exists());
        missing.map(|(path, made)| (path.as_path(), made)).collect()
    }

    /// The cases to send; asked when all files are there.
    ///
    /// # Errors
    /// [`StudyError::File`] for a file that cannot be read.
    pub fn list(&self) -> Result<Vec<SentCase>, StudyError> {
        self.scenes.iter().map(|scene| self.sent(scene)).collect()
    }

    fn sent(&self, scene: &Subject) -> Result<SentCase, StudyError> {
        let document = scene.document();
        let absolute = |path: PathBuf| std::path::absolute(&path).unwrap_or(path);
        let folder = scene.folder();
        let named = folder.map(|folder| named_files(&document.text, folder));
        let named = named
            .into_iter()
            .flatten()
            .map(|(name, path)| (name, absolute(path)));
        let (file, identity, inputs) = match scene {
            Subject::System(scene) => {
                let head = system_cases::head(scene);
                let identity = head.identity();
                (system_cases::file_name(&identity), identity, head.inputs)
            }
            scene => {
                let identity = self.rest.identity(scene)?;
                (RestCases::file_name(&identity), identity, Vec::new())
            }
        };
        Ok(SentCase {
            file,
            identity,
            text: document.text.clone(),
            title: document.file.clone(),
            named: named.collect(),
            inputs,
        })
    }
}

/// Runs cases that were sent. Threads may share it; models are read once.
#[derive(Debug, Default)]
pub struct CaseRunner {
    rest: RestCases,
}

impl CaseRunner {
    /// Whether a folder has the whole file of a case.
    #[must_use]
    pub fn is_there(case: &SentCase, folder: &Path) -> bool {
        let file = folder.join(&case.file);
        if file.extension().is_some_and(|ending| ending == "csv") {
            return RestCases::stored(&file, &case.identity).is_some();
        }
        system_cases::is_there(&file, &case.identity)
    }

    /// Runs a case into a folder unless its file is there: true where it was computed, none where it was stopped.
    /// `places`: where files lie here that lie elsewhere where the case comes from.
    ///
    /// # Errors
    /// [`StudyError`]: what keeps the case from being run.
    pub fn run(
        &self,
        case: &SentCase,
        places: &BTreeMap<PathBuf, PathBuf>,
        folder: &Path,
        stop: &AtomicBool,
    ) -> Result<Option<bool>, StudyError> {
        make_folder(folder)?;
        let document = relocated(case, places)?;
        // Whatever it names has its whole path by now.
        match Subject::from_document(document, Path::new("/"))? {
            Subject::System(scene) => system_cases::run_sent(*scene, case, folder, stop),
            scene => {
                let found = self.rest.figures_as(&scene, &case.identity, folder)?;
                Ok(Some(found.computed))
            }
        }
    }
}

/// The scene with the whole paths of the files that it names.
fn relocated(
    case: &SentCase,
    places: &BTreeMap<PathBuf, PathBuf>,
) -> Result<InputDocument, InputError> {
    let place = |(name, path): &(String, PathBuf)| {
        let place = places.get(path).unwrap_or(path);
        (name.clone(), place.display().to_string())
    };
    let names = case.named.iter().map(place).collect();
    let text = renamed_files(&case.text, &names).map_err(|problem| {
        InputDocument::new(case.title.clone(), case.text.clone()).error("", problem)
    })?;
    Ok(InputDocument::new(case.title.clone(), text))
}

/// Makes the table of a study from what lies in its folder; nothing is computed. `failures`: why cases have failed, by
/// the names of their files.
///
/// # Errors
/// As [`super::run_study`] for the study as a whole.
pub fn gather_study(
    study: &Study,
    folder: &Path,
    failures: &BTreeMap<String, String>,
) -> Result<StudyOutcome, StudyError> {
    let scenes = StudyScenes::new(study, folder)?;
    let rest = RestCases::default();
    scenes.check_columns(study, &rest)?;
    let outcome = |scene: &Subject| -> Result<Option<(PathBuf, Found)>, StudyError> {
        let (name, found) = match scene {
            Subject::System(scene) => {
                let identity = system_cases::head(scene).identity();
                let name = system_cases::file_name(&identity);
                let found = system_cases::stored(study, &folder.join(&name), &identity);
                (name, found)
            }
            scene => {
                let identity = rest.identity(scene)?;
                let name = RestCases::file_name(&identity);
                let found = RestCases::stored(&folder.join(&name), &identity);
                (name, found.map(|figures| figures.found(study)))
            }
        };
        match (found, failures.get(&name)) {
            (Some(found), _) => Ok(Some((folder.join(name), found))),
            (None, Some(problem)) => Err(StudyError::Elsewhere(problem.clone())),
            (None, None) => Err(StudyError::Elsewhere(
                "is not there: the study was broken off; start it again".to_owned(),
            )),
        }
    };
    let outcomes = scenes.scenes.par_iter().map(outcome).collect();
    make_folder(folder)?;
    finished(
        study,
        (scenes.cases, &scenes.scene_of),
        (outcomes, scenes.base.series_over()),
        (folder, 0),
    )
}
