//! What a setting of a scene gives, and what it takes.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

use gearmesh_geometry::{GearDefinition, InputError};
use gearmesh_model::{ReducedGear, write_text};
use gearmesh_specification::study::{Case, Setting};

use super::column_errors::ColumnErrors;
use super::default_columns::default_columns;
use super::effects::{Effect, of_scene};
use super::element_knob;
use super::knobs::{Knob, Rung, case_of_rung, of_bevel, of_pair};
use super::system_knobs::of_system;
use crate::model_shelf::ModelShelf;
use crate::pair::warnings::ColumnPressure;
use crate::study::{
    BaseScene, Effort, Evaluated, FigureKinds, MadeFile, MadeFiles, RestCases, Scratch, StudyError,
    StudyOptions, Subject, VaryError, Wanted, evaluate, known_columns, make_files, number,
    steady_meshes,
};

/// Runs of a setting at most.
const MOST_REPEATS: usize = 5;

/// Which time settings are judged by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum JudgedTime {
    /// Wall time: what a user waits.
    #[default]
    Wall,
    /// Processor time, which other work on the machine hardly changes.
    Processor,
}

impl JudgedTime {
    /// The time of an effort \[s\].
    #[must_use]
    pub fn of(self, effort: &Effort) -> f64 {
        match self {
            Self::Wall => effort.wall_s,
            Self::Processor => effort.cpu_s,
        }
    }

    /// In words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Wall => "wall time",
            Self::Processor => "processor time",
        }
    }
}

/// Meshes and reduces a gear.
pub type Reduce<'a> = &'a (dyn Fn(&GearDefinition) -> Result<ReducedGear, String> + Sync);

/// How a scene is tried.
pub struct BenchOptions<'a> {
    /// What is to be exact; where empty, what the model decides: in motion deviations, peaks and lines at mesh orders.
    pub wanted: Vec<Wanted>,
    /// Runs in time: figures from this time on \[s\].
    pub from_s: f64,
    /// Which time counts.
    pub time: JudgedTime,
    /// Short runs are repeated until they have taken so long \[s\], up to five times; the shortest counts.
    pub repeated_for_s: f64,
    /// Vary the gears' meshes, too: each rung reduces every gear.
    pub elements: bool,
    /// For results, and for models that are not kept; the caller removes it.
    pub scratch: &'a Path,
    /// Where models of other meshes are kept, by digest.
    pub models: &'a Path,
    /// Set from outside.
    pub stop: &'a AtomicBool,
    /// Makes models: this side never does it itself.
    pub reduce: Reduce<'a>,
}

/// What a setting gave.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// What it took.
    pub effort: Effort,
    /// The figures, column by column; of a gear pair each torque's.
    pub values: Vec<f64>,
    /// The column with the largest pressure, where steel yields under it; also where it is not judged.
    pub yielding: Option<ColumnPressure>,
    /// Wall time of reducing the gears that it needs and the scene does not name \[s\], once, also where they were kept
    /// from before.
    pub reduction_s: f64,
}

/// Runs a scene in other and other settings.
pub struct Bench<'a> {
    base: BaseScene,
    folder: PathBuf,
    rest: RestCases,
    scratch: Scratch<'a>,
    options: BenchOptions<'a>,
}

impl<'a> Bench<'a> {
    /// Reads a scene.
    ///
    /// # Errors
    /// [`StudyError`] for a scene that cannot be loaded, and for columns that it does not have.
    pub fn new(scene: &Path, options: BenchOptions<'a>) -> Result<Self, StudyError> {
        let mut this = Self {
            base: BaseScene::read(scene, std::iter::empty(), None)?,
            folder: scene.parent().unwrap_or(Path::new("")).to_owned(),
            rest: RestCases::default(),
            scratch: Scratch::new(options.scratch, options.stop),
            options,
        };
        let error = |problem: String| StudyError::Input(InputError::of_file("--columns", problem));
        let subject = this.subject(&Case::default(), &mut MadeFiles::new())?;
        if let Subject::Bearing(_) = subject {
            let problem = "is a bearing file, which has no knobs; allowed is a scene, in which bearings have models to choose from, or a bevel pair";
            return Err(this.refused(problem.to_owned()).into());
        }
        let (known, kinds) = known_columns(&subject, &this.rest)?;
        if this.options.wanted.is_empty() {
            let steady = match &subject {
                Subject::System(scene) => steady_meshes(scene, this.options.from_s)?,
                _ => Vec::new(),
            };
            this.options.wanted = default_columns(&known, kinds, &steady);
        }
        if this.options.wanted.is_empty() {
            let told = "none is named, and the scene has no teeth, gauges or bearings in motion, nor a pair of gears, whose columns would be judged; name what is to be exact";
            return Err(error(told.to_owned()));
        }
        for one in &this.options.wanted {
            one.check(&known, kinds).map_err(error)?;
            if kinds != FigureKinds::None && one.word.is_empty() {
                let name = one.name();
                let told = format!(
                    "`{name}` is a series; say what of it, written COLUMN:FIGURE: `{name}:mean`, `:peak-to-peak`, `:largest` and so on"
                );
                return Err(error(told));
            }
        }
        if this.options.from_s > 0.0 && kinds != FigureKinds::InTime {
            let told = "--from-s belongs to runs in time; this scene has none";
            return Err(error(told.to_owned()));
        }
        Ok(this)
    }

