//! A bevel pair under the torques of its `[load]`: the same positions, curves and file as other pairs.
//!
//! One pitch is solved. Where the members have gauges, the run goes on over the pitches around it, through which a
//! tooth passes the mesh: a pitch later the next teeth stand where these stood and carry what these carried.

use super::all_positions::{Positions, TorquePositions, Watched, curves};
use super::bevel_result::BevelRest;
use super::contact_places::PatchPlace;
use super::position::Measures;
use super::result::SceneResult;
use super::run::{RunError, absolute, te_mesh_error};
use crate::model_shelf::{ModelShelf, ShelvedModel};
use crate::periods::Coverage;
use gearmesh_bevel::pair_file::{BevelFile, LoadRequest};
use gearmesh_bevel::{AssembledPair, BevelError, PairDesign, PairFile, ToothCheck};
use gearmesh_contact::slice_contact::SliceContact;
use gearmesh_contact::{ContactPatch, LocalContact, StaticContact};
use gearmesh_drivetrain::{BevelAtRest, BevelMesh, BevelSlices};
use gearmesh_geometry::InputError;
use gearmesh_geometry::input::InputDocument;
use gearmesh_model::{ReducedGear, StoredGear};
use std::f64::consts::TAU;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize};
use std::sync::{Arc, OnceLock};
use std::time::Instant;

/// Slices of rigid gears where the file says nothing, and more where a light load touches few of them.
const SLICES: usize = 31;
/// Slices of rigid gears at most where the file says nothing.
const MOST_SLICES: usize = 100;
/// Slices of the pair that carries most which are to be loaded at every position.
const LOADED_SLICES: usize = 8;
/// Pitches before and after the one that is solved: no tooth is longer in mesh.
const PASSAGE: usize = 4;

/// A bevel pair file.
#[derive(Debug, Clone)]
pub struct BevelScene {
    /// What it holds. Flanks that were made already do not follow a change of it.
    pub file: PairFile,
    /// The file, for complaints and provenance.
    pub document: InputDocument,
    made: Made,
}

/// Settings and flanks with the checks of the teeth of both members.
type CheckedDesign = (PairDesign, [ToothCheck; 2]);

/// What follows from a pair file, made once, when it is first asked for; clones share it.
#[derive(Debug, Clone, Default)]
struct Made {
    design: Arc<OnceLock<Result<CheckedDesign, InputError>>>,
    assembled: Arc<OnceLock<Result<AssembledPair, BevelError>>>,
    flanks: Arc<OnceLock<BevelMesh>>,
}

/// A bevel pair with what deflects under its loads.
#[derive(Debug)]
pub struct LoadedBevel {
    scene: BevelScene,
    load: LoadRequest,
    models: Option<[ShelvedModel; 2]>,
    model_files: [String; 2],
}

impl BevelScene {
    /// The pair of tables in memory; file names are relative to `folder`, models in memory are those of the shelf it is
    /// loaded with.
    ///
    /// # Errors
    /// [`InputError`] with the path of the field, what was found and what is allowed.
    pub fn new(tables: &BevelFile, folder: &Path) -> Result<Self, InputError> {
        Self::from_document(InputDocument::of_values(tables, folder)?)
    }

    /// Checks a pair file that is in memory; its file names are relative to where it says it lies.
    ///
    /// # Errors
    /// [`InputError`] with file, line, key, what was found and what is allowed.
    pub fn from_document(document: InputDocument) -> Result<Self, InputError> {
        let file = PairFile::from_document(&document)?;
        let made = Made::default();
        Ok(Self {
            file,
            document,
            made,
        })
    }

    /// The pair of a result, from the text inside it; none where flanks go through points of files, which may have
    /// changed since.
    ///
    /// # Errors
    /// [`InputError`] for a text that this version does not understand, and as of [`Self::design`].
    pub fn of_result(result: &SceneResult) -> Result<Option<Self>, InputError> {
        let document = InputDocument::new("scene in result", &result.source.scene_toml);
        let scene = Self::from_document(document)?;
        let is_cut = scene.design()?.settings.iter().all(Option::is_some);
        Ok(is_cut.then_some(scene))
    }

    /// Settings and flanks, the teeth of both members checked.
    ///
    /// # Errors
    /// [`InputError`] for flanks that cannot be made.
    pub fn design(&self) -> Result<&PairDesign, InputError> {
        let make = || self.file.checked_design(&self.document);
        match self.made.design.get_or_init(make) {
            Ok((design, _)) => Ok(design),
            Err(error) => Err(error.clone()),
        }
    }

