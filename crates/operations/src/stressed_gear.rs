//! A gear's finite element body under forces at places of its flanks: the stress on its surface, for series and
//! pictures.
//!
//! | what | file |
//! | --- | --- |
//! | the factorised body and its fields | this one |
//! | one tooth: its root, how it stands, gauges put on it, places in words | `stressed_gear/tooth.rs` |
//! | which of many loads strains the root most | `stressed_gear/root_search.rs` |

mod root_search;
mod tooth;

pub use root_search::RootSearch;
pub use tooth::{GaugeReading, RootFace, ToothFrame};

use crate::failure::{Failure, Result};
use crate::watch::Watch;
use gearmesh_bevel::BevelGear;
use gearmesh_contact::ProfileHats;
use gearmesh_contact::bevel_slices::profile_hats;
use gearmesh_fe::FeModel;
use gearmesh_geometry::{Flank, GearDefinition, ProfileCurve};
use gearmesh_mesh::{BevelMesh, OutlineFace};
use gearmesh_model::{FlankGrid, ReducedGear};
use gearmesh_recovery::{PlacedForce, placed_forces};
use gearmesh_reduction::GearBody;
use gearmesh_reduction::bevel::bevel_body;
use gearmesh_reduction::bevel::loads::{bevel_grid, shares_of};
use gearmesh_reduction::field::{Field, FlankUnits, GridForce, LooseBore};
use gearmesh_reduction::flank_loads::flank_grid;
use gearmesh_reduction::repeated_mesh::RepeatedMesh;
use gearmesh_reduction::skin::{SkinFace, skin, von_mises_on_faces};
use gearmesh_report::moving::{FlankFace, GearSurface, Moment};
use std::collections::HashMap;
use std::sync::Arc;

/// A factorised body with the unit loads of its flanks.
pub struct StressedGear {
    /// What it is.
    pub body: StressedBody,
    /// Faces of its surface.
    pub faces: Vec<SkinFace>,
    units: FlankUnits,
    grid: FlankGrid,
    face_width_m: f64,
    /// Right and left; none where the reduced gear carries no loads.
    hats: [Option<ProfileHats>; 2],
    /// The model with the motions of a bore that is not held.
    bore: Option<Arc<ReducedGear>>,
}

/// What acts on a gear at a moment.
#[derive(Debug, Clone, Default)]
pub struct Pressed {
    /// Forces on its flanks.
    pub forces: Vec<PlacedForce>,
    /// Radial motions of its bore, where rollers press on it \[m\].
    pub bore_m: Vec<f64>,
}

impl From<Vec<PlacedForce>> for Pressed {
    fn from(forces: Vec<PlacedForce>) -> Self {
        Self {
            forces,
            bore_m: Vec::new(),
        }
    }
}

/// The body by its kind.
pub enum StressedBody {
    /// A cylindrical gear.
    Cylindrical(Box<GearDefinition>, Box<GearBody>),
    /// A bevel gear.
    Bevel(Box<BevelGear>, Box<GearBody<BevelMesh>>),
}

/// The bevel gear of a reduced model, from the texts that it keeps; `file` names the model in messages.
pub fn bevel_gear_of(model: &ReducedGear, file: &str) -> Result<BevelGear> {
    let bevel = model.bevel.as_ref().ok_or_else(|| {
        Failure::input(format!(
            "{file}: found a cylindrical gear, allowed is a reduced bevel gear"
        ))
    })?;
    Ok(BevelGear::from_texts(
        file,
        &model.input.text,
        &bevel.pair_text,
    )?)
}

/// What presses on a gear at a moment.
pub fn pressed_at(moment: &Moment, gear: usize) -> Pressed {
    let own = moment.loads.iter().filter(|load| load.gear == gear);
    let forces = own.map(|load| PlacedForce {
        tooth: load.tooth,
        side: load.side,
        u: load.roll_rad,
        v_m: load.height_m,
        width_m: load.width_m,
        normal_n: load.components_n[0],
        tangential_n: load.components_n[1],
    });
    Pressed {
        forces: forces.collect(),
        bore_m: moment.bore_m.get(gear).cloned().unwrap_or_default(),
    }
}

