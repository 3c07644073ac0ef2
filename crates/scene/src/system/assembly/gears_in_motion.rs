//! The gears of a scene where the bodies of a result stand: their teeth, and what presses on them there.

use std::sync::Arc;

use gearmesh_drivetrain::{GearMesh, Pose};
use gearmesh_dynamics::{BodyMotion, Marker, MarkerPair};
use gearmesh_geometry::{Flank, GearDefinition, InputError};
use gearmesh_model::ReducedGear;
use nalgebra::{UnitQuaternion, Vector3};

use super::LoadedSystem;
use super::bodies::cardan;
use super::gears::BodyGear;
use super::meshes_together::{MeshesTogether, MovingError};
use super::parts::Parts;
use super::parts_in_motion::{MovingParts, moving_parts, rows};
use super::start::settle_phases;
use crate::system::names::body_column;

/// A body that is a gear. The frame of the body is that of the gear: z along the axis, tooth 0 on +x, the origin at
/// mid-face or, of a bevel gear, in the pitch apex.
#[derive(Debug, Clone)]
pub struct MovingGear {
    /// Body.
    pub body: String,
    /// The gear.
    pub shape: MovingShape,
    /// The model with the motions of its bore, where that slides or rollers press on it.
    pub bore: Option<Arc<ReducedGear>>,
}

/// What a moving gear is.
#[derive(Debug, Clone)]
pub enum MovingShape {
    /// A cylindrical gear.
    Cylindrical(Box<GearDefinition>),
    /// A reduced bevel gear.
    Bevel(Arc<ReducedGear>),
}

impl MovingGear {
    /// (1 − ν²)/E \[1/Pa\].
    fn contact_compliance(&self) -> f64 {
        let (young_pa, poisson) = match &self.shape {
            MovingShape::Cylindrical(gear) => (gear.material.young_pa, gear.material.poisson),
            MovingShape::Bevel(model) => (model.young_pa, model.poisson),
        };
        (1.0 - poisson * poisson) / young_pa
    }
}

/// Where a gear's body is, and how it moves, as columns of a result state it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct GearState {
    /// Reference point, world \[m\].
    pub position_m: [f64; 3],
    /// R = Rx Ry Rz \[rad\].
    pub cardan_rad: [f64; 3],
    /// Of the reference point, world \[m/s\].
    pub velocity_m_per_s: [f64; 3],
    /// Along the body's axes \[rad/s\].
    pub angular_velocity_rad_per_s: [f64; 3],
}

impl GearState {
    /// The columns of a body, in the order of the fields. Results at rest have the first six.
    #[must_use]
    pub fn columns(body: &str) -> [String; 12] {
        let names = ["", "cardan_", "velocity_", "angular_velocity_"];
        let units = ["m", "rad", "m_per_s", "rad_per_s"];
        std::array::from_fn(|k| {
            let axis = ["x", "y", "z"][k % 3];
            body_column(body, &format!("{}{axis}_{}", names[k / 3], units[k / 3]))
        })
    }

    /// From the values of those columns; the last six may be missing.
    #[must_use]
    pub fn from_values(values: &[f64]) -> Self {
        let three = |first: usize| {
            std::array::from_fn(|k| values.get(first + k).copied().unwrap_or_default())
        };
        Self {
            position_m: three(0),
            cardan_rad: three(3),
            velocity_m_per_s: three(6),
            angular_velocity_rad_per_s: three(9),
        }
    }

    fn orientation(&self) -> UnitQuaternion<f64> {
        cardan(self.cardan_rad)
    }

    /// World from body axes, by rows.
    #[must_use]
    pub fn rotation(&self) -> [[f64; 3]; 3] {
        rows(self.orientation())
    }

    pub(super) fn motion(&self) -> BodyMotion {
        let orientation = self.orientation();
        BodyMotion {
            position_m: self.position_m.into(),
            orientation,
            rotation: *orientation.to_rotation_matrix().matrix(),
            velocity_m_per_s: self.velocity_m_per_s.into(),
            angular_velocity_rad_per_s: self.angular_velocity_rad_per_s.into(),
        }
    }
}

