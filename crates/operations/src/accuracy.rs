//! What accuracy costs in time, for a scene of the user's own.

use crate::failure::{Failure, Result};
use crate::file_words::time_words;
use crate::reduce::reduced_for_study;
use crate::scratch::Scratch;
use crate::watch::Watch;
use crate::{output_name, overwriting, page_file};
use gearmesh_report::accuracy_page::{accuracy_page, goal_in_words};
use gearmesh_report::short;
use gearmesh_scene::accuracy::{
    Accuracy, Advice, Bench, BenchOptions, EffectFound, Goal, JudgedTime, Reduce, Tried,
    accuracy as judge, words,
};
use gearmesh_scene::study::{Effort, Wanted};
use serde::Deserialize;
use serde_json::{Value, json};
use std::path::PathBuf;

/// Short runs are repeated for so long \[s\].
const REPEATED_FOR_S: f64 = 0.2;

/// What is judged.
#[derive(Debug, Clone, Default, clap::Args, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AccuracyRequest {
    /// Scene of a gear pair, multibody scene, or bevel pair
    pub scene: PathBuf,
    /// What is to be exact: columns of a study of the scene, of series COLUMN:FIGURE, with mean, deviation, rms,
    /// peak-to-peak, largest, least; of runs in time line-250Hz; of sweeps resonance-rpm. Where none is named:
    /// deviations and peaks of teeth, gauges and bearings in motion, and the first three mesh orders where the speed
    /// stays; of pairs at rest peak-to-peak, pressure, K_Hbeta and strain
    #[arg(long, value_delimiter = ',')]
    #[serde(default, deserialize_with = "crate::one_or_many::read")]
    pub columns: Vec<String>,
    /// Runs in time: figures from this time on
    #[arg(long, default_value = "0")]
    #[serde(default)]
    pub from_s: f64,
    /// Vary elements and element lengths of the reduced gears, too, which reduces each several times; keep the models
    /// in this folder
    #[arg(long)]
    pub elements: Option<PathBuf>,
    /// Judge settings by this time; processor time where other work shares the machine
    #[arg(long = "time", value_name = "TIME", default_value = "wall", value_parser = time_words(),
        action = clap::ArgAction::Set)]
    #[serde(default)]
    pub by_processor_time: bool,
    /// Page with the picture of error against time
    #[arg(short, long)]
    pub output: Option<PathBuf>,
}

/// Runs the scene with each setting of its knobs, and writes the page where asked for.
///
/// # Errors
/// [`Failure`] for a scene or column that is wrong, and a page that cannot be written.
pub fn accuracy(a: &AccuracyRequest, watch: &Watch<'_>) -> Result<Accuracy> {
    let outputs: Vec<PathBuf> = a.output.iter().cloned().collect();
    overwriting::refuse(vec![a.scene.clone()], &outputs)?;
    if let Some(path) = &a.output {
        output_name::demand_page(path)?;
    }
    let scratch = Scratch::new()?;
    let reduce = |gear: &_| reduced_for_study(gear, watch);
    let bench = bench_of(a, &scratch, &reduce, watch)?;
    let task = watch.listener.begin("settings");
    let found = judge(&bench, &|done, count| {
        task.advance(done as f64, count as f64);
    });
    drop(task);
    watch.go_on()?;
    let found = found?;
    watch.yielding(found.yielding.as_ref());
    if let Some(path) = &a.output {
        let scene = a.scene.display().to_string();
        page_file::write(&accuracy_page(&scene, &found), path, watch)?;
    }
    Ok(found)
}

/// The scene with its columns, to be run in other settings. `reduce` makes the models that a setting needs.
pub(crate) fn bench_of<'a>(
    a: &'a AccuracyRequest,
    scratch: &'a Scratch,
    reduce: Reduce<'a>,
    watch: &'a Watch<'_>,
) -> Result<Bench<'a>> {
    let options = BenchOptions {
        wanted: a.columns.iter().map(|c| Wanted::of(c)).collect(),
        from_s: a.from_s,
        time: match a.by_processor_time {
            false => JudgedTime::Wall,
            true => JudgedTime::Processor,
        },
        repeated_for_s: REPEATED_FOR_S,
        elements: a.elements.is_some(),
        scratch: scratch.path(),
        models: a.elements.as_deref().unwrap_or_else(|| scratch.path()),
        stop: watch.stop,
        reduce,
    };
    Ok(Bench::new(&a.scene, options)?)
}

/// What was advised was run once more: it must keep its word.
///
/// # Errors
/// [`Failure`] where it does not.
pub fn demand_kept(found: &Accuracy) -> Result<()> {
    for Advice { goal, tried, .. } in &found.advice {
        if let Goal::Within(most) = goal
            && tried.error() > *most
        {
            let (error, most) = (short(100.0 * tried.error()), 100.0 * most);
            return Err(Failure::work(format!(
                "the setting for {most} %, run once more, has an error of {error} %"
            )));
        }
    }
    Ok(())
}

/// A figure of each column.
pub(crate) fn by_column(columns: &[String], figures: &[f64]) -> Value {
    let named = columns
        .iter()
        .cloned()
        .zip(figures.iter().map(|f| json!(f)));
    Value::Object(named.collect())
}

/// For other programs.
#[must_use]
pub fn figures(found: &Accuracy) -> Value {
    let effort = |effort: &Effort| {
        json!({
            "wall_s": effort.wall_s, "cpu_s": effort.cpu_s, "states": effort.states,
            "calls": effort.calls, "iterations": effort.iterations,
        })
    };
    let setting = |one: &Tried| {
        let mut value = effort(&one.effort);
        value["setting"] = json!(words(&found.knobs, &one.rungs));
        let rungs = found.knobs.iter().zip(&one.rungs);
        value["rungs"] = rungs
            .map(|(knob, rung)| (knob.name.clone(), json!(rung)))
            .collect();
        value["one_knob_alone"] = json!(one.alone.is_some());
        value["errors"] = by_column(&found.columns, &one.errors);
        value["reduction_s"] = json!(one.reduction_s);
        value
    };
    let effect = |one: &EffectFound| {
        json!({
            "effect": one.effect.name, "in_scene": one.effect.present, "changes": by_column(&found.columns, &one.changes),
            "with": effort(&one.with), "without": effort(&one.without),
        })
    };
    let advice = |one: &Advice| json!({"goal": goal_in_words(one.goal), "toml": one.toml, "run_again": setting(&one.tried)});
    json!({
        "kind": found.kind,
        "tried": found.tried.iter().map(setting).collect::<Vec<_>>(),
        "advice": found.advice.iter().map(advice).collect::<Vec<_>>(),
        "effects": found.effects.iter().map(effect).collect::<Vec<_>>(),
        "judged_by": found.time.words(),
        "last_step_of_reference": found.unsettled().map(|(knob, error)| json!({"knob": knob.name, "change": error})),
        "reference_may_be_off": by_column(&found.columns, &found.doubts()),
        "chaotic": !found.spread.is_empty(), "spread": by_column(&found.columns, &found.spread),
        "no_setting_within": found.open.iter().map(|goal| goal_in_words(*goal)).collect::<Vec<_>>(),
        "not_varied": found.left_out, "failed": found.failed,
    })
}
