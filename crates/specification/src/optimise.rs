//! The file: variables with bounds, what scatters, what is to be small.

use gearmesh_geometry::given;
use gearmesh_geometry::input::TableKeys;
use std::path::{Path, PathBuf};

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::InputDocument;
use schemars::JsonSchema;
use serde::Deserialize;

use crate::MOST_RESULT_BYTES;
use crate::names::label_problem;
use crate::study::{NormalTable, OperationTable, UniformTable, demand_each_once};

/// The keys of the file.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OptimiseTables {
    /// Title in prints.
    pub title: String,
    /// What is varied, relative to this file: a scene of a gear pair, a multibody scene, a bevel pair or a bearing.
    pub scene: PathBuf,
    /// With a bearing: what it carries. Its keys vary as "operation.load_N.2".
    pub operation: Option<OperationTable>,
    /// Run "transient": figures are those from this time on; 0 where not given.
    #[serde(default)]
    pub from_s: f64,
    /// About so many choices of the variables are tried by a search; 200 where not given.
    #[serde(default = "default_trials")]
    pub trials: usize,
    /// With several objectives: searches between them, after one for each alone; 6 where not given.
    pub searches: Option<usize>,
    /// Other seeds try other choices; 0 where not given.
    #[serde(default)]
    pub seed: u64,
    /// What is sought.
    pub variable: Vec<VariableTable>,
    /// What manufacture and mounting add.
    #[serde(default)]
    pub scatter: Vec<ScatterTable>,
    /// With `[[scatter]]`: how many pairs of the workshop a choice is tried on, always the same ones; 8 where not
    /// given.
    pub scatter_samples: Option<usize>,
    /// With `[[scatter]]`: what of these pairs counts; "mean" where not given.
    pub judged_by: Option<Judged>,
    /// What is to be small.
    pub objective: Vec<ObjectiveTable>,
}

fn default_trials() -> usize {
    200
}

/// `[[variable]]`.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct VariableTable {
    /// Name in the table.
    pub name: String,
    /// Keys of the scene that all take the value, as in a study.
    pub keys: Vec<String>,
    /// Least value.
    pub from: f64,
    /// Largest value.
    pub to: f64,
}

/// `[[scatter]]`.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ScatterTable {
    /// Name in the table.
    pub name: String,
    /// Keys of the scene to which a number is added; those that the scene does not state count as 0.
    pub keys: Vec<String>,
    /// Any number of a range.
    pub uniform: Option<UniformTable>,
    /// Normally distributed numbers, instead of uniform ones.
    pub normal: Option<NormalTable>,
}

/// What of the pairs that scatter makes counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Judged {
    /// Their mean.
    #[default]
    Mean,
    /// The worst of them.
    Worst,
}

/// `[[objective]]`: a weighted sum that is to be small.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ObjectiveTable {
    /// Name in the table.
    pub name: String,
    /// What is added up.
    pub term: Vec<TermTable>,
}

/// `[[objective.term]]`.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct TermTable {
    /// A column that a study of the scene has; of series COLUMN:FIGURE.
    pub column: String,
    /// Gear pairs: a torque of the scene; the mean over all of them where not given.
    pub torque_Nm: Option<f64>,
    /// Weight; 1 where not given.
    #[serde(default = "default_weight")]
    pub weight: f64,
}

fn default_weight() -> f64 {
    1.0
}

/// Most choices of all searches together, scatter not counted.
const MOST_TRIALS: usize = 1_000_000;

/// Fewer than this let a swarm and a simplex find nothing.
const LEAST_TRIALS: usize = 20;

/// A file, checked as far as the scene is not needed.
#[derive(Debug, Clone)]
pub struct Optimisation {
    /// The keys of the file.
    pub tables: OptimiseTables,
    /// The file, for later complaints.
    pub document: InputDocument,
    /// The file's folder.
    pub folder: PathBuf,
    /// Largest result of a trial of a multibody scene \[bytes\]; [`MOST_RESULT_BYTES`] where nobody allows more.
    pub most_result_bytes: f64,
}

impl Optimisation {
    /// Reads and checks a file.
    ///
    /// # Errors
    /// [`InputError`] with file, line, key, what was found and what is allowed.
    pub fn read(path: &Path) -> Result<Self, InputError> {
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::from_document(InputDocument::read(path)?, folder)
    }