    /// The pair as it is assembled, without load.
    ///
    /// # Errors
    /// [`InputError`] as of [`Self::design`], and for an assembly in which the flanks do not touch, or teeth jam.
    pub fn assembled(&self) -> Result<&AssembledPair, InputError> {
        let design = self.design()?;
        let make = || AssembledPair::new(&self.file, design);
        let made = self.made.assembled.get_or_init(make);
        made.as_ref()
            .map_err(|error| error.clone().in_file(&self.document))
    }

    /// The flanks of both sides as a mesh takes them.
    ///
    /// # Errors
    /// [`RunError`] for flanks that cannot be made, or touch along a line.
    pub(super) fn flanks(&self) -> Result<&BevelMesh, RunError> {
        if let Some(made) = self.made.flanks.get() {
            return Ok(made);
        }
        let made = BevelMesh::new(&self.file.blank, self.design()?)?;
        Ok(self.made.flanks.get_or_init(|| made))
    }

    /// Folder that its file names are relative to.
    #[must_use]
    pub fn folder(&self) -> &Path {
        self.document.folder()
    }

    /// The pair with its models, those of the shelf.
    ///
    /// # Errors
    /// [`InputError`] for a file without `[load]`, flanks that cannot be made, and models that cannot be read.
    pub fn load(&self, shelf: &ModelShelf) -> Result<LoadedBevel, RunError> {
        let problem = "is missing: a bevel pair is run under the torques of its [load]; `gearmesh tca` analyses its contact without load";
        let missing = || self.document.error("load", problem);
        let load = self.file.load.clone().ok_or_else(missing)?;
        self.design()?;
        let mut model_files = [String::new(), String::new()];
        let models = match &load.models {
            Some(files) => {
                let read = |i: usize| -> Result<ShelvedModel, RunError> {
                    let found = shelf.model(&self.folder().join(&files[i]));
                    let key = format!("load.models.{i}");
                    Ok(found.map_err(|error| self.document.error(&key, error))?)
                };
                model_files = files
                    .each_ref()
                    .map(|file| absolute(&self.folder().join(file)));
                Some([read(0)?, read(1)?])
            }
            None => None,
        };
        Ok(LoadedBevel {
            scene: self.clone(),
            load,
            models,
            model_files,
        })
    }
}

impl LoadedBevel {
    fn members(&self) -> Option<[&ReducedGear; 2]> {
        let models = self.models.as_ref()?;
        Some(models.each_ref().map(|shelved| &*shelved.model))
    }

    /// Gauges of both members: gear (1 or 2) and name.
    #[must_use]
    pub fn gauges(&self) -> Vec<(usize, String)> {
        let members = self
            .members()
            .into_iter()
            .flat_map(|members| [1, 2].into_iter().zip(members));
        let of = |(gear, model): (usize, &ReducedGear)| -> Vec<(usize, String)> {
            model
                .gauges
                .iter()
                .map(|gauge| (gear, gauge.name.clone()))
                .collect()
        };
        members.flat_map(of).collect()
    }

    /// Positions of a pitch.
    #[must_use]
    pub fn points_per_pitch(&self) -> usize {
        self.load.positions
    }

    /// What will be computed, in lines for people.
    #[must_use]
    pub fn plan(&self) -> Vec<String> {
        let (file, load) = (&self.scene.file, &self.load);
        let [pinion, gear] = file.blank.data.teeth;
        let slices = load
            .slices
            .map_or("slices by the load".to_owned(), |n| format!("{n} slices"));
        vec![
            format!("scene      {}", file.title),
            format!(
                "analysis   static, {} torques x {} positions",
                load.torques_nm.len(),
                load.positions
            ),
            format!(
                "pair       bevel, z {pinion}/{gear}, {} flank of the pinion drives",
                file.pinion_flank.word()
            ),
            format!("bodies     {}", self.bodies()),
            format!("mesh       `hybrid`, {slices}"),
            match load.friction {
                Some(friction) => format!("friction   {friction}, for the efficiency"),
                None => "friction   not computed".to_owned(),
            },
            format!("gauges     {}, methods 1 and 2", self.gauges().len()),
        ]
    }

