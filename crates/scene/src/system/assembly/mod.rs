//! From the tables of a scene to a multibody system.
//!
//! | step | file |
//! | --- | --- |
//! | read the gears that bodies name | `gears.rs` |
//! | bodies in their places, markers on them | `bodies.rs`, `lump.rs` |
//! | all bodies, shafts and meshes | `bodies_and_meshes.rs` |
//! | shafts; gears that are cut into them | `shafts.rs`, `cut_into_shaft.rs` |
//! | gear meshes: do the gears fit, models, effects | `gear_mesh.rs`, `scene_mesh.rs`, `mesh_model.rs`, `mesh_stiffness.rs`, `pair_stiffness.rs`, `mesh_effects.rs`; of bevel gears `bevel_mesh.rs` |
//! | speeds that nobody states, on axes that may be carried round | `start_speeds.rs`, `willis.rs`, `carriers.rs` |
//! | angles that nobody states | `start.rs` |
//! | a start in equilibrium where balls move | `start_at_rest.rs` |
//! | bearings that are linear about an operating point | `operating_point.rs` |
//! | how often teeth come into mesh, and whether steps follow it | `mesh_frequency.rs` |
//! | what a plan says of a mesh | `described_mesh.rs` |
//! | speeds that stay, whose mesh orders are judged | `steady_speeds.rs` |
//! | speeds that contradict a joint, stiffnesses that no run resolves | `stated_speeds.rs`, `stiffness.rs` |
//! | joints and motions, loads and springs, bearings | `connections.rs`, `joints.rs`, `elements.rs`, `bearings/` |
//! | which meshes are solved together | `coupled.rs`, `linked.rs` |
//! | whether the tables fit each other | `consistency.rs` |
//! | what only cylindrical rollers support | `loose_along_axis.rs` |
//! | gears that overlap, loads that drive | `overlaps.rs`, `load_powers.rs` |
//! | what is judged after the run | `ratings.rs` |

mod bearings;
mod bevel_hybrid;
mod bevel_mesh;
mod bodies;
mod bodies_and_meshes;
mod carriers;
mod connections;
mod consistency;
mod coupled;
mod cut_into_shaft;
mod described_mesh;
mod elements;
mod gear_mesh;
mod gears;
mod gears_in_motion;
mod joints;
mod linked;
mod load_powers;
mod loose_along_axis;
mod lump;
mod mesh_effects;
mod mesh_frequency;
mod mesh_model;
mod mesh_stiffness;
mod meshes_together;
mod node_surface;
mod operating_point;
mod overlaps;
mod pair_stiffness;
mod parts;
mod parts_in_motion;
mod ratings;
mod scene_mesh;
mod shafts;
mod start;
mod start_at_rest;
mod start_speeds;
mod stated_speeds;
mod steady_speeds;
mod stiffness;
mod willis;

pub(super) use self::bearings::cages::PlacedCage;
pub(super) use self::bearings::tangent::TangentSeat;
pub use gears_in_motion::{GearState, GearsInMotion, MovingGear, MovingShape, SliceLoad};
pub(crate) use mesh_frequency::{STEPS_A_PERIOD, floored, line_of_centres_rad_per_s};
pub use meshes_together::MovingError;
pub use parts_in_motion::{
    BodyAtStart, MovingElements, MovingPart, MovingParts, PartKind, PartShape,
};

use std::collections::BTreeSet;
use std::sync::Arc;

use gearmesh_dynamics::{Motion, Redundancy, System, SystemBuilder};
use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{InputDocument, TableKeys};
use gearmesh_specification::names::unknown;
use gearmesh_specification::system::function::Sources;
use gearmesh_specification::system::mesh_model::MeshKind;
use gearmesh_specification::system::run::Run;
use gearmesh_specification::system::solver::Start;

use self::bearings::tangent::Tangent;
use self::bearings::{cages, housing, rigid};
use self::bodies::Bodies;
use self::carriers::Holds;
use self::connections::Connections;
use self::coupled::is_eligible;
use self::gear_mesh::PreparedMesh;
use self::gears::{BodyGear, GearFiles};
use self::joints::PlacedMotion;
use self::parts::Parts;
use self::shafts::PlacedShaft;
use self::start_at_rest::start_in_equilibrium;
use self::start_speeds::settle_speeds;
use super::built::{BuiltBody, BuiltGauge, BuiltMesh, BuiltSystem};
use super::scene::SystemScene;

/// A scene whose gears have been read. Systems can be built from it again and again.
#[derive(Debug, Clone)]
pub struct LoadedSystem {
    /// The scene.
    pub scene: SystemScene,
    /// The gear of each `[[body]]`.
    gears: Vec<Option<BodyGear>>,
}

