//! `[[rating]]` to what is made of which columns of the result.

use gearmesh_geometry::input::TableKeys;
use gearmesh_geometry::{Flank, InputError};
use gearmesh_rating::{LoadPoint, NominalRating};

use super::bodies::Bodies;
use super::gear_mesh::{PreparedMesh, fitting_pair};
use crate::rating::{FatigueJob, FatigueRule, Rating, RatingTable, nominal_error, nominal_method};
use crate::system::built::{BuiltGauge, RatingJob, RatingRule};
use crate::system::names;
use crate::system::scene::SystemScene;
use crate::system::tables::gear_mesh::MeshModel;
use crate::system::tables::run::Run;
use crate::system_run::element_column;

/// All ratings of a scene.
pub(super) fn build(
    scene: &SystemScene,
    bodies: &Bodies,
    meshes: &[PreparedMesh],
    gauges: &[BuiltGauge],
) -> Result<Vec<RatingJob>, InputError> {
    let mut jobs = Vec::new();
    for (i, table) in scene.tables.rating.iter().enumerate() {
        let key = format!("rating.{i}");
        let keys = TableKeys::new(&scene.document, &key);
        let rating = table.check(&keys)?;
        table.refuse_keys_of_pairs(&keys)?;
        let from_s = start(scene, &rating, table.from_s, &keys)?;
        let job = match &rating {
            Rating::Fatigue(rule) => {
                fatigue(scene, (table, rule), from_s, (bodies, gauges), &keys)?
            }
            Rating::Nominal(load) => {
                let mesh = keys.needed("mesh", table.mesh.clone(), "kind = \"nominal\"")?;
                let prepared = meshes.iter().find(|other| other.name == mesh);
                let prepared = prepared.ok_or_else(|| {
                    let known: Vec<&str> = meshes.iter().map(|mesh| &*mesh.name).collect();
                    keys.error("mesh", names::unknown("gear mesh", &mesh, &known))
                })?;
                let job = nominal(prepared, *load, bodies, &keys)?;
                written(scene, &mesh, &keys)?;
                RatingJob {
                    name: format!("mesh {mesh}"),
                    method: nominal_method(*load),
                    from_s,
                    columns: normal_forces(prepared),
                    turn_column: None,
                    rule: RatingRule::Nominal(Box::new(job)),
                }
            }
        };
        jobs.push(job);
    }
    Ok(jobs)
}

/// Time from which rows count; the run must have what the rating needs.
fn start(
    scene: &SystemScene,
    rating: &Rating,
    from_s: Option<f64>,
    keys: &TableKeys<'_>,
) -> Result<f64, InputError> {
    let run = scene.run.kind().name();
    let end_s = match (&scene.run, rating) {
        (Run::Transient { end_s }, _) => *end_s,
        (Run::SpeedSweep(_), Rating::Nominal(_)) => {
            if from_s.is_some() {
                let problem =
                    "is not used by run.kind = \"speed-sweep\", whose windows all count; remove it";
                return Err(keys.error("from_s", problem));
            }
            return Ok(0.0);
        }
        (Run::SpeedSweep(_), Rating::Fatigue(_)) => {
            let problem = "\"fatigue\" counts the rows of a run.kind = \"transient\"; a speed-sweep keeps none";
            return Err(keys.error("kind", problem));
        }
        _ => {
            let problem = format!(
                "is for runs in time (run.kind = \"transient\" or \"speed-sweep\"), found run.kind = \"{run}\""
            );
            return Err(keys.error("kind", problem));
        }
    };
    let from_s = from_s.unwrap_or(0.0);
    let allowed = format!("0 to below {end_s}, the end of the run");
    keys.require("from_s", from_s, (0.0..end_s).contains(&from_s), &allowed)?;
    Ok(from_s)
}

/// The channels of a mesh must be among what is written.
fn written(scene: &SystemScene, mesh: &str, keys: &TableKeys<'_>) -> Result<(), InputError> {
    let chosen = scene.output.elements.as_ref();
    if chosen.is_none_or(|names| names.iter().any(|name| name == mesh)) {
        return Ok(());
    }
    let problem = format!(
        "it reads channels of mesh `{mesh}`, which is not among output.elements; add it there"
    );
    Err(keys.error("", problem))
}

fn fatigue(
    scene: &SystemScene,
    (table, rule): (&RatingTable, &FatigueRule),
    from_s: f64,
    (bodies, gauges): (&Bodies, &[BuiltGauge]),
    keys: &TableKeys<'_>,
) -> Result<RatingJob, InputError> {
    if let Some(body) = &table.body {
        bodies.find_body(keys, "body", body)?;
    }
    let of_body = |gauge: &&BuiltGauge| table.body.as_ref().is_none_or(|body| gauge.body == *body);
    let mut found = gauges.iter().filter(of_body);
    let gauge = found.clone().find(|gauge| gauge.name == rule.gauge);
    let gauge = gauge.ok_or_else(|| {
        let known: Vec<&str> = found.clone().map(|gauge| &*gauge.name).collect();
        keys.error(
            "gauge",
            names::unknown("gauge in a [[gauge]]", &rule.gauge, &known),
        )
    })?;
    if found.any(|other| other.name == rule.gauge && other.body != gauge.body) {
        let problem = format!(
            "missing; gauges of several bodies are called `{}`",
            rule.gauge
        );
        return Err(keys.error("body", problem));
    }
    let mut columns = Vec::new();
    for (mesh, gear) in &gauge.meshes {
        written(scene, mesh, keys)?;
        let channel = format!(
            "strain_gear{gear}_{}_method{}_ustrain",
            gauge.name, rule.method
        );
        columns.push(element_column(mesh, &channel));
    }
    let placed = bodies.list.iter().find(|p| p.body.name == gauge.body);
    let material = placed
        .and_then(|placed| placed.gear.as_ref())
        .map(|gear| gear.definition.material)
        .ok_or_else(|| keys.error("gauge", "its body is no gear"))?;
    Ok(RatingJob {
        name: format!("gauge {} of {}", gauge.name, gauge.body),
        method: rule.method(),
        from_s,
        columns,
        turn_column: Some(format!("bodies/{}/turn_rad", gauge.body)),
        rule: RatingRule::Fatigue(FatigueJob::new(rule, material, &scene.folder, keys)?),
    })
}

fn normal_forces(mesh: &PreparedMesh) -> Vec<String> {
    let of_side = |side: &Flank| {
        let channel = match side {
            Flank::Right => "normal_force_right_N",
            Flank::Left => "normal_force_left_N",
        };
        element_column(&mesh.name, channel)
    };
    mesh.sides.iter().map(of_side).collect()
}

fn nominal(
    mesh: &PreparedMesh,
    load: LoadPoint,
    bodies: &Bodies,
    keys: &TableKeys<'_>,
) -> Result<NominalRating, InputError> {
    if mesh.model == MeshModel::Kinematic {
        let problem = format!("`{}` is kinematic and has no normal force", mesh.name);
        return Err(keys.error("mesh", problem));
    }
    let [Some(first), Some(second)] = mesh.bodies.map(|number| bodies.list[number].gear.as_ref())
    else {
        return Err(keys.error("mesh", "its bodies are no gears"));
    };
    let pair = fitting_pair([first, second], &mesh.pose(bodies), keys)?;
    let gears = [&first.definition, &second.definition];
    let (teeth, materials) = (
        gears.map(|gear| &gear.tooth),
        gears.map(|gear| gear.material),
    );
    NominalRating::new(&pair, teeth, materials, load)
        .map_err(|error| nominal_error(&error, "mesh", keys))
}
