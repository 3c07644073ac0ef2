//! What a scene file asks for, as a job.

use std::path::{Path, PathBuf};

use gearmesh_dynamics::{DynamicsError, Interpolation, Motion, System, Table, TimeFunction};
use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{MOST_TEXT_BYTES, read_bytes};
use gearmesh_model::{bytes_digest, file_digest};
use gearmesh_specification::system::function::FunctionTable;
use gearmesh_specification::system::gear_mesh::GearMeshTable;
use gearmesh_specification::system::joint::MotionTable;
use gearmesh_specification::system::load::LoadTable;
use gearmesh_specification::system::run::{MotionValues, Run};
use gearmesh_specification::system::solver::Start;

use super::error::SystemRunError;
use super::job::{
    EigenJob, EigenPoint, InTime, MeshRecord, RunHead, RunJob, RunKind, Settling, StaticJob,
    StaticPoint,
};
use super::recorder::Selection;
use super::speed_plan::SpeedPlan;
use crate::named_files_and_theirs;
use crate::system::{BuiltSystem, LoadedSystem, SystemScene, Variation};

impl RunJob {
    /// The job of a scene.
    ///
    /// # Errors
    /// [`SystemRunError::Input`] with file, line, key, what was found and what is allowed.
    pub fn from_scene(loaded: LoadedSystem) -> Result<Self, SystemRunError> {
        let scene = &loaded.scene;
        let params = scene.solver.params;
        let needs_solver = || scene.document.error("solver", "missing; give a step");
        // Where balls move, the system itself starts in equilibrium.
        let start = if loaded.has_moving_balls() {
            Start::AsGiven
        } else {
            scene.solver.start
        };
        let in_time = |end_s: f64, windows| {
            Ok::<InTime, InputError>(InTime {
                params: params.ok_or_else(needs_solver)?,
                start,
                end_s,
                interval_s: scene.output.interval_s.unwrap_or(end_s),
                statistics_from_s: scene.output.statistics_begin_s(end_s),
                windows,
            })
        };
        let mut variation = Variation::default();
        let mut nominal = None;
        let kind = match &scene.run {
            Run::Transient { end_s } => RunKind::Transient(in_time(*end_s, Vec::new())?),
            Run::SpeedSweep(sweep) => {
                let plan = SpeedPlan::new(sweep);
                let speed = plan
                    .function()
                    .map_err(|e| scene.document.error("run", e))?;
                variation = varied(&sweep.motion, Motion::Speed(speed), 1.0);
                RunKind::SpeedSweep(in_time(plan.end_s(), plan.windows().to_vec())?)
            }
            Run::Static {
                load_factors,
                angles_rad,
            } => {
                if let Some(angles) = angles_rad {
                    refuse_functions(&loaded, &angles.motion)?;
                    refuse_friction(&loaded)?;
                }
                let built = nominal.insert(loaded.build_varied(&variation)?);
                let angles = angles_rad.clone();
                let job = static_job(&loaded, load_factors, angles, built)?;
                RunKind::Static(job)
            }
            Run::Eigen {
                settle_s,
                load_factors,
                speeds_rad_per_s,
                most_frequency_hz,
            } => {
                let settle = match settle_s {
                    Some(time_s) => Some(Settling {
                        time_s: *time_s,
                        params: params.ok_or_else(needs_solver)?,
                        start: scene.solver.start,
                    }),
                    None => None,
                };
                let speeds = speeds_rad_per_s.clone();
                let mut job = eigen_job(&loaded, load_factors, speeds);
                (job.settle, job.most_frequency_hz) = (settle, *most_frequency_hz);
                RunKind::Eigen(job)
            }
        };
        let built = match nominal {
            Some(built) => built,
            None => loaded.build_varied(&variation)?,
        };
        Ok(Self {
            head: head(&loaded, &built),
            selection: selection(&loaded, &built.system),
            ratings: built.ratings,
            system: built.system,
            kind,
        })
    }
}

/// A scene with another function for a motion.
pub(super) fn varied(motion: &str, function: Motion, load_factor: f64) -> Variation {
    Variation {
        motions: vec![(motion.to_owned(), function)],
        load_factor,
    }
}

/// Longest step between two equilibria \[pitches\]: a tooth that only teeth carry along stays in its space, half a
/// pitch wide.
const LONGEST_STEP_PITCHES: f64 = 0.25;

/// The shortest way from one angle of a series to the next, for the clock \[rad\]: the same angle twice.
const SHORTEST_WAY_RAD: f64 = 1e-9;

