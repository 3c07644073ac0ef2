//! Loads the models of a scene, solves all positions, reads the gauges.

use super::contact_places::ContactPlaces;
use super::contacts;
use super::flank_effects;
use super::model_shelf::{CondensedPairs, ModelShelf, ShelvedModel};
use super::plan::Plan;
use super::rating::{PairRating, RatedPair, judged};
use super::result::{SceneResult, StrainSeries};
use super::scene_file::Scene;
use super::warnings::{Assumption, Warnings};
use crate::periods::PairPeriods;
use gearmesh_contact::mesh_stiffness::MeshStiffness;
use gearmesh_contact::{
    AxialSpread, ContactError, ContactLines, ContactPatch, Drive, FlankDeviations, PathExtension,
    Runout, SliceLayout, StaticContact,
};
use gearmesh_geometry::input::TableKeys;
use gearmesh_geometry::{GearDefinition, GearPair, InputError};
use gearmesh_model::{FileError, ReducedGear, ReducedGearError, utc_now};
use gearmesh_recovery::GaugeReader;
use rayon::prelude::*;
use std::f64::consts::TAU;
use std::path::Path;
use std::sync::Arc;
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
}

impl RunError {
    /// True when the input is to blame, not the computation.
    pub fn is_input(&self) -> bool {
        !matches!(self, Self::Contact(cause) if cause.is_computation())
    }
}

