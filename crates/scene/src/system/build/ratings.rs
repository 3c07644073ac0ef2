//! `[[rating]]` to what is made of which columns of the result.

use gearmesh_geometry::input::TableKeys;
use gearmesh_geometry::{FlankSide, GearPair, InputError};
use gearmesh_rating::{
    MeanStress, Passage, RootConstruction, RootSection, SurfaceState, flank_pressure,
    highest_single_contact_rolls_rad, root_stress_pa,
};

use super::bodies::Bodies;
use super::gear_mesh::{PreparedMesh, fitting_pair};
use crate::system::built::{BuiltGauge, FatigueJob, NominalJob, RatingJob, RatingRule};
use crate::system::names;
use crate::system::scene::SystemScene;
use crate::system::tables::gear_mesh::MeshModel;
use crate::system::tables::rating::{FatigueRule, LoadPointWord, Rating, read_sn_table};
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
        let from_s = start(scene, &rating, table.from_s, &keys)?;
        let job = match &rating {
            Rating::Fatigue(rule) => fatigue(scene, rule, from_s, (bodies, gauges), &keys)?,
            Rating::Nominal { mesh, load_point } => {
                let prepared = meshes.iter().find(|other| other.name == *mesh);
                let prepared = prepared.ok_or_else(|| {
                    let known: Vec<&str> = meshes.iter().map(|mesh| &*mesh.name).collect();
                    keys.error("mesh", names::unknown("gear mesh", mesh, &known))
                })?;
                let job = nominal(prepared, *load_point, bodies, &keys)?;
                written(scene, mesh, &keys)?;
                RatingJob {
                    name: format!("mesh {mesh}"),
                    method: format!(
                        "Lewis's root stress (load at the {}) and Hertz's flank pressure under the largest normal force",
                        match load_point {
                            LoadPointWord::HighestSingleContact =>
                                "highest point of single contact",
                            LoadPointWord::Tip => "tip",
                        }
                    ),
                    from_s,
                    columns: normal_forces(prepared),
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
        (Run::SpeedSweep(_), Rating::Nominal { .. }) => {
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
    rule: &FatigueRule,
    from_s: f64,
    (bodies, gauges): (&Bodies, &[BuiltGauge]),
    keys: &TableKeys<'_>,
) -> Result<RatingJob, InputError> {
    if let Some(body) = &rule.body {
        bodies.find_body(keys, "body", body)?;
    }
    let of_body = |gauge: &&BuiltGauge| rule.body.as_ref().is_none_or(|body| gauge.body == *body);
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
    let curve = read_sn_table(&scene.folder.join(&rule.sn_table), keys)?;
    let mean = match rule.mean_stress {
        MeanStress::None => "without regard to the mean",
        MeanStress::Goodman { .. } => "mean by Goodman's line",
    };
    let passage = match rule.passage {
        Passage::Once => "passed once",
        Passage::Repeated => "repeated",
    };
    let surface = match rule.surface {
        SurfaceState::PlaneStrain => "plane strain",
        SurfaceState::Uniaxial => "uniaxial",
    };
    Ok(RatingJob {
        name: format!("gauge {} of {}", gauge.name, gauge.body),
        method: format!(
            "cycles and damage of the stress ({surface}) from strain by method {}, S-N table {}, {mean}, history {passage}",
            rule.method,
            rule.sn_table.display()
        ),
        from_s,
        columns,
        rule: RatingRule::Fatigue(FatigueJob {
            modulus_pa: root_stress_pa(&[1.0], material, rule.surface)[0],
            curve,
            mean_stress: rule.mean_stress,
            passage: rule.passage,
        }),
    })
}

fn normal_forces(mesh: &PreparedMesh) -> Vec<String> {
    let of_side = |side: &FlankSide| {
        let channel = match side {
            FlankSide::Right => "normal_force_right_N",
            FlankSide::Left => "normal_force_left_N",
        };
        element_column(&mesh.name, channel)
    };
    mesh.sides.iter().map(of_side).collect()
}

fn nominal(
    mesh: &PreparedMesh,
    load_point: LoadPointWord,
    bodies: &Bodies,
    keys: &TableKeys<'_>,
) -> Result<NominalJob, InputError> {
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
    let rolls = match load_point {
        LoadPointWord::Tip => [&pair.gear_1, &pair.gear_2].map(|gear| gear.flank_end_roll_rad),
        LoadPointWord::HighestSingleContact => {
            highest_single_contact_rolls_rad(&pair).map_err(|e| keys.error("load_point", e))?
        }
    };
    let module_m = gears[0].tooth.module_m;
    let factor = |gear, roll_rad| {
        RootSection::new(gear, roll_rad, RootConstruction::Parabola)
            .map(|section| section.lewis_factor(module_m))
            .map_err(|e| keys.error("mesh", e))
    };
    let mut job = NominalJob {
        materials: gears.map(|gear| gear.material),
        face_width_m: gears[0].tooth.face_width_m.min(gears[1].tooth.face_width_m),
        module_m,
        lewis_factors: [
            factor(&pair.gear_1, rolls[0])?,
            factor(&pair.gear_2, rolls[1])?,
        ],
        pressure_roll_1_rad: 0.0,
        pair,
    };
    job.pressure_roll_1_rad = most_curved(&job, keys)?;
    Ok(job)
}

/// Where one pair of teeth bears all and the flanks are most curved against each other. ρ₁ρ₂/(ρ₁ + ρ₂) has its maximum between the
/// ends of a stretch of the path, so its minimum is at one of them. With two pairs everywhere it is the pitch point.
fn most_curved(job: &NominalJob, keys: &TableKeys<'_>) -> Result<f64, InputError> {
    let pair: &GearPair = &job.pair;
    let [start, end] = [pair.roll_start_1_rad, pair.roll_end_1_rad];
    let pitch = pair.pitch_1_rad();
    let rolls = if end - start < 2.0 * pitch {
        vec![(end - pitch).max(start), (start + pitch).min(end)]
    } else {
        vec![pair.working_pressure_angle_rad.tan()]
    };
    let mut worst = (f64::NEG_INFINITY, 0.0);
    for roll in rolls {
        let found = flank_pressure(pair, roll, 1.0, job.materials);
        let pressure = found.map_err(|e| keys.error("mesh", e))?.peak_pressure_pa;
        if pressure > worst.0 {
            worst = (pressure, roll);
        }
    }
    Ok(worst.1)
}
