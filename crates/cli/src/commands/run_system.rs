//! `gearmesh run` on a multibody scene: runs it, resumes it, prints its figures.
//!
//! The table for people is in `system_table.rs`.

use crate::arguments::RunArguments;
use crate::commands::run::demand_size;
use crate::commands::{losses, stages, system_table};
use crate::console::{self, RunBar};
use crate::failure::Failure;
use crate::interrupt;
use gearmesh_model::Named;
use gearmesh_scene::system::LoadedSystem;
use gearmesh_scene::system_run::{
    Advance, Outcome, ResultKind, ResultSize, RunJob, RunOptions, SystemResult, is_overdamped,
    run as run_job,
};
use serde_json::{Value, json};
use std::f64::consts::TAU;
use std::time::Duration;

/// Runs a scene.
pub fn run(loaded: LoadedSystem, arguments: &RunArguments) -> Result<(), Failure> {
    loaded.scene.notes.iter().for_each(console::note);
    let slips = loaded.unit_slips();
    // Slips are among the notes of the job; what is refused may follow from them.
    let job = RunJob::from_scene(loaded).inspect_err(|_| console::unit_slips(slips))?;
    let before = job.head.notes.len();
    job.head.notes.iter().for_each(console::note);
    if let Some(size) = ResultSize::of(&job) {
        demand_size(size.bytes(), "output.interval_s", arguments)?;
    }
    let resumes = job.kind.resumes();
    let bar = RunBar::new(job.kind.of_result().name_in_files());
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
    (result.head.notes.iter().skip(before)).for_each(console::note);
    let warnings = result.warnings().map_err(Failure::work)?;
    warnings.iter().for_each(console::warning);
    if arguments.json {
        console::json(&figures(&result)?);
    } else {
        system_table::table(&result)?
            .into_iter()
            .for_each(console::data);
    }
    // The file is kept: it shows where things go wrong.
    match result.problem() {
        Some(problem) => Err(Failure::work(problem)),
        None => Ok(()),
    }
}

/// The figures for machines.
fn figures(result: &SystemResult) -> Result<Value, Failure> {
    let mut value = json!({"title": result.head.title, "kind": result.kind.to_string(), "notes": result.head.notes});
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
    value["ratings"] = gearmesh_report::run_figures::ratings(&result.ratings);
    value["warnings"] = json!(result.warnings().map_err(Failure::work)?);
    if let stages @ Value::Object(_) = stages::json(result)? {
        value["stages"] = stages;
    }
    if let losses @ Value::Object(_) = losses::json(result)? {
        value["losses"] = losses;
    }
    match result.kind {
        ResultKind::Transient => {
            let passings = result.mesh_passings().map_err(Failure::work)?;
            let columns = result.summaries(|_| true).map_err(Failure::work)?;
            let columns = columns.iter().map(|c| {
                json!({
                    "name": c.name, "unit": c.unit, "mean": c.figures.mean, "deviation": c.figures.deviation, "least": c.figures.least,
                    "largest": c.figures.largest, "dominant_Hz": c.dominant_hz,
                    "complete": !passings.iter().any(|mesh| mesh.leaves_incomplete(&c.name)),
                })
            });
            value["rows"] = json!(result.rows.rows());
            value["statistics_from_s"] = json!(result.statistics_from_s);
            value["samples_per_row"] = json!(result.samples_per_row);
            value["columns"] = columns.collect();
            let meshes = passings.iter().map(|mesh| {
                json!({
                    "name": mesh.mesh.name, "mean_frequency_Hz": mesh.frequency_hz, "pitches": mesh.pitches(),
                    "revolutions": mesh.revolutions,
                })
            });
            value["meshes"] = meshes.collect();
        }
        ResultKind::SpeedSweep => {
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
                let names = sweep.columns.iter().map(|column| &column.name);
                value["columns"] = json!(names.collect::<Vec<_>>());
                let units = sweep.columns.iter().map(|column| &column.unit);
                value["units"] = json!(units.collect::<Vec<_>>());
            }
        }
        ResultKind::Static => {
            let read = |column: &gearmesh_model::Column| {
                let values = result.rows.read(&column.name).map_err(Failure::work)?;
                Ok((column.name.clone(), json!(values)))
            };
            let columns = result.rows.columns().iter().map(read);
            value["columns"] = Value::Object(columns.collect::<Result<_, Failure>>()?);
        }
        ResultKind::Eigen => {
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
