//! Running the cases of a study and reading their figures.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Duration;

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::InputDocument;
use gearmesh_model::{FileError, write_text};
use rayon::prelude::*;

use super::study_file::{Case, Study};
use super::varied_scene::varied;
use crate::system::{Run, SystemScene};
use crate::system_run::{
    ColumnStatistics, Figures, Outcome, RunJob, RunOptions, SystemResult, SystemRunError, run,
};

/// Wall time between checkpoints of a case.
const CHECKPOINTS: Duration = Duration::from_secs(60);

/// Wall time between two looks at a case that another study has in hand.
const WAITING: Duration = Duration::from_millis(200);

/// Digits of the digest in a file's name.
const NAME_DIGITS: usize = 16;

/// Why a study could not be run.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// The study or a scene that it makes.
    #[error(transparent)]
    Input(#[from] InputError),
    /// A case that is not the input's fault.
    #[error(transparent)]
    Run(#[from] SystemRunError),
    /// The table could not be written.
    #[error(transparent)]
    File(#[from] FileError),
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
            Self::File(_) | Self::Folder { .. } => false,
        }
    }
}

/// Figures of one column over the time that the study looks at.
#[derive(Debug, Clone, PartialEq)]
pub struct Selected {
    /// Name with unit.
    pub column: String,
    /// Unit.
    pub unit: String,
    /// Mean, deviation, extremes.
    pub figures: Figures,
}

/// A case and what came out.
#[derive(Debug)]
pub struct CaseResult {
    /// What was changed.
    pub case: Case,
    /// Its result file; none if the run failed.
    pub file: Option<PathBuf>,
    /// Figures of the study's columns, or why there are none: a case that fails does not end the study.
    pub figures: Result<Vec<Selected>, String>,
}

/// A study that was run.
#[derive(Debug)]
pub struct StudyOutcome {
    /// The cases, in the order of the study; less where it was stopped.
    pub cases: Vec<CaseResult>,
    /// Stopped on demand; the same command goes on.
    pub stopped: bool,
}

/// The scenes that the cases of a study come to.
pub struct StudyScenes {
    /// The cases.
    pub cases: Vec<Case>,
    /// The scenes, each once.
    pub scenes: Vec<SystemScene>,
    /// Scene of each case.
    scene_of: Vec<usize>,
}

impl StudyScenes {
    /// Makes the scenes of all cases: a wrong key is told before the first run, not after it.
    ///
    /// # Errors
    /// [`InputError`] for the first scene that is wrong.
    pub fn new(study: &Study) -> Result<Self, InputError> {
        let path = study.folder.join(&study.tables.scene);
        let scene = InputDocument::read(&path)?;
        let scene_folder = path.parent().unwrap_or(Path::new(""));
        let cases = study.cases();
        let mut scenes: Vec<SystemScene> = Vec::new();
        let mut scene_of = Vec::with_capacity(cases.len());
        for case in &cases {
            let made = varied(study, &scene, case, scene_folder)?;
            match made.run {
                Run::Transient { .. } => {}
                Run::Static { .. } if study.tables.from_s == 0.0 => {}
                Run::Static { .. } => {
                    return Err(study.document.error(
                        "from_s",
                        "belongs to runs in time; the scene's run is \"static\": its figures are those of all its equilibria",
                    ));
                }
                _ => {
                    let problem = "must be \"transient\" or \"static\" in the scene of a study";
                    return Err(made.document.error("run.kind", problem));
                }
            }
            let same = |other: &SystemScene| other.document.text == made.document.text;
            let place = scenes.iter().position(same).unwrap_or(scenes.len());
            if place == scenes.len() {
                scenes.push(made);
            }
            scene_of.push(place);
        }
        Ok(Self {
            cases,
            scenes,
            scene_of,
        })
    }
}

