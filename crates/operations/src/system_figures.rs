//! The figures of a multibody run for other programs.

use std::f64::consts::TAU;

use gearmesh_model::Column;
use gearmesh_scene::system_run::{Figures, ResultKind, SweepResult, SystemResult, is_overdamped};
use serde_json::{Value, json};

use crate::failure::{Failure, Result};
use crate::{losses, sets, stages};

/// All figures of a run.
///
/// # Errors
/// [`Failure`] where the result's file cannot be read.
pub fn figures(result: &SystemResult) -> Result<Value> {
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
    if let sets @ Value::Object(_) = sets::json(result)? {
        value["planetary"] = sets;
    }
    if let stages @ Value::Object(_) = stages::json(result)? {
        value["stages"] = stages;
    }
    if let losses @ Value::Object(_) = losses::json(result)? {
        value["losses"] = losses;
    }
    let of_kind = match result.kind {
        ResultKind::Transient => of_rows(result)?,
        ResultKind::SpeedSweep => result.sweep.as_ref().map_or(json!({}), of_sweep),
        ResultKind::Static => {
            let read = |column: &Column| {
                let values = result.rows.read(&column.name).map_err(Failure::work)?;
                Ok((column.name.clone(), json!(values)))
            };
            let columns = result.rows.columns().iter().map(read);
            json!({"columns": Value::Object(columns.collect::<Result<_>>()?)})
        }
        ResultKind::Eigen => of_points(result),
    };
    for (key, figures) in of_kind.as_object().into_iter().flatten() {
        value[key] = figures.clone();
    }
    Ok(value)
}

fn of_rows(result: &SystemResult) -> Result<Value> {
    let passings = result.mesh_passings().map_err(Failure::work)?;
    let columns = result.summaries(|_| true).map_err(Failure::work)?;
    let columns = columns.iter().map(|c| {
        json!({
            "name": c.name, "unit": c.unit, "mean": c.figures.mean, "deviation": c.figures.deviation, "least": c.figures.least,
            "largest": c.figures.largest, "dominant_Hz": c.dominant_hz,
            "complete": !passings.iter().any(|mesh| mesh.leaves_incomplete(&c.name)),
        })
    });
    let meshes = passings.iter().map(|mesh| {
        json!({
            "name": mesh.mesh.name, "mean_frequency_Hz": mesh.frequency_hz, "pitches": mesh.pitches(),
            "revolutions": mesh.revolutions,
        })
    });
    Ok(json!({
        "rows": result.rows.rows(), "statistics_from_s": result.statistics_from_s, "samples_per_row": result.samples_per_row,
        "columns": columns.collect::<Vec<_>>(), "meshes": meshes.collect::<Vec<_>>(),
    }))
}

fn of_sweep(sweep: &SweepResult) -> Value {
    let windows = sweep.windows.iter().zip(&sweep.figures);
    let windows = windows.map(|(window, figures)| {
        let all = |figure: fn(&Figures) -> f64| figures.iter().map(figure).collect::<Vec<_>>();
        json!({
            "speed_rpm": window.speed_rad_per_s * 60.0 / TAU, "up": window.up, "from_s": window.from_s, "to_s": window.to_s,
            "mean": all(|f| f.mean), "deviation": all(|f| f.deviation), "least": all(|f| f.least), "largest": all(|f| f.largest),
        })
    });
    let columns = || sweep.columns.iter();
    json!({
        "windows": windows.collect::<Vec<_>>(),
        "columns": columns().map(|column| &column.name).collect::<Vec<_>>(),
        "units": columns().map(|column| &column.unit).collect::<Vec<_>>(),
    })
}

fn of_points(result: &SystemResult) -> Value {
    let points = result.eigen.iter().map(|found| {
        let of_sets = found.set_modes(&result.bodies, &result.head.sets);
        let modes = found.modes.iter().zip(&found.participation).enumerate();
        let modes = modes.map(|(k, (mode, shares))| {
            let kinds = of_sets.iter().map(|set| (set.set.clone(), json!(set.kinds[k].name())));
            json!({
                "kind_in_set": kinds.collect::<serde_json::Map<_, _>>(),
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
    json!({"points": points.collect::<Vec<_>>()})
}
