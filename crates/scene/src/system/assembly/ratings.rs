//! `[[rating]]` to what is made of which columns of the result.

use gearmesh_bearings::QuasiStaticBearing;
use gearmesh_bearings::life::Lubrication;
use gearmesh_geometry::input::{Count, TableKeys};
use gearmesh_geometry::{Flank, InputError};
use gearmesh_rating::{LoadPoint, NominalRating};
use gearmesh_specification::names::unknown;
use gearmesh_specification::rating::{BearingLifeTable, FatigueTable, RatingTable};
use gearmesh_specification::system::bearing::BearingModel;
use gearmesh_specification::system::mesh_model::MeshKind;
use gearmesh_specification::system::run::Run;
use nalgebra::Vector3;

use super::bearings::placed_bearing;
use super::bodies::Bodies;
use super::gear_mesh::{PreparedMesh, fitting_pair};
use super::gears::BodyGear;
use crate::rating::{BearingLifeJob, FatigueJob, nominal_error, nominal_method, rim_m};
use crate::system::built::{BuiltGauge, RatingJob, RatingRule};
use crate::system::names::{body_column, element_column};
use crate::system::scene::SystemScene;

/// All ratings of a scene.
pub(super) fn build(
    scene: &SystemScene,
    bodies: &Bodies,
    meshes: &[PreparedMesh],
    gauges: &[BuiltGauge],
) -> Result<Vec<RatingJob>, InputError> {
    let mut jobs = Vec::new();
    for (i, table) in scene.tables.rating.iter().enumerate() {
        let keys = TableKeys::new(&scene.document, format!("rating.{i}"));
        table.refuse_keys_of_pairs(&keys)?;
        let from_s = start(scene, table, &keys)?;
        let job = match table {
            RatingTable::BearingLife(table) => bearing_life(scene, table, from_s, bodies, &keys)?,
            RatingTable::Fatigue(table) => fatigue(scene, table, from_s, (bodies, gauges), &keys)?,
            RatingTable::Nominal(table) => {
                let load = table.load_point();
                let mesh = keys.needed("mesh", table.mesh.clone(), "kind = \"nominal\"")?;
                let prepared = meshes.iter().find(|other| other.built.name == mesh);
                let prepared = prepared.ok_or_else(|| {
                    let known: Vec<&str> = meshes.iter().map(|mesh| &*mesh.built.name).collect();
                    keys.error("mesh", unknown("gear mesh", &mesh, &known))
                })?;
                let load_and_class = (load, table.tolerance_class.map(Count::get));
                let job = nominal(prepared, load_and_class, bodies, &keys)?;
                channels_written(scene, &mesh, &keys)?;
                RatingJob {
                    name: format!("mesh {mesh}"),
                    method: nominal_method(load),
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
    rating: &RatingTable,
    keys: &TableKeys<'_>,
) -> Result<f64, InputError> {
    let (run, from_s) = (scene.run.kind().name(), rating.from_s());
    let stated = [("from_s", from_s.is_some())];
    let end_s = match (&scene.run, rating) {
        (Run::Transient { end_s }, _) => *end_s,
        (Run::Static { .. }, RatingTable::BearingLife(_) | RatingTable::Nominal(_)) => {
            let problem = "is not used by run.kind = \"static\", which has no time; remove it";
            return keys.refuse(&stated, problem).map(|()| 0.0);
        }
        (Run::SpeedSweep(_), RatingTable::Nominal(_)) => {
            let problem =
                "is not used by run.kind = \"speed-sweep\", whose windows all count; remove it";
            return keys.refuse(&stated, problem).map(|()| 0.0);
        }
        (Run::SpeedSweep(_), RatingTable::Fatigue(_) | RatingTable::BearingLife(_)) => {
            let problem = "counts the rows of a run.kind = \"transient\"; a speed-sweep keeps none";
            return Err(keys.error("kind", problem));
        }
        _ => {
            let problem = format!(
                "{}, found run.kind = \"{run}\"; change run.kind, or remove the rating",
                allowed_runs(rating)
            );
            return Err(keys.error("kind", problem));
        }
    };
    let from_s = from_s.unwrap_or(0.0);
    let allowed = format!("0 to below {end_s}, the end of the run");
    keys.require("from_s", from_s, (0.0..end_s).contains(&from_s), &allowed)?;
    Ok(from_s)
}

/// Kinds of runs that a rating is for.
fn allowed_runs(rating: &RatingTable) -> &'static str {
    match rating {
        RatingTable::Nominal(_) => {
            "judges the largest normal force of equilibria or of a motion (run.kind = \"static\", \"transient\" or \"speed-sweep\")"
        }
        RatingTable::BearingLife(_) => {
            "needs loads of equilibria or of a motion (run.kind = \"static\" or \"transient\")"
        }
        RatingTable::Fatigue(_) => "counts the cycles of a motion (run.kind = \"transient\")",
    }
}

/// What a rating reads of a part must be among what is written: those of a list of `[output]`.
fn written(
    name: &str,
    (list, chosen): (&str, &Option<Vec<String>>),
    reads: &str,
    keys: &TableKeys<'_>,
) -> Result<(), InputError> {
    let is_written = |names: &Vec<String>| names.iter().any(|one| one == name);
    if chosen.as_ref().is_none_or(is_written) {
        return Ok(());
    }
    let problem = format!("it reads {reads}, which is not among output.{list}; add it there");
    Err(keys.error("", problem))
}

/// The channels of a mesh or bearing must be written.
fn channels_written(
    scene: &SystemScene,
    name: &str,
    keys: &TableKeys<'_>,
) -> Result<(), InputError> {
    let reads = format!("channels of mesh `{name}`");
    written(name, ("elements", &scene.output.elements), &reads, keys)
}

fn fatigue(
    scene: &SystemScene,
    table: &FatigueTable,
    from_s: f64,
    (bodies, gauges): (&Bodies, &[BuiltGauge]),
    keys: &TableKeys<'_>,
) -> Result<RatingJob, InputError> {
    let rule = &table.rule(keys)?;
    if let Some(body) = &table.body {
        bodies.find_body(keys, "body", body)?;
    }
    let of_body = |gauge: &&BuiltGauge| table.body.as_ref().is_none_or(|body| gauge.body == *body);
    let mut found = gauges.iter().filter(of_body);
    let gauge = found.clone().find(|gauge| gauge.name == rule.gauge);
    let gauge = gauge.ok_or_else(|| {
        let known: Vec<&str> = found.clone().map(|gauge| &*gauge.name).collect();
        let problem = unknown("gauge in a [[gauge]]", &rule.gauge, &known);
        keys.error("gauge", problem)
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
        channels_written(scene, mesh, keys)?;
        let channel = format!(
            "strain_gear{gear}_{}_method{}_ustrain",
            gauge.name, rule.method
        );
        columns.push(element_column(mesh, &channel));
    }
    let placed = bodies.number(&gauge.body).map(|body| &bodies.list[body]);
    let material = placed
        .and_then(|placed| placed.gear.as_ref())
        .map(BodyGear::material)
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

fn lubrication(
    table: &BearingLifeTable,
    keys: &TableKeys<'_>,
) -> Result<Option<Lubrication>, InputError> {
    let (viscosity, contamination) = (table.viscosity_mm2_per_s, table.contamination);
    if viscosity.is_none() && contamination.is_none() {
        return Ok(None);
    }
    let viscosity = keys.needed("viscosity_mm2_per_s", viscosity, "contamination")?;
    let clean = keys.needed("contamination", contamination, "viscosity_mm2_per_s")?;
    Ok(Some(Lubrication {
        viscosity_mm2_per_s: *viscosity,
        contamination: *clean,
    }))
}

fn bearing_life(
    scene: &SystemScene,
    table: &BearingLifeTable,
    from_s: f64,
    bodies: &Bodies,
    keys: &TableKeys<'_>,
) -> Result<RatingJob, InputError> {
    let lubrication = lubrication(table, keys)?;
    let tables = &scene.tables.bearing;
    let bearing = tables.iter().find(|one| one.name == table.bearing);
    let bearing = bearing.ok_or_else(|| {
        let known: Vec<&str> = tables.iter().map(|one| &*one.name).collect();
        keys.error("bearing", unknown("bearing", &table.bearing, &known))
    })?;
    if matches!(bearing.model, BearingModel::Rigid(_)) {
        let problem = "is a joint and has no load in its rows; take another kind of model";
        return Err(keys.error("bearing", format!("`{}` {problem}", table.bearing)));
    }
    channels_written(scene, &table.bearing, keys)?;
    let file = match (bearing.model.file(), &table.file) {
        (Some(_), Some(_)) => {
            let problem = "is given in the bearing's model, too; remove it here";
            return Err(keys.error("file", problem));
        }
        (Some(file), None) => ("bearing", file),
        (None, file) => {
            let needed_by = "a bearing whose model names no file";
            ("file", keys.needed("file", file.as_deref(), needed_by)?)
        }
    };
    let definition = placed_bearing::read(file, &scene.folder, keys)?.definition;
    let rolling = QuasiStaticBearing::new(&definition).map_err(|e| keys.error("bearing", e))?;
    let (on, at) = (
        (&bearing.body_1, &*bearing.body_2),
        (bearing.at_mm, bearing.axis),
    );
    let seat = bodies.seat(keys, on, at)?;
    let axis = seat.frame.axes * Vector3::z();
    // Inner ring first.
    let rings = [seat.ends[1], seat.ends[0]];
    let channels = ["force_shaft_x_N", "force_shaft_y_N", "force_shaft_z_N"].into_iter();
    let channels = channels.chain(["moment_shaft_x_Nm", "moment_shaft_y_Nm"]);
    let column = |channel| element_column(&bearing.name, channel);
    let mut columns: Vec<String> = channels.map(column).collect();
    let in_time = matches!(scene.run, Run::Transient { .. });
    let mut senses = [1.0; 2];
    if in_time {
        for (sense, ring) in senses.iter_mut().zip(rings) {
            let Some(body) = ring else { continue };
            let along = bodies.list[body].axis().dot(&axis);
            let name = bodies.name(ring);
            if along.abs() < 1.0 - 1e-9 {
                let problem = format!(
                    "the bearing's axis is not that of `{name}`'s own z, whose speed the rows have; turn the body, or its bearing"
                );
                return Err(keys.error("bearing", problem));
            }
            *sense = along.signum();
            let reads = format!("the speed of `{name}`");
            written(name, ("bodies", &scene.output.bodies), &reads, keys)?;
            columns.push(body_column(name, "angular_velocity_z_rad_per_s"));
        }
    }
    let job = BearingLifeJob {
        bearing: rolling,
        definition,
        lubrication,
        speeds_rad_per_s: rings.map(|ring| axis.dot(&bodies.turning(ring))),
        senses: in_time.then_some(senses),
    };
    Ok(RatingJob {
        name: format!("bearing {}", bearing.name),
        method: job.method(),
        from_s,
        columns,
        turn_column: None,
        rule: RatingRule::BearingLife(Box::new(job)),
    })
}

fn normal_forces(mesh: &PreparedMesh) -> Vec<String> {
    let of_side = |side: &Flank| {
        let channel = match side {
            Flank::Right => "normal_force_right_N",
            Flank::Left => "normal_force_left_N",
        };
        element_column(&mesh.built.name, channel)
    };
    mesh.sides.iter().map(of_side).collect()
}

fn nominal(
    mesh: &PreparedMesh,
    load_and_class: (LoadPoint, Option<usize>),
    bodies: &Bodies,
    keys: &TableKeys<'_>,
) -> Result<NominalRating, InputError> {
    if mesh.model == MeshKind::Kinematic {
        let problem = format!("`{}` is kinematic and has no normal force", mesh.built.name);
        return Err(keys.error("mesh", problem));
    }
    let [Some(first), Some(second)] = mesh.bodies.map(|number| bodies.list[number].cylindrical())
    else {
        return Err(keys.error("mesh", "its bodies are no gears"));
    };
    let pair = fitting_pair([first, second], &mesh.pose(bodies), keys)?;
    let gears = [&first.definition, &second.definition];
    let (teeth, materials) = (
        gears.map(|gear| &gear.tooth),
        gears.map(|gear| gear.material),
    );
    NominalRating::new(&pair, teeth, materials, gears.map(rim_m), load_and_class)
        .map_err(|error| nominal_error(&error, "mesh", keys))
}
