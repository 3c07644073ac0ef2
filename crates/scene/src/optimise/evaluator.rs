//! What a choice of the variables is worth: the objectives of what scatter makes of it.

use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::fs::create_dir_all;
use std::sync::{Mutex, PoisonError};

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::TableKeys;
use gearmesh_model::write_text;
use gearmesh_specification::optimise::{Judged, Optimisation, TermTable};
use gearmesh_specification::study::{Case, Design, Setting, probabilities, seeded};
use gearmesh_specification::system::run::Run;
use rayon::prelude::*;

use crate::pair::warnings::{ColumnPressure, yielding};
use crate::study::{
    BaseScene, FigureKinds, MadeFile, MadeFiles, RestCases, Scratch, StudyError, Subject,
    VaryError, Wanted, evaluate, is_without_load, known_columns, number, result_size,
};
use crate::system_run::demand_result_size;

/// A choice of the variables that was tried.
#[derive(Debug, Clone, PartialEq)]
pub struct Trial {
    /// Values of the variables, in their units.
    pub values: Vec<f64>,
    /// The objectives.
    pub objectives: Vec<f64>,
    /// The column with the largest pressure, where steel yields under it; also where no objective asks for it.
    pub yielding: Option<ColumnPressure>,
}

/// A term, looked up: place of its column among those that are wanted, place of its torque (all of them where none),
/// weight.
type Term = (usize, Option<usize>, f64);

/// The wanted columns, a row for each torque, and the column under whose pressure steel yields.
type Rows = (Vec<Vec<f64>>, Option<ColumnPressure>);

/// Tells what choices of the variables are worth. Threads may share it.
#[derive(Debug)]
pub struct Evaluator<'a> {
    base: BaseScene,
    rest: RestCases,
    scratch: Scratch<'a>,
    /// Columns of all terms.
    wanted: Vec<Wanted>,
    /// Runs in time: figures from this time on \[s\].
    from_s: f64,
    /// Keys that each variable sets.
    keys: Vec<Vec<String>>,
    /// What is added to which key, for each sample.
    samples: Vec<Vec<(String, f64)>>,
    judged: Judged,
    terms: Vec<Vec<Term>>,
    tried: Mutex<Vec<Trial>>,
    failed: Mutex<Option<String>>,
}

impl<'a> Evaluator<'a> {
    /// Reads scene and models, and finds the columns. Runs of multibody scenes write in `scratch`.
    ///
    /// # Errors
    /// [`StudyError`] for keys, columns and torques that the scene does not have.
    pub fn new(problem: &Optimisation, scratch: Scratch<'a>) -> Result<Self, StudyError> {
        let tables = &problem.tables;
        let all_keys = (tables.variable.iter().map(|v| &v.keys))
            .chain(tables.scatter.iter().map(|s| &s.keys))
            .flatten();
        let path = problem.folder.join(&tables.scene);
        let operation = tables.operation.as_ref();
        let base = BaseScene::read(&path, all_keys.map(String::as_str), operation)?;
        let mut this = Self {
            base,
            rest: RestCases::default(),
            scratch,
            wanted: Vec::new(),
            from_s: tables.from_s,
            keys: tables.variable.iter().map(|v| v.keys.clone()).collect(),
            samples: samples(problem),
            judged: tables.judged_by.unwrap_or_default(),
            terms: Vec::new(),
            tried: Mutex::new(Vec::new()),
            failed: Mutex::new(None),
        };
        let scene = this.middle(problem)?;
        let torques = match &scene {
            Subject::Pair(scene) => scene.torques_nm.clone(),
            Subject::Bevel(pair) => pair
                .file
                .load
                .as_ref()
                .map_or_else(Vec::new, |load| load.torques_nm.clone()),
            _ => Vec::new(),
        };
        if tables.from_s > 0.0 && !is_in_time(&scene) {
            let told = "belongs to a multibody scene whose run is \"transient\"; remove it";
            return Err(problem.document.error("from_s", told).into());
        }
        if let Some(size) = result_size(&scene)? {
            let sized = ("the result of each trial", size.bytes());
            demand_result_size((&problem.document, ""), sized, problem.most_result_bytes)?;
        }
        let (known, kinds) = known_columns(&scene, &this.rest)?;
        for (i, objective) in tables.objective.iter().enumerate() {
            let mut terms = Vec::new();
            for (j, term) in objective.term.iter().enumerate() {
                let table = format!("objective.{i}.term.{j}");
                let keys = TableKeys::new(&problem.document, &table);
                let wanted = wanted_column(&keys, term, (&known, kinds))?;
                let torque = torque_of(&keys, term, (&scene, &torques), &wanted)?;
                let column = match this.wanted.iter().position(|one| *one == wanted) {
                    Some(place) => place,
                    None => {
                        this.wanted.push(wanted);
                        this.wanted.len() - 1
                    }
                };
                terms.push((column, torque, term.weight));
            }
            this.terms.push(terms);
        }
        Ok(this)
    }