/// A scene with its models.
#[derive(Debug)]
pub struct LoadedScene {
    /// The scene.
    pub scene: Scene,
    /// Reduced models of gear 1 and gear 2.
    pub models: [Arc<ReducedGear>; 2],
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

/// Reads the models of a scene and checks that everything it names exists.
///
/// # Errors
/// [`RunError`] when a model is missing or broken, the gears do not run together, or a gauge does not exist.
pub fn load(scene: Scene) -> Result<LoadedScene, RunError> {
    load_from(scene, &ModelShelf::default())
}

/// The same with models of a shelf, which reads those only that it does not have: for many scenes of the same gears.
///
/// # Errors
/// As [`load`].
pub fn load_from(mut scene: Scene, shelf: &ModelShelf) -> Result<LoadedScene, RunError> {
    let read = |key: &str, path: &Path| -> Result<(ShelvedModel, GearDefinition), RunError> {
        if !path.exists() {
            let problem = format!(
                "the model {} does not exist; make it with `gearmesh reduce GEAR.toml -o {}`",
                path.display(),
                path.display()
            );
            return Err(scene.document.error(key, problem).into());
        }
        let model = shelf.model(path)?;
        let gear = model.model.input.definition_in(path.display())?.clone();
        Ok((model, gear))
    };
    let (model_1, mut gear_1) = read("pair.gear_1", &scene.gear_1)?;
    let (model_2, mut gear_2) = read("pair.gear_2", &scene.gear_2)?;
    let microgeometry = [
        scene.modify_flanks(1, &mut gear_1)?,
        scene.modify_flanks(2, &mut gear_2)?,
    ];
    if let Some(from) = &scene.misalignment_from {
        let keys = TableKeys::new(&scene.document, "pair");
        let pair = ([gear_1.profile.teeth, gear_2.profile.teeth], scene.flank);
        let (misalignment, note) = from.take(&keys, &scene.folder, pair)?;
        scene.misalignment = misalignment;
        scene.notes.push(note);
    }
    let pair = GearPair::new(
        gear_1.profile.clone(),
        gear_2.profile.clone(),
        scene.centre_distance_m,
        scene.misalignment,
    )
    .map_err(|e| scene.document.error("pair", e))?
    .on_flanks(scene.flank);
    if pair.is_helical() && scene.path_by_default {
        scene.edge_radius_m = None;
    }
    if pair.is_helical() && scene.edge_radius_m.is_some() {
        let problem = "found \"extended\" with helical gears, whose tip edges are not modelled; allowed is \"line-of-action\"";
        return Err(scene.document.error("mesh.teeth.path", problem).into());
    }
    let extension = scene
        .edge_radius_m
        .map(|radius| PathExtension::new(&pair, radius));
    let model_digests = [model_1.digest, model_2.digest];
    let models = [model_1.model, model_2.model];
    for (key, model) in ["pair.gear_1", "pair.gear_2"].iter().zip(&models) {
        model
            .flank_index(scene.flank)
            .map_err(|e| scene.document.error(key, e))?;
    }
    let mut gauges = Vec::new();
    for (gear, names) in [(1, &scene.gauges_1), (2, &scene.gauges_2)] {
        for (i, name) in names.iter().enumerate() {
            let known = &models[gear - 1].gauges;
            let index = known.iter().position(|g| g.name == *name).ok_or_else(|| {
                let names: Vec<&str> = known.iter().map(|g| g.name.as_str()).collect();
                scene.document.error(
                    &format!("gauges.gear_{gear}.{i}"),
                    format!(
                        "the model has no gauge `{name}`; it has: {}",
                        if names.is_empty() {
                            "none".into()
                        } else {
                            names.join(", ")
                        }
                    ),
                )
            })?;
            gauges.push((gear, index));
        }
    }
    let rated = RatedPair {
        scene: &scene,
        pair: &pair,
        gears: [&gear_1, &gear_2],
        models: &models,
        gauges: &gauges,
    };
    let ratings = rated.ratings()?;
    let layout = contacts::slice_layout(&scene, &models)?;
    let spreads = [0, 1].map(|i: usize| layout.spread(i + 1, &models[i]));
    let deviations = flank_effects::deviations(&scene, [&gear_1, &gear_2])?;
    let runout = flank_effects::runout(&scene, &pair)?;
    let mut periods = PairPeriods::of([&gear_1, &gear_2]);
    for gear in [1, 2]
        .into_iter()
        .filter(|gear| scene.tells_teeth_apart(*gear))
    {
        periods = periods.with_unlike_teeth(gear);
    }
    let lines = ContactLines {
        pair,
        extension,
        zone: layout.reference,
        microgeometry_1: gear_1.microgeometry.of(scene.flank).clone(),
        microgeometry_2: gear_2.microgeometry.of(scene.flank).clone(),
    };
    refuse_too_many_forces(&scene, lines.most_pairs() * layout.slices)?;
    Ok(LoadedScene {
        scene,
        models,
        lines,
        layout,
        spreads,
        microgeometry,
        deviations,
        runout,
        gauges,
        periods,
        ratings,
        model_digests,
        condensed: shelf.condensed(),
    })
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

/// Most slice forces of a result: 1 GB, and as much again for the pressures, in memory until it is written.
const MOST_FORCES: usize = 1 << 27;

/// Told before the run, which would fill the memory.
fn refuse_too_many_forces(scene: &Scene, slices_in_contact: usize) -> Result<(), InputError> {
    let positions = scene.positions().saturating_mul(scene.torques_nm.len());
    let forces = positions.saturating_mul(slices_in_contact);
    if forces <= MOST_FORCES {
        return Ok(());
    }
    let problem = format!(
        "{} pitches of {} points at {} torques are {positions} positions of {slices_in_contact} slice forces, allowed are {} positions",
        scene.pitches,
        scene.points_per_pitch,
        scene.torques_nm.len(),
        MOST_FORCES / slices_in_contact.max(1)
    );
    Err(scene.document.error("run.pitches", problem))
}

/// Curves of one torque.
struct TorqueCurves {
    te: Vec<f64>,
    unloaded: Vec<f64>,
    torque_1: Vec<f64>,
    axial_1: Vec<f64>,
    secant: Vec<f64>,
    tangent: Vec<f64>,
    force: Vec<f64>,
    pressure: Vec<f64>,
    k_h_beta: f64,
    iterations: u32,
    residual: f64,
    torque_balance: f64,
    warnings: Vec<(Assumption, f64)>,
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
    let scene = &loaded.scene;
    let angles = loaded.angles_rad();
    let clock = Instant::now();
    let slots = loaded.line_slots(&angles);
    let done = std::sync::atomic::AtomicUsize::new(0);
    let contact = loaded.contact()?;
    let curves: Vec<TorqueCurves> = scene
        .torques_nm
        .par_iter()
        .map(|&torque| {
            let curves = solve_torque(loaded, contact.clone(), &angles, slots, torque)?;
            let finished = done.fetch_add(1, std::sync::atomic::Ordering::Relaxed) + 1;
            progress(finished, scene.torques_nm.len());
            Ok(curves)
        })
        .collect::<Result<_, RunError>>()?;
    let contact_seconds = clock.elapsed().as_secs_f64();

    let (mut pair, mut pair_count) = (Vec::new(), Vec::new());
    for &angle in &angles {
        let (_, lines) = loaded.lines_at(angle);
        pair_count.push(lines.len() as u32);
        pair.extend((0..slots).map(|k| lines.get(k).map_or(0.0, |l| l.pair as f64)));
    }
    let mut warnings = Warnings::default();
    for (torque, curve) in scene.torques_nm.iter().zip(&curves) {
        for (assumption, value) in &curve.warnings {
            warnings.note(*assumption, *value, *torque);
        }
    }
    let flatten = |part: fn(&TorqueCurves) -> &Vec<f64>| {
        curves
            .iter()
            .flat_map(|c| part(c).iter().copied())
            .collect()
    };
    let slips = loaded.unit_slips().into_iter().map(|slip| slip.to_string());
    let mut result = SceneResult {
        title: scene.title.clone(),
        scene_toml: scene.document.text.clone(),
        gears: loaded.models.each_ref().map(|model| model.input.clone()),
        model_files: [&scene.gear_1, &scene.gear_2].map(|file| {
            std::path::absolute(file)
                .unwrap_or_else(|_| file.clone())
                .display()
                .to_string()
        }),
        version: env!("CARGO_PKG_VERSION").into(),
        created_utc: utc_now(),
        pitches: scene.pitches,
        microgeometry: loaded.microgeometry.clone(),
        contact_coverage: loaded.contact_coverage(),
        proposal: loaded.proposal(&loaded.gauges),
        torque_nm: scene.torques_nm.clone(),
        te_m: flatten(|c| &c.te),
        unloaded_m: curves
            .first()
            .map(|c| c.unloaded.clone())
            .unwrap_or_default(),
        torque_1_nm: flatten(|c| &c.torque_1),
        axial_force_1_n: flatten(|c| &c.axial_1),
        secant_n_per_m: flatten(|c| &c.secant),
        tangent_n_per_m: flatten(|c| &c.tangent),
        slots,
        slices: loaded.layout.slices,
        pair,
        pair_count,
        force_n: flatten(|c| &c.force),
        pressure_pa: flatten(|c| &c.pressure),
        places: Some(ContactPlaces::new(loaded, &angles, slots)),
        k_h_beta: curves.iter().map(|c| c.k_h_beta).collect(),
        iterations: curves.iter().map(|c| c.iterations).collect(),
        residual: curves.iter().map(|c| c.residual).collect(),
        torque_balance: curves.iter().map(|c| c.torque_balance).collect(),
        strain: Vec::new(),
        ratings: Vec::new(),
        warnings: (slips.chain(warnings.sentences())).collect(),
        seconds: [contact_seconds, 0.0],
        angle_rad: angles,
    };
    let clock = Instant::now();
    result.strain = strain(loaded, &result, &loaded.gauges)?;
    result.seconds[1] = clock.elapsed().as_secs_f64();
    result.ratings = judged(&loaded.ratings, &result);
    Ok(result)
}

fn solve_torque(
    loaded: &LoadedScene,
    mut contact: StaticContact,
    angles: &[f64],
    slots: usize,
    torque: f64,
) -> Result<TorqueCurves, RunError> {
    let slices = contact.slices();
    let base_2 = loaded.lines.pair.gear_2.base_radius_m;
    let base_pitch = loaded.lines.pair.pitch_1_rad() * loaded.lines.pair.gear_1.base_radius_m;
    let distances = loaded.models.each_ref().map(|m| {
        m.opposite_distance_m
            .iter()
            .copied()
            .fold(f64::INFINITY, f64::min)
    });
    let least_distance = distances[0].min(distances[1]);
    let young = loaded.models[0].young_pa.min(loaded.models[1].young_pa);
    let n = angles.len();
    let mut c = TorqueCurves {
        te: Vec::with_capacity(n),
        unloaded: Vec::with_capacity(n),
        torque_1: Vec::with_capacity(n),
        axial_1: Vec::with_capacity(n),
        secant: Vec::with_capacity(n),
        tangent: Vec::with_capacity(n),
        force: vec![0.0; n * slots * slices],
        pressure: vec![0.0; n * slots * slices],
        k_h_beta: 1.0,
        iterations: 0,
        residual: 0.0,
        torque_balance: 0.0,
        warnings: Vec::new(),
    };
    let mut worst = [0.0f64; 4];
    for (k, &angle) in angles.iter().enumerate() {
        let state = contact.solve(angle, Drive::Torque(torque))?;
        let stiffness = MeshStiffness::of(&state, base_2);
        c.te.push(state.transmission_error_m);
        c.unloaded.push(state.unloaded_m);
        c.torque_1.push(state.torque_1_nm);
        c.axial_1.push(state.axial_force_1_n);
        c.secant.push(stiffness.secant_n_per_m);
        c.tangent.push(stiffness.tangent_n_per_m);
        c.iterations += state.info.iterations as u32;
        c.residual = c.residual.max(state.info.residual);
        c.torque_balance = c
            .torque_balance
            .max((state.torque_2_nm / torque - 1.0).abs());
        let forces = contact.forces_n();
        let first = k * slots * slices;
        c.force[first..first + forces.len()].copy_from_slice(forces);
        let mut heaviest = (0.0, 1.0);
        for on_line in contact.patches().chunk_by(|a, b| a.line == b.line) {
            let force = |s: &ContactPatch| contact.force_n(s);
            let sum: f64 = on_line.iter().map(force).sum();
            if sum > heaviest.0 {
                // Largest over mean line load; a slice partly on the path counts with its share.
                let length: f64 = on_line.iter().map(|s| s.share).sum();
                let largest = on_line.iter().map(force).fold(0.0, f64::max);
                heaviest = (sum, largest * length / sum);
            }
        }
        for (number, slice) in contact.patches().iter().enumerate() {
            let (half_width, pressure) = contact.hertz(number, contact.force_n(slice));
            c.pressure[first + slice.line * slices + slice.slice] = pressure;
            worst[0] = worst[0].max(half_width / least_distance);
            worst[1] = worst[1].max(pressure / young);
        }
        c.k_h_beta = c.k_h_beta.max(heaviest.1);
        worst[2] = worst[2].max((state.unloaded_m - state.transmission_error_m) / base_pitch);
        worst[3] = worst[3].max(state.info.cap_hits as f64);
    }
    let assumptions = [
        Assumption::NarrowContact,
        Assumption::ElasticMaterial,
        Assumption::SmallDeflection,
        Assumption::LocalTermCapped,
    ];
    c.warnings = assumptions.into_iter().zip(worst).collect();
    Ok(c)
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
    let flank = loaded.scene.flank;
    let patches_at: Vec<Vec<ContactPatch>> = result
        .angle_rad
        .iter()
        .map(|&angle| loaded.patches_at(angle))
        .collect();
    gauges
        .par_iter()
        .map(|&(gear, index)| {
            let model = &loaded.models[gear - 1];
            let rows = &model.gauges[index];
            let reader = GaugeReader::new(model, rows, flank, &loaded.spreads[gear - 1])?;
            let readings: Vec<_> = (0..result.torque_nm.len() * result.angles())
                .map(|k| {
                    let (torque, angle) = (k / result.angles(), k % result.angles());
                    let forces = result.position_forces(torque, angle);
                    reader.read(loaded.loaded_slices(gear, &patches_at[angle], forces))
                })
                .collect();
            Ok(StrainSeries {
                gear,
                name: rows.name.clone(),
                error_estimate_relative: rows.error_estimate_relative,
                coverage: loaded.gauge_coverage(gear, index),
                method_1: readings.iter().map(|s| s.method_1).collect(),
                method_2: readings.iter().map(|s| s.method_2).collect(),
            })
        })
        .collect()
}
