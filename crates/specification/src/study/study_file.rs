//! The study file: the scene, the keys that vary, their values and the columns that are looked at.

use gearmesh_geometry::given;
use gearmesh_geometry::input::TableKeys;
use std::path::{Path, PathBuf};

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::InputDocument;
use schemars::JsonSchema;
use serde::Deserialize;

use super::bearing_operation::OperationTable;
use super::design::{self, Case, Design};
use super::scatter::{NormalTable, SpacedTable, UniformTable};
use super::varied_once::demand_each_once;
use crate::MOST_RESULT_BYTES;
use crate::names::label_problem;

/// The keys of the file.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StudyTables {
    /// Title in prints.
    pub title: String,
    /// What is varied, relative to this file: a scene of a gear pair, a multibody scene of any run, a bevel pair (its
    /// tooth contact analysis) or a bearing.
    pub scene: PathBuf,
    /// With a bearing: what it carries. Its keys vary as "operation.load_N.2".
    pub operation: Option<OperationTable>,
    /// How the parameters are combined; "one-at-a-time" where not given.
    #[serde(default)]
    pub design: Design,
    /// With design = "latin-hypercube" or "random": how many cases.
    pub samples: Option<usize>,
    /// With design = "latin-hypercube" or "random": other seeds give other samples; 0 where not given.
    pub seed: Option<u64>,
    /// Columns whose figures are listed: of gear pairs, bevel pairs, bearings and natural frequencies those that
    /// docs/scene.md names, otherwise columns of the result, or COLUMN:FIGURE for one number of them.
    pub columns: Vec<String>,
    /// Run "transient": the figures are those from this time on; 0 where not given.
    #[serde(default)]
    pub from_s: f64,
    /// What varies.
    pub parameter: Vec<ParameterTable>,
}

/// `[[parameter]]`.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ParameterTable {
    /// Name in the table.
    pub name: String,
    /// Keys of the scene that all take the value: dotted paths, items of lists by number from 0:
    /// "gear_mesh.0.exponent". "pair.gear_1:blank.web_thickness_mm" is the key blank.web_thickness_mm of the gear file
    /// that pair.gear_1 names.
    pub keys: Vec<String>,
    /// Numbers or texts, one case each.
    #[schemars(with = "Option<Vec<ValueSchema>>")]
    pub values: Option<Vec<toml::Value>>,
    /// Numbers at equal steps, instead of values.
    pub spaced: Option<SpacedTable>,
    /// Sampled designs: any number of a range, instead of values.
    pub uniform: Option<UniformTable>,
    /// Sampled designs: normally distributed numbers, instead of values.
    pub normal: Option<NormalTable>,
}

impl ParameterTable {
    /// The values that are stated; none of a scatter.
    #[must_use]
    pub fn listed(&self) -> Vec<toml::Value> {
        match (&self.values, self.spaced) {
            (Some(values), _) => values.clone(),
            (None, Some(spaced)) => spaced
                .values()
                .into_iter()
                .map(toml::Value::Float)
                .collect(),
            (None, None) => Vec::new(),
        }
    }

    /// The value below which this share of all lies; of stated ones, in their order, each has the same share.
    #[must_use]
    pub fn at_probability(&self, probability: f64) -> toml::Value {
        let drawn = (self.uniform.map(|uniform| uniform.quantile(probability)))
            .or_else(|| self.normal.map(|normal| normal.quantile(probability)));
        if let Some(value) = drawn {
            return toml::Value::Float(rounded(value));
        }
        let listed = self.listed();
        let place = (probability * listed.len() as f64) as usize;
        listed[place.min(listed.len() - 1)].clone()
    }

    /// What is wrong with it in a design: the key, and why.
    fn problem(&self, design: Design) -> Option<(&'static str, String)> {
        if self.keys.is_empty() {
            return Some(("keys", "is empty; give at least one".to_owned()));
        }
        let stated = [
            ("values", self.values.is_some()),
            ("spaced", self.spaced.is_some()),
            ("uniform", self.uniform.is_some()),
            ("normal", self.normal.is_some()),
        ];
        let mut stated = stated.into_iter().filter(|(_, is)| *is).map(|(key, _)| key);
        let Some(first) = stated.next() else {
            let problem = "states no values; give one of values, spaced, uniform, normal";
            return Some(("", problem.to_owned()));
        };
        if let Some(second) = stated.next() {
            return Some((
                second,
                format!("there is `{first}` already; remove one of the two"),
            ));
        }
        if matches!(first, "uniform" | "normal") && !design.is_sampled() {
            let problem = "is a scatter, which needs design = \"latin-hypercube\" or \"random\"";
            return Some((first, problem.to_owned()));
        }
        if self.values.as_ref().is_some_and(Vec::is_empty) {
            return Some(("values", "is empty; give at least one".to_owned()));
        }
        let problem = (self.spaced.and_then(SpacedTable::problem))
            .or_else(|| self.uniform.and_then(UniformTable::problem))
            .or_else(|| self.normal.and_then(NormalTable::problem));
        problem.map(|problem| (first, problem))
    }
}