/// How one system of a series differs from the scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Variation {
    /// Other functions for motions, by name.
    pub motions: Vec<(String, Motion)>,
    /// Share of all `[[load]]` that acts.
    pub load_factor: f64,
}

impl Default for Variation {
    fn default() -> Self {
        Self {
            motions: Vec::new(),
            load_factor: 1.0,
        }
    }
}

/// A scene before the parts of its system are added.
struct SetUp {
    bodies: Bodies,
    shafts: Vec<PlacedShaft>,
    meshes: Vec<PreparedMesh>,
    motions: Vec<PlacedMotion>,
    parts: Parts,
    built_meshes: Vec<BuiltMesh>,
    /// As in [`BuiltSystem`].
    pitches_per_rad: f64,
    varied_rad_per_s: f64,
}

impl SystemScene {
    /// Reads the gears that bodies name.
    ///
    /// # Errors
    /// [`InputError`] at the body, or in the gear's file.
    pub fn load(self) -> Result<LoadedSystem, InputError> {
        let mut files = GearFiles::default();
        let mut gears = Vec::new();
        for (i, table) in self.tables.body.iter().enumerate() {
            let keys = TableKeys::new(&self.document, format!("body.{i}"));
            let read = |path| files.get(&self.folder.join(path), &keys, &self.models);
            let gear = table.gear.as_ref().map(read).transpose()?;
            let gear = gears::with_own_microgeometry(gear, &self, i)?;
            let gear = files.with_own_bore(gear, &self, i)?;
            gears.push(cut_into_shaft::on_its_shaft(gear, &self, i)?);
        }
        Ok(LoadedSystem { scene: self, gears })
    }
}

impl LoadedSystem {
    /// Numbers of the scene and of its gears' and bearings' files that look like those of another unit.
    #[must_use]
    pub fn unit_slips(&self) -> Vec<InputError> {
        let mut slips = self.scene.document.unit_slips();
        let mut seen = Vec::new();
        for gear in self.gears.iter().flatten() {
            if !seen.contains(&gear.file()) {
                seen.push(gear.file());
                slips.extend(gear.unit_slips());
            }
        }
        let bearings = self.scene.tables.bearing.iter();
        let files: BTreeSet<&str> = bearings.filter_map(|b| b.model.file()).collect();
        // Files that cannot be read are complained about where the system is built.
        let documents = files.into_iter().map(|file| self.scene.folder.join(file));
        slips.extend(
            documents
                .filter_map(|path| InputDocument::read(&path).ok())
                .flat_map(|document| document.unit_slips()),
        );
        slips
    }

    /// The system of the scene.
    ///
    /// # Errors
    /// [`InputError`] with file, line, key, what was found and what is allowed.
    pub fn build(&self) -> Result<BuiltSystem, InputError> {
        self.build_varied(&Variation::default())
    }

    /// The system of the scene with some things changed.
    ///
    /// # Errors
    /// As [`LoadedSystem::build`].
    pub fn build_varied(&self, variation: &Variation) -> Result<BuiltSystem, InputError> {
        let at_rest = self.is_at_rest();
        let (tangents, notes) = operating_point::tangents(self, variation)?;
        let mut built = self.assemble(variation, at_rest, &tangents)?;
        built.notes.extend(notes);
        if !at_rest && self.scene.solver.start == Start::Equilibrium && self.has_moving_balls() {
            let resting = self.assemble(variation, true, &tangents)?;
            start_in_equilibrium(&mut built, resting).map_err(|e| self.scene.complaint(&e))?;
        }
        Ok(built)
    }

    /// Whether its run has no time.
    fn is_at_rest(&self) -> bool {
        matches!(self.scene.run, Run::Static { .. } | Run::Eigen { .. })
    }

    /// Whether an equilibrium is sought before anything moves.
    fn seeks_rest(&self) -> bool {
        self.is_at_rest() || self.scene.solver.start == Start::Equilibrium
    }

    /// Whether the scene has bearings whose balls move.
    pub(crate) fn has_moving_balls(&self) -> bool {
        bearings::any_dynamic(&self.scene.tables.bearing)
    }