/// Runs all cases, as many at a time as there are processors, and writes `study.csv` into the folder. `progress` is
/// told how many of how many are done.
///
/// # Errors
/// [`StudyError`] for the study as a whole; that of a case stands with the case.
pub fn run_study(
    study: &Study,
    folder: &Path,
    stop: &AtomicBool,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<StudyOutcome, StudyError> {
    let StudyScenes {
        cases,
        scenes,
        scene_of,
    } = StudyScenes::new(study)?;
    std::fs::create_dir_all(folder).map_err(|source| StudyError::Folder {
        path: folder.to_owned(),
        source,
    })?;
    let (done, count) = (AtomicUsize::new(0), scenes.len());
    let outcomes: Vec<Result<Option<PathBuf>, StudyError>> = scenes
        .into_par_iter()
        .map(|scene| {
            let outcome = run_case(scene, folder, stop);
            progress(done.fetch_add(1, Ordering::Relaxed) + 1, count);
            outcome
        })
        .collect();
    let stopped = outcomes.iter().any(|outcome| matches!(outcome, Ok(None)));
    let mut results = Vec::with_capacity(cases.len());
    for (case, place) in cases.into_iter().zip(scene_of) {
        let (file, figures) = match &outcomes[place] {
            Ok(None) => continue,
            Ok(Some(file)) => (Some(file.clone()), selected(study, file)),
            Err(error) => (None, Err(error.to_string())),
        };
        results.push(CaseResult {
            case,
            file,
            figures,
        });
    }
    if !stopped {
        write_text(&folder.join("study.csv"), &table(study, &results))?;
    }
    Ok(StudyOutcome {
        cases: results,
        stopped,
    })
}

/// Runs a case, or waits for the other study in the same folder that is at it; none if it was stopped.
fn run_case(
    scene: SystemScene,
    folder: &Path,
    stop: &AtomicBool,
) -> Result<Option<PathBuf>, StudyError> {
    loop {
        match run_unless_there(scene.clone(), folder, stop) {
            Err(StudyError::Run(SystemRunError::File(FileError::InUse { .. }))) => {
                std::thread::sleep(WAITING);
            }
            outcome => return outcome,
        }
    }
}

/// Runs a case unless its result is there already; none if it was stopped.
fn run_unless_there(
    scene: SystemScene,
    folder: &Path,
    stop: &AtomicBool,
) -> Result<Option<PathBuf>, StudyError> {
    if stop.load(Ordering::Relaxed) {
        return Ok(None);
    }
    let job = RunJob::from_scene(scene.load()?)?;
    let identity = job.head.identity();
    let name: String = identity.chars().take(NAME_DIGITS).collect();
    let file = folder.join(format!("{name}.h5"));
    if SystemResult::open(&file).is_ok_and(|result| result.head.identity() == identity) {
        return Ok(Some(file));
    }
    let options = RunOptions {
        output: &file,
        restart: false,
        checkpoint_interval: CHECKPOINTS,
        stop,
        progress: &|_| (),
    };
    match run(job, &options)? {
        Outcome::Finished => Ok(Some(file)),
        Outcome::Stopped => Ok(None),
    }
}

/// Figures of the study's columns over its time, or what keeps them from being read.
fn selected(study: &Study, file: &Path) -> Result<Vec<Selected>, String> {
    let say = |error: FileError| error.to_string();
    let result = SystemResult::open(file).map_err(say)?;
    if let Some(problem) = result.problem() {
        return Err(problem);
    }
    let mut first = 0;
    // Equilibria have no time.
    if study.tables.from_s > 0.0 {
        let times = result.rows.read("time_s").map_err(say)?;
        // Half a step of the clock's rounding belongs to the first row.
        first = times.partition_point(|time| *time < study.tables.from_s * (1.0 - 1e-12));
        if first == times.len() {
            return Err(format!(
                "from_s = {} is after the end of the run at {} s",
                study.tables.from_s,
                times.last().copied().unwrap_or_default()
            ));
        }
    }
    let figures = |name: &String| {
        let mut columns = result.rows.columns().iter();
        let Some(column) = columns.find(|column| column.name == *name) else {
            let known: Vec<&str> = result.rows.columns().iter().map(|c| &c.name[..]).collect();
            return Err(format!(
                "the result has no column `{name}`; it has {}",
                known.join(", ")
            ));
        };
        let values = result.rows.read(name).map_err(say)?;
        let mut statistics = ColumnStatistics::new(1);
        values[first..]
            .iter()
            .for_each(|value| statistics.add(&[*value]));
        Ok(Selected {
            column: name.clone(),
            unit: column.unit.clone(),
            figures: statistics.figures()[0],
        })
    };
    study.tables.columns.iter().map(figures).collect()
}

/// `study.csv`: a line for each case and column.
fn table(study: &Study, results: &[CaseResult]) -> String {
    let parameters = study
        .tables
        .parameter
        .iter()
        .map(|parameter| &parameter.name[..]);
    let mut head: Vec<String> = parameters.clone().map(quoted).collect();
    let figures = [
        "column",
        "mean",
        "deviation",
        "least",
        "largest",
        "file",
        "failure",
    ];
    head.extend(figures.map(str::to_owned));
    let mut text = head.join(",") + "\n";
    for result in results {
        let setting = |name: &str| {
            let mut settings = result.case.settings.iter();
            let found = settings.find(|setting| setting.parameter == name);
            found.map_or_else(String::new, |setting| match &setting.value {
                toml::Value::String(word) => quoted(word),
                value => value.to_string(),
            })
        };
        let settings: String = parameters.clone().map(|name| setting(name) + ",").collect();
        let file = result.file.as_deref().and_then(Path::file_name);
        let file = file.map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        match &result.figures {
            Ok(columns) => {
                for Selected {
                    column, figures, ..
                } in columns
                {
                    let [mean, deviation] = [figures.mean, figures.deviation];
                    let [least, largest] = [figures.least, figures.largest];
                    let column = quoted(column);
                    text += &format!(
                        "{settings}{column},{mean:e},{deviation:e},{least:e},{largest:e},{file},\n"
                    );
                }
            }
            Err(problem) => text += &format!("{settings},,,,,{file},{}\n", quoted(problem)),
        }
    }
    text
}

/// A text as a cell of a comma separated file.
fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}