impl StressedGear {
    /// Meshes and factorises a cylindrical gear.
    pub fn of_gear(gear: &GearDefinition, watch: &Watch<'_>) -> Result<Self> {
        let python = watch.python()?;
        let body = watch.offline(&gear.name, |told| GearBody::new(gear, &python, told))?;
        let grid = flank_grid(gear);
        let hats = ProfileHats::of_involute(&grid.roll_angles_rad);
        Ok(Self {
            faces: skin(&body.model),
            units: FlankUnits::of_gear(gear, &body, &Flank::ALL)?,
            grid,
            face_width_m: gear.tooth.face_width_m,
            hats: [Some(hats.clone()), Some(hats)],
            bore: None,
            body: StressedBody::Cylindrical(Box::new(gear.clone()), Box::new(body)),
        })
    }

    /// Meshes and factorises a reduced bevel gear again.
    pub fn of_bevel(model: &ReducedGear, file: &str, watch: &Watch<'_>) -> Result<Self> {
        let gear = bevel_gear_of(model, file)?;
        let body = watch.offline(&gear.name, |told| bevel_body(&gear, told))?;
        Ok(Self {
            faces: skin(&body.model),
            units: FlankUnits::of_bevel(&gear, &body.mesh, &Flank::ALL)?,
            grid: bevel_grid(&gear),
            face_width_m: gear.blank().face_width_m,
            hats: Flank::ALL.map(|side| profile_hats(model, side).ok()),
            bore: None,
            body: StressedBody::Bevel(Box::new(gear), Box::new(body)),
        })
    }

    /// On a bore that slides or that rollers press; of a cylindrical gear, whose model has its motions.
    #[must_use]
    pub fn on_bore(self, bore: Option<Arc<ReducedGear>>) -> Self {
        Self { bore, ..self }
    }

    /// Forces on the unit loads of the flanks.
    pub fn grid_forces(&self, forces: &[PlacedForce]) -> Result<Vec<GridForce>> {
        if let Some(force) = forces.iter().find(|f| self.hats[f.side as usize].is_none()) {
            let problem = format!(
                "the reduced gear carries no loads on its {} flanks; reduce it with both",
                force.side
            );
            return Err(Failure::input(problem));
        }
        let any = self.hats.iter().flatten().next();
        let any = any.ok_or_else(|| Failure::input("the reduced gear carries no loads"))?;
        let hats = |side: Flank| self.hats[side as usize].as_ref().unwrap_or(any);
        let on_grid = placed_forces((&self.grid, self.face_width_m), hats, forces);
        let on_grid = on_grid.into_iter().map(|(side, load)| GridForce {
            tooth: load.tooth,
            side,
            load: load.load,
            normal_n: load.normal_n,
            tangential_n: load.tangential_n,
        });
        Ok(on_grid.collect())
    }

    /// Von Mises stress in the middles of the surface's faces \[Pa\].
    pub fn stress(&self, pressed: &Pressed) -> Result<Vec<f64>> {
        if pressed.forces.is_empty() && pressed.bore_m.is_empty() {
            return Ok(vec![0.0; self.faces.len()]);
        }
        let displacement_m = self.displacement_m(pressed)?;
        Ok(von_mises_on_faces(
            self.model(),
            &self.faces,
            &displacement_m,
        )?)
    }

    /// Displacement of all degrees of freedom \[m\].
    pub fn displacement_m(&self, pressed: &Pressed) -> Result<Vec<f64>> {
        let forces = self.grid_forces(&pressed.forces)?;
        match &self.body {
            StressedBody::Cylindrical(_, body) => {
                let bore = self.bore.as_ref().map(|model| LooseBore {
                    model,
                    radial_m: &pressed.bore_m,
                });
                Ok(self.units.displacement_m(body, &forces, bore)?)
            }
            StressedBody::Bevel(_, body) => {
                let mut displacement_m = Vec::new();
                self.units.solve_each(body, &[forces], |_, u| {
                    displacement_m.extend_from_slice(u);
                });
                Ok(displacement_m)
            }
        }
    }

    /// The finite element model.
    pub fn model(&self) -> &FeModel {
        match &self.body {
            StressedBody::Cylindrical(_, body) => &body.model,
            StressedBody::Bevel(_, body) => &body.model,
        }
    }

    /// The whole field.
    pub fn field(&self, pressed: &Pressed) -> Result<Field> {
        Ok(Field::new(self.model(), &self.displacement_m(pressed)?)?)
    }

