//! Strain of all gauges of a pair's result, and a whole field on request.

use crate::bevel_stress;
use crate::cross_section::{FieldCase, field_of};
use crate::failure::{Failure, Result};
use crate::mesh_file::{LengthUnit, export_mesh};
use crate::result_scene::scene_of;
use crate::watch::Watch;
use crate::{output_name, overwriting};
use gearmesh_model::ReducedGear;
use gearmesh_reduction::GearBody;
use gearmesh_report::run_figures::coverage;
use gearmesh_scene::pair::bevel_result::strain;
use gearmesh_scene::{LoadedScene, SceneResult};
use serde::Deserialize;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// What is recovered from which result.
#[derive(Debug, Clone, clap::Args, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct RecoverRequest {
    /// Result file
    pub result: PathBuf,
    /// Strain file
    #[arg(short, long)]
    pub output: PathBuf,
    /// Write the displacement and von Mises field of this gear (1 or 2), too
    #[arg(long, requires = "field_output")]
    pub field_gear: Option<u8>,
    /// Driver angle of the field, the nearest computed position is taken [default: where a pair of teeth carries most]
    #[arg(long, allow_negative_numbers = true, requires = "field_gear")]
    pub field_angle_deg: Option<f64>,
    /// Torque of the field; the largest computed one where not given
    #[arg(
        long = "field-torque-Nm",
        allow_negative_numbers = true,
        requires = "field_gear"
    )]
    pub field_torque_Nm: Option<f64>,
    /// Mesh file of the field (vtu, ...)
    #[arg(long, requires = "field_gear")]
    pub field_output: Option<PathBuf>,
}

/// Why there is nothing to recover.
const NO_GAUGE: &str =
    "neither model has a gauge; add [[gauge]] to a gear file and reduce it again";

/// Ranges of strain at a gauge under a torque.
#[derive(Debug, Clone)]
pub struct StrainRange {
    /// Place of the gauge among the result's series.
    pub series: usize,
    /// Torque \[N m\].
    pub torque_nm: f64,
    /// Largest less least strain by methods 1 and 2.
    pub ranges: [f64; 2],
}

/// All gauges under all torques.
#[must_use]
pub fn strain_ranges(result: &SceneResult) -> Vec<StrainRange> {
    let mut rows = Vec::new();
    for series in 0..result.strain.len() {
        for (k, torque_nm) in result.torque_nm.iter().enumerate() {
            let range = |method: usize| {
                let [least, most] = result.strain_ends(series, method, k);
                most - least
            };
            rows.push(StrainRange {
                series,
                torque_nm: *torque_nm,
                ranges: [range(1), range(2)],
            });
        }
    }
    rows
}

/// The ranges for other programs.
#[must_use]
pub fn figures(result: &SceneResult) -> Value {
    let rows = strain_ranges(result).into_iter().map(|row| {
        let series = &result.strain[row.series];
        let [one, two] = row.ranges;
        json!({"gear": series.gear, "gauge": series.name, "torque_Nm": row.torque_nm, "range_method_1": one, "range_method_2": two,
               "complete": series.coverage.has_extremes(), "mesh_error_relative": series.error_estimate()})
    });
    json!({"rows": rows.collect::<Vec<_>>(), "coverage": coverage(result), "seconds": result.solution.seconds[1]})
}

/// Reads all gauges of both models, and writes the result with their strain; and a field where one is asked for.
///
/// # Errors
/// [`Failure`] where the models are not those of the result, have no gauges, or a file cannot be written.
pub fn recover(a: &RecoverRequest, watch: &Watch<'_>) -> Result<SceneResult> {
    let outputs: Vec<PathBuf> = a.field_output.iter().chain([&a.output]).cloned().collect();
    overwriting::refuse(vec![a.result.clone()], &outputs)?;
    output_name::demand_hdf5(&a.output)?;
    if let Some(path) = &a.field_output {
        output_name::demand_mesh(path)?;
    }
    let mut result = SceneResult::read(&a.result).map_err(Failure::input)?;
    let models = result.source.model_files.clone().map(PathBuf::from);
    for output in std::iter::once(&a.output).chain(&a.field_output) {
        overwriting::apart(output, &models)?;
    }
    let request = field_request(a, &result)?;
    let scene = match result.bevel {
        Some(_) => None,
        None => Some(scene_of(&result, &a.result)?),
    };
    let clock = std::time::Instant::now();
    match &scene {
        Some(loaded) => {
            let all = gauges(loaded.models.each_ref().map(|model| &**model), &request)?;
            result.strain = gearmesh_scene::pair::run::strain(loaded, &result, &all)?;
            result.proposal = loaded.proposal(&all);
        }
        None => {
            bevel_stress::demand_bodies(&result, "recover")?;
            let models = bevel_stress::models_of(&result)?;
            let all = gauges(models.each_ref(), &request)?;
            result.strain = strain(models.each_ref(), &result, &all).map_err(Failure::work)?;
        }
    }
    result.solution.seconds[1] = clock.elapsed().as_secs_f64();
    watch.go_on()?;
    result.write(&a.output)?;
    match (request, &scene) {
        (Some((case, output)), Some(loaded)) => field((case, output), loaded, &result, watch)?,
        (Some((case, output)), None) => bevel_stress::write_field(&result, case, output, watch)?,
        (None, _) => {}
    }
    Ok(result)
}

/// All gauges of both models: gear and index in its model.
fn gauges(
    models: [&ReducedGear; 2],
    request: &Option<FieldRequest<'_>>,
) -> Result<Vec<(usize, usize)>> {
    let of = |gear: usize| (0..models[gear - 1].gauges.len()).map(move |k| (gear, k));
    let all: Vec<(usize, usize)> = [1, 2].into_iter().flat_map(of).collect();
    match all.is_empty() && request.is_none() {
        true => Err(Failure::input(NO_GAUGE)),
        false => Ok(all),
    }
}

/// A field that is asked for, and its file.
type FieldRequest<'a> = (FieldCase, &'a Path);

/// Checks the request for a field, where there is one.
fn field_request<'a>(
    a: &'a RecoverRequest,
    result: &SceneResult,
) -> Result<Option<FieldRequest<'a>>> {
    let place = (a.field_angle_deg, a.field_torque_Nm);
    match (a.field_gear, &a.field_output) {
        (Some(gear @ 1..=2), Some(output)) => {
            let case = FieldCase::asked(result, gear.into(), place)?;
            Ok(Some((case, output)))
        }
        (Some(gear @ 1..=2), None) => Err(Failure::input(format!(
            "--field-gear {gear} needs --field-output"
        ))),
        (Some(gear), _) => Err(Failure::input(format!(
            "--field-gear: found {gear}, allowed is 1 or 2"
        ))),
        (None, None) if place == (None, None) => Ok(None),
        (None, _) => Err(Failure::input(
            "--field-angle-deg, --field-torque-Nm and --field-output need --field-gear",
        )),
    }
}

fn field(
    (case, output): FieldRequest<'_>,
    loaded: &LoadedScene,
    result: &SceneResult,
    watch: &Watch<'_>,
) -> Result<()> {
    let definition = result.source.gears[case.gear - 1].definition_in("the result")?;
    let python = watch.python()?;
    let body = watch.offline(&definition.name, |told| {
        GearBody::new(definition, &python, told)
    })?;
    let field = field_of(loaded, result, definition, &body, case)?;
    let file = (output, LengthUnit::M);
    export_mesh(definition, &body.mesh, (&field).into(), file, watch)?;
    watch.note(format!(
        "{}: field of gear {}, {}",
        output.display(),
        case.gear,
        case.words(result)
    ));
    Ok(())
}
