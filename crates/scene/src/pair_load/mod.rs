//! From the scene of a pair to what is run: its models, its axes as they stand by the scene or by a gearbox's result
//! (`taken_axes.rs`), and all else that it names, checked.

mod taken_axes;

use std::path::Path;
use std::sync::Arc;
use taken_axes::{TakenAxes, refuse_further_torques};

use gearmesh_contact::{ContactLines, PathExtension};
use gearmesh_geometry::input::TableKeys;
use gearmesh_geometry::{GearDefinition, GearPair, InputError};
use gearmesh_model::ReducedGear;

use crate::model_shelf::{ModelShelf, ShelvedModel};
use crate::pair::rating::RatedPair;
use crate::pair::{LoadedScene, RunError, Scene, contacts, demand_gears_that_fit, flank_effects};
use crate::periods::PairPeriods;

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
    demand_gears_that_fit(&scene, shelf)?;
    let (model_1, mut gear_1) = gear_of(&scene, shelf, ("pair.gear_1", &scene.gears[0].model))?;
    let (model_2, mut gear_2) = gear_of(&scene, shelf, ("pair.gear_2", &scene.gears[1].model))?;
    let microgeometry = [
        scene.modify_flanks(1, &mut gear_1)?,
        scene.modify_flanks(2, &mut gear_2)?,
    ];
    let pair = standing(&mut scene, [&gear_1, &gear_2])?;
    if pair.is_helical() && scene.path_by_default {
        scene.edge_radius_m = None;
    }
    let extension = scene
        .edge_radius_m
        .map(|radius| PathExtension::new(&pair, radius));
    let model_digests = [model_1.digest, model_2.digest];
    let mut models = [model_1.model, model_2.model];
    let bores = on_their_bores(&scene, &mut models)?;
    let sides = [0, 1].map(|gear| pair.flank_of(gear));
    for (key, i) in [("pair.gear_1", 0), ("pair.gear_2", 1)] {
        let flank = models[i].flank_index(sides[i]);
        flank.map_err(|e| scene.document.error(key, e))?;
    }
    let gauges = gauge_places(&scene, &models)?;
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
    let unlike = [1, 2].into_iter();
    for gear in unlike.filter(|gear| scene.tells_teeth_apart(*gear)) {
        periods = periods.with_unlike_teeth(gear);
    }
    let lines = ContactLines {
        pair,
        extension,
        zone: layout.reference,
        microgeometry_1: gear_1.microgeometry.of(sides[0]).clone(),
        microgeometry_2: gear_2.microgeometry.of(sides[1]).clone(),
    };
    refuse_too_many_forces(&scene, lines.most_pairs() * layout.slices)?;
    Ok(LoadedScene {
        scene,
        models,
        bores,
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

/// The pair as its axes stand, by the scene or by a result that it names.
fn standing(scene: &mut Scene, gears: [&GearDefinition; 2]) -> Result<GearPair, InputError> {
    let mut taken = None;
    if let Some(from) = &scene.misalignment_from {
        let keys = TableKeys::new(&scene.document, "pair");
        let pair = (gears.map(|gear| gear.profile.teeth), scene.flank);
        refuse_further_torques(&scene.document, &scene.torques_nm)?;
        let axes = TakenAxes::of(from, &keys, &scene.folder, pair)?;
        scene.misalignment = axes.misalignment;
        scene.notes.push(axes.note.clone());
        taken = Some(axes);
    }
    let [gear_1, gear_2] = gears.map(|gear| gear.profile.clone());
    let pair = GearPair::new(gear_1, gear_2, scene.centre_distance_m, scene.misalignment);
    let pair = pair.map_err(|e| scene.document.error("pair", e))?;
    let pair = pair.on_flanks(scene.flank);
    let other_load = taken.and_then(|axes| axes.other_load(&pair, scene.torques_nm[0]));
    scene.notes.extend(other_load);
    Ok(pair)
}

/// Lets gears slide on their bores that do so; gives their models with the motions of the bore.
fn on_their_bores(
    scene: &Scene,
    models: &mut [Arc<ReducedGear>; 2],
) -> Result<[Option<Arc<ReducedGear>>; 2], InputError> {
    let mut bores = [None, None];
    for (k, model) in models.iter_mut().enumerate() {
        if scene.gears[k].slides {
            bores[k] = Some(Arc::clone(model));
            let sliding = model.with_sliding_bore();
            let key = format!("gear_{}.bore", k + 1);
            *model = Arc::new(sliding.map_err(|e| scene.document.error(&key, e))?.gear);
        }
    }
    Ok(bores)
}

/// The model of a gear of the scene, and the gear that it was made of.
fn gear_of(
    scene: &Scene,
    shelf: &ModelShelf,
    (key, path): (&str, &Path),
) -> Result<(ShelvedModel, GearDefinition), RunError> {
    if !shelf.knows(path) {
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
}

/// Gear and index of each gauge that the scene names.
fn gauge_places(
    scene: &Scene,
    models: &[Arc<ReducedGear>; 2],
) -> Result<Vec<(usize, usize)>, InputError> {
    let mut places = Vec::new();
    for (gear, stated) in [1, 2].into_iter().zip(&scene.gears) {
        let known = &models[gear - 1].gauges;
        for (i, name) in stated.gauges.iter().enumerate() {
            let index = known.iter().position(|g| g.name == *name).ok_or_else(|| {
                let names: Vec<&str> = known.iter().map(|g| g.name.as_str()).collect();
                let known = match names.is_empty() {
                    true => "none".to_owned(),
                    false => names.join(", "),
                };
                let problem = format!("the model has no gauge `{name}`; it has: {known}");
                let key = format!("gauges.gear_{gear}.{i}");
                scene.document.error(&key, problem)
            })?;
            places.push((gear, index));
        }
    }
    Ok(places)
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
