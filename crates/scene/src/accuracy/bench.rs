//! What a setting of a scene gives, and how long it takes.

use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use gearmesh_geometry::InputError;

use super::knobs::{Knob, case_of, of_pair, of_system};
use crate::pair::{SceneResult, run as run_pair};
use crate::scene_file::SceneFile;
use crate::study::{
    BaseScene, Case, MadeFiles, PairCases, StudyError, VaryError, column_names, column_place,
    columns,
};
use crate::system::unknown;
use crate::system_run::{
    Figures, Outcome, RunJob, RunOptions, SystemResult, recorded_columns, run as run_system,
};

/// Short runs are repeated until they have taken so long, at most this many times; the shortest counts.
const REPEATED_FOR: Duration = Duration::from_millis(200);
const MOST_REPEATS: usize = 5;

/// Multibody runs write a checkpoint after this time.
const CHECKPOINTS: Duration = Duration::from_secs(600);

/// A figure that the user wants: a column, and of a multibody run what of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Wanted {
    /// The column.
    pub column: String,
    /// `mean`, `deviation`, `peak-to-peak`, `largest`, `least`; empty for columns of a gear pair.
    pub figure: String,
}

/// What may stand behind the column of a multibody run.
const FIGURES: [&str; 5] = ["mean", "deviation", "peak-to-peak", "largest", "least"];

impl Wanted {
    /// `COLUMN` or `COLUMN:FIGURE`.
    #[must_use]
    pub fn of(text: &str) -> Self {
        let (column, figure) = text.rsplit_once(':').unwrap_or((text, ""));
        Self {
            column: column.to_owned(),
            figure: figure.to_owned(),
        }
    }

    /// As it was written.
    #[must_use]
    pub fn name(&self) -> String {
        if self.figure.is_empty() {
            return self.column.clone();
        }
        format!("{}:{}", self.column, self.figure)
    }

    fn value(&self, figures: Figures) -> f64 {
        match &self.figure[..] {
            "mean" => figures.mean,
            "deviation" => figures.deviation,
            "largest" => figures.largest,
            "least" => figures.least,
            _ => figures.peak_to_peak(),
        }
    }
}

/// What a setting gave.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// Wall time of the computation; reading models and writing files is not in it \[s\].
    pub seconds: f64,
    /// Iterations: of the contact at all positions, or of the integrator's steps.
    pub iterations: f64,
    /// The figures; of a gear pair each torque's, column by column.
    pub values: Vec<f64>,
}

/// Runs a scene in other and other settings.
pub struct Bench<'a> {
    base: BaseScene,
    pairs: PairCases,
    wanted: Vec<Wanted>,
    /// Multibody runs: figures from this time on \[s\].
    from_s: f64,
    /// For results of multibody runs; the caller removes it.
    scratch: &'a Path,
    stop: &'a AtomicBool,
}

impl<'a> Bench<'a> {
    /// Reads a scene.
    ///
    /// # Errors
    /// [`StudyError`] for a scene that cannot be loaded, and for columns that it does not have.
    pub fn new(
        scene: &Path,
        wanted: Vec<Wanted>,
        (from_s, scratch, stop): (f64, &'a Path, &'a AtomicBool),
    ) -> Result<Self, StudyError> {
        let this = Self {
            base: BaseScene::read(scene, std::iter::empty())?,
            pairs: PairCases::default(),
            wanted,
            from_s,
            scratch,
            stop,
        };
        let error = |problem: String| InputError {
            file: "--columns".to_owned(),
            line: None,
            key: String::new(),
            problem,
        };
        match this.scene(&Case::default())? {
            SceneFile::Pair(scene) => {
                let known = column_names(&this.pairs.load(&scene)?);
                for one in &this.wanted {
                    column_place(&one.name(), &known).map_err(error)?;
                }
                if from_s > 0.0 {
                    return Err(error(
                        "--from-s belongs to runs in time; a gear pair is looked at at rest"
                            .to_owned(),
                    )
                    .into());
                }
            }
            SceneFile::System(scene) => {
                let job = RunJob::from_scene(scene.load()?)?;
                let known: Vec<String> =
                    recorded_columns(&job).into_iter().map(|c| c.name).collect();
                for one in &this.wanted {
                    column_place(&one.column, &known).map_err(error)?;
                    if !FIGURES.contains(&&one.figure[..]) {
                        let what = format!("figure of {}, written COLUMN:FIGURE,", one.column);
                        return Err(error(unknown(&what, &one.figure, &FIGURES)).into());
                    }
                }
            }
        }
        Ok(this)
    }