    /// The knobs of the scene with the rungs that it takes, and what was left out.
    ///
    /// # Errors
    /// [`StudyError`] for a scene that cannot be loaded.
    pub fn knobs(&self) -> Result<(Vec<Knob>, Vec<String>), StudyError> {
        let mut knobs = match self.subject(&Case::default(), &mut MadeFiles::new())? {
            Subject::Pair(scene) => of_pair(&self.rest.load(&scene)?),
            Subject::Bevel(pair) => of_bevel(&pair.file),
            Subject::System(_) => of_system(&self.base),
            Subject::Bearing(_) => Vec::new(),
        };
        let mut left_out = Vec::new();
        for knob in &mut knobs {
            let name = knob.name.clone();
            let refused = |rung: &Rung| self.try_load(&case_of_rung(rung)).err();
            knob.rungs.retain(|rung| {
                let told = refused(rung);
                if let Some(told) = &told {
                    left_out.push(format!("{name} = {}: {told}", rung.label));
                }
                told.is_none()
            });
            knob.further.retain(|rung| refused(rung).is_none());
        }
        if self.options.elements {
            // What each rung needs is reduced when it is run.
            match element_knob::of_gears(&self.base, &self.folder, &ModelShelf::default()) {
                Some(knob) => knobs.push(knob),
                None => left_out.push(
                    "gears' meshes: the scene has no reduced gears, or some with meshes that are not of hexahedra made here"
                        .to_owned(),
                ),
            }
        }
        knobs.retain(|knob| {
            if knob.rungs.len() < 2 {
                left_out.push(format!("{}: nothing to choose", knob.name));
            }
            knob.rungs.len() > 1
        });
        Ok((knobs, left_out))
    }

    /// The effects that the scene could do without, or have, and what was left out.
    pub(super) fn effects(&self) -> (Vec<Effect>, Vec<String>) {
        let mut left_out = Vec::new();
        let mut effects = of_scene(&self.base);
        effects.retain(|effect| {
            let loaded = self.try_load(&effect.case);
            if let Err(told) = &loaded {
                left_out.push(format!("{}: {told}", effect.name));
            }
            loaded.is_ok()
        });
        (effects, left_out)
    }

    /// A case whose run begins next to that of another one, its ρ∞ changed in the fourth digit; none where nothing is
    /// integrated in time.
    pub(super) fn beside(&self, case: &Case, number: usize) -> Option<Case> {
        self.base.value("solver")?;
        let key = "solver.rho_infinity";
        let stated = case.settings.iter().rev().find(|one| one.parameter == key);
        let stated = stated.and_then(|one| one.value.as_float())?;
        let off = 1e-4 * number as f64;
        let beside = stated + if stated > 0.5 { -off } else { off };
        let mut case = case.clone();
        case.settings.push(Setting::of(key, beside));
        Some(case)
    }

    /// Whether the user has asked to stop.
    pub(super) fn is_stopped(&self) -> bool {
        self.options.stop.load(Ordering::Relaxed)
    }

    /// The time that settings are judged by.
    #[must_use]
    pub fn time(&self) -> JudgedTime {
        self.options.time
    }

    /// Errors of values against a reference, column by column.
    pub(super) fn errors(&self, values: &[f64], reference: &[f64]) -> Vec<f64> {
        ColumnErrors::new(&self.options.wanted).of(values, reference)
    }

    /// What errors are relative to.
    pub(super) fn scales(&self, reference: &[f64]) -> Vec<f64> {
        ColumnErrors::new(&self.options.wanted).scales(reference)
    }

    /// Names of the figures, in the order of the values.
    pub(super) fn names(&self) -> Vec<String> {
        self.options.wanted.iter().map(Wanted::name).collect()
    }

    /// The name of a table of a list, for people.
    pub(super) fn name_of(&self, table: &str) -> String {
        match self.base.value(&format!("{table}.name")) {
            Some(toml::Value::String(name)) => format!(" \"{name}\""),
            _ => String::new(),
        }
    }

    /// Runs a case, short ones several times.
    ///
    /// # Errors
    /// [`StudyError`] for a case that cannot be run.
    pub fn measure(&self, case: &Case) -> Result<Measured, StudyError> {
        let time = |one: &Measured| self.options.time.of(&one.effort);
        let mut best = self.measure_once(case)?;
        let mut spent = best.effort.wall_s;
        for _ in 1..MOST_REPEATS {
            if spent >= self.options.repeated_for_s {
                break;
            }
            let again = self.measure_once(case)?;
            spent += again.effort.wall_s;
            if time(&again) < time(&best) {
                best = again;
            }
        }
        Ok(best)
    }