    /// Checks what is already in memory; the scene is relative to `folder`.
    ///
    /// # Errors
    /// As [`Optimisation::read`].
    pub fn from_document(document: InputDocument, folder: &Path) -> Result<Self, InputError> {
        let tables: OptimiseTables = document.parse()?;
        if !(tables.from_s.is_finite() && tables.from_s >= 0.0) {
            let found = format!("found {}, allowed is 0 or more", tables.from_s);
            return Err(document.error("from_s", found));
        }
        for (key, is_empty) in [
            ("variable", tables.variable.is_empty()),
            ("objective", tables.objective.is_empty()),
        ] {
            if is_empty {
                return Err(document.error(key, "is empty; give at least one"));
            }
        }
        let variables = tables.variable.iter().map(|v| ("variable", &v.name));
        let scatter = tables.scatter.iter().map(|s| ("scatter", &s.name));
        let objectives = tables.objective.iter().map(|o| ("objective", &o.name));
        for names in [
            variables.collect::<Vec<_>>(),
            scatter.collect(),
            objectives.collect(),
        ] {
            for (i, (table, name)) in names.into_iter().enumerate() {
                if let Some(problem) = label_problem(name) {
                    return Err(document.error(&format!("{table}.{i}.name"), problem));
                }
            }
        }
        let variables = tables.variable.iter();
        let varied = variables.map(|variable| (variable.name.as_str(), variable.keys.as_slice()));
        demand_each_once(&document, "variable", varied, false)?;
        for (i, variable) in tables.variable.iter().enumerate() {
            keys_of(&document, &format!("variable.{i}"), &variable.keys)?;
            let ordered = variable.from.is_finite() && variable.to.is_finite();
            if !(ordered && variable.from < variable.to) {
                let problem = format!(
                    "found {} to {}, allowed is from below to",
                    variable.from, variable.to
                );
                return Err(document.error(&format!("variable.{i}.to"), problem));
            }
        }
        for (i, scatter) in tables.scatter.iter().enumerate() {
            let at = format!("scatter.{i}");
            keys_of(&document, &at, &scatter.keys)?;
            let problem = match (scatter.uniform, scatter.normal) {
                (Some(uniform), None) => uniform.problem(),
                (None, Some(normal)) => normal.problem(),
                _ => Some("give one of uniform and normal".to_owned()),
            };
            if let Some(problem) = problem {
                return Err(document.error(&at, problem));
            }
        }
        for (i, objective) in tables.objective.iter().enumerate() {
            if objective.term.is_empty() {
                return Err(document.error(
                    &format!("objective.{i}.term"),
                    "is empty; give at least one",
                ));
            }
        }
        let this = Self {
            tables,
            document,
            folder: folder.to_path_buf(),
            most_result_bytes: MOST_RESULT_BYTES,
        };
        this.demand_counts()?;
        Ok(this)
    }

    fn demand_counts(&self) -> Result<(), InputError> {
        let OptimiseTables {
            trials,
            searches,
            scatter,
            scatter_samples,
            objective,
            ..
        } = &self.tables;
        let error = |key: &str, problem: &str| Err(self.document.error(key, problem));
        if scatter.is_empty() {
            let problem = "belongs to [[scatter]], of which there is none; remove it";
            let keys = TableKeys::new(&self.document, "");
            keys.refuse(&given!(self.tables; scatter_samples, judged_by), problem)?;
        }
        if scatter_samples.is_some_and(|samples| !(1..=1000).contains(&samples)) {
            return error("scatter_samples", "allowed is 1 to 1000");
        }
        if searches.is_some() && objective.len() < 2 {
            return error(
                "searches",
                "belongs to several objectives; there is one; remove it",
            );
        }
        // A simplex has a corner more than there are variables, and a swarm before it as many trials.
        let least = LEAST_TRIALS.max(2 * (self.tables.variable.len() + 1));
        let all = trials.saturating_mul(self.searches());
        if *trials < least || all > MOST_TRIALS {
            let problem = format!(
                "found {trials} in {} searches, allowed are {least} and more of {} variables, {MOST_TRIALS} in all",
                self.searches(),
                self.tables.variable.len()
            );
            return error("trials", &problem);
        }
        Ok(())
    }

    /// Searches: one for each objective, and those between them.
    #[must_use]
    pub fn searches(&self) -> usize {
        match self.tables.objective.len() {
            0 | 1 => 1,
            count => count + self.tables.searches.unwrap_or(6),
        }
    }

    /// Pairs that a choice is tried on.
    #[must_use]
    pub fn samples(&self) -> usize {
        if self.tables.scatter.is_empty() {
            return 1;
        }
        self.tables.scatter_samples.unwrap_or(8)
    }
}

fn keys_of(document: &InputDocument, at: &str, keys: &[String]) -> Result<(), InputError> {
    let at = format!("{at}.keys");
    if keys.is_empty() {
        return Err(document.error(&at, "is empty; give at least one"));
    }
    Ok(())
}
