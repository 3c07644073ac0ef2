//! The study file: the scene, the keys that vary, their values and the columns that are looked at.

use std::path::{Path, PathBuf};

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::InputDocument;
use schemars::JsonSchema;
use serde::Deserialize;

/// The keys of the file.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StudyTables {
    /// Title in prints.
    pub title: String,
    /// The scene that is varied, relative to this file; a multibody scene whose run is "transient" or "static".
    pub scene: PathBuf,
    /// How the parameters are combined; "one-at-a-time" where not given.
    #[serde(default)]
    pub design: Design,
    /// Columns of the result whose figures are listed.
    pub columns: Vec<String>,
    /// The figures are those from this time on; 0 where not given.
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
    /// "gear_mesh.0.exponent".
    pub keys: Vec<String>,
    /// Numbers or texts, one case each.
    #[schemars(with = "Vec<ValueSchema>")]
    pub values: Vec<toml::Value>,
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

/// How the parameters are combined.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Design {
    /// The scene as it is, then each parameter by itself.
    #[default]
    OneAtATime,
    /// Every combination.
    Grid,
}

/// One parameter at one value.
#[derive(Debug, Clone, PartialEq)]
pub struct Setting {
    /// Name of the parameter.
    pub parameter: String,
    /// Keys of the scene that take the value.
    pub keys: Vec<String>,
    /// The value.
    pub value: toml::Value,
}

/// What is changed in one run; nothing in the scene as it is.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Case {
    /// The settings.
    pub settings: Vec<Setting>,
}

impl Case {
    /// `load = -900.0, speed = 250.0`, or `as it is`.
    #[must_use]
    pub fn name(&self) -> String {
        if self.settings.is_empty() {
            return "as it is".to_owned();
        }
        let settings = self.settings.iter();
        let words = settings.map(|setting| format!("{} = {}", setting.parameter, setting.value));
        words.collect::<Vec<_>>().join(", ")
    }
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
        let mut names: Vec<&str> = Vec::new();
        for (i, parameter) in tables.parameter.iter().enumerate() {
            let at = |key: &str| format!("parameter.{i}.{key}");
            if names.contains(&parameter.name.as_str()) {
                let problem = format!("`{}` is there twice; names must differ", parameter.name);
                return Err(document.error(&at("name"), problem));
            }
            names.push(&parameter.name);
            for (key, is_empty) in [
                ("keys", parameter.keys.is_empty()),
                ("values", parameter.values.is_empty()),
            ] {
                if is_empty {
                    return Err(document.error(&at(key), "is empty; give at least one"));
                }
            }
        }
        let study = Self {
            tables,
            document,
            folder: folder.to_path_buf(),
        };
        let count = study.case_count();
        if count.is_none_or(|count| count > MOST_CASES) {
            let problem = format!(
                "asks for more than {MOST_CASES} runs; take fewer values, or design = \"one-at-a-time\""
            );
            return Err(study.document.error("parameter", problem));
        }
        Ok(study)
    }

    fn case_count(&self) -> Option<usize> {
        let mut counts = self.tables.parameter.iter().map(|p| p.values.len());
        match self.tables.design {
            Design::OneAtATime => Some(1 + counts.sum::<usize>()),
            Design::Grid => counts.try_fold(1_usize, usize::checked_mul),
        }
    }

    /// The runs, in the order of the table.
    #[must_use]
    pub fn cases(&self) -> Vec<Case> {
        let settings = |parameter: &ParameterTable| {
            let setting = |value: &toml::Value| Setting {
                parameter: parameter.name.clone(),
                keys: parameter.keys.clone(),
                value: value.clone(),
            };
            parameter.values.iter().map(setting).collect::<Vec<_>>()
        };
        let parameters = self.tables.parameter.iter().map(settings);
        match self.tables.design {
            Design::OneAtATime => {
                let single = |setting| Case {
                    settings: vec![setting],
                };
                let varied = parameters.flatten().map(single);
                std::iter::once(Case::default()).chain(varied).collect()
            }
            Design::Grid => parameters.fold(vec![Case::default()], |cases, settings| {
                let extended = cases.iter().flat_map(|case| {
                    settings.iter().map(|setting| {
                        let mut case = case.clone();
                        case.settings.push(setting.clone());
                        case
                    })
                });
                extended.collect()
            }),
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn study(more: &str) -> Result<Study, InputError> {
        let text = format!(
            "title = 't'\nscene = 's.toml'\ncolumns = ['x']\n{more}\n\
             [[parameter]]\nname = 'a'\nkeys = ['k']\nvalues = [1.0, 2.0]\n\
             [[parameter]]\nname = 'b'\nkeys = ['l', 'm']\nvalues = ['p', 'q', 'r']\n"
        );
        Study::from_document(InputDocument::new("study.toml", text), Path::new(""))
    }

    #[test]
    fn one_at_a_time_begins_with_the_scene_as_it_is_and_a_grid_has_every_combination() {
        let cases = study("").unwrap().cases();
        assert_eq!(cases.len(), 6);
        assert_eq!(cases[0].name(), "as it is");
        assert_eq!(cases[5].name(), "b = \"r\"");
        let cases = study("design = 'grid'").unwrap().cases();
        assert_eq!(cases.len(), 6);
        assert_eq!(cases[0].name(), "a = 1.0, b = \"p\"");
        assert_eq!(cases[5].name(), "a = 2.0, b = \"r\"");
    }

    #[test]
    fn a_wrong_study_says_what_is_allowed() {
        let complaint = study("from_s = -1.0").unwrap_err().to_string();
        assert_eq!(
            complaint,
            "study.toml:4: from_s: found -1, allowed is 0 or more"
        );
        let twice = "[[parameter]]\nname = 'b'\nkeys = ['k']\nvalues = [1]\n";
        let complaint = study(twice).unwrap_err().to_string();
        assert!(complaint.contains("`b` is there twice"), "{complaint}");
    }
}
