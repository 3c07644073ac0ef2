//! Moments of a multibody result: gears where their bodies are, line loads and pressures computed again from places and
//! speeds.

use crate::failure::{Failure, Result};
use crate::stressed_gear::{StressedGear, bevel_gear_of, bevel_surface};
use crate::watch::Watch;
use gearmesh_geometry::input::InputDocument;
use gearmesh_mesh::BevelMesh;
use gearmesh_reduction::ReductionError;
use gearmesh_reduction::bevel::bevel_model;
use gearmesh_reduction::skin::skin;
use gearmesh_report::moving::{FlankLoad, GearSurface, Moment, Placement};
use gearmesh_scene::system::{
    GearState, GearsInMotion, LoadedSystem, MovingGear, MovingParts, MovingShape, SystemScene,
};
use gearmesh_scene::system_run::{
    ResultKind, RunJob, RunKind, SystemResult, digests_of_named_files,
};
use std::path::{Path, PathBuf};

/// Sections of a gear's surface over its face.
const SECTIONS: usize = 20;

/// Which moments of a result are wanted, and where its scene is.
pub struct WantedMoments<'a> {
    /// File of the result.
    pub result: &'a Path,
    /// First time, of a run in time.
    pub from_s: Option<f64>,
    /// Last time, of a run in time.
    pub to_s: Option<f64>,
    /// Folder that the scene's file names are relative to, where the user names one.
    pub scene_folder: Option<&'a Path>,
}

/// A result whose rows are moments.
pub struct SystemMoments {
    /// What the series runs over, in words.
    pub unit: &'static str,
    gears: GearsInMotion,
    /// What the series runs over.
    at: Vec<f64>,
    /// Time of each row \[s\].
    times_s: Vec<f64>,
    /// Of the gears, then of further bodies, `[body][column][row]`.
    states: Vec<Vec<Vec<f64>>>,
    first: usize,
    last: usize,
}

impl SystemMoments {
    /// Reads the columns of all gears and builds their meshes.
    pub fn new(a: &WantedMoments<'_>, result: &SystemResult, watch: &Watch<'_>) -> Result<Self> {
        let shown = a.result.display();
        let axis = match result.kind {
            ResultKind::Transient => "time_s",
            ResultKind::Static => "point",
            ResultKind::SpeedSweep | ResultKind::Eigen => {
                return Err(Failure::input(format!(
                    "{shown}: gears move in results of `transient` and `static` runs only"
                )));
            }
        };
        if axis == "point" && (a.from_s.is_some() || a.to_s.is_some()) {
            return Err(Failure::input(format!(
                "{shown}: --from-s and --to-s are for runs in time; this result is `static`, leave them out"
            )));
        }
        let loaded = loaded_of(a, result)?;
        let gears = loaded.gears_in_motion()?;
        for mesh in &gears.without_forces {
            watch.note(format!("no forces on the teeth of {mesh}"));
        }
        let names: Vec<&str> = result.rows.columns().iter().map(|c| &*c.name).collect();
        let read = |name: &str| result.rows.read(name).map_err(Failure::input);
        let mut states = Vec::new();
        let bodies = gears.gears.iter().map(|gear| &gear.body);
        for body in bodies.chain(&gears.further) {
            let columns = GearState::columns(body);
            let there = |name: &String| names.contains(&&**name);
            if let Some(missing) = columns[..6].iter().find(|name| !there(name)) {
                return Err(Failure::input(format!(
                    "{shown} has no column `{missing}`: let [output] record the bodies of the gears and of the bearings in their bores, and run again"
                )));
            }
            let own = columns.iter().filter(|name| there(name));
            states.push(own.map(|name| read(name)).collect::<Result<_, _>>()?);
        }
        let at = read(axis)?;
        let times_s = match axis {
            "point" if !gears.further.is_empty() => times_of_points(loaded)?,
            _ => at.clone(),
        };
        let first = at.partition_point(|t| *t < a.from_s.unwrap_or(f64::NEG_INFINITY));
        let last = at.partition_point(|t| *t <= a.to_s.unwrap_or(f64::INFINITY));
        if first >= last {
            return Err(Failure::input(format!(
                "--from-s, --to-s: no row lies there; the result runs from {} to {}",
                at.first().unwrap_or(&0.0),
                at.last().unwrap_or(&0.0)
            )));
        }
        Ok(Self {
            unit: if axis == "time_s" { "s" } else { "equilibria" },
            gears,
            at,
            times_s,
            states,
            first,
            last,
        })
    }

    /// Refuses a machine without gears.
    ///
    /// # Errors
    /// [`Failure`] naming the result.
    pub fn demand_gears(&self, file: &Path) -> Result<()> {
        if self.gears.gears.is_empty() {
            return Err(Failure::input(format!(
                "{}: no body of the scene is a cylindrical gear or has a reduced bevel gear (bevel_models)",
                file.display()
            )));
        }
        Ok(())
    }

    /// Gears, in the order in which a moment numbers them.
    pub fn gears(&self) -> &[MovingGear] {
        &self.gears.gears
    }

    /// What is drawn beside the gears.
    pub fn parts(&self) -> &MovingParts {
        &self.gears.parts
    }

    /// What a row is of what the series runs over.
    pub fn at(&self, row: usize) -> f64 {
        self.at[row]
    }

