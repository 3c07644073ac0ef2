//! `gearmesh run` on a multibody scene: runs it, resumes it, prints its figures.

use crate::arguments::RunArguments;
use crate::commands::ratings;
use crate::console::{self, RunBar};
use crate::failure::Failure;
use crate::interrupt;
use gearmesh_scene::system::LoadedSystem;
use gearmesh_scene::system_run::{
    Advance, ColumnSummary, EigenResult, Outcome, RunJob, RunOptions, RunRecord, SystemResult,
    is_prominent, run as run_job,
};
use serde_json::{Value, json};
use std::f64::consts::TAU;
use std::time::Duration;

/// Lines of the table of columns; all are in the JSON and in the file.
const MOST_LINES: usize = 40;

/// Columns of the tables of sweeps and equilibria.
const MOST_COLUMNS: usize = 5;

/// Bodies named with a mode.
const MOST_BODIES: usize = 3;

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
        "static" => equilibria(result)?,
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
    let of_a_mesh = |name: &str| {
        let mut meshes = result.head.meshes.iter();
        meshes.any(|mesh| name.starts_with(&format!("elements/{}/", mesh.name)))
    };
    // Gear meshes, other force elements, speeds.
    found.sort_by_key(|column| {
        let name = &column.name[..];
        (!of_a_mesh(name), !name.starts_with("elements/"))
    });
    let width = found
        .iter()
        .take(MOST_LINES)
        .map(|column| column.name.chars().count())
        .max()
        .unwrap_or(0)
        .max(6);
    let mut lines = vec![format!(
        "{:width$} {:>13} {:>13} {:>13} {:>12}",
        "column", "mean", "deviation", "pk-pk", "dominant Hz"
    )];
    for ColumnSummary {
        name,
        figures,
        dominant_hz,
    } in found.iter().take(MOST_LINES)
    {
        let dominant = dominant_hz.map_or("-".to_owned(), |hz| format!("{hz:.3}"));
        lines.push(format!(
            "{name:width$} {:>13.6e} {:>13.6e} {:>13.6e} {dominant:>12}",
            figures.mean,
            figures.deviation,
            figures.peak_to_peak()
        ));
    }
    if found.len() > MOST_LINES {
        lines.push(format!("and {} more", found.len() - MOST_LINES));
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
    chosen.sort_by_key(|(_, name)| !name.starts_with("elements/"));
    chosen.truncate(MOST_COLUMNS);
    let mut head = format!("{:>12} {:>5}", "speed rpm", "way");
    for (_, name) in &chosen {
        head += &format!(" {:>30}", format!("pk-pk {}", short(name)));
    }
    let mut lines = vec![head];
    for (window, figures) in sweep.windows.iter().zip(&sweep.figures) {
        let mut line = format!(
            "{:>12.3} {:>5}",
            window.speed_rad_per_s * 60.0 / TAU,
            if window.up { "up" } else { "down" }
        );
        for (column, _) in &chosen {
            line += &format!(" {:>30.6e}", figures[*column].peak_to_peak());
        }
        lines.push(line);
    }
    lines
}

/// The last two parts of a column's name.
fn short(name: &str) -> String {
    let parts: Vec<&str> = name.split('/').collect();
    let short = parts[parts.len().saturating_sub(2)..].join("/");
    let cut = short.chars().count().saturating_sub(24);
    short.chars().skip(cut).collect()
}

fn equilibria(result: &SystemResult) -> Result<Vec<String>, Failure> {
    let names = result.rows.columns().iter().map(|c| c.name.as_str());
    let leading = names
        .clone()
        .filter(|name| matches!(*name, "load_factor" | "angle_rad"));
    let channels = names.clone().filter(|name| is_prominent(name));
    let mut chosen: Vec<&str> = leading.chain(channels).take(MOST_COLUMNS + 2).collect();
    if chosen.iter().all(|name| !is_prominent(name)) {
        let angles = names.filter(|name| name.ends_with("/turn_rad"));
        chosen.extend(angles.take(MOST_COLUMNS));
    }
    let read = |name: &&str| result.rows.read(name).map_err(Failure::work);
    let values = chosen.iter().map(read).collect::<Result<Vec<_>, _>>()?;
    let head = chosen.iter().map(|name| format!("{:>26}", short(name)));
    let mut lines = vec![head.collect::<Vec<_>>().join(" ")];
    for row in 0..result.rows.rows() {
        let cells = values
            .iter()
            .map(|column| format!("{:>26.8e}", column[row]));
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
            "{:>5} {:>15} {:>12} {:>14}  share of the kinetic energy",
            "mode", "frequency Hz", "damping %", "growth 1/s"
        ),
    ];
    for (k, (mode, shares)) in found.modes.iter().zip(&found.participation).enumerate() {
        let mut order: Vec<usize> = (0..shares.len()).collect();
        order.sort_by(|&a, &b| shares[b].total_cmp(&shares[a]));
        let bodies = order
            .iter()
            .take(MOST_BODIES)
            .filter(|&&body| shares[body] > 5e-4)
            .map(|&body| format!("{} {:.1} %", result.bodies[body], 100.0 * shares[body]));
        lines.push(format!(
            "{:>5} {:>15.6} {:>12.4} {:>14.5e}  {}",
            k + 1,
            mode.frequency_hz(),
            100.0 * mode.damping_ratio(),
            mode.growth_per_s,
            bodies.collect::<Vec<_>>().join(", ")
        ));
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