    /// The scene in the middle of all bounds, which is a sound one, or the file is at fault.
    fn middle(&self, problem: &Optimisation) -> Result<Subject, InputError> {
        let tables = &problem.tables;
        let middle = tables.variable.iter().map(|v| 0.5 * (v.from + v.to));
        let scene = self.scene(&middle.collect::<Vec<f64>>(), 0);
        scene.map_err(|error| match error {
            VaryError::Scene(error) => error,
            VaryError::Key {
                parameter,
                problem: told,
            } => {
                // A setting is named by its key.
                let has = |keys: &Vec<String>| keys.contains(&parameter);
                let at = match tables.variable.iter().position(|v| has(&v.keys)) {
                    Some(i) => format!("variable.{i}.keys"),
                    None => {
                        let scatter = tables.scatter.iter().position(|s| has(&s.keys));
                        format!("scatter.{}.keys", scatter.unwrap_or_default())
                    }
                };
                problem.document.error(&at, told)
            }
        })
    }

    /// Number of objectives.
    #[must_use]
    pub fn objectives(&self) -> usize {
        self.terms.len()
    }

    /// The objectives of a choice; none where one of its pairs cannot be computed.
    #[must_use]
    pub fn objectives_of(&self, values: &[f64]) -> Option<Vec<f64>> {
        match self.judged(values) {
            Ok(trial) => {
                let objectives = trial.objectives.clone();
                let mut tried = self.tried.lock().unwrap_or_else(PoisonError::into_inner);
                tried.push(trial);
                Some(objectives)
            }
            Err(told) => {
                let mut failed = self.failed.lock().unwrap_or_else(PoisonError::into_inner);
                failed.get_or_insert(told);
                None
            }
        }
    }

    /// The objectives of the scene as it is, under the same scatter; none where it cannot be computed.
    #[must_use]
    pub fn as_it_is(&self) -> Option<Trial> {
        // Without values no key is set but by scatter.
        self.judged(&[]).ok()
    }

    fn judged(&self, values: &[f64]) -> Result<Trial, String> {
        let of_sample = |sample: usize| {
            let (rows, yielding) = self.rows(values, sample)?;
            Ok((self.added_up(&rows), yielding))
        };
        let (each, pressures): (Vec<Vec<f64>>, Vec<Option<ColumnPressure>>) =
            (0..self.samples.len())
                .into_par_iter()
                .map(of_sample)
                .collect::<Result<Vec<_>, String>>()?
                .into_iter()
                .unzip();
        let judged = |k: usize| {
            let own = each.iter().map(|sample| sample[k]);
            match self.judged {
                Judged::Mean => own.sum::<f64>() / each.len() as f64,
                Judged::Worst => own.fold(f64::NEG_INFINITY, f64::max),
            }
        };
        Ok(Trial {
            values: values.to_vec(),
            objectives: (0..self.terms.len()).map(judged).collect(),
            yielding: yielding(pressures.into_iter().flatten()),
        })
    }

    /// All choices that were tried, in an order that does not depend on the threads.
    #[must_use]
    pub fn tried(&self) -> Vec<Trial> {
        let mut tried = self
            .tried
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone();
        tried.sort_by(|a, b| in_order(&a.values, &b.values));
        tried.dedup();
        tried
    }

    /// Why the first choice that failed did.
    #[must_use]
    pub fn failure(&self) -> Option<String> {
        self.failed
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone()
    }

    /// The objectives of rows of columns, a row for each torque.
    fn added_up(&self, rows: &[Vec<f64>]) -> Vec<f64> {
        let term = |&(column, torque, weight): &Term| {
            let value = match torque {
                Some(torque) => rows[torque][column],
                None => rows.iter().map(|row| row[column]).sum::<f64>() / rows.len() as f64,
            };
            weight * value
        };
        self.terms
            .iter()
            .map(|terms| terms.iter().map(term).sum())
            .collect()
    }

    fn rows(&self, values: &[f64], sample: usize) -> Result<Rows, String> {
        let subject = match self.scene(values, sample) {
            Ok(subject) => subject,
            Err(VaryError::Scene(error)) => return Err(error.to_string()),
            Err(VaryError::Key { problem, .. }) => return Err(problem),
        };
        let wanted = (&self.wanted[..], self.from_s);
        let found = evaluate(subject, wanted, &self.rest, &self.scratch);
        let found = found.map_err(|error| error.to_string())?;
        let rows = found.selected.chunks(self.wanted.len());
        let rows = rows.map(|row| row.iter().map(number).collect());
        Ok((rows.collect(), found.yielding))
    }

