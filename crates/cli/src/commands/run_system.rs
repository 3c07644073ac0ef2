//! `gearmesh run` on a multibody scene: runs it, resumes it, prints its figures.

use crate::arguments::RunArguments;
use crate::commands::{mesh_axes, ratings};
use crate::console::{self, RunBar};
use crate::failure::Failure;
use crate::interrupt;
use gearmesh_report::{short, usual_unit};
use gearmesh_scene::system::LoadedSystem;
use gearmesh_scene::system_run::{
    Advance, ColumnSummary, EigenResult, Outcome, RunJob, RunOptions, RunRecord, SystemResult,
    is_overdamped, is_prominent, rank, run as run_job, shares_in_words, split_unit,
};
use serde_json::{Value, json};
use std::f64::consts::TAU;
use std::time::Duration;

/// Lines of the table of columns; all are in the JSON and in the file.
const MOST_LINES: usize = 40;

/// Columns of the tables of sweeps and equilibria.
const MOST_COLUMNS: usize = 5;

/// Bodies and force elements named with a mode.
const MOST_SHARES: usize = 3;

/// Runs a scene.
pub fn run(loaded: LoadedSystem, arguments: &RunArguments) -> Result<(), Failure> {
    let job = RunJob::from_scene(loaded)?;
    job.head.notes.iter().for_each(console::note);
    let resumes = job.kind.resumes();
    let bar = RunBar::new(job.kind.name());
    let progress = |advance: Advance| {
        if advance.resumed {
            console::note(format!(
                "goes on from the checkpoint at {:.6} of {}",
                advance.done, advance.total
            ));
        }
        bar.advance(advance.done, advance.total);
    };
    let stop = interrupt::on_demand();
    let outcome = run_job(
        job,
        &RunOptions {
            output: &arguments.output,
            restart: arguments.restart,
            checkpoint_interval: Duration::from_secs_f64(arguments.checkpoint_s),
            stop: &stop.asked,
            progress: &progress,
        },
    );
    bar.finish();
    if outcome? == Outcome::Stopped {
        console::error(if resumes {
            "interrupted; the same command goes on from here, --restart begins anew"
        } else {
            "interrupted; nothing is written"
        });
        std::process::exit(interrupt::EXIT_CODE);
    }
    drop(stop);
    let result = SystemResult::open(&arguments.output).map_err(Failure::work)?;
    ratings::warn(&result.ratings);
    if arguments.json {
        console::json(&figures(&result)?);
    } else {
        table(&result)?.into_iter().for_each(console::data);
    }
    // The file is kept: it shows where things go wrong.
    match result.problem() {
        Some(problem) => Err(Failure::work(problem)),
        None => Ok(()),
    }
}

/// The figures for people.
pub fn table(result: &SystemResult) -> Result<Vec<String>, Failure> {
    let mut lines = vec![format!("{}: {}", result.head.title, result.kind)];
    if let Some(record) = &result.record {
        lines.extend(effort(
            record,
            result.relative_energy_error().unwrap_or(f64::NAN),
        ));
    }
    lines.extend(match &result.kind[..] {
        "transient" => columns(result)?,
        "speed-sweep" => sweep(result),
        "static" => [equilibria(result)?, mesh_axes::lines(result)?].concat(),
        _ => result.eigen.iter().flat_map(|p| modes(result, p)).collect(),
    });
    lines.extend(ratings::lines(&result.ratings));
    Ok(lines)
}

fn effort(r: &RunRecord, relative_energy_error: f64) -> Vec<String> {
    let per_step = |count: f64| count / r.steps.max(1.0);
    vec![
        format!(
            "{:.6} s simulated in {:.3} s: {:.4} times real time",
            r.simulated_s,
            r.wall_s,
            r.real_time_factor()
        ),
        format!(
            "{} steps of {:.3e} to {:.3e} s ({} rejected, {} not converged), {:.2} iterations, {:.2} evaluations, {:.4} factorisations a step",
            r.steps,
            r.least_step_s,
            r.largest_step_s,
            r.rejected,
            r.unconverged,
            per_step(r.iterations),
            per_step(r.evaluations),
            per_step(r.factorisations)
        ),
        format!(
            "joints hold to {:.1e} m or rad, their rates to {:.1e}; energy balances to {:.2e} J, {:.1e} of the work done",
            r.largest_violation,
            r.largest_violation_rate,
            r.largest_energy_error_j,
            relative_energy_error
        ),
    ]
}

