//! Keys of a scene that make its objectives least.

use crate::failure::{Failure, Result};
use crate::file_words::positive;
use crate::scratch::Scratch;
use crate::watch::Watch;
use crate::{overwriting, page_file};
use gearmesh_model::{csv_cell, write_text};
use gearmesh_report::optimise_page::optimise_page;
use gearmesh_scene::optimise::{Optimum, Trial, optimise as seek};
use gearmesh_specification::optimise::Optimisation;
use serde::Deserialize;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// What is sought, and where the files go.
#[derive(Debug, Clone, clap::Args, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OptimiseRequest {
    /// File with the scene, what is sought, what scatters, what is to be small
    pub file: PathBuf,
    /// Folder for front.csv, tried.csv and the page optimise.html
    #[arg(short, long)]
    pub output: PathBuf,
    /// Largest result of a trial of a multibody scene
    #[arg(long = "most-result-GB", default_value = "1", value_parser = positive)]
    #[serde(rename = "most_result_GB")]
    pub most_result_gb: f64,
}

impl OptimiseRequest {
    /// Seeks the optimum, as [`optimise`].
    ///
    /// # Errors
    /// As [`optimise`].
    pub fn optimise(&self, watch: &Watch<'_>) -> Result<FoundOptimum> {
        optimise(&self.file, &self.output, self.most_result_gb, watch)
    }
}

/// What was sought, and what was found.
pub struct FoundOptimum {
    /// The file.
    pub problem: Optimisation,
    /// The front, and all that was tried.
    pub optimum: Optimum,
}

/// Seeks the optimum of a file, and writes `front.csv`, `tried.csv` and the page into a folder. The result of a trial
/// of a multibody scene may be as large as `most_result_gb` at most. Stopped, the files have what was tried until then,
/// which [`Optimum::stopped`] says.
///
/// # Errors
/// [`Failure`] for a file or scene that is wrong, and files that cannot be written.
pub fn optimise(
    file: &Path,
    folder: &Path,
    most_result_gb: f64,
    watch: &Watch<'_>,
) -> Result<FoundOptimum> {
    let outputs = ["front.csv", "tried.csv", "optimise.html"].map(|name| folder.join(name));
    overwriting::refuse(vec![PathBuf::from(file)], &outputs)?;
    let mut problem = Optimisation::read(file)?;
    problem.most_result_bytes = 1e9 * most_result_gb;
    let scratch = Scratch::new()?;
    let task = watch.listener.begin("search");
    let progress = |done: usize, count: usize| task.advance(done as f64, count as f64);
    let found = seek(&problem, scratch.path(), watch.stop, &progress);
    drop(task);
    let found = found?;
    watch.yielding(found.yielding.as_ref());
    std::fs::create_dir_all(folder).map_err(|cause| {
        Failure::work(format!(
            "cannot make the folder {}: {cause}",
            folder.display()
        ))
    })?;
    let [front, tried, page] = &outputs;
    write_text(front, &csv(&problem, &found.front))?;
    write_text(tried, &csv(&problem, &found.tried))?;
    if !found.front.is_empty() {
        page_file::write(&optimise_page(&problem, &found), page, watch)?;
    }
    Ok(FoundOptimum {
        problem,
        optimum: found,
    })
}

/// Names of variables, then objectives.
#[must_use]
pub fn names(problem: &Optimisation) -> Vec<String> {
    let tables = &problem.tables;
    let variables = tables.variable.iter().map(|v| v.name.clone());
    variables
        .chain(tables.objective.iter().map(|o| o.name.clone()))
        .collect()
}

/// A line for each choice: variables, objectives.
fn csv(problem: &Optimisation, trials: &[Trial]) -> String {
    let names = names(problem);
    let head: Vec<_> = names.iter().map(|name| csv_cell(name)).collect();
    let line = |trial: &Trial| {
        let numbers = trial.values.iter().chain(&trial.objectives);
        numbers.map(f64::to_string).collect::<Vec<_>>().join(",") + "\n"
    };
    head.join(",") + "\n" + &trials.iter().map(line).collect::<String>()
}

impl FoundOptimum {
    /// Demands that the search was not stopped.
    ///
    /// # Errors
    /// [`Failure::stopped`] where it was.
    pub fn demand_ended(&self) -> Result<()> {
        match self.optimum.stopped {
            true => Err(Failure::stopped(
                "interrupted; the files have what was tried until then",
            )),
            false => Ok(()),
        }
    }

    /// The front for other programs.
    #[must_use]
    pub fn figures(&self) -> Value {
        let (tables, found) = (&self.problem.tables, &self.optimum);
        let trial = |trial: &Trial| {
            let variables = tables.variable.iter().zip(&trial.values);
            let objectives = tables.objective.iter().zip(&trial.objectives);
            json!({
                "variables": variables.map(|(v, x)| (v.name.clone(), json!(x))).collect::<serde_json::Map<_, _>>(),
                "objectives": objectives.map(|(o, f)| (o.name.clone(), json!(f))).collect::<serde_json::Map<_, _>>(),
            })
        };
        json!({
            "title": tables.title,
            "tried": found.tried.len(),
            "objectives": tables.objective.iter().map(|o| &o.name).collect::<Vec<_>>(),
            "as_it_is": found.before,
            "front": found.front.iter().map(trial).collect::<Vec<_>>(),
        })
    }
}