    /// The system; `at_rest`: with balls in equilibrium, where others would move. `tangents`: of the bearings that are
    /// linear about an operating point, as far as known; others are taken with balls in equilibrium.
    fn assemble(
        &self,
        variation: &Variation,
        at_rest: bool,
        tangents: &[Tangent],
    ) -> Result<BuiltSystem, InputError> {
        let scene = &self.scene;
        let (tables, document) = (&scene.tables, &scene.document);
        let mut set_up = self.set_up(variation, at_rest)?;
        let bodies = &mut set_up.bodies;
        // Gears have been turned: frames along their axes are the same, others follow.
        let joints = joints::place(&tables.joint, document, bodies)?;
        housing::place(scene, bodies)?;
        let cages = match at_rest {
            true => Vec::new(),
            false => cages::place(scene, bodies)?,
        };
        let builder = self.with_bodies(bodies)?;
        let (bodies, meshes) = (&set_up.bodies, set_up.meshes);
        let mut connections = Connections {
            scene,
            bodies,
            at_rest,
            cages: &cages,
            tangents,
            builder,
            parts: set_up.parts,
            seated: Vec::new(),
        };
        joints::add_joints(&joints, &mut connections)?;
        rigid::add(&mut connections)?;
        for shaft in &set_up.shafts {
            shaft.connect(&mut connections)?;
        }
        joints::add_motions(&set_up.motions, &joints, &mut connections)?;
        elements::add(variation.load_factor, self.sources(), &mut connections)?;
        if self.seeks_rest() {
            self.refuse_loose_along_axis(bodies, &meshes, &connections.parts)?;
        }
        let gauges = self.gauges(bodies, &meshes)?;
        let ratings = ratings::build(scene, bodies, &meshes, &gauges)?;
        self.add_meshes(meshes, &gauges, &mut connections)?;
        self.add_gravity(&mut connections);
        let Connections {
            builder, mut parts, ..
        } = connections;
        self.check_output(bodies, &parts)?;
        let system = builder.build().map_err(|e| scene.complaint(&e))?;
        parts.notes.extend(system.redundant().iter().map(in_words));
        let all = bodies.list.iter().zip(&bodies.ids);
        let built_bodies = all.map(|(placed, id)| BuiltBody {
            name: placed.body.name.clone(),
            id: *id,
            source: placed.source.clone(),
            model: placed.model().cloned(),
        });
        Ok(BuiltSystem {
            system,
            bodies: built_bodies.collect(),
            joints: parts.joints,
            elements: parts.elements,
            meshes: set_up.built_meshes,
            pitches_per_rad: set_up.pitches_per_rad,
            varied_rad_per_s: set_up.varied_rad_per_s,
            together: parts.together,
            gauges,
            ratings,
            notes: parts.notes,
            effects: parts.effects,
            cages,
            tangents: parts.tangents,
        })
    }

    /// A system of the bodies, which get their numbers in it.
    fn with_bodies(&self, bodies: &mut Bodies) -> Result<SystemBuilder, InputError> {
        let mut builder = System::builder();
        for (i, placed) in bodies.list.iter().enumerate() {
            let key = match self.scene.tables.body.get(i) {
                Some(_) => format!("body.{i}"),
                None => "shaft".to_string(),
            };
            let id = builder.body(placed.body.clone());
            bodies
                .ids
                .push(id.map_err(|e| self.scene.document.error(&key, e))?);
        }
        Ok(builder)
    }

