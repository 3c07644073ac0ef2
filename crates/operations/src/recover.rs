//! Strain of all gauges of a pair's result, and a whole field on request.

use crate::bevel_stress::{self, BevelStressRequest};
use crate::cross_section::{FieldCase, field_of};
use crate::failure::Failure;
use crate::mesh_file::{LengthUnit, export_mesh};
use crate::result_scene::scene_of;
use crate::watch::Watch;
use crate::{output_name, overwriting};
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
    #[arg(long, requires = "field_angle_deg", requires = "field_output")]
    pub field_gear: Option<u8>,
    /// Driver angle of the field: the nearest computed position is taken
    #[arg(long)]
    pub field_angle_deg: Option<f64>,
    /// Torque of the field; the largest computed one where not given
    #[arg(long = "field-torque-Nm")]
    pub field_torque_Nm: Option<f64>,
    /// Mesh file of the field (vtu, ...)
    #[arg(long)]
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
    json!({"rows": rows.collect::<Vec<_>>(), "coverage": coverage(result), "seconds": result.seconds[1]})
}

/// Reads all gauges of both models, and writes the result with their strain; and a field where one is asked for.
///
/// # Errors
/// [`Failure`] where the models are not those of the result, have no gauges, or a file cannot be written.
pub fn recover(a: &RecoverRequest, watch: &Watch<'_>) -> Result<SceneResult, Failure> {
    let outputs: Vec<PathBuf> = a.field_output.iter().chain([&a.output]).cloned().collect();
    overwriting::refuse(vec![a.result.clone()], &outputs)?;
    output_name::demand_hdf5(&a.output)?;
    if let Some(path) = &a.field_output {
        output_name::demand_mesh(path)?;
    }
    let mut result = SceneResult::read(&a.result).map_err(Failure::input)?;
    let models = result.model_files.clone().map(PathBuf::from);
    for output in std::iter::once(&a.output).chain(&a.field_output) {
        overwriting::apart(output, &models)?;
    }
    if result.bevel.is_some() {
        return recover_bevel(a, result, watch);
    }
    let loaded = scene_of(&result, &a.result)?;
    let all: Vec<(usize, usize)> = (1..=2)
        .flat_map(|gear| (0..loaded.models[gear - 1].gauges.len()).map(move |k| (gear, k)))
        .collect();
    if all.is_empty() && a.field_gear.is_none() {
        return Err(Failure::input(NO_GAUGE));
    }
    let request = field_request(a, &result)?;
    let clock = std::time::Instant::now();
    result.strain = gearmesh_scene::pair::run::strain(&loaded, &result, &all)?;
    result.proposal = loaded.proposal(&all);
    result.seconds[1] = clock.elapsed().as_secs_f64();
    watch.go_on()?;
    result.write(&a.output)?;
    if let Some(request) = request {
        field(&request, &loaded, &result, watch)?;
    }
    Ok(result)
}

/// The same of a bevel pair, whose result says where on both flanks its teeth press.
fn recover_bevel(
    a: &RecoverRequest,
    mut result: SceneResult,
    watch: &Watch<'_>,
) -> Result<SceneResult, Failure> {
    if result.model_files[0].is_empty() {
        return Err(Failure::input(
            "the gears are rigid: their bodies have no strain; name reduced models, `models` of [load] in the pair file",
        ));
    }
    let models = bevel_stress::models_of(&result)?;
    let of = |gear: usize| (0..models[gear - 1].gauges.len()).map(move |k| (gear, k));
    let gauges: Vec<(usize, usize)> = (1..=2).flat_map(of).collect();
    if gauges.is_empty() && a.field_gear.is_none() {
        return Err(Failure::input(NO_GAUGE));
    }
    let clock = std::time::Instant::now();
    result.strain = strain(models.each_ref(), &result, &gauges).map_err(Failure::work)?;
    result.seconds[1] = clock.elapsed().as_secs_f64();
    let request = BevelStressRequest {
        field_gear: a.field_gear,
        field_angle_deg: a.field_angle_deg,
        field_torque_nm: a.field_torque_Nm,
        field_output: a.field_output.clone(),
        ..BevelStressRequest::default()
    };
    bevel_stress::asked(&request, Some(&result), watch)?;
    watch.go_on()?;
    result.write(&a.output)?;
    Ok(result)
}

/// The field that was asked for.
struct FieldRequest<'a> {
    case: FieldCase,
    output: &'a Path,
}

/// Checks the request for a field, where there is one.
fn field_request<'a>(
    a: &'a RecoverRequest,
    result: &SceneResult,
) -> Result<Option<FieldRequest<'a>>, Failure> {
    let Some(gear) = a.field_gear.map(usize::from) else {
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
    watch: &Watch<'_>,
) -> Result<(), Failure> {
    let FieldRequest { case, output } = request;
    let definition = result.gears[case.gear - 1].definition_in("the result")?;
    let python = watch.python()?;
    let body = watch.offline(&definition.name, |told| {
        GearBody::new(definition, &python, told)
    })?;
    let field = field_of(loaded, result, definition, &body, *case)?;
    let file = (*output, LengthUnit::M);
    export_mesh(definition, &body.mesh, (&field).into(), file, watch)?;
    watch.note(format!(
        "{}: field of gear {} at {:.4} deg and {} N m",
        output.display(),
        case.gear,
        result.angle_rad[case.angle].to_degrees(),
        result.torque_nm[case.torque]
    ));
    Ok(())
}