    /// Runs a case once.
    ///
    /// # Errors
    /// [`StudyError`] for a case that cannot be run, and one in which a column has no number at all: nothing could be
    /// judged by it.
    pub(super) fn measure_once(&self, case: &Case) -> Result<Measured, StudyError> {
        let mut files = MadeFiles::new();
        let subject = self.subject(case, &mut files)?;
        let reduction_s = self.make(files)?;
        let wanted = (&self.options.wanted[..], self.options.from_s);
        let Evaluated {
            selected,
            effort,
            yielding,
        } = evaluate(subject, wanted, &self.rest, &self.scratch)?;
        let columns = self.options.wanted.len();
        let of_column = |k: usize| selected.iter().skip(k).step_by(columns).map(number);
        let values: Vec<f64> = (0..columns).flat_map(of_column).collect();
        if let Some(empty) = without_number(&values, columns) {
            let name = self.options.wanted[empty].name();
            let problem = format!(
                "`{name}` is not a number here, so no setting can be judged by it; name other columns"
            );
            return Err(self.refused(problem).into());
        }
        Ok(Measured {
            effort,
            values,
            yielding,
            reduction_s,
        })
    }

    /// Makes the files of a case; how long the models among them took \[s\].
    fn make(&self, files: MadeFiles) -> Result<f64, StudyError> {
        let options = StudyOptions {
            folder: self.options.models,
            stop: self.options.stop,
            progress: &|_, _| (),
            reduce: self.options.reduce,
        };
        let mut seconds = 0.0;
        for (path, file) in files {
            let is_model = matches!(file, MadeFile::Model(_));
            let there = path.exists();
            let clock = Instant::now();
            make_files(&MadeFiles::from([(path.clone(), file)]), &options)?;
            if is_model {
                // Beside the model, for the next time.
                let kept = path.with_extension("seconds");
                if !there {
                    write_text(&kept, &clock.elapsed().as_secs_f64().to_string())?;
                }
                let told = std::fs::read_to_string(&kept).ok();
                seconds += told.and_then(|text| text.parse().ok()).unwrap_or(0.0);
            }
        }
        Ok(seconds)
    }

    pub(super) fn refused(&self, problem: String) -> InputError {
        InputError::of_file(self.base.file(), problem)
    }

    /// What runs in the scene: the kind of a multibody run, `pair at rest` or `tooth contact`.
    #[must_use]
    pub fn kind(&self) -> String {
        match (self.base.value("run.kind"), self.base.value("run")) {
            (Some(toml::Value::String(kind)), _) => kind,
            (_, Some(_)) => "pair at rest".to_owned(),
            (_, None) => "tooth contact".to_owned(),
        }
    }

    /// The scene with a case's settings.
    ///
    /// # Errors
    /// [`StudyError`] where it does not take them.
    pub(super) fn subject_of(&self, case: &Case) -> Result<Subject, StudyError> {
        Ok(self.subject(case, &mut MadeFiles::new())?)
    }

    fn subject(&self, case: &Case, files: &mut MadeFiles) -> Result<Subject, InputError> {
        let scene = self.base.scene(case, files, self.options.models);
        scene.map_err(|error| match error {
            VaryError::Scene(error) => error,
            VaryError::Key { problem, .. } => self.refused(problem),
        })
    }

    /// Loads a case and looks for the columns in it.
    fn try_load(&self, case: &Case) -> Result<(), String> {
        let subject = self
            .subject(case, &mut MadeFiles::new())
            .map_err(|e| e.problem)?;
        if let Subject::Pair(scene) = &subject {
            let loaded = self.rest.load(scene).map_err(|e| e.to_string())?;
            loaded.contact().map_err(|e| e.to_string())?;
        }
        let known = known_columns(&subject, &self.rest).map_err(|e| e.to_string())?;
        let wanted = self.options.wanted.iter();
        let mut lost = wanted.filter(|one| one.check(&known.0, known.1).is_err());
        match lost.next() {
            Some(one) => Err(format!("has no column `{}`", one.column)),
            None => Ok(()),
        }
    }
}

/// The first column that has no number, of values column by column.
fn without_number(values: &[f64], columns: usize) -> Option<usize> {
    let each = (values.len() / columns.max(1)).max(1);
    let mut of_columns = values.chunks(each);
    of_columns.position(|column| !column.iter().any(|value| value.is_finite()))
}

#[cfg(test)]
mod tests {
    use super::without_number;

    #[test]
    fn a_column_without_any_number_is_found() {
        let gap = f64::NAN;
        assert_eq!(without_number(&[1.0, gap, 2.0, 3.0], 2), None);
        assert_eq!(without_number(&[1.0, 2.0, gap, f64::INFINITY], 2), Some(1));
        assert_eq!(without_number(&[], 2), None);
    }
}