    /// The surface of the elements, to be drawn.
    pub fn surface(&self) -> Result<GearSurface> {
        match &self.body {
            StressedBody::Cylindrical(gear, body) => {
                let curve = ProfileCurve::new(&gear.profile);
                let base = gear.profile.base_radius_m;
                let ends = [curve.flank_start_m(), curve.flank_end_m()];
                let outline =
                    |tooth: usize, side: Flank| body.mesh.outline_faces(tooth, side, ends);
                // Arc length to roll angle.
                let place = |[arc, z]: [f64; 2]| {
                    let [x, y] = curve.point_at(arc);
                    [((x.hypot(y) / base).powi(2) - 1.0).max(0.0).sqrt(), z]
                };
                Ok(element_surface(&body.mesh, &self.faces, outline, place))
            }
            StressedBody::Bevel(gear, body) => bevel_surface(gear, &body.mesh, &self.faces),
        }
    }
}

/// The surface of a bevel gear's elements.
pub fn bevel_surface(
    gear: &BevelGear,
    mesh: &BevelMesh,
    faces: &[SkinFace],
) -> Result<GearSurface> {
    let patch = |side| gear.patch(side).map_err(Failure::work);
    let patches = [patch(Flank::Right)?, patch(Flank::Left)?];
    let width_m = gear.blank().face_width_m;
    let outline = |tooth: usize, side: Flank| -> Vec<OutlineFace> {
        let lines = &mesh.outline_m[side as usize];
        let faces = mesh.outline_faces(tooth, side, |k, section| {
            let [cone, height] = lines[section][k];
            shares_of(&patches[side as usize], cone, height)
        });
        // Above the fillet.
        let on_flank = |face: &OutlineFace| face.range_m(0)[1] > 1e-6;
        faces.into_iter().filter(on_flank).collect()
    };
    let place = |[u, s]: [f64; 2]| [u, (s - 0.5) * width_m];
    Ok(element_surface(mesh, faces, outline, place))
}

/// Nodes of the surface numbered anew, teeth and flanks of its faces. `place`: what the coordinates of an outline
/// face's corners are on the flank.
fn element_surface(
    mesh: &impl RepeatedMesh,
    faces: &[SkinFace],
    outline: impl Fn(usize, Flank) -> Vec<OutlineFace>,
    place: impl Fn([f64; 2]) -> [f64; 2],
) -> GearSurface {
    let mut number: HashMap<u32, u32> = HashMap::new();
    let mut points_m = Vec::new();
    let mut quads = Vec::with_capacity(faces.len());
    for face in faces {
        let corners: Vec<u32> = (face.corners.iter())
            .map(|node| {
                *number.entry(*node).or_insert_with(|| {
                    points_m.push(mesh.nodes()[*node as usize]);
                    points_m.len() as u32 - 1
                })
            })
            .collect();
        let last = corners.len() - 1;
        quads.push([0, 1, 2, 3].map(|k: usize| corners[k.min(last)]));
    }
    let mut tooth_of: HashMap<u32, i32> = HashMap::new();
    for tooth in 0..mesh.teeth() {
        let own = mesh.cell_elements(tooth).into_iter();
        tooth_of.extend(own.map(|element| (element, tooth as i32)));
    }
    let teeth = faces
        .iter()
        .map(|face| tooth_of.get(&face.element).copied().unwrap_or(-1));
    let key = |corners: &[u32]| {
        let mut key = corners.to_vec();
        key.sort_unstable();
        key
    };
    let places: HashMap<Vec<u32>, u32> = (0..)
        .zip(faces)
        .map(|(k, face)| (key(&face.corners), k))
        .collect();
    let flanks = Flank::ALL.map(|side| {
        let of_teeth: Vec<Vec<OutlineFace>> = (0..mesh.teeth())
            .map(|tooth| outline(tooth, side))
            .collect();
        (of_teeth[0].iter().enumerate())
            .map(|(k, face)| {
                let at: Vec<[f64; 2]> = face.corners_m().iter().map(|p| place(*p)).collect();
                let range = |axis: usize| {
                    at.iter()
                        .fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], p| {
                            [a.min(p[axis]), b.max(p[axis])]
                        })
                };
                let quads = of_teeth.iter().filter_map(|faces| {
                    let corners = &faces[k].nodes[..faces[k].shape.corner_count()];
                    places.get(&key(corners)).copied()
                });
                FlankFace {
                    along_profile: range(0),
                    heights_m: range(1),
                    quads: quads.collect(),
                }
            })
            .filter(|face| face.quads.len() == mesh.teeth())
            .collect()
    });
    GearSurface::of_elements(points_m, quads, teeth.collect(), flanks)
}
