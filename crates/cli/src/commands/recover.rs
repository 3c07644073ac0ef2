//! `gearmesh recover`: strain of all gauges of both models; the whole field on request.

use crate::arguments::RecoverArguments;
use crate::failure::Failure;
use crate::offline::{self, FieldCase};
use crate::{console, console::StageBar};
use gearmesh_geometry::GearDefinition;
use gearmesh_geometry::input::InputDocument;
use gearmesh_reduction::GearBody;
use gearmesh_scene::{LoadedScene, Scene, SceneResult, load, run as scene_run};
use gearmesh_signal::statistics::peak_to_peak;
use serde_json::json;
use std::path::Path;

/// Runs the command.
pub fn run(a: &RecoverArguments) -> Result<(), Failure> {
    let mut result = SceneResult::read(&a.result).map_err(Failure::input)?;
    let loaded = scene_of(&result, &a.result)?;
    let all: Vec<(usize, usize)> = (1..=2)
        .flat_map(|gear| (0..loaded.models[gear - 1].gauges.len()).map(move |k| (gear, k)))
        .collect();
    if all.is_empty() && a.field_gear.is_none() {
        return Err(Failure::input(
            "neither model has a gauge; add [[gauge]] to a gear file and reduce it again",
        ));
    }
    let clock = std::time::Instant::now();
    result.strain = scene_run::strain(&loaded, &result, &all)?;
    result.seconds[1] = clock.elapsed().as_secs_f64();
    result.write(&a.output).map_err(Failure::work)?;
    print(&result, a.json)?;
    if let Some(gear) = a.field_gear {
        field(a, &loaded, &result, gear)?;
    }
    Ok(())
}

/// The scene of a result, with its models; their paths are those of the run.
pub fn scene_of(result: &SceneResult, path: &Path) -> Result<LoadedScene, Failure> {
    let document = InputDocument::new(
        format!("scene inside {}", path.display()),
        result.scene_toml.clone(),
    );
    let mut scene = Scene::from_document(document, Path::new(""))?;
    scene.gear_1 = result.model_files[0].clone().into();
    scene.gear_2 = result.model_files[1].clone().into();
    let loaded = load(scene)?;
    for (k, model) in loaded.models.iter().enumerate() {
        if model.input_toml != result.gear_toml[k] {
            return Err(Failure::input(format!(
                "{} has been made again from another gear file since {} was computed; run the scene again",
                result.model_files[k],
                path.display()
            )));
        }
    }
    Ok(loaded)
}

fn print(result: &SceneResult, as_json: bool) -> Result<(), Failure> {
    let mut rows = Vec::new();
    for series in &result.strain {
        for (k, torque) in result.torque_nm.iter().enumerate() {
            let range =
                |values: &[f64]| peak_to_peak(result.curve(values, k)).map_err(Failure::work);
            rows.push((
                series,
                *torque,
                range(&series.method_1)?,
                range(&series.method_2)?,
            ));
        }
    }
    if as_json {
        let list: Vec<_> = rows
            .iter()
            .map(|(s, torque, one, two)| {
                json!({"gear": s.gear, "gauge": s.name, "torque_Nm": torque, "range_method_1": one, "range_method_2": two,
                       "mesh_error_relative": s.error_estimate_relative})
            })
            .collect();
        console::json(&json!({"rows": list, "seconds": result.seconds[1]}));
        return Ok(());
    }
    console::data(format!(
        "{:>4} {:<18} {:>10} {:>18} {:>18} {:>12}",
        "gear", "gauge", "torque N m", "range 1 ustrain", "range 2 ustrain", "mesh error %"
    ));
    for (s, torque, one, two) in rows {
        console::data(format!(
            "{:>4} {:<18} {torque:>10.1} {:>18.2} {:>18.2} {:>12.2}",
            s.gear,
            s.name,
            one * 1e6,
            two * 1e6,
            100.0 * s.error_estimate_relative
        ));
    }
    console::data(format!(
        "{} gauges, {} positions, both methods: {:.3} s",
        result.strain.len(),
        result.angles() * result.torque_nm.len(),
        result.seconds[1]
    ));
    Ok(())
}

fn field(
    a: &RecoverArguments,
    loaded: &LoadedScene,
    result: &SceneResult,
    gear: usize,
) -> Result<(), Failure> {
    if !(1..=2).contains(&gear) {
        return Err(Failure::input(format!(
            "--field-gear: found {gear}, allowed is 1 or 2"
        )));
    }
    let (Some(angle_deg), Some(output)) = (a.field_angle_deg, &a.field_output) else {
        return Err(Failure::input(
            "--field-gear needs --field-angle-deg and --field-output",
        ));
    };
    let nearest = |values: &[f64], wanted: f64| {
        (0..values.len())
            .min_by(|i, j| {
                (values[*i] - wanted)
                    .abs()
                    .total_cmp(&(values[*j] - wanted).abs())
            })
            .unwrap_or(0)
    };
    let angle = nearest(&result.angle_rad, angle_deg.to_radians());
    let torque = match a.field_torque_Nm {
        None => nearest(&result.torque_nm, f64::INFINITY.min(1e300)),
        Some(wanted) => result
            .torque_nm
            .iter()
            .position(|t| (t - wanted).abs() < 1e-9 * wanted.abs())
            .ok_or_else(|| {
                Failure::input(format!(
                    "--field-torque-Nm: found {wanted}, the result has {:?}",
                    result.torque_nm
                ))
            })?,
    };
    let document = InputDocument::new("gear in result", result.gear_toml[gear - 1].clone());
    let definition = GearDefinition::from_document(&document)?;
    let bar = StageBar::new(&definition.name);
    let body = GearBody::new(&definition, &offline::python()?, &bar)?;
    bar.finish();
    let field = offline::field_of(
        loaded,
        result,
        &definition,
        &body,
        FieldCase {
            gear,
            torque,
            angle,
        },
    )?;
    offline::export_mesh(&definition, &body.mesh, Some(&field), output)?;
    console::note(format!(
        "{}: field of gear {gear} at {:.4} deg and {} N m",
        output.display(),
        result.angle_rad[angle].to_degrees(),
        result.torque_nm[torque]
    ));
    Ok(())
}
