//! What a choice of the variables is worth: the objectives of the pairs that scatter makes of it.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

use super::file::{Judged, Optimisation};
use crate::scene_file::SceneFile;
use crate::study::{
    BaseScene, Case, Design, MadeFiles, PairCases, PairFigures, Setting, StudyError, VaryError,
    column_names, column_place, probabilities, seeded,
};

/// A choice of the variables that was tried.
#[derive(Debug, Clone, PartialEq)]
pub struct Trial {
    /// Values of the variables, in their units.
    pub values: Vec<f64>,
    /// The objectives.
    pub objectives: Vec<f64>,
}

/// A term, looked up: place of its column, place of its torque (all of them where none), weight.
type Term = (usize, Option<usize>, f64);

/// Tells what choices of the variables are worth. Threads may share it.
#[derive(Debug)]
pub struct Evaluator {
    base: BaseScene,
    pairs: PairCases,
    /// Keys that each variable sets.
    keys: Vec<Vec<String>>,
    /// What is added to which key, for each sample.
    samples: Vec<Vec<(String, f64)>>,
    judged: Judged,
    terms: Vec<Vec<Term>>,
    tried: Mutex<Vec<Trial>>,
    failed: Mutex<Option<String>>,
}

impl Evaluator {
    /// Reads scene and models, and finds the columns.
    ///
    /// # Errors
    /// [`StudyError`] for keys, columns and torques that the scene does not have.
    pub fn new(problem: &Optimisation) -> Result<Self, StudyError> {
        let tables = &problem.tables;
        let all_keys = (tables.variable.iter().map(|v| &v.keys))
            .chain(tables.scatter.iter().map(|s| &s.keys))
            .flatten();
        let path = problem.folder.join(&tables.scene);
        let base = BaseScene::read(&path, all_keys.map(String::as_str))?;
        let pairs = PairCases::default();
        let mut this = Self {
            base,
            pairs,
            keys: tables.variable.iter().map(|v| v.keys.clone()).collect(),
            samples: samples(problem),
            judged: tables.judged_by.unwrap_or_default(),
            terms: Vec::new(),
            tried: Mutex::new(Vec::new()),
            failed: Mutex::new(None),
        };
        // The middle of all bounds is a sound scene, or the file is at fault.
        let middle: Vec<f64> = tables
            .variable
            .iter()
            .map(|v| 0.5 * (v.from + v.to))
            .collect();
        let scene = this.scene(&middle, 0).map_err(|error| match error {
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
        })?;
        let SceneFile::Pair(scene) = scene else {
            let told = "is a multibody scene; allowed is one with [pair]. `gearmesh study` varies multibody scenes";
            return Err(problem.document.error("scene", told).into());
        };
        let known = column_names(&this.pairs.load(&scene)?);
        for (i, objective) in tables.objective.iter().enumerate() {
            let mut terms = Vec::new();
            for (j, term) in objective.term.iter().enumerate() {
                let at = |key: &str| format!("objective.{i}.term.{j}.{key}");
                let column = column_place(&term.column, &known)
                    .map_err(|told| problem.document.error(&at("column"), told))?;
                let torque = match term.torque_Nm {
                    None => None,
                    Some(torque) => {
                        let found = scene.torques_nm.iter().position(|known| *known == torque);
                        if found.is_none() {
                            let told =
                                format!("found {torque}, the scene has {:?}", scene.torques_nm);
                            return Err(problem.document.error(&at("torque_Nm"), told).into());
                        }
                        found
                    }
                };
                terms.push((column, torque, term.weight));
            }
            this.terms.push(terms);
        }
        Ok(this)
    }

    /// Number of objectives.
    #[must_use]
    pub fn objectives(&self) -> usize {
        self.terms.len()
    }

    /// The objectives of a choice; none where one of its pairs cannot be computed.
    #[must_use]
    pub fn objectives_of(&self, values: &[f64]) -> Option<Vec<f64>> {
        match self.judged_objectives(values) {
            Ok(objectives) => {
                let trial = Trial {
                    values: values.to_vec(),
                    objectives: objectives.clone(),
                };
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
    pub fn as_it_is(&self) -> Option<Vec<f64>> {
        // Without values no key is set but by scatter.
        self.judged_objectives(&[]).ok()
    }

    fn judged_objectives(&self, values: &[f64]) -> Result<Vec<f64>, String> {
        let each: Vec<Vec<f64>> = (0..self.samples.len())
            .into_par_iter()
            .map(|sample| Ok(self.added_up(&self.figures(values, sample)?)))
            .collect::<Result<_, String>>()?;
        let judged = |k: usize| {
            let own = each.iter().map(|sample| sample[k]);
            match self.judged {
                Judged::Mean => own.sum::<f64>() / each.len() as f64,
                Judged::Worst => own.fold(f64::NEG_INFINITY, f64::max),
            }
        };
        Ok((0..self.terms.len()).map(judged).collect())
    }

    /// All choices that were tried, in an order that does not depend on the threads.
    #[must_use]
    pub fn tried(&self) -> Vec<Trial> {
        let mut tried = self
            .tried
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone();
        tried.sort_by(|a, b| {
            let pairs = a.values.iter().zip(&b.values);
            let mut orders = pairs.map(|(x, y)| x.total_cmp(y));
            orders
                .find(|order| order.is_ne())
                .unwrap_or(std::cmp::Ordering::Equal)
        });
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

    fn added_up(&self, figures: &PairFigures) -> Vec<f64> {
        let term = |&(column, torque, weight): &Term| {
            let values = &figures.columns[column].values;
            let value = match torque {
                Some(torque) => values[torque],
                None => values.iter().sum::<f64>() / values.len() as f64,
            };
            weight * value
        };
        self.terms
            .iter()
            .map(|terms| terms.iter().map(term).sum())
            .collect()
    }

    fn figures(&self, values: &[f64], sample: usize) -> Result<PairFigures, String> {
        match self.scene(values, sample) {
            Ok(SceneFile::Pair(scene)) => self.pairs.figures(&scene).map_err(|e| e.to_string()),
            Ok(SceneFile::System(_)) => Err("a multibody scene".to_owned()),
            Err(VaryError::Scene(error)) => Err(error.to_string()),
            Err(VaryError::Key { problem, .. }) => Err(problem),
        }
    }

    /// The scene of a choice, as a sample of the workshop has it.
    fn scene(&self, values: &[f64], sample: usize) -> Result<SceneFile, VaryError> {
        let mut at: BTreeMap<&str, f64> = BTreeMap::new();
        for (keys, value) in self.keys.iter().zip(values) {
            at.extend(keys.iter().map(|key| (&key[..], *value)));
        }
        for (key, added) in &self.samples[sample] {
            let stated = || match self.base.value(key) {
                Some(toml::Value::Float(value)) => value,
                Some(toml::Value::Integer(value)) => value as f64,
                _ => 0.0,
            };
            *at.entry(key).or_insert_with(stated) += added;
        }
        let setting = |(key, value): (&str, f64)| Setting {
            parameter: key.to_owned(),
            keys: vec![key.to_owned()],
            value: toml::Value::Float(value),
        };
        let settings = at.into_iter().map(setting).collect();
        self.base
            .scene(&Case { settings }, &mut MadeFiles::new(), Path::new(""))
    }
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