fn columns(result: &SystemResult) -> Result<Vec<String>, Failure> {
    let mut found = result.summaries(is_prominent).map_err(Failure::work)?;
    let all = found.len();
    found.retain(|column| column.figures.least != 0.0 || column.figures.largest != 0.0);
    found.sort_by_key(|column| rank(&column.name));
    let stems = found.iter().map(|column| split_unit(&column.name).0);
    let width = stems
        .take(MOST_LINES)
        .map(|stem| stem.chars().count())
        .max();
    let width = width.unwrap_or(0).max(6);
    let mut lines = vec![format!(
        "{:width$} {:<7} {:>11} {:>11} {:>11} {:>12}",
        "column", "unit", "mean", "deviation", "pk-pk", "dominant Hz"
    )];
    for ColumnSummary {
        name,
        figures,
        dominant_hz,
    } in found.iter().take(MOST_LINES)
    {
        let (stem, unit) = split_unit(name);
        let largest = figures.least.abs().max(figures.largest.abs());
        let (factor, unit) = usual_unit(unit, largest);
        let dominant = dominant_hz.map_or("-".to_owned(), |hz| format!("{hz:.3}"));
        lines.push(format!(
            "{stem:width$} {unit:<7} {:>11} {:>11} {:>11} {dominant:>12}",
            short(factor * figures.mean),
            short(factor * figures.deviation),
            short(factor * figures.peak_to_peak())
        ));
    }
    let shown = found.len().min(MOST_LINES);
    if shown < all {
        let zero = all - found.len();
        lines.push(format!(
            "and {} more, {zero} of them zero throughout",
            all - shown
        ));
    }
    Ok(lines)
}

fn sweep(result: &SystemResult) -> Vec<String> {
    let Some(sweep) = &result.sweep else {
        return Vec::new();
    };
    let varying = sweep.varying();
    let mut chosen: Vec<(usize, &String)> = sweep.columns.iter().enumerate().collect();
    chosen.retain(|(place, name)| varying[*place] && is_prominent(name));
    chosen.sort_by_key(|(_, name)| rank(name));
    chosen.truncate(MOST_COLUMNS);
    let mut head = format!("{:>12} {:>5}", "speed rpm", "way");
    let mut factors = Vec::new();
    for (column, name) in &chosen {
        let (stem, unit) = split_unit(name);
        let windows = sweep.figures.iter();
        let largest = windows.fold(0.0, |most: f64, figures| {
            most.max(figures[*column].peak_to_peak())
        });
        let (factor, unit) = usual_unit(unit, largest);
        factors.push(factor);
        head += &format!(" {:>32}", format!("pk-pk {} {unit}", last_parts(stem)));
    }
    let mut lines = vec![head];
    for (window, figures) in sweep.windows.iter().zip(&sweep.figures) {
        let mut line = format!(
            "{:>12.3} {:>5}",
            window.speed_rad_per_s * 60.0 / TAU,
            if window.up { "up" } else { "down" }
        );
        for ((column, _), factor) in chosen.iter().zip(&factors) {
            line += &format!(" {:>32}", short(factor * figures[*column].peak_to_peak()));
        }
        lines.push(line);
    }
    lines
}

/// The last two parts of a column's name.
fn last_parts(name: &str) -> String {
    let parts: Vec<&str> = name.split('/').collect();
    let last = parts[parts.len().saturating_sub(2)..].join("/");
    let cut = last.chars().count().saturating_sub(22);
    last.chars().skip(cut).collect()
}

fn equilibria(result: &SystemResult) -> Result<Vec<String>, Failure> {
    let names = result.rows.columns().iter().map(|c| c.name.as_str());
    let leading = names
        .clone()
        .filter(|name| matches!(*name, "load_factor" | "angle_rad"));
    let mut channels: Vec<&str> = names.clone().filter(|name| is_prominent(name)).collect();
    channels.sort_by_key(|name| rank(name));
    let mut chosen: Vec<&str> = leading.chain(channels).take(MOST_COLUMNS + 2).collect();
    if chosen.iter().all(|name| !is_prominent(name)) {
        let angles = names.filter(|name| name.ends_with("/turn_rad"));
        chosen.extend(angles.take(MOST_COLUMNS));
    }
    let (mut head, mut columns) = (Vec::new(), Vec::new());
    for name in chosen {
        let (stem, unit) = split_unit(name);
        let values = result.rows.read(name).map_err(Failure::work)?;
        let largest = values.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let (factor, unit) = usual_unit(unit, largest);
        let title = format!("{} {unit}", last_parts(stem));
        head.push(format!("{:>28}", title.trim_end()));
        columns.push(
            values
                .into_iter()
                .map(move |x| short(factor * x))
                .collect::<Vec<_>>(),
        );
    }
    let mut lines = vec![head.join(" ")];
    for row in 0..result.rows.rows() {
        let cells = columns.iter().map(|column| format!("{:>28}", column[row]));
        lines.push(cells.collect::<Vec<_>>().join(" "));
    }
    Ok(lines)
}