    /// What deflects, in words.
    fn bodies(&self) -> &'static str {
        match self.models {
            Some(_) => "reduced gears",
            None => "rigid gears, their surfaces deflect",
        }
    }

    /// Solves all positions; torques run in parallel.
    ///
    /// # Errors
    /// [`RunError`] when a position has no solution, the models are not those of the pair, or the run is stopped.
    pub fn run(
        &self,
        progress: &(dyn Fn(usize, usize) + Sync),
        stop: &AtomicBool,
    ) -> Result<SceneResult, RunError> {
        let watched = Watched {
            progress,
            stop,
            solved: &AtomicUsize::new(0),
        };
        let mut slices = self.slices()?;
        let is_free = self.models.is_none() && self.load.slices.is_none();
        loop {
            let clock = Instant::now();
            let result = self.run_in_slices(slices, &watched)?;
            let finer = (2 * slices).min(MOST_SLICES);
            if !is_free || finer == slices || !wants_more(&result, slices as f64 / finer as f64) {
                return self.with_strain(result, clock.elapsed().as_secs_f64());
            }
            slices = finer;
        }
    }

    /// Slices along the face. A model tells its own apart, shorter ones not: their pressure beside edges would be too
    /// high.
    fn slices(&self) -> Result<usize, InputError> {
        let Some([pinion, gear]) = self.members() else {
            return Ok(self.load.slices.unwrap_or(SLICES));
        };
        let most = pinion.grid.slices.min(gear.grid.slices).max(3);
        let found = self.load.slices.unwrap_or(most);
        if found <= most {
            return Ok(found);
        }
        let problem = format!(
            "found {found}, allowed with these models is at most {most}, the slices of the coarser one; state fewer, or reduce the members with more `slices`"
        );
        Err(self.scene.document.error("load.slices", problem))
    }

    fn run_in_slices(&self, slices: usize, watched: &Watched<'_>) -> Result<SceneResult, RunError> {
        let (file, load) = (&self.scene.file, &self.load);
        let flanks = BevelSlices::of_pair(self.scene.flanks()?.clone(), slices)?;
        let pair = BevelAtRest::new(&file.blank, flanks, (file.pinion_flank, &file.tca.error));
        let contact = self.contact(&pair)?;
        let found = self.solve(&pair, &contact, watched)?;
        let mut result = curves(&load.torques_nm, found, (1, slices));
        let run_pitches = result.angle_rad.len() / load.positions;
        let gears = self
            .members()
            .map(|members| members.map(|model| model.input.clone()));
        let none = || StoredGear::without_definition(String::new());
        result.source.title.clone_from(&file.title);
        result
            .source
            .scene_toml
            .clone_from(&self.scene.document.text);
        result.source.gears = gears.unwrap_or_else(|| [none(), none()]);
        result.source.model_files = self.model_files.clone();
        result.pitches = run_pitches;
        result.te_mesh_error = self.members().map_or(0.0, te_mesh_error);
        result.contact_coverage = Coverage::of_contact(1, run_pitches);
        result.bevel = Some(BevelRest {
            teeth: file.blank.data.teeth,
            side: pair.side(),
            radius_2_m: pair.radius_2_m(),
            face_widths_m: pair.flanks().pair().face_widths_m(),
            flank_heights_m: [0, 1].map(|gear: usize| {
                let [root, tip] = [0.0, 1.0].map(|v| {
                    pair.flanks()
                        .pair()
                        .flank_point_m(pair.side(), gear, [0.5, v])
                });
                (tip - root).norm()
            }),
            friction: load.friction,
        });
        let slips = self.scene.document.unit_slips();
        let slips = slips.iter().map(ToString::to_string);
        result.warnings = slips.chain(result.warnings).collect();
        if self.models.is_none() {
            result.warnings.extend(short_slices(&result));
        }
        Ok(result)
    }

    fn contact(&self, pair: &BevelAtRest) -> Result<SliceContact, RunError> {
        let flanks = pair.flanks();
        Ok(match self.members() {
            Some(models) => {
                flanks.reduced_contact(pair.side(), models, LocalContact::Calibrated)?
            }
            None => flanks.surface_contact([self.load.material; 2]),
        })
    }

    /// The pitch, and the same around it where gauges want it.
    fn solve(
        &self,
        pair: &BevelAtRest,
        contact: &SliceContact,
        watched: &Watched<'_>,
    ) -> Result<Vec<TorquePositions>, RunError> {
        let teeth = pair.flanks().pair().teeth();
        let pitch_rad = TAU / teeth[0] as f64;
        let positions = self.load.positions;
        let angle = |k: usize| k as f64 / positions as f64 * pitch_rad;
        let angles: Vec<f64> = (0..positions).map(angle).collect();
        let place_of = |angle_rad: f64, patch: &ContactPatch| -> PatchPlace {
            let place = pair.place(angle_rad, patch);
            let [on_1, on_2] = patch.places;
            let (sliding_m, to_tip_m) = (place.sliding_m, place.to_tip_m);
            [
                on_1.u,
                on_1.v,
                patch.length_m,
                on_2.u,
                on_2.v,
                sliding_m,
                to_tip_m,
            ]
        };
        let members = self.members();
        let depths = members
            .into_iter()
            .flatten()
            .flat_map(|m| &m.opposite_distance_m);
        let young_pa = members.map_or(self.load.material.0, |[a, b]| a.young_pa.min(b.young_pa));
        let all = Positions {
            torques_nm: &self.load.torques_nm,
            angles_rad: &angles,
            looked_at: positions,
            repeats: true,
            measures: Measures {
                pitch_rad,
                base_pitch_m: pitch_rad * pair.flanks().pair().levers_m()[0],
                least_distance_m: depths.copied().fold(f64::INFINITY, f64::min),
                young_pa,
                whole_line: Some(contact.slices() as f64),
                place_of: Some(&place_of),
            },
        };
        let at_rest = || StaticContact::of_flanks(pair.posed(), contact.clone());
        let mut found = all.solve(at_rest, pair.radius_2_m(), watched)?;
        // Zero where the gear leads most without load.
        let every = found.iter().flat_map(TorquePositions::all);
        let most_m = every
            .map(|p| p.unloaded_m)
            .fold(f64::NEG_INFINITY, f64::max);
        for position in found.iter_mut().flat_map(TorquePositions::all_mut) {
            if members.is_none() {
                // The law of half spaces has no hats; `short_slices` says where it is cut off.
                position.strained[3] = 0.0;
            }
            position.te_m -= most_m;
            position.unloaded_m -= most_m;
            position
                .pairs
                .iter_mut()
                .for_each(|tooth| *tooth = pair.pair_of(*tooth));
        }
        if !self.gauges().is_empty() {
            found.iter_mut().for_each(|found| pass(found, pitch_rad));
        }
        Ok(found)
    }

    fn with_strain(&self, mut result: SceneResult, seconds: f64) -> Result<SceneResult, RunError> {
        let clock = Instant::now();
        if let Some(members) = self.members() {
            let all = |gear: usize| (0..members[gear - 1].gauges.len()).map(move |k| (gear, k));
            let gauges: Vec<(usize, usize)> = [1, 2].into_iter().flat_map(all).collect();
            result.strain = super::bevel_result::strain(members, &result, &gauges)?;
        }
        result.solution.seconds = [seconds, clock.elapsed().as_secs_f64()];
        Ok(result)
    }
}