/// To six digits: numbers that are drawn stand in tables and names.
fn rounded(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}

/// What a value may be.
#[derive(JsonSchema)]
#[schemars(untagged)]
#[allow(dead_code)]
enum ValueSchema {
    Number(f64),
    Text(String),
    Truth(bool),
}

/// A study, checked as far as the scene is not needed.
#[derive(Debug, Clone)]
pub struct Study {
    /// The keys of the file.
    pub tables: StudyTables,
    /// The file, for later complaints.
    pub document: InputDocument,
    /// The file's folder.
    pub folder: PathBuf,
    /// Largest size of the results of all cases together \[bytes\]; [`MOST_RESULT_BYTES`] where nobody allows more.
    pub most_result_bytes: f64,
}

/// Cases beyond which a study is refused: a mistake, or a task for a cluster.
const MOST_CASES: usize = 10_000;

impl Study {
    /// Reads and checks a study file.
    ///
    /// # Errors
    /// [`InputError`] with file, line, key, what was found and what is allowed.
    pub fn read(path: &Path) -> Result<Self, InputError> {
        let folder = path.parent().unwrap_or(Path::new(""));
        Self::from_document(InputDocument::read(path)?, folder)
    }

    /// Checks a study that is already in memory; the scene is relative to `folder`.
    ///
    /// # Errors
    /// As [`Study::read`].
    pub fn from_document(document: InputDocument, folder: &Path) -> Result<Self, InputError> {
        let tables: StudyTables = document.parse()?;
        if !(tables.from_s.is_finite() && tables.from_s >= 0.0) {
            let found = format!("found {}, allowed is 0 or more", tables.from_s);
            return Err(document.error("from_s", found));
        }
        if tables.columns.is_empty() {
            return Err(document.error(
                "columns",
                "is empty; name at least one column of the result",
            ));
        }
        let varied = (tables.parameter.iter()).map(|one| (one.name.as_str(), one.keys.as_slice()));
        let at_a_time = tables.design == Design::OneAtATime;
        demand_each_once(&document, "parameter", varied, at_a_time)?;
        for (i, parameter) in tables.parameter.iter().enumerate() {
            let at = |key: &str| format!("parameter.{i}.{key}");
            if let Some(problem) = label_problem(&parameter.name) {
                return Err(document.error(&at("name"), problem));
            }
            if let Some((key, problem)) = parameter.problem(tables.design) {
                let key = if key.is_empty() {
                    format!("parameter.{i}")
                } else {
                    at(key)
                };
                return Err(document.error(&key, problem));
            }
        }
        demand_samples(&tables, &document)?;
        let study = Self {
            tables,
            document,
            folder: folder.to_path_buf(),
            most_result_bytes: MOST_RESULT_BYTES,
        };
        let count = study.case_count();
        if count.is_none_or(|count| count > MOST_CASES) {
            let problem = format!(
                "asks for more than {MOST_CASES} runs; take fewer values or samples, or design = \"one-at-a-time\""
            );
            return Err(study.document.error("parameter", problem));
        }
        Ok(study)
    }

    fn case_count(&self) -> Option<usize> {
        let mut counts = self.tables.parameter.iter().map(|p| p.listed().len());
        match self.tables.design {
            Design::OneAtATime => Some(1 + counts.sum::<usize>()),
            Design::Grid => counts.try_fold(1_usize, usize::checked_mul),
            Design::LatinHypercube | Design::Random => self.tables.samples,
        }
    }

    /// The runs, in the order of the table.
    #[must_use]
    pub fn cases(&self) -> Vec<Case> {
        let StudyTables {
            design,
            parameter,
            samples,
            seed,
            ..
        } = &self.tables;
        let drawn = (samples.unwrap_or_default(), seed.unwrap_or_default());
        design::cases(*design, parameter, drawn)
    }
}

/// `samples` and `seed` stand where cases are drawn, and nowhere else.
fn demand_samples(tables: &StudyTables, document: &InputDocument) -> Result<(), InputError> {
    let sampled = tables.design.is_sampled();
    if !sampled {
        let problem = "belongs to design = \"latin-hypercube\" and \"random\"; remove it";
        TableKeys::new(document, "").refuse(&given!(tables; samples, seed), problem)?;
    }
    if sampled && tables.samples.is_none_or(|samples| samples < 1) {
        let problem = "must be stated with this design: how many cases, 1 or more";
        return Err(document.error("samples", problem));
    }
    Ok(())
}