/// The points of a static series: every angle at every load factor. The angle is a function of time, which begins at
/// the start of the scene, where teeth touch, and goes on as at the speed that the scene states (1 rad/s where none),
/// so that balls and rollers go round with the rings.
fn static_job(
    loaded: &LoadedSystem,
    load_factors: &[f64],
    angles: Option<MotionValues>,
    built: &BuiltSystem,
) -> Result<StaticJob, SystemRunError> {
    let values = angles.as_ref().map(|angles| &angles.values[..]);
    let turned_to = |i: usize| {
        let turned = values.map_or(0.0, |v| v[i] - if i > 0 { v[i - 1] } else { 0.0 });
        turned.abs()
    };
    let stated = built.varied_rad_per_s.abs();
    let rad_per_s = if stated > 0.0 { stated } else { 1.0 };
    let mut times_s = vec![0.0];
    for i in 0..values.map_or(0, <[f64]>::len) {
        times_s.push(times_s[i] + turned_to(i).max(SHORTEST_WAY_RAD) / rad_per_s);
    }
    let steps_to = |i: usize| {
        let pitches = turned_to(i) * built.pitches_per_rad;
        (pitches / LONGEST_STEP_PITCHES - 1e-9).ceil().max(1.0) as usize
    };
    let of_factor = |&load_factor: &f64| {
        let (count, times_s) = (values.map_or(1, <[f64]>::len), &times_s);
        (0..count).map(move |i| StaticPoint {
            angle_rad: values.map(|values| values[i]),
            time_s: values.map_or(0.0, |_| times_s[i + 1]),
            load_factor,
            steps: steps_to(i),
        })
    };
    let points = load_factors.iter().flat_map(of_factor).collect();
    let function = angles.map(|series| series_in_time(series, times_s));
    let function = function.transpose()?;
    let loaded = loaded.clone();
    Ok(StaticJob {
        points,
        system_at: Box::new(move |load_factor| {
            let motions = function.clone().into_iter().collect();
            let variation = Variation {
                motions,
                load_factor,
            };
            Ok(loaded.build_varied(&variation)?.system)
        }),
    })
}

/// The start, from which a motion counts, at the first of the times, and the values at the others.
fn series_in_time(
    series: MotionValues,
    times_s: Vec<f64>,
) -> Result<(String, Motion), DynamicsError> {
    let values = [&[0.0], &series.values[..]].concat();
    let table = Table::new("angles_deg", times_s, values, Interpolation::Linear)?;
    let function = TimeFunction::Table(table);
    Ok((series.motion, Motion::Position(function)))
}

/// Natural frequencies at every speed and load factor.
fn eigen_job(
    loaded: &LoadedSystem,
    load_factors: &[f64],
    speeds: Option<MotionValues>,
) -> EigenJob {
    let all: Vec<Option<f64>> = match &speeds {
        None => vec![None],
        Some(speeds) => speeds.values.iter().copied().map(Some).collect(),
    };
    let points = load_factors.iter().flat_map(|&load_factor| {
        all.iter().map(move |&speed_rad_per_s| EigenPoint {
            speed_rad_per_s,
            load_factor,
        })
    });
    let points = points.collect();
    let motion = speeds.map(|speeds| speeds.motion);
    let loads = loaded.scene.tables.load.iter();
    let torques = loads.filter(|load| load.torque_Nm.is_some());
    let torques = torques.map(LoadTable::name).collect();
    let loaded = loaded.clone();
    EigenJob {
        torques,
        points,
        settle: None,
        most_frequency_hz: None,
        system_at: Box::new(move |point| {
            let function = |speed| Motion::Speed(TimeFunction::Constant(speed));
            let variation = match (&motion, point.speed_rad_per_s) {
                (Some(motion), Some(speed)) => varied(motion, function(speed), point.load_factor),
                _ => Variation {
                    load_factor: point.load_factor,
                    ..Variation::default()
                },
            };
            Ok(loaded.build_varied(&variation)?.system)
        }),
    }
}