/// What presses on a slice of a flank.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SliceLoad {
    /// Number of the mesh among those with forces.
    pub mesh: usize,
    /// Number of the gear among [`GearsInMotion::gears`].
    pub gear: usize,
    /// Tooth.
    pub tooth: usize,
    /// Flank.
    pub side: Flank,
    /// Roll angle \[rad\]; on a bevel gear the share of the way up the flank.
    pub roll_rad: f64,
    /// Height above mid-face \[m\], on a bevel gear along the pitch cone.
    pub height_m: f64,
    /// Width of the slice \[m\].
    pub width_m: f64,
    /// Normal force on this gear, damping included, without friction; world axes \[N\].
    pub force_n: [f64; 3],
    /// Over the width that touches \[N/m\].
    pub line_load_n_per_m: f64,
    /// Largest pressure of the line contact after Hertz \[Pa\]: √(q E*/(π ρ)), q along the contact line.
    pub pressure_pa: f64,
}

struct MovingMesh {
    name: String,
    /// Place among the meshes that are solved together, where it is one.
    together: Option<[usize; 2]>,
    gears: [usize; 2],
    seats: [Marker; 2],
    mesh: GearMesh,
    slice_width_m: f64,
    /// E*: 1/E* = Σ (1 − ν²)/E \[Pa\].
    contact_modulus_pa: f64,
}

/// Gears of a scene and the meshes of their teeth.
pub struct GearsInMotion {
    /// Gears, in the order of the bodies.
    pub gears: Vec<MovingGear>,
    /// Meshes whose forces are not known from the places of the bodies alone, and why.
    pub without_forces: Vec<String>,
    /// What is drawn beside the gears.
    pub parts: MovingParts,
    /// Further bodies, on whose places forces on the teeth depend.
    pub further: Vec<String>,
    meshes: Vec<MovingMesh>,
    together: Option<MeshesTogether>,
}

impl LoadedSystem {
    /// The gears of the scene, to be put where a result has them.
    ///
    /// # Errors
    /// [`InputError`] as [`LoadedSystem::build`].
    pub fn gears_in_motion(&self) -> Result<GearsInMotion, InputError> {
        let (bodies, shafts) = self.bodies_and_shafts()?;
        let mut places = vec![None; bodies.list.len()];
        let mut gears = Vec::new();
        for (place, body) in bodies.list.iter().enumerate() {
            let shape = match &body.gear {
                Some(BodyGear::Cylindrical(gear)) => {
                    MovingShape::Cylindrical(Box::new(gear.definition.clone()))
                }
                Some(BodyGear::Bevel(gear)) => MovingShape::Bevel(Arc::clone(&gear.model)),
                None => continue,
            };
            let bore = body.cylindrical().and_then(|gear| gear.bore.clone());
            places[place] = Some(gears.len());
            gears.push(MovingGear {
                body: body.body.name.clone(),
                shape,
                bore,
            });
        }
        let prepared = self.prepared_meshes(&bodies, &mut Parts::default())?;
        let mut turned = bodies.clone();
        let at = (&self.scene.document, self.seeks_rest());
        settle_phases(&mut turned, &prepared, at, &mut Vec::new())?;
        let parts = moving_parts(&self.scene, &shafts, &mut turned)?;
        let (mut meshes, mut without_forces) = (Vec::new(), Vec::new());
        for prepared in prepared {
            let drawn = match &prepared.models {
                Some(models) => [0, 1].map(|k: usize| {
                    let body = &bodies.list[prepared.bodies[k]].body.name;
                    Some(place_of_bevel(&mut gears, body, &models[k]))
                }),
                None => prepared.bodies.map(|body| places[body]),
            };
            let vibrates = prepared.bodies.iter().any(|b| bodies.list[*b].modes > 0);
            let (gears_of, mesh) = match (drawn, prepared.mesh) {
                ([Some(a), Some(b)], Some(mesh)) if !vibrates => ([a, b], mesh),
                (drawn, mesh) => {
                    let why = match (drawn, mesh) {
                        ([Some(_), Some(_)], None) => "kinematic",
                        ([Some(_), Some(_)], Some(_)) => "its gears vibrate in their own modes",
                        _ => "neither cylindrical nor reduced bevel gears",
                    };
                    without_forces.push(format!("`{}`: {why}", prepared.built.name));
                    continue;
                }
            };
            let compliance = gears_of.map(|gear| gears[gear].contact_compliance());
            meshes.push(MovingMesh {
                name: prepared.built.name,
                together: None,
                gears: gears_of,
                seats: prepared.seats,
                mesh,
                slice_width_m: prepared.slice_width_m,
                contact_modulus_pa: 1.0 / (compliance[0] + compliance[1]),
            });
        }
        let names: Vec<&str> = gears.iter().map(|gear| &*gear.body).collect();
        let together = MeshesTogether::of(self, &names)?;
        if let Some(all) = &together {
            for mesh in &mut meshes {
                mesh.together = all.place(&mesh.name);
            }
        }
        let further = together.as_ref().map(|all| all.further.clone());
        Ok(GearsInMotion {
            gears,
            without_forces,
            parts,
            further: further.unwrap_or_default(),
            meshes,
            together,
        })
    }
}