fn modes(result: &SystemResult, found: &EigenResult) -> Vec<String> {
    let mut title = format!("load factor {}", found.point.load_factor);
    if let Some(speed) = found.point.speed_rad_per_s {
        title += &format!(", {:.3} rpm", speed * 60.0 / TAU);
    }
    let mut lines = vec![
        title,
        format!(
            "{:>5} {:>13} {:>11}  {:<44} share of the strain energy",
            "mode", "frequency Hz", "damping %", "share of the kinetic energy"
        ),
    ];
    let mut overdamped = Vec::new();
    for (k, mode) in found.modes.iter().enumerate() {
        let moves = shares_in_words(&result.bodies, &found.participation[k], MOST_SHARES);
        let strain = found.strain.get(k);
        let strained = strain.map_or(String::new(), |shares| {
            shares_in_words(&result.elements, shares, MOST_SHARES)
        });
        if is_overdamped(mode) {
            let decay_ms = -1e3 / mode.growth_per_s;
            overdamped.push(format!(
                "{:>5} {:>13} {:>11}  {moves:<44} {strained}",
                k + 1,
                short(decay_ms),
                ""
            ));
            continue;
        }
        let line = format!(
            "{:>5} {:>13.4} {:>11.4}  {moves:<44} {strained}",
            k + 1,
            mode.frequency_hz(),
            100.0 * mode.damping_ratio()
        );
        lines.push(line.trim_end().to_owned());
    }
    if !overdamped.is_empty() {
        lines.push(format!(
            "{} motions die out without vibrating (overdamped); time in ms to 1/e:",
            overdamped.len()
        ));
        lines.extend(overdamped);
    }
    lines
}

/// The figures for machines.
fn figures(result: &SystemResult) -> Result<Value, Failure> {
    let mut value =
        json!({"title": result.head.title, "kind": result.kind, "notes": result.head.notes});
    if let Some(record) = &result.record {
        let entries = record
            .entries()
            .map(|(name, _, value)| (name.to_owned(), json!(value)));
        let mut run = Value::Object(entries.collect());
        run["real_time_factor"] = json!(record.real_time_factor());
        run["relative_energy_error"] = json!(result.relative_energy_error());
        run["problem"] = json!(result.problem());
        value["run"] = run;
    }
    value["ratings"] = ratings::json(&result.ratings);
    match &result.kind[..] {
        "transient" => {
            let columns = result.summaries(|_| true).map_err(Failure::work)?;
            let columns = columns.iter().map(|c| {
                json!({
                    "name": c.name, "mean": c.figures.mean, "deviation": c.figures.deviation, "least": c.figures.least,
                    "largest": c.figures.largest, "dominant_Hz": c.dominant_hz,
                })
            });
            value["rows"] = json!(result.rows.rows());
            value["columns"] = columns.collect();
        }
        "speed-sweep" => {
            if let Some(sweep) = &result.sweep {
                let windows = sweep.windows.iter().zip(&sweep.figures);
                let windows = windows.map(|(window, figures)| {
                    json!({
                        "speed_rpm": window.speed_rad_per_s * 60.0 / TAU, "up": window.up, "from_s": window.from_s, "to_s": window.to_s,
                        "mean": figures.iter().map(|f| f.mean).collect::<Vec<_>>(),
                        "deviation": figures.iter().map(|f| f.deviation).collect::<Vec<_>>(),
                        "least": figures.iter().map(|f| f.least).collect::<Vec<_>>(),
                        "largest": figures.iter().map(|f| f.largest).collect::<Vec<_>>(),
                    })
                });
                value["windows"] = windows.collect();
                value["columns"] = json!(sweep.columns);
            }
        }
        "static" => {
            let read = |column: &gearmesh_model::Column| {
                let values = result.rows.read(&column.name).map_err(Failure::work)?;
                Ok((column.name.clone(), json!(values)))
            };
            let columns = result.rows.columns().iter().map(read);
            value["columns"] = Value::Object(columns.collect::<Result<_, Failure>>()?);
        }
        _ => {
            let points = result.eigen.iter().map(|found| {
                let modes = found.modes.iter().zip(&found.participation);
                let modes = modes.map(|(mode, shares)| {
                    json!({
                        "frequency_Hz": mode.frequency_hz(), "damping_ratio": mode.damping_ratio(), "growth_per_s": mode.growth_per_s,
                        "overdamped": is_overdamped(mode),
                        "participation": result.bodies.iter().zip(shares).map(|(b, s)| (b.clone(), json!(s))).collect::<serde_json::Map<_, _>>(),
                    })
                });
                json!({
                    "load_factor": found.point.load_factor,
                    "speed_rpm": found.point.speed_rad_per_s.map(|speed| speed * 60.0 / TAU),
                    "modes": modes.collect::<Vec<_>>(),
                })
            });
            value["points"] = points.collect();
        }
    }
    Ok(value)
}
