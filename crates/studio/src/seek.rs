//! An optimisation from the page: which keys of the pair are varied, and what is to be small.

use gearmesh_operations::optimise::optimise;
use gearmesh_operations::{Scratch, Watch};
use serde::Deserialize;
use serde_json::{Value, json};

use crate::pair::{Change, PairSession};
use crate::problem::Problem;

/// Most choices of a search that a page waits for.
const MOST_TRIALS: usize = 5000;

/// What is sought, from a state of the pair on.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Seek {
    change: Change,
    variables: Vec<Variable>,
    objectives: Vec<Objective>,
    trials: usize,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct Variable {
    key: String,
    from: f64,
    to: f64,
}

#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
struct Objective {
    column: String,
    torque_Nm: Option<f64>,
}

impl PairSession {
    /// Seeks. The figures are those of `gearmesh optimise --json`; variables are named by their keys.
    ///
    /// # Errors
    /// [`Problem`] for keys and columns that are none, for what the scene refuses, and once `watch` stops it.
    pub fn seek(&self, seek: &Seek, watch: &Watch<'_>) -> Result<Value, Problem> {
        if seek.trials > MOST_TRIALS {
            return Err(Problem::Input(format!(
                "trials: found {}, allowed are {MOST_TRIALS} here; `gearmesh optimise` takes more",
                seek.trials
            )));
        }
        let mut change = seek.change.clone();
        for Variable { key, from, to } in &seek.variables {
            let field = self.field(key)?;
            if field.reduces {
                let problem = format!("{key}: would reduce a gear for each trial; vary the flanks");
                return Err(Problem::Input(problem));
            }
            // What the key means nothing without.
            for (second, value) in &field.with {
                let given = change.settings.entry(second.clone());
                given.or_insert_with(|| value.clone());
            }
            let given = change.settings.entry(key.clone());
            given.or_insert_with(|| json!(0.5 * (from + to)));
        }
        let folder = Scratch::new()?;
        let write = |name: &str, text: String| {
            let path = folder.path().join(name);
            let written = gearmesh_model::write_text(&path, &text);
            written.map(|()| path).map_err(Problem::not_written)
        };
        write("scene.toml", self.text(&change)?)?;
        let file = write("optimise.toml", seek.file()?)?;
        let found = optimise(&file, &folder.path().join("found"), 1.0, watch)?;
        match found.optimum.stopped {
            true => Err(Problem::Stopped),
            false => Ok(json!({"figures": found.figures(), "settings": change.settings})),
        }
    }
}

impl Seek {
    /// The file for `gearmesh optimise`.
    fn file(&self) -> Result<String, Problem> {
        let variables = self
            .variables
            .iter()
            .map(|one| json!({"name": one.key, "keys": [one.key], "from": one.from, "to": one.to}));
        let objectives = self.objectives.iter().map(|one| {
            let term = match one.torque_Nm {
                Some(torque) => json!({"column": one.column, "torque_Nm": torque}),
                None => json!({"column": one.column}),
            };
            let torque = one
                .torque_Nm
                .map_or("mean".to_owned(), |load| format!("{load} Nm"));
            json!({"name": format!("{} at {torque}", one.column), "term": [term]})
        });
        let file = json!({
            "title": "Optimised in the studio",
            "scene": "scene.toml",
            "trials": self.trials,
            "variable": variables.collect::<Vec<_>>(),
            "objective": objectives.collect::<Vec<_>>(),
        });
        toml::to_string(&file).map_err(|error| Problem::Input(error.to_string()))
    }
}