    /// The knobs of the scene with the rungs that it takes, and what was left out.
    ///
    /// # Errors
    /// [`StudyError`] for a scene that cannot be loaded.
    pub fn knobs(&self) -> Result<(Vec<Knob>, Vec<String>), StudyError> {
        let mut knobs = match self.scene(&Case::default())? {
            SceneFile::Pair(scene) => of_pair(&self.pairs.load(&scene)?),
            SceneFile::System(_) => of_system(&self.base),
        };
        let mut left_out = Vec::new();
        for knob in &mut knobs {
            let name = knob.name.clone();
            knob.rungs.retain(|rung| {
                let alone = Knob {
                    name: name.clone(),
                    rungs: vec![rung.clone()],
                };
                let loaded = self.try_load(&case_of(&[alone], &[0]));
                if let Err(told) = &loaded {
                    left_out.push(format!("{name} = {}: {told}", rung.label));
                }
                loaded.is_ok()
            });
        }
        knobs.retain(|knob| {
            if knob.rungs.len() < 2 {
                left_out.push(format!("{}: nothing to choose", knob.name));
            }
            knob.rungs.len() > 1
        });
        Ok((knobs, left_out))
    }

    /// Whether the user has asked to stop.
    pub(super) fn is_stopped(&self) -> bool {
        self.stop.load(std::sync::atomic::Ordering::Relaxed)
    }

    /// Names of the figures, in the order of the values.
    pub(super) fn names(&self) -> Vec<String> {
        self.wanted.iter().map(Wanted::name).collect()
    }

    /// Runs a case, short ones several times.
    ///
    /// # Errors
    /// [`StudyError`] for a case that cannot be run.
    pub fn measure(&self, case: &Case) -> Result<Measured, StudyError> {
        let mut best = self.measure_once(case)?;
        let mut spent = best.seconds;
        for _ in 1..MOST_REPEATS {
            if spent > REPEATED_FOR.as_secs_f64() {
                break;
            }
            let again = self.measure_once(case)?;
            spent += again.seconds;
            if again.seconds < best.seconds {
                best = again;
            }
        }
        Ok(best)
    }

    fn measure_once(&self, case: &Case) -> Result<Measured, StudyError> {
        match self.scene(case)? {
            SceneFile::Pair(scene) => {
                let loaded = self.pairs.load(&scene)?;
                let clock = Instant::now();
                let result: SceneResult = run_pair(&loaded, &|_, _| ())?;
                let seconds = clock.elapsed().as_secs_f64();
                let all = columns(&loaded, &result);
                let own = |one: &Wanted| all.iter().find(|column| column.name == one.name());
                Ok(Measured {
                    seconds,
                    iterations: result.iterations.iter().map(|n| f64::from(*n)).sum(),
                    values: self
                        .wanted
                        .iter()
                        .filter_map(own)
                        .flat_map(|c| c.values.clone())
                        .collect(),
                })
            }
            SceneFile::System(scene) => {
                let job = RunJob::from_scene(scene.load()?)?;
                let file = self.scratch.join("run.h5");
                let options = RunOptions {
                    output: &file,
                    restart: true,
                    checkpoint_interval: CHECKPOINTS,
                    stop: self.stop,
                    progress: &|_| (),
                };
                let clock = Instant::now();
                let outcome = run_system(job, &options)?;
                let seconds = clock.elapsed().as_secs_f64();
                if outcome == Outcome::Stopped {
                    return Err(StudyError::Stopped);
                }
                let result = SystemResult::open(&file)?;
                let times = match self.from_s > 0.0 {
                    true => result.rows.read("time_s")?,
                    false => Vec::new(),
                };
                let first = times.partition_point(|time| *time < self.from_s * (1.0 - 1e-12));
                let value = |one: &Wanted| {
                    let values = result.rows.read(&one.column)?;
                    Ok(one.value(Figures::of(&values[first.min(values.len())..])))
                };
                Ok(Measured {
                    seconds,
                    iterations: result
                        .record
                        .as_ref()
                        .map_or(0.0, |record| record.iterations),
                    values: self
                        .wanted
                        .iter()
                        .map(value)
                        .collect::<Result<_, StudyError>>()?,
                })
            }
        }
    }

    fn refused(&self, problem: String) -> InputError {
        InputError {
            file: self.base.file().to_owned(),
            line: None,
            key: String::new(),
            problem,
        }
    }

    fn scene(&self, case: &Case) -> Result<SceneFile, InputError> {
        let scene = self.base.scene(case, &mut MadeFiles::new(), Path::new(""));
        scene.map_err(|error| match error {
            VaryError::Scene(error) => error,
            VaryError::Key { problem, .. } => self.refused(problem),
        })
    }

    fn try_load(&self, case: &Case) -> Result<(), String> {
        match self.scene(case).map_err(|e| e.problem)? {
            SceneFile::Pair(scene) => {
                let loaded = self.pairs.load(&scene).map_err(|e| e.to_string())?;
                loaded.contact().map(|_| ()).map_err(|e| e.to_string())
            }
            SceneFile::System(scene) => {
                let loaded = scene.load().map_err(|e| e.to_string())?;
                RunJob::from_scene(loaded)
                    .map(|_| ())
                    .map_err(|e| e.to_string())
            }
        }
    }
}
