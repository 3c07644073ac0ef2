//! Running the cases of a study and reading their figures.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use gearmesh_bearings::BearingError;
use gearmesh_geometry::{GearDefinition, InputError};
use gearmesh_model::{FileError, ReducedGear, write_reduced_gear, write_text};
use gearmesh_specification::study::{Case, Study};
use rayon::prelude::*;

use super::figure::{FigureKinds, Wanted};
use super::rest_cases::RestCases;
use super::subject::{SeriesOver, Subject};
use super::system_cases;
use super::table::table;
use super::varied_scene::{BaseScene, MadeFile, MadeFiles, VaryError};
use crate::pair::RunError;
use crate::pair::warnings::ColumnPressure;
use crate::system::SystemScene;
use crate::system_run::{Figures, SystemResult, SystemRunError, demand_result_size};

/// Why a study could not be run.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// The study or a scene that it makes.
    #[error(transparent)]
    Input(#[from] InputError),
    /// A multibody case.
    #[error(transparent)]
    Run(#[from] SystemRunError),
    /// A case of a gear pair.
    #[error(transparent)]
    Pair(#[from] RunError),
    /// A case of a bevel pair.
    #[error(transparent)]
    Bevel(InputError),
    /// A case of a bearing.
    #[error(transparent)]
    Bearing(#[from] BearingError),
    /// A file could not be written or read.
    #[error(transparent)]
    File(#[from] FileError),
    /// A gear that a case needs could not be reduced.
    #[error("{gear} for {}: {problem}", path.display())]
    Reduction {
        /// Name of the gear.
        gear: String,
        /// The model that was to be made.
        path: PathBuf,
        /// What went wrong.
        problem: String,
    },
    /// A result does not give a column.
    #[error("{0}")]
    Column(String),
    /// A case that was computed on another machine.
    #[error("{0}")]
    Elsewhere(String),
    /// The user has asked to stop.
    #[error("stopped on demand")]
    Stopped,
    /// The folder could not be made.
    #[error("cannot make the folder {}: {source}", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
}

impl StudyError {
    /// True when the input is to blame, not the computation.
    #[must_use]
    pub fn is_input(&self) -> bool {
        match self {
            Self::Input(_) => true,
            Self::Run(error) => error.is_input(),
            Self::Pair(error) => error.is_input(),
            Self::Bevel(_) | Self::Bearing(_) | Self::Column(_) | Self::Elsewhere(_) => false,
            Self::File(_) | Self::Folder { .. } | Self::Reduction { .. } | Self::Stopped => false,
        }
    }
}

/// What a study says of a column.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SelectedValue {
    /// Figures over time or over equilibria.
    Series(Figures),
    /// A single number.
    Single(f64),
}

/// One column of a case.
#[derive(Debug, Clone, PartialEq)]
pub struct Selected {
    /// Name with unit.
    pub column: String,
    /// Unit.
    pub unit: String,
    /// Of a gear pair, and of a bevel pair under load, the torque on gear 2 \[N·m\].
    pub torque_nm: Option<f64>,
    /// What was found.
    pub value: SelectedValue,
}

/// A case and what came out.
#[derive(Debug)]
pub struct CaseResult {
    /// What was changed.
    pub case: Case,
    /// The file of its result or figures; none if it failed.
    pub file: Option<PathBuf>,
    /// The study's columns, or why there are none: a case that fails does not end the study.
    pub figures: Result<Vec<Selected>, String>,
    /// The column with the largest pressure, where steel yields under it; also where the study does not ask for it.
    pub yielding: Option<ColumnPressure>,
}

/// A study that was run.
#[derive(Debug)]
pub struct StudyOutcome {
    /// The cases, in the order of the study; less where it was stopped.
    pub cases: Vec<CaseResult>,
    /// What figures of series are taken over.
    pub series_over: SeriesOver,
    /// Stopped on demand; the same command goes on.
    pub stopped: bool,
    /// Gears that were reduced on the way.
    pub reduced: usize,
}

/// How to run a study.
pub struct StudyOptions<'a> {
    /// Where files go.
    pub folder: &'a Path,
    /// Set from outside: stop after the cases at hand.
    pub stop: &'a AtomicBool,
    /// Told how many of how many cases are done.
    pub progress: &'a (dyn Fn(usize, usize) + Sync),
    /// Meshes and reduces a gear: this side never does it itself.
    pub reduce: &'a (dyn Fn(&GearDefinition) -> Result<ReducedGear, String> + Sync),
}

/// The scenes that the cases of a study come to.
pub struct StudyScenes {
    /// The cases.
    pub cases: Vec<Case>,
    /// The scene as it is.
    pub base: Subject,
    /// The scenes, each once.
    pub scenes: Vec<Subject>,
    /// Files that they need and that the study makes.
    pub files: MadeFiles,
    /// Scene of each case.
    pub(super) scene_of: Vec<usize>,
}

impl StudyScenes {
    /// Makes the scenes of all cases: a wrong key is reported before the first run, not after it. `out`: the folder of
    /// the study, of which only the name is used.
    ///
    /// # Errors
    /// [`InputError`] for the first scene that is wrong.
    pub fn new(study: &Study, out: &Path) -> Result<Self, InputError> {
        let path = study.folder.join(&study.tables.scene);
        let parameters = study.tables.parameter.iter();
        let keys = parameters.flat_map(|p| p.keys.iter().map(String::as_str));
        let operation = study.tables.operation.as_ref();
        let base_scene = BaseScene::read(&path, keys, operation)?;
        let mut files = MadeFiles::new();
        let cases = study.cases();
        let mut made = |case: &Case| {
            let scene = base_scene.scene(case, &mut files, out);
            let scene = scene.map_err(|error| blamed(study, error))?;
            demand_runnable(study, &scene)?;
            Ok::<_, InputError>(scene)
        };
        let base = made(&Case::default())?;
        let mut scenes: Vec<Subject> = Vec::new();
        let mut scene_of = Vec::with_capacity(cases.len());
        let mut places: BTreeMap<String, usize> = BTreeMap::new();
        for case in &cases {
            let scene = made(case)?;
            let place = *places
                .entry(scene.document().text.clone())
                .or_insert(scenes.len());
            if place == scenes.len() {
                scenes.push(scene);
            }
            scene_of.push(place);
        }
        Ok(Self {
            cases,
            base,
            scenes,
            files,
            scene_of,
        })
    }

    /// Checks the columns that the study asks for: those of the scene as it is; and that its results are not larger
    /// than is allowed.
    ///
    /// # Errors
    /// [`StudyError`] for a column that is not there, with near names, for a scene that cannot be loaded, and for
    /// results that are too large.
    pub fn check_columns(&self, study: &Study, rest: &RestCases) -> Result<(), StudyError> {
        let (known, kinds) = known_columns(&self.base, rest)?;
        for (number, one) in Wanted::of_study(study).iter().enumerate() {
            if let Err(problem) = one.check(&known, kinds) {
                return Err(study
                    .document
                    .error(&format!("columns.{number}"), problem)
                    .into());
            }
        }
        let what = match self.scenes.len() {
            1 => "the result of its case".to_owned(),
            count => format!("the results of its {count} cases together"),
        };
        let sized = (what.as_str(), self.result_bytes()?);
        demand_result_size((&study.document, ""), sized, study.most_result_bytes)?;
        Ok(())
    }

    /// Bytes of the rows of all results, nearly all of them; 0 of what is at rest, which keeps its figures only.
    ///
    /// # Errors
    /// [`StudyError`] for a scene that cannot be loaded.
    pub fn result_bytes(&self) -> Result<f64, StudyError> {
        let Some(size) = system_cases::result_size(&self.base)? else {
            return Ok(0.0);
        };
        let systems = self.scenes.iter().filter_map(|scene| match scene {
            Subject::System(scene) => Some(scene),
            _ => None,
        });
        // Cases have the columns of the scene as it is.
        Ok(systems.map(|scene| size.with_rows_of(scene).bytes()).sum())
    }
}

/// The columns of a scene, and what may be asked of them.
///
/// # Errors
/// [`StudyError`] for a scene that cannot be loaded.
pub(crate) fn known_columns(
    subject: &Subject,
    rest: &RestCases,
) -> Result<(Vec<String>, FigureKinds), StudyError> {
    match (rest.names(subject)?, subject) {
        (Some(names), _) => Ok((names, FigureKinds::None)),
        (None, Subject::System(scene)) => system_cases::column_names(scene),
        (None, _) => Ok((Vec::new(), FigureKinds::None)),
    }
}

/// Whose fault it is that a case comes to no scene.
fn blamed(study: &Study, error: VaryError) -> InputError {
    match error {
        VaryError::Scene(error) => error,
        VaryError::Key { parameter, problem } => {
            let parameters = &study.tables.parameter;
            let number = parameters.iter().position(|p| p.name == parameter);
            let at = format!("parameter.{}.keys", number.unwrap_or_default());
            study.document.error(&at, problem)
        }
    }
}

/// `from_s` and `operation` stand where they mean something.
fn demand_runnable(study: &Study, scene: &Subject) -> Result<(), InputError> {
    let told = match (scene.series_over(), scene) {
        (SeriesOver::Time, _) => "",
        (SeriesOver::Equilibria, _) => {
            "the scene's run is \"static\": its figures are those of all its equilibria"
        }
        (SeriesOver::OperatingPoints, _) => {
            "the scene's run is \"eigen\": its figures are those of all its operating points"
        }
        (SeriesOver::Speeds, _) => {
            "the scene's run is \"speed-sweep\": its figures are those of all its windows"
        }
        (SeriesOver::Nothing, Subject::Pair(_)) => "a gear pair is looked at at rest",
        (SeriesOver::Nothing, _) => "this is looked at at rest",
    };
    if study.tables.from_s > 0.0 && !told.is_empty() {
        let problem = format!("belongs to runs in time; {told}");
        return Err(study.document.error("from_s", problem));
    }
    Ok(())
}

/// Runs all cases, as many at a time as there are processors, and writes `study.csv` into the folder.
///
/// # Errors
/// [`StudyError`] for the study as a whole; that of a case stands with the case.
pub fn run_study(study: &Study, options: &StudyOptions<'_>) -> Result<StudyOutcome, StudyError> {
    let folder = options.folder;
    let scenes = StudyScenes::new(study, folder)?;
    let rest = RestCases::default();
    scenes.check_columns(study, &rest)?;
    make_folder(folder)?;
    let reduced = make_files(&scenes.files, options)?;
    let StudyScenes {
        cases,
        base,
        scenes,
        scene_of,
        ..
    } = scenes;
    let (done, count) = (AtomicUsize::new(0), scenes.len());
    let outcomes: Outcomes = scenes
        .into_par_iter()
        .map(|scene| {
            let outcome = run_case(study, scene, &rest, options);
            (options.progress)(done.fetch_add(1, Ordering::Relaxed) + 1, count);
            outcome
        })
        .collect();
    let over = base.series_over();
    finished(
        study,
        (cases, &scene_of),
        (outcomes, over),
        (folder, reduced),
    )
}

/// Puts the outcomes of the scenes beside the cases that led to them and writes the table; `reduced`: gears that were
/// reduced on the way.
pub(super) fn finished(
    study: &Study,
    (cases, scene_of): (Vec<Case>, &[usize]),
    (outcomes, series_over): (Outcomes, SeriesOver),
    (folder, reduced): (&Path, usize),
) -> Result<StudyOutcome, StudyError> {
    let stopped = outcomes.iter().any(|outcome| matches!(outcome, Ok(None)));
    let mut results = Vec::with_capacity(cases.len());
    for (case, place) in cases.into_iter().zip(scene_of) {
        let (file, figures, yielding) = match &outcomes[*place] {
            Ok(None) => continue,
            Ok(Some((file, found))) => {
                let Found { figures, yielding } = found.clone();
                (Some(file.clone()), figures, yielding)
            }
            Err(error) => (None, Err(error.to_string()), None),
        };
        results.push(CaseResult {
            case,
            file,
            figures,
            yielding,
        });
    }
    if !stopped {
        write_text(&folder.join("study.csv"), &table(study, &results))?;
    }
    Ok(StudyOutcome {
        cases: results,
        series_over,
        stopped,
        reduced,
    })
}

/// What became of the scenes: file and columns; none where the study was stopped before.
type Outcomes = Vec<Result<Option<(PathBuf, Found)>, StudyError>>;

/// What a study takes from the result of a case.
#[derive(Clone)]
pub(super) struct Found {
    /// The study's columns, or why the result does not give them.
    pub figures: Result<Vec<Selected>, String>,
    /// The column with the largest pressure, where steel yields under it; also where the study does not ask for it.
    pub yielding: Option<ColumnPressure>,
}

/// Runs a case unless it is there already; none if it was stopped.
fn run_case(
    study: &Study,
    subject: Subject,
    rest: &RestCases,
    options: &StudyOptions<'_>,
) -> Result<Option<(PathBuf, Found)>, StudyError> {
    if options.stop.load(Ordering::Relaxed) {
        return Ok(None);
    }
    match subject {
        Subject::System(scene) => {
            let scene: SystemScene = *scene;
            let file = system_cases::run_case(scene, options.folder, options.stop)?;
            let Some(file) = file else {
                return Ok(None);
            };
            let found = system_cases::found(study, &SystemResult::open(&file)?);
            Ok(Some((file, found)))
        }
        subject => {
            let (file, figures) = rest.figures_in(&subject, options.folder)?;
            Ok(Some((file, figures.found(study))))
        }
    }
}

pub(super) fn make_folder(path: &Path) -> Result<(), StudyError> {
    std::fs::create_dir_all(path).map_err(|source| StudyError::Folder {
        path: path.to_owned(),
        source,
    })
}

/// Makes what the cases need and what is not there yet; how many gears were reduced.
pub(crate) fn make_files(
    files: &MadeFiles,
    options: &StudyOptions<'_>,
) -> Result<usize, StudyError> {
    let mut reduced = 0;
    for (path, made) in files {
        // Named by what is in it: what is there is right.
        if path.exists() {
            continue;
        }
        make_folder(path.parent().unwrap_or(options.folder))?;
        match made {
            MadeFile::Text(text) => write_text(path, text)?,
            MadeFile::Model(gear) => {
                let model = (options.reduce)(gear).map_err(|problem| StudyError::Reduction {
                    gear: gear.name.clone(),
                    path: path.clone(),
                    problem,
                })?;
                write_reduced_gear(path, &model)?;
                reduced += 1;
            }
        }
    }
    Ok(reduced)
}
