//! A scene with its models: solves all positions, reads the gauges.

use super::all_positions::{Positions, Watched, curves};
use super::contact_places::ContactPlaces;
use super::plan::Plan;
use super::position::Measures;
use super::rating::{PairRating, judged};
use super::result::{LineForces, PairSource, SceneResult, StrainSeries};
use super::scene_file::Scene;
use crate::model_shelf::{CondensedPairs, ModelShelf};
use crate::periods::PairPeriods;
use gearmesh_contact::{
    AxialSpread, ContactError, ContactLines, ContactPatch, FlankDeviations, Runout, SliceLayout,
};
use gearmesh_drivetrain::DrivetrainError;
use gearmesh_geometry::input::InputDocument;
use gearmesh_geometry::{GearDefinition, GearPair, InputError};
use gearmesh_model::{FileError, ReducedGear, ReducedGearError, ReductionChecks};
use gearmesh_recovery::{GaugeReader, LoadedSlice};
use rayon::prelude::*;
use std::f64::consts::TAU;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize};
use std::time::Instant;

/// Why a scene could not be run.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// The scene or a gear file inside a model is wrong.
    #[error(transparent)]
    Input(#[from] InputError),
    /// A model cannot be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// A model lacks a flank.
    #[error(transparent)]
    Model(#[from] ReducedGearError),
    /// No contact state.
    #[error(transparent)]
    Contact(#[from] ContactError),
    /// Flanks of a bevel pair, or models that are not those of the pair.
    #[error(transparent)]
    Flanks(#[from] DrivetrainError),
    /// [`PairWatch::stop`] was set.
    #[error("stopped; nothing is kept")]
    Stopped,
}

impl RunError {
    /// True when the input is to blame, not the computation.
    pub fn is_input(&self) -> bool {
        match self {
            Self::Contact(cause) => !cause.is_computation(),
            Self::Stopped | Self::Flanks(_) => false,
            Self::Input(_) | Self::File(_) | Self::Model(_) => true,
        }
    }
}

/// How far a run is, and what ends it early: for who waits for it. Threads share it.
#[derive(Debug, Default)]
pub struct PairWatch {
    /// Once true, the run ends with [`RunError::Stopped`] after the positions that are being solved.
    pub stop: AtomicBool,
    /// Positions of the even grid that are solved, of all torques together.
    pub solved: AtomicUsize,
}

/// A scene with its models.
#[derive(Debug)]
pub struct LoadedScene {
    /// The scene.
    pub scene: Scene,
    /// Reduced models of gear 1 and gear 2.
    pub models: [Arc<ReducedGear>; 2],
    /// Models with the motions of a bore that slides; the others state what the flanks feel of it.
    pub bores: [Option<Arc<ReducedGear>>; 2],
    /// Kinematics and microgeometry.
    pub lines: ContactLines,
    /// Slices over the overlap of the faces.
    pub layout: SliceLayout,
    /// Where their forces sit on gear 1 and gear 2.
    pub spreads: [AxialSpread; 2],
    /// Microgeometry of gear 1 and gear 2 in words, and where it is stated.
    pub microgeometry: [String; 2],
    /// Errors and faults of single flanks.
    pub deviations: FlankDeviations,
    /// Gears beside their axes.
    pub runout: Option<Runout>,
    /// Gauges to read: gear (1 or 2) and index in the model.
    pub gauges: Vec<(usize, usize)>,
    /// After how many pitches what repeats.
    pub periods: PairPeriods,
    /// What is judged after the run.
    pub ratings: Vec<PairRating>,
    /// Digests of both models' files.
    pub model_digests: [String; 2],
    /// What scenes of the same shelf have condensed.
    pub condensed: CondensedPairs,
}

/// Where models are not there yet, the gear files of the same names beside them say whether the gears run together:
/// told before minutes go into reducing them.
///
/// # Errors
/// [`InputError`] for gears that do not run together, as two of one hand.
pub fn demand_gears_that_fit(scene: &Scene, shelf: &ModelShelf) -> Result<(), InputError> {
    let models = scene.gears.each_ref().map(|gear| &gear.model);
    if models.iter().all(|path| shelf.knows(path)) {
        return Ok(());
    }
    let stated = |path: &Path| -> Option<GearDefinition> {
        if shelf.knows(path) {
            let model = shelf.model(path).ok()?.model;
            return model.input.definition_in(path.display()).ok().cloned();
        }
        let file = path.with_extension("toml");
        let document = InputDocument::read(&file).ok()?;
        GearDefinition::from_document(&document).ok()
    };
    let [Some(gear_1), Some(gear_2)] = models.map(|path| stated(path)) else {
        return Ok(());
    };
    let (distance_m, misalignment) = (scene.centre_distance_m, scene.misalignment);
    GearPair::new(gear_1.profile, gear_2.profile, distance_m, misalignment)
        .map_err(|error| scene.document.error("pair", error))?;
    Ok(())
}

impl LoadedScene {
    /// Numbers of the scene that look like those of another unit.
    #[must_use]
    pub fn unit_slips(&self) -> Vec<InputError> {
        self.scene.document.unit_slips()
    }

    /// What will be computed.
    pub fn plan(&self) -> Plan {
        Plan::new(self)
    }

    /// Bytes of the forces, pressures and places of contact of a result, nearly all of it.
    #[must_use]
    pub fn result_bytes(&self) -> f64 {
        let slots = self.line_slots(&self.angles_rad());
        let slices = (slots * self.layout.slices * self.scene.positions()) as f64;
        let (of_each_torque, of_all) = (2 * self.scene.torques_nm.len(), 3);
        8.0 * slices * (of_each_torque + of_all) as f64
    }

    /// Driver angles of the scene \[rad\].
    pub fn angles_rad(&self) -> Vec<f64> {
        let step = TAU / self.models[0].teeth as f64 / self.scene.points_per_pitch as f64;
        (0..self.scene.positions())
            .map(|k| self.scene.start_rad + step * k as f64)
            .collect()
    }
}

/// Solves all positions of a scene; torques run in parallel, each warm from angle to angle.
///
/// `progress` hears of each finished torque: done, total.
///
/// # Errors
/// [`RunError`] when a position has no solution.
pub fn run(
    loaded: &LoadedScene,
    progress: &(dyn Fn(usize, usize) + Sync),
) -> Result<SceneResult, RunError> {
    run_watched(loaded, progress, &PairWatch::default())
}

/// The same, watched position by position.
///
/// # Errors
/// As [`run`]; [`RunError::Stopped`].
pub fn run_watched(
    loaded: &LoadedScene,
    progress: &(dyn Fn(usize, usize) + Sync),
    watch: &PairWatch,
) -> Result<SceneResult, RunError> {
    solve(loaded, progress, (&watch.stop, &watch.solved))
}

/// The same with a flag of the caller's: ends before the next position once it is true.
///
/// # Errors
/// As [`run`]; [`RunError::Stopped`].
pub fn run_until(
    loaded: &LoadedScene,
    progress: &(dyn Fn(usize, usize) + Sync),
    stop: &AtomicBool,
) -> Result<SceneResult, RunError> {
    solve(loaded, progress, (stop, &AtomicUsize::new(0)))
}

fn solve(
    loaded: &LoadedScene,
    progress: &(dyn Fn(usize, usize) + Sync),
    (stop, solved): (&AtomicBool, &AtomicUsize),
) -> Result<SceneResult, RunError> {
    let scene = &loaded.scene;
    let angles = loaded.angles_rad();
    let clock = Instant::now();
    let contact = loaded.contact()?;
    let coverage = loaded.contact_coverage();
    let pitches = coverage.period_pitches.min(scene.pitches);
    let pair = &loaded.lines.pair;
    let distances = loaded.models.iter().flat_map(|m| &m.opposite_distance_m);
    let positions = Positions {
        torques_nm: &scene.torques_nm,
        angles_rad: &angles,
        looked_at: pitches * scene.points_per_pitch,
        repeats: coverage.is_whole(),
        measures: Measures {
            pitch_rad: pair.pitch_1_rad(),
            base_pitch_m: pair.pitch_1_rad() * pair.gear_1.base_radius_m,
            least_distance_m: distances.copied().fold(f64::INFINITY, f64::min),
            young_pa: loaded.models[0].young_pa.min(loaded.models[1].young_pa),
            whole_line: None,
            place_of: None,
        },
    };
    let watched = Watched {
        progress,
        stop,
        solved,
    };
    let radius_2_m = pair.gear_2.base_radius_m;
    let found = positions.solve(|| contact.clone(), radius_2_m, &watched)?;
    let contact_seconds = clock.elapsed().as_secs_f64();
    let size = (loaded.line_slots(&angles), loaded.layout.slices);
    let curves = curves(&scene.torques_nm, found, size);
    let slips = loaded.unit_slips().into_iter().map(|slip| slip.to_string());
    let mut result = SceneResult {
        source: PairSource {
            title: scene.title.clone(),
            scene_toml: scene.document.text.clone(),
            gears: loaded.models.each_ref().map(|model| model.input.clone()),
            model_files: scene.gears.each_ref().map(|gear| absolute(&gear.model)),
            microgeometry: loaded.microgeometry.clone(),
            ..curves.source
        },
        pitches: scene.pitches,
        contact_coverage: coverage,
        proposal: loaded.proposal(&loaded.gauges),
        te_mesh_error: te_mesh_error(loaded.models.each_ref().map(|model| &**model)),
        lines: LineForces {
            places: Some(ContactPlaces::new(loaded, &angles, curves.lines.slots)),
            ..curves.lines
        },
        warnings: slips.chain(curves.warnings).collect(),
        ..curves
    };
    let clock = Instant::now();
    result.strain = strain(loaded, &result, &loaded.gauges)?;
    result.solution.seconds = [contact_seconds, clock.elapsed().as_secs_f64()];
    result.ratings = judged(&loaded.ratings, &result);
    Ok(result)
}

/// Estimated relative error of the meshes in the deflection of teeth, the larger one of both gears; zero where it was
/// not estimated.
pub(super) fn te_mesh_error(models: [&ReducedGear; 2]) -> f64 {
    let name = ReductionChecks::BOTH_TEETH_ERROR;
    match models.map(|model| model.checks.further(name)) {
        [Some(first), Some(second)] => first.max(second),
        _ => 0.0,
    }
}

/// A file's place, so that a result can be used from any folder.
pub(super) fn absolute(file: &Path) -> String {
    let found = std::path::absolute(file).unwrap_or_else(|_| file.to_owned());
    found.display().to_string()
}

/// Strain of gauges (gear, index in its model) for all positions of a result.
///
/// # Errors
/// [`RunError::Model`] when a model carries no loads on the scene's flank.
pub fn strain(
    loaded: &LoadedScene,
    result: &SceneResult,
    gauges: &[(usize, usize)],
) -> Result<Vec<StrainSeries>, RunError> {
    if gauges.is_empty() {
        return Ok(Vec::new());
    }
    let patches = |angles: &[f64]| -> Vec<Vec<ContactPatch>> {
        angles.iter().map(|&a| loaded.patches_at(a)).collect()
    };
    let even = patches(&result.angle_rad);
    let between = patches(&result.between.angle_rad);
    gauges
        .par_iter()
        .map(|&(gear, index)| {
            let model = &loaded.models[gear - 1];
            let rows = &model.gauges[index];
            let flank = loaded.lines.pair.flank_of(gear - 1);
            let reader = GaugeReader::new(model, rows, flank, &loaded.spreads[gear - 1])?;
            let first = loaded.lines.pair.teeth_of(0)[gear - 1];
            let read = |patches: &[ContactPatch], forces: &[f64], later: usize| {
                let tooth = loaded.lines.pair.teeth_of(later as i64)[gear - 1];
                let on = model.teeth + tooth - first;
                let slices = loaded.loaded_slices(gear, patches, forces);
                reader.read(slices.map(|at| LoadedSlice {
                    tooth: (at.tooth + on) % model.teeth,
                    ..at
                }))
            };
            Ok(StrainSeries::read(
                result,
                (gear, rows, loaded.gauge_coverage(gear, index)),
                |torque, angle| read(&even[angle], result.position_forces(torque, angle), 0),
                |k, later| read(&between[k], result.between.position_forces(k), later),
            ))
        })
        .collect()
}