/// A series of angles counts by the time, at which loads that vary with it would be taken.
fn refuse_functions(loaded: &LoadedSystem, motion: &str) -> Result<(), InputError> {
    let (tables, document) = (&loaded.scene.tables, &loaded.scene.document);
    let is_constant = |function: &Option<FunctionTable>| {
        matches!(function, None | Some(FunctionTable::Constant(_)))
    };
    let varies = |key: String| {
        let problem = "found a function of time; with run.angles_deg loads and other motions must be numbers, which run.load_factors multiply";
        Err(document.error(&key, problem))
    };
    for (
        i,
        LoadTable {
            torque_Nm, force_N, ..
        },
    ) in tables.load.iter().enumerate()
    {
        for (key, function) in [("torque_Nm", torque_Nm), ("force_N", force_N)] {
            if !is_constant(function) {
                return varies(format!("load.{i}.{key}"));
            }
        }
    }
    for (i, table) in tables.motion.iter().enumerate() {
        if table.name() == motion {
            continue;
        }
        let MotionTable {
            angle_deg,
            speed_rpm,
            position_mm,
            speed_mm_per_s,
            ..
        } = table;
        for (key, function) in [("angle_deg", angle_deg), ("position_mm", position_mm)] {
            if !is_constant(function) {
                return varies(format!("motion.{i}.{key}"));
            }
        }
        for (key, function) in [("speed_rpm", speed_rpm), ("speed_mm_per_s", speed_mm_per_s)] {
            if function.is_some() {
                return varies(format!("motion.{i}.{key}"));
            }
        }
    }
    Ok(())
}

/// Positions of a series follow each other at rest, where no flank slides over another.
fn refuse_friction(loaded: &LoadedSystem) -> Result<(), InputError> {
    let meshes = &loaded.scene.tables.gear_mesh;
    let rubs = |mesh: &GearMeshTable| mesh.teeth.as_ref().is_some_and(|t| t.friction.is_some());
    meshes.iter().position(rubs).map_or(Ok(()), |i| {
        let problem = "found a table; nothing slides at the positions of run.angles_deg: leave it out, run the scene in time, or one pair at rest as a [pair]";
        let document = &loaded.scene.document;
        Err(document.error(&format!("gear_mesh.{i}.teeth.friction"), problem))
    })
}

fn head(loaded: &LoadedSystem, built: &BuiltSystem) -> RunHead {
    let scene = &loaded.scene;
    let meshes = built.meshes.iter().map(|mesh| MeshRecord {
        name: mesh.name.clone(),
        bodies: mesh.gears.clone(),
        teeth: mesh.teeth,
        flank_corners_m: mesh.flank_corners_m.clone(),
        stage: mesh.stage,
        speeds_rad_per_s: Some(mesh.speeds_rad_per_s),
    });
    let slips = loaded.unit_slips().into_iter();
    let slips = slips.map(|slip| format!("warning: {slip}")).collect();
    RunHead {
        title: scene.title.clone(),
        scene_toml: scene.document.text.clone(),
        inputs: inputs(scene),
        notes: [built.notes.clone(), slips].concat(),
        meshes: meshes.collect(),
        sets: scene.sets.clone(),
    }
}

/// Names and digests of all files that a scene names, and what tells the functions of the calling program apart.
pub(crate) fn inputs(scene: &SystemScene) -> Vec<String> {
    let mut inputs = digests_of_named_files(&scene.document.text, &scene.folder);
    if !scene.host.is_empty() {
        inputs.push(format!("functions {}", scene.host.identity));
    }
    inputs
}

/// Names and digests of all files that a scene names, and that these name, as [`RunHead::inputs`] keeps them: whether
/// files beside a scene are still those of a result.
pub fn digests_of_named_files(text: &str, folder: &Path) -> Vec<String> {
    let digest = |(name, path): (String, PathBuf)| {
        // The seal of a model names its content; anything else is read.
        let sealed = file_digest(&path).ok();
        let digest = sealed.or_else(|| {
            let bytes = read_bytes(&path, MOST_TEXT_BYTES).ok()?;
            Some(bytes_digest(&bytes))
        });
        format!("{name} {}", digest.unwrap_or_default())
    };
    let files = named_files_and_theirs(text, folder).into_iter();
    files.map(digest).collect()
}

/// What `[output]` names; all of a kind where it names none.
fn selection(loaded: &LoadedSystem, system: &System) -> Selection {
    let output = &loaded.scene.output;
    let chosen = |names: &Option<Vec<String>>, name: &str| {
        names
            .as_ref()
            .is_none_or(|names| names.iter().any(|known| known == name))
    };
    let bodies = system.body_ids().zip(system.bodies());
    let joints = system.joints().iter().enumerate();
    let elements = system.elements().enumerate();
    Selection {
        bodies: bodies
            .filter(|(_, body)| chosen(&output.bodies, &body.name))
            .map(|(id, _)| id)
            .collect(),
        joints: joints
            .filter(|(_, joint)| chosen(&output.joints, joint.name()))
            .map(|(index, _)| index)
            .collect(),
        elements: elements
            .filter(|(_, name)| chosen(&output.elements, name))
            .map(|(index, _)| index)
            .collect(),
    }
}