    /// The scene of a choice, as a sample of the workshop has it.
    fn scene(&self, values: &[f64], sample: usize) -> Result<Subject, VaryError> {
        let mut at: BTreeMap<&str, f64> = BTreeMap::new();
        for (keys, value) in self.keys.iter().zip(values) {
            at.extend(keys.iter().map(|key| (&key[..], *value)));
        }
        for (key, added) in &self.samples[sample] {
            let stated = || match self.base.stated(key) {
                Some(toml::Value::Float(value)) => value,
                Some(toml::Value::Integer(value)) => value as f64,
                _ => 0.0,
            };
            *at.entry(key).or_insert_with(stated) += added;
        }
        let settings = at.into_iter().map(|(key, value)| Setting::of(key, value));
        let case = Case::of(settings.collect());
        let mut files = MadeFiles::new();
        let subject = self.base.scene(&case, &mut files, self.scratch.folder())?;
        self.write(&files, &case)?;
        Ok(subject)
    }

    /// Writes the changed copies of files that a choice names. A gear is not reduced anew for a choice.
    fn write(&self, files: &MadeFiles, case: &Case) -> Result<(), VaryError> {
        for (path, made) in files {
            let MadeFile::Text(text) = made else {
                return Err(self.of_model(case));
            };
            let unwritten =
                |told: String| VaryError::Scene(InputError::of_file(path.display(), told));
            // Named by what is in it: what is there is right.
            if path.exists() {
                continue;
            }
            if let Some(folder) = path.parent() {
                create_dir_all(folder).map_err(|cause| unwritten(cause.to_string()))?;
            }
            write_text(path, text).map_err(|cause| unwritten(cause.to_string()))?;
        }
        Ok(())
    }

    /// Complains of the key that would change a reduced gear.
    fn of_model(&self, case: &Case) -> VaryError {
        let of_model = |setting: &&Setting| self.base.is_of_model(&setting.parameter);
        let key = case.settings.iter().find(of_model);
        let key = key.map_or_else(String::new, |setting| setting.parameter.clone());
        VaryError::Key {
            problem: format!(
                "`{key}` is a key of the gear inside a reduced model, which each choice would reduce anew; a study reduces it once for each of its values"
            ),
            parameter: key,
        }
    }
}

/// The column of a term, which must be a number of the scene.
fn wanted_column(
    keys: &TableKeys,
    term: &TermTable,
    (known, kinds): (&[String], FigureKinds),
) -> Result<Wanted, InputError> {
    let wanted = Wanted::of(&term.column);
    let mut checked = wanted.check(known, kinds);
    if kinds != FigureKinds::None && wanted.word.is_empty() && checked.is_ok() {
        checked = Err(format!(
            "`{}` is a series; say which number of it is to be small: `{}:largest`, `:mean`, `:peak-to-peak` and so on",
            term.column, term.column
        ));
    }
    checked.map_err(|told| keys.error("column", told))?;
    Ok(wanted)
}

/// Place of a term's torque among those of the scene; none where it says none.
fn torque_of(
    keys: &TableKeys,
    term: &TermTable,
    (scene, torques): (&Subject, &[f64]),
    wanted: &Wanted,
) -> Result<Option<usize>, InputError> {
    let Some(torque) = term.torque_Nm else {
        return Ok(None);
    };
    let found = torques.iter().position(|known| *known == torque);
    if found.is_none() {
        let told = match torques.is_empty() {
            true => "belongs to gear pairs, and to bevel pairs with [load]; remove it".to_owned(),
            false => format!("found {torque}, the scene has {torques:?}"),
        };
        return Err(keys.error("torque_Nm", told));
    }
    if matches!(scene, Subject::Bevel(_)) && is_without_load(&wanted.column) {
        let told = format!(
            "`{}` is a number without load, the same at every torque; remove this key, or name a column under load, as `loaded_te_peak_to_peak_urad`",
            term.column
        );
        return Err(keys.error("torque_Nm", told));
    }
    Ok(found)
}

/// Compares row by row of numbers: by the first in which they differ.
pub(super) fn in_order(a: &[f64], b: &[f64]) -> Ordering {
    let mut orders = a.iter().zip(b).map(|(x, y)| x.total_cmp(y));
    orders
        .find(|order| order.is_ne())
        .unwrap_or(Ordering::Equal)
}

fn is_in_time(subject: &Subject) -> bool {
    matches!(subject, Subject::System(scene) if matches!(scene.run, Run::Transient { .. }))
}

/// What the workshop adds, for each sample: a Latin hypercube; nothing where nothing scatters.
fn samples(problem: &Optimisation) -> Vec<Vec<(String, f64)>> {
    let tables = &problem.tables;
    let mut samples = vec![Vec::new(); problem.samples()];
    for scatter in &tables.scatter {
        let rng = seeded(tables.seed, &scatter.name);
        let drawn = probabilities(Design::LatinHypercube, samples.len(), rng);
        for (sample, probability) in samples.iter_mut().zip(drawn) {
            let added = (scatter.uniform.map(|u| u.quantile(probability)))
                .or_else(|| scatter.normal.map(|n| n.quantile(probability)));
            let added = added.unwrap_or_default();
            sample.extend(scatter.keys.iter().map(|key| (key.clone(), added)));
        }
    }
    samples
}