    /// Where functions come from that the scene only names.
    fn sources(&self) -> Sources<'_> {
        Sources {
            folder: &self.scene.folder,
            host: &self.scene.host,
        }
    }

    /// Bodies in their places at their speeds, and what is known of meshes and motions there.
    fn set_up(&self, variation: &Variation, at_rest: bool) -> Result<SetUp, InputError> {
        let scene = &self.scene;
        let (tables, document, run) = (&scene.tables, &scene.document, &scene.run);
        let mut parts = Parts::default();
        let (mut bodies, shafts) = self.bodies_and_shafts()?;
        self.refuse_repeated_names()?;
        let meshes = self.prepared_meshes(&bodies, &mut parts)?;
        self.check_flexibility(&bodies, &meshes)?;
        let joints = joints::place(&tables.joint, document, &bodies)?;
        let (from, varied) = ((document, self.sources()), &variation.motions[..]);
        let motions = joints::motions(&tables.motion, from, &joints, varied)?;
        let holds = Holds {
            joints: &joints,
            bearings: &tables.bearing,
            shafts: &shafts,
        };
        let mut fastest = bodies.clone();
        let moved = (&motions[..], &PlacedMotion::spin_at_start as &_);
        settle_speeds(&mut bodies, holds, moved, &meshes, &mut parts.notes);
        if !at_rest {
            start_speeds::note_jerks(&bodies, &tables.torsion_spring, &mut parts.notes);
        }
        start_speeds::refuse_missed_ratios(&bodies, &meshes, document)?;
        // What motions drive is not held at the speeds of the start.
        fastest.free_speeds();
        let steady = steady_speeds::find(scene, &fastest, holds, (&motions, &meshes));
        let fastest_of = |motion: &PlacedMotion| motion.fastest_spin(run);
        let moved = (&motions[..], &fastest_of as &_);
        settle_speeds(&mut fastest, holds, moved, &meshes, &mut Vec::new());
        mesh_frequency::refuse_long_steps(scene, &meshes, [&bodies, &fastest])?;
        stated_speeds::check(&tables.body, &bodies, &joints, document)?;
        let at = (document, self.seeks_rest());
        start::settle_phases(&mut bodies, &meshes, at, &mut parts.notes)?;
        overlaps::note(&bodies, &mut parts.notes);
        load_powers::note(tables, &motions, &bodies, &mut parts.notes);
        let later = run.simulated_s().map(|_| &fastest);
        let described = |mesh: &PreparedMesh| mesh.describe(&bodies, later, steady.as_ref());
        let is_varied = |motion: &&PlacedMotion| run.varied_motion() == Some(motion.name());
        let varied = motions.iter().find(is_varied);
        Ok(SetUp {
            built_meshes: meshes.iter().map(described).collect(),
            pitches_per_rad: mesh_frequency::pitches_per_rad(run, &meshes, &fastest),
            varied_rad_per_s: varied.and_then(PlacedMotion::spin_at_start).unwrap_or(0.0),
            bodies,
            shafts,
            meshes,
            motions,
            parts,
        })
    }

    fn gauges(
        &self,
        bodies: &Bodies,
        meshes: &[PreparedMesh],
    ) -> Result<Vec<BuiltGauge>, InputError> {
        let mut gauges = Vec::new();
        for (i, table) in self.scene.tables.gauge.iter().enumerate() {
            let keys = TableKeys::new(&self.scene.document, format!("gauge.{i}"));
            let body = bodies.find_body(&keys, "body", &table.body)?;
            let model = bodies.list[body].model();
            let of_bevel = || meshes.iter().find_map(|mesh| mesh.bevel_model(body));
            let model = model.or_else(of_bevel).ok_or_else(|| {
                let problem = "is no reduced gear (.h5), which alone has gauges";
                keys.error("body", format!("`{}` {problem}", table.body))
            })?;
            let of_body = |mesh: &&PreparedMesh| {
                mesh.model == MeshKind::Hybrid && mesh.bodies.contains(&body)
            };
            // The first one reads the bending of a bore, which those without vibration modes know.
            let (solved_together, others): (Vec<_>, Vec<_>) =
                (meshes.iter().filter(of_body)).partition(|mesh| is_eligible(mesh, bodies));
            let number = |mesh: &PreparedMesh| if mesh.bodies[0] == body { 1 } else { 2 };
            let loaded: Vec<(String, usize)> = (solved_together.into_iter().chain(others))
                .map(|mesh| (mesh.built.name.clone(), number(mesh)))
                .collect();
            if loaded.is_empty() {
                let problem = "is in no hybrid mesh, whose slice forces a gauge reads";
                return Err(keys.error("body", format!("`{}` {problem}", table.body)));
            }
            let known: Vec<&str> = model.gauges.iter().map(|gauge| &*gauge.name).collect();
            for (k, name) in table.names.iter().enumerate() {
                let index = known.iter().position(|gauge| gauge == name);
                let index = index.ok_or_else(|| {
                    keys.error(&format!("names.{k}"), unknown("gauge", name, &known))
                })?;
                gauges.push(BuiltGauge {
                    name: name.clone(),
                    body: table.body.clone(),
                    index,
                    model: Arc::clone(model),
                    meshes: loaded.clone(),
                });
            }
        }
        Ok(gauges)
    }

    fn add_gravity(&self, connections: &mut Connections<'_>) {
        let Some(gravity) = self.scene.tables.gravity_m_per_s2 else {
            connections.parts.effect("weight", None);
            return;
        };
        connections.builder.gravity(gravity);
        for (i, name) in connections.bodies.names().enumerate() {
            // The name that the element of dynamics has.
            let name = format!("weight of {name}");
            let part = connections.bodies.part(&name, "weight", &[Some(i)]);
            connections.parts.elements.push(part);
        }
        let [x, y, z] = gravity;
        let how = format!("[{x}, {y}, {z}] m/s2");
        connections.parts.effect("weight", Some(how));
    }
}

/// What becomes of the equations of a joint that follow from others.
fn in_words(redundancy: &Redundancy) -> String {
    let (joint, count) = (&redundancy.joint, redundancy.equations);
    let implied = redundancy.implied_by.iter().map(|name| format!("`{name}`"));
    format!(
        "joint `{joint}`: {count} of its equations follow from {}; they are watched, and its reaction is shared among these joints as the first of them take it",
        implied.collect::<Vec<_>>().join(", ")
    )
}