    /// Rows that were asked for.
    pub fn rows(&self) -> Vec<usize> {
        (self.first..self.last).collect()
    }

    /// The moment of a row.
    pub fn moment(&mut self, row: usize) -> Result<Moment> {
        let state = |columns: &Vec<Vec<f64>>| {
            let values: Vec<f64> = columns.iter().map(|column| column[row]).collect();
            GearState::from_values(&values)
        };
        let states: Vec<GearState> = self.states.iter().map(state).collect();
        let time_s = self.times_s[row];
        let loads = self.gears.loads(&states, time_s).map_err(|error| {
            Failure::work(format!("at {} of the series: {error}", self.at[row]))
        })?;
        let placed = |state: &GearState| Placement {
            rotation: state.rotation(),
            origin_m: state.position_m,
        };
        let loads = loads.into_iter().map(|load| FlankLoad {
            mesh: load.mesh,
            gear: load.gear,
            tooth: load.tooth,
            side: load.side,
            roll_rad: load.roll_rad,
            height_m: load.height_m,
            width_m: load.width_m,
            components_n: [load.force_n.iter().map(|x| x * x).sum::<f64>().sqrt(), 0.0],
            force_n: load.force_n,
            line_load_n_per_m: load.line_load_n_per_m,
            pressure_pa: load.pressure_pa,
        });
        Ok(Moment {
            at: self.at[row],
            placements: states[..self.gears.gears.len()]
                .iter()
                .map(placed)
                .collect(),
            loads: loads.collect(),
            bore_m: (0..self.gears.gears.len())
                .map(|gear| self.gears.bore_motions_m(gear))
                .collect(),
            von_mises_pa: Vec::new(),
        })
    }
}

/// The machine of a result: its gears, what is drawn beside them, its meshes.
///
/// # Errors
/// [`Failure`] for files that are not as they were in the run.
pub fn machine_of(a: &WantedMoments<'_>, result: &SystemResult) -> Result<GearsInMotion> {
    Ok(loaded_of(a, result)?.gears_in_motion()?)
}

/// Times of the equilibria of a series \[s\], by which rollers have gone round.
fn times_of_points(loaded: LoadedSystem) -> Result<Vec<f64>> {
    match RunJob::from_scene(loaded).map_err(Failure::input)?.kind {
        RunKind::Static(job) => Ok(job.points.iter().map(|point| point.time_s).collect()),
        RunKind::Transient(_) | RunKind::SpeedSweep(_) | RunKind::Eigen(_) => Ok(Vec::new()),
    }
}

/// The scene of a result with its gears.
fn loaded_of(a: &WantedMoments<'_>, result: &SystemResult) -> Result<LoadedSystem> {
    let folder = scene_folder(a, result)?;
    let document = InputDocument::new(
        format!("scene inside {}", a.result.display()),
        result.head.scene_toml.clone(),
    );
    let scene = SystemScene::from_document(document, &folder)?;
    Ok(scene.load()?)
}

/// A gear as it is drawn without stress.
pub fn surface(gear: &MovingGear) -> Result<GearSurface> {
    match &gear.shape {
        MovingShape::Cylindrical(definition) => {
            let width_m = definition.tooth.face_width_m;
            let share = |k: usize| k as f64 / SECTIONS as f64 - 0.5;
            let heights: Vec<f64> = (0..=SECTIONS).map(|k| share(k) * width_m).collect();
            Ok(GearSurface::new(definition, &heights))
        }
        MovingShape::Bevel(model) => {
            let bevel = bevel_gear_of(model, &format!("model of body `{}`", gear.body))?;
            let mesh = BevelMesh::new(&bevel).map_err(ReductionError::from)?;
            let faces = skin(&bevel_model(&bevel, &mesh)?);
            bevel_surface(&bevel, &mesh, &faces)
        }
    }
}

/// A gear's body, factorised.
pub fn stressed(gear: &MovingGear, watch: &Watch<'_>) -> Result<StressedGear> {
    match &gear.shape {
        MovingShape::Cylindrical(definition) => {
            Ok(StressedGear::of_gear(definition, watch)?.on_bore(gear.bore.clone()))
        }
        MovingShape::Bevel(model) => {
            StressedGear::of_bevel(model, &format!("model of body `{}`", gear.body), watch)
        }
    }
}

/// The folder from which the scene names the files that the result was computed with.
fn scene_folder(a: &WantedMoments<'_>, result: &SystemResult) -> Result<PathBuf> {
    let beside = a.result.parent().unwrap_or(Path::new("")).to_owned();
    let candidates = match a.scene_folder {
        Some(folder) => vec![folder.to_owned()],
        None => vec![beside, PathBuf::new()],
    };
    let scene = &result.head.scene_toml;
    let fits = |folder: &&PathBuf| digests_of_named_files(scene, folder) == result.head.inputs;
    let found = candidates.iter().find(fits);
    found.cloned().ok_or_else(|| {
        let names = result.head.inputs.iter();
        let names: Vec<&str> = names.filter_map(|line| line.rsplit_once(' ')).map(|(n, _)| n).collect();
        let searched: Vec<String> = candidates.iter().map(|f| f.join(".").display().to_string()).collect();
        Failure::input(format!(
            "the files that the scene of {} names ({}) are not in {} as they were in the run; --scene-folder says where the scene is, else run it again",
            a.result.display(),
            names.join(", "),
            searched.join(" or ")
        ))
    })
}