/// Number of a bevel gear on a body; two of its meshes share it.
fn place_of_bevel(gears: &mut Vec<MovingGear>, body: &str, model: &Arc<ReducedGear>) -> usize {
    let same = |gear: &MovingGear| {
        let MovingShape::Bevel(other) = &gear.shape else {
            return false;
        };
        gear.body == body && other.input == model.input
    };
    gears.iter().position(same).unwrap_or_else(|| {
        gears.push(MovingGear {
            body: body.to_owned(),
            shape: MovingShape::Bevel(Arc::clone(model)),
            bore: None,
        });
        gears.len() - 1
    })
}

impl GearsInMotion {
    /// What presses on the flanks where bodies stand and move like this at a time: those of [`GearsInMotion::gears`],
    /// then [`GearsInMotion::further`].
    ///
    /// # Errors
    /// [`MovingError`].
    pub fn loads(
        &mut self,
        states: &[GearState],
        time_s: f64,
    ) -> Result<Vec<SliceLoad>, MovingError> {
        if let Some(together) = &mut self.together {
            together.find(states, time_s)?;
        }
        let mut loads = Vec::new();
        for (number, at) in self.meshes.iter_mut().enumerate() {
            let first = states[at.gears[0]].motion();
            if at.together.is_none() {
                let [a, b] = at.seats;
                let second = states[at.gears[1]].motion();
                let pose = Pose::from(&MarkerPair { a, b }.motion(&first, &second));
                at.mesh.evaluate(&pose, false)?;
                at.mesh.remember();
            }
            let mut read = |mesh: &GearMesh| at.read(mesh, (number, &first), &mut loads);
            match (&self.together, at.together) {
                (Some(together), Some(place)) => together.of_mesh(place, read),
                _ => read(&at.mesh),
            }
        }
        Ok(loads)
    }

    /// Radial motions of a gear's bore where rollers pressed on it at the last loads \[m\]; none of other gears.
    #[must_use]
    pub fn bore_motions_m(&self, gear: usize) -> Vec<f64> {
        let together = self.together.as_ref();
        together.map_or_else(Vec::new, |all| all.bore_motions_m(gear))
    }
}

impl MovingMesh {
    /// Adds what presses on the slices of a mesh with its number, where gear 1 moves like this.
    fn read(&self, mesh: &GearMesh, at: (usize, &BodyMotion), loads: &mut Vec<SliceLoad>) {
        let (number, first) = at;
        for side in [Flank::Right, Flank::Left] {
            let Some((found, forces)) = mesh.side(side) else {
                continue;
            };
            for (contact, &force_n) in found.contacts.iter().zip(forces) {
                if force_n <= 0.0 {
                    continue;
                }
                let section = found.section(contact);
                let along_line = force_n / section.length_m;
                let pressure = along_line * self.contact_modulus_pa
                    / (std::f64::consts::PI * section.radius_m);
                // The load of a unit force on gear 2, in gear 1's axes; edges press along the flank that they touch.
                let unit: Vector3<f64> = contact.gradient.fixed_rows::<3>(0).into();
                let on_2 = first.rotation * unit * force_n;
                for (k, gear) in self.gears.into_iter().enumerate() {
                    let on_gear = if k == 0 { -on_2 } else { on_2 };
                    loads.push(SliceLoad {
                        mesh: number,
                        gear,
                        tooth: found.lines[contact.line].teeth[k],
                        side,
                        roll_rad: section.touching_roll_rad[k],
                        height_m: contact.heights_m[k],
                        width_m: self.slice_width_m,
                        force_n: on_gear.into(),
                        line_load_n_per_m: force_n / (self.slice_width_m * section.share),
                        pressure_pa: pressure.sqrt(),
                    });
                }
            }
        }
    }
}