/// Repeats a pitch before and after it, pairs of teeth counted on.
fn pass(found: &mut TorquePositions, pitch_rad: f64) {
    let reach = PASSAGE as i64;
    let pitch = std::mem::take(&mut found.even);
    found.even = (-reach..=reach)
        .flat_map(|pitches| {
            pitch.iter().map(move |position| {
                let mut position = position.clone();
                position.angle_rad += pitches as f64 * pitch_rad;
                position.pairs.iter_mut().for_each(|pair| *pair += pitches);
                position.iterations *= usize::from(pitches == 0);
                position
            })
        })
        .collect();
}

/// Whether some position has too few loaded slices for its load to be spread over them, and slices that are shorter by
/// a factor stay longer than every contact's half width, below which the law of half spaces is cut off.
fn wants_more(result: &SceneResult, shorter: f64) -> bool {
    let few = result.even_positions().any(|position| {
        let shares = position.pair_forces_n();
        let best = shares.first().map(|(pair, _)| *pair);
        let loaded = position.pressing().filter(|at| Some(at.pair) == best);
        loaded.count() < LOADED_SLICES
    });
    few && (result.even_positions().flat_map(|p| p.pressing()))
        .all(|at| at.half_width_m() < shorter * at.length_m())
}

/// On half spaces the law of a slice is cut off where it is shorter than the contact's half width
/// (docs/theory/sliced_contact.md).
fn short_slices(result: &SceneResult) -> Option<String> {
    let pressing = result
        .even_positions()
        .flat_map(|position| position.pressing());
    let too_short = pressing.filter(|at| at.half_width_m() > at.length_m());
    let widest = too_short.max_by(|a, b| a.half_width_m().total_cmp(&b.half_width_m()))?;
    Some(format!(
        "slices, {:.3} mm long, are shorter than the contact's half width, {:.3} mm: deflections of short slices are cut off there; state fewer `slices`",
        1e3 * widest.length_m(),
        1e3 * widest.half_width_m()
    ))
}
