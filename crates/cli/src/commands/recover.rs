//! `gearmesh recover`: strain of all gauges of both models; the whole field on request.

use crate::arguments::RecoverArguments;
use crate::commands::periods;
use crate::failure::Failure;
use crate::length_unit::LengthUnit;
use crate::offline::{self, FieldCase};
use crate::{console, console::StageBar, output_name, overwriting};
use gearmesh_geometry::input::InputDocument;
use gearmesh_reduction::GearBody;
use gearmesh_scene::{LoadedScene, Scene, SceneResult, load, run as scene_run};
use serde_json::json;
use std::path::{Path, PathBuf};

/// Runs the command.
pub fn run(a: &RecoverArguments) -> Result<(), Failure> {
    output_name::demand_hdf5(&a.output)?;
    if let Some(path) = &a.field_output {
        output_name::demand_mesh(path)?;
    }
    let mut result = SceneResult::read(&a.result).map_err(Failure::input)?;
    let models = result.model_files.clone().map(PathBuf::from);
    for output in std::iter::once(&a.output).chain(&a.field_output) {
        overwriting::apart(output, &models)?;
    }
    let loaded = scene_of(&result, &a.result)?;
    let all: Vec<(usize, usize)> = (1..=2)
        .flat_map(|gear| (0..loaded.models[gear - 1].gauges.len()).map(move |k| (gear, k)))
        .collect();
    if all.is_empty() && a.field_gear.is_none() {
        return Err(Failure::input(
            "neither model has a gauge; add [[gauge]] to a gear file and reduce it again",
        ));
    }
    let request = field_request(a, &result)?;
    let clock = std::time::Instant::now();
    result.strain = scene_run::strain(&loaded, &result, &all)?;
    result.proposal = loaded.proposal(&all);
    result.seconds[1] = clock.elapsed().as_secs_f64();
    result.write(&a.output).map_err(Failure::work)?;
    print(&result, a.json)?;
    if let Some(request) = request {
        field(&request, &loaded, &result)?;
    }
    Ok(())
}

/// The scene of a result, with its models; their paths are those of the run.
pub fn scene_of(result: &SceneResult, path: &Path) -> Result<LoadedScene, Failure> {
    let document = InputDocument::new(
        format!("scene inside {}", path.display()),
        result.scene_toml.clone(),
    );
    let mut scene = Scene::from_document(document, Path::new(""))?.with_known_forces();
    scene.gear_1 = result.model_files[0].clone().into();
    scene.gear_2 = result.model_files[1].clone().into();
    let mut loaded = load(scene.clone())?;
    if scene.path_by_default && !loaded.has_lines_of(result) {
        // Written when the rigid path was the default.
        scene.edge_radius_m = None;
        loaded = load(scene)?;
    }
    if !loaded.has_lines_of(result) {
        return Err(Failure::input(format!(
            "the scene inside {} does not give its contact lines; run the scene again",
            path.display()
        )));
    }
    for (k, model) in loaded.models.iter().enumerate() {
        if model.input != result.gears[k] {
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
    for (number, series) in result.strain.iter().enumerate() {
        for (k, torque) in result.torque_nm.iter().enumerate() {
            let range = |method: usize| {
                let [least, most] = result.strain_ends(number, method, k);
                most - least
            };
            rows.push((series, *torque, range(1), range(2)));
        }
    }
    if as_json {
        let list: Vec<_> = rows
            .iter()
            .map(|(s, torque, one, two)| {
                json!({"gear": s.gear, "gauge": s.name, "torque_Nm": torque, "range_method_1": one, "range_method_2": two,
                       "complete": s.coverage.has_extremes(), "mesh_error_relative": s.error_estimate()})
            })
            .collect();
        console::json(
            &json!({"rows": list, "coverage": gearmesh_report::run_figures::coverage(result), "seconds": result.seconds[1]}),
        );
        return Ok(());
    }
    console::data(format!(
        "{:>4} {:<18} {:>10} {:>18} {:>18} {:>14}",
        "gear", "gauge", "torque N m", "range 1 ustrain", "range 2 ustrain", "mesh error"
    ));
    for (s, torque, one, two) in rows {
        console::data(format!(
            "{:>4} {:<18} {torque:>10.1} {:>18.2} {:>18.2} {:>14}{}",
            s.gear,
            s.name,
            one * 1e6,
            two * 1e6,
            console::mesh_error(s.error_estimate()),
            periods::mark_of_extremes(&s.coverage)
        ));
    }
    console::data(format!(
        "{} gauges, {} positions, both methods: {:.3} s",
        result.strain.len(),
        result.angles() * result.torque_nm.len(),
        result.seconds[1]
    ));
    periods::lines(result).into_iter().for_each(console::data);
    Ok(())
}

/// The field that was asked for.
struct FieldRequest<'a> {
    case: FieldCase,
    output: &'a Path,
}

/// Checks the request for a field, where there is one.
fn field_request<'a>(
    a: &'a RecoverArguments,
    result: &SceneResult,
) -> Result<Option<FieldRequest<'a>>, Failure> {
    let Some(gear) = a.field_gear else {
        return Ok(None);
    };
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
    let wanted = angle_deg.to_radians();
    let distance = |k: usize| (result.angle_rad[k] - wanted).abs();
    let angle = (0..result.angles())
        .min_by(|i, j| distance(*i).total_cmp(&distance(*j)))
        .unwrap_or(0);
    let torques = &result.torque_nm;
    let torque = match a.field_torque_Nm {
        None => (0..torques.len()).max_by(|i, j| torques[*i].total_cmp(&torques[*j])),
        Some(wanted) => torques
            .iter()
            .position(|t| (t - wanted).abs() < 1e-9 * wanted.abs()),
    };
    let torque = torque.ok_or_else(|| {
        Failure::input(format!(
            "--field-torque-Nm: found {}, the result has {torques:?}",
            a.field_torque_Nm.unwrap_or_default()
        ))
    })?;
    Ok(Some(FieldRequest {
        case: FieldCase {
            gear,
            torque,
            angle,
        },
        output,
    }))
}

fn field(
    request: &FieldRequest<'_>,
    loaded: &LoadedScene,
    result: &SceneResult,
) -> Result<(), Failure> {
    let FieldRequest { case, output } = request;
    let definition = result.gears[case.gear - 1].definition_in("the result")?;
    let bar = StageBar::new(&definition.name);
    let body = GearBody::new(definition, &offline::python()?, &bar)?;
    bar.finish();
    let field = offline::field_of(loaded, result, definition, &body, *case)?;
    offline::export_mesh(
        definition,
        &body.mesh,
        (&field).into(),
        LengthUnit::M,
        output,
    )?;
    console::note(format!(
        "{}: field of gear {} at {:.4} deg and {} N m",
        output.display(),
        case.gear,
        result.angle_rad[case.angle].to_degrees(),
        result.torque_nm[case.torque]
    ));
    Ok(())
}
