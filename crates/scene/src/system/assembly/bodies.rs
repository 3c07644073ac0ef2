//! `[[body]]` to bodies in their places, and markers on them.

use gearmesh_geometry::given;
use gearmesh_specification::gear_tables::MM;
use gearmesh_specification::names::unknown;
use gearmesh_specification::system::body::{BodyTable, Flexibility};
use std::sync::Arc;

use gearmesh_drivetrain::{modal_gear_body, modes_up_to};
use gearmesh_dynamics::state::BodyMotion;
use gearmesh_dynamics::{Body, BodyId, GROUND, Marker, MarkerPair, Modes};
use gearmesh_geometry::InputError;
use gearmesh_geometry::input::TableKeys;
use gearmesh_model::{RadialMotions, ReducedGear};
use nalgebra::{Matrix3, UnitQuaternion, Vector3};

use super::gears::{BodyGear, Gear};
use crate::system::built::BuiltPart;

/// The world in scene files.
pub(super) const GROUND_NAME: &str = "ground";

/// A body at its start.
#[derive(Debug, Clone)]
pub(super) struct PlacedBody {
    pub body: Body,
    /// Where mass and inertia come from.
    pub source: String,
    pub gear: Option<BodyGear>,
    /// Natural modes that the body has; none unless it is modal.
    pub modes: usize,
    /// Nobody has said where it is.
    pub place_is_free: bool,
    /// Nobody has said how far it is turned about its z.
    pub turn_is_free: bool,
    /// Nobody has said how fast it turns.
    pub speed_is_free: bool,
    /// Nobody has said how fast its origin moves.
    pub velocity_is_free: bool,
}

impl PlacedBody {
    /// A body of the scene.
    pub(super) fn new(
        table: &BodyTable,
        keys: &TableKeys<'_>,
        gear: Option<BodyGear>,
    ) -> Result<Self, InputError> {
        if table.name.is_empty() || table.name == GROUND_NAME {
            let problem =
                "is empty or \"ground\", which is the world; give the body a name of its own";
            return Err(keys.error("name", problem));
        }
        let mut body = match &gear {
            Some(gear) if table.mass_kg.is_none() && table.inertia_kg_m2.is_none() => {
                gear.body(keys)?
            }
            _ => stated_mass(table, keys)?,
        };
        body.name.clone_from(&table.name);
        if let Some(centre) = table.centre_of_mass_mm {
            body.center_of_mass_m = MM * Vector3::from(centre);
        }
        if let Some(position) = table.position_mm {
            body.position_m = MM * Vector3::from(position);
        }
        if let Some(velocity) = table.velocity_mm_per_s {
            body.velocity_m_per_s = MM * Vector3::from(velocity);
        }
        let mode_count = modes(table, keys, gear.as_ref(), &mut body)?;
        if let Some(angles) = &table.cardan_deg {
            let angle = |i: usize| angles.get(i).map_or(0.0, |degrees| degrees.to_radians());
            if !(2..=3).contains(&angles.len()) {
                let count = angles.len();
                let problem = format!(
                    "found {count} angles, allowed are 3, or 2 where a mesh sets the third"
                );
                return Err(keys.error("cardan_deg", problem));
            }
            body.orientation = cardan([angle(0), angle(1), angle(2)]);
        }
        match (table.speed_rpm, table.angular_velocity_rad_per_s) {
            (None, None) => {}
            (Some(rpm), None) => {
                body.angular_velocity_rad_per_s.z = rpm * std::f64::consts::TAU / 60.0;
            }
            (None, Some(omega)) => body.angular_velocity_rad_per_s = omega.into(),
            (Some(_), Some(_)) => {
                let problem =
                    "is given together with angular_velocity_rad_per_s; remove one of the two";
                return Err(keys.error("speed_rpm", problem));
            }
        }
        body.validate()
            .map_err(|e| keys.error(fault_key(table), e))?;
        Ok(Self {
            source: match &gear {
                Some(gear) if mode_count > 0 => format!("{}, {mode_count} modes", gear.source()),
                Some(gear) => gear.source(),
                None => "mass and inertia as stated".to_string(),
            },
            modes: mode_count,
            body,
            place_is_free: table.position_mm.is_none(),
            turn_is_free: table.cardan_deg.as_ref().is_none_or(|two| two.len() == 2),
            speed_is_free: table.speed_rpm.is_none() && table.angular_velocity_rad_per_s.is_none(),
            velocity_is_free: table.velocity_mm_per_s.is_none(),
            gear,
        })
    }

    /// A body that something else places and moves.
    pub(super) fn placed(body: Body, source: String) -> Self {
        Self {
            body,
            source,
            gear: None,
            modes: 0,
            place_is_free: false,
            turn_is_free: false,
            speed_is_free: false,
            velocity_is_free: false,
        }
    }

    /// Its gear, on parallel axes.
    pub(super) fn cylindrical(&self) -> Option<&Arc<Gear>> {
        self.gear.as_ref()?.cylindrical()
    }

    /// Its reduced gear.
    pub(super) fn model(&self) -> Option<&Arc<ReducedGear>> {
        self.gear.as_ref()?.model()
    }

    /// Radial motions of its bore, where rollers press on it.
    pub(super) fn bore_motions(&self) -> Option<&RadialMotions> {
        self.cylindrical()?.bore_motions.as_deref()
    }

    /// Its reduced gear if that is a bevel gear.
    pub(super) fn bevel(&self) -> Option<&Arc<ReducedGear>> {
        self.model().filter(|model| model.bevel.is_some())
    }

    /// Its motion at the start.
    pub(super) fn motion(&self) -> BodyMotion {
        let body = &self.body;
        BodyMotion {
            position_m: body.position_m,
            orientation: body.orientation,
            rotation: *body.orientation.to_rotation_matrix().matrix(),
            velocity_m_per_s: body.velocity_m_per_s,
            angular_velocity_rad_per_s: body.angular_velocity_rad_per_s,
        }
    }

    /// Speed about its z at the start \[rad/s\].
    pub(super) fn spin(&self) -> f64 {
        self.body.angular_velocity_rad_per_s.z
    }

    /// Its angular velocity at the start, world axes \[rad/s\].
    pub(super) fn turning(&self) -> Vector3<f64> {
        self.body.orientation * self.body.angular_velocity_rad_per_s
    }

    /// Its z axis in the world.
    pub(super) fn axis(&self) -> Vector3<f64> {
        self.body.orientation * Vector3::z()
    }

    /// Turns it further about its own z.
    pub(super) fn turn(&mut self, angle_rad: f64) {
        self.body.orientation *=
            UnitQuaternion::from_scaled_axis(Vector3::new(0.0, 0.0, angle_rad));
    }
}

/// The key that a body's own check most likely complains about: everything else has been checked before.
fn fault_key(table: &BodyTable) -> &'static str {
    match (&table.mass_kg, &table.inertia_kg_m2) {
        (Some(mass), _) if !(*mass > 0.0 && mass.is_finite()) => "mass_kg",
        (_, Some(_)) => "inertia_kg_m2",
        _ => "",
    }
}

/// Gives a modal body its modes; how many they are.
fn modes(
    table: &BodyTable,
    keys: &TableKeys<'_>,
    gear: Option<&BodyGear>,
    body: &mut Body,
) -> Result<usize, InputError> {
    let word = table.flexibility.map_or("", Flexibility::name);
    keys.refuse_unused(
        ("flexibility", word),
        &[
            (
                &[("modes_up_to_Hz", table.modes_up_to_hz.is_some())],
                "modal",
            ),
            (&given!(table; modal_damping_ratio), "modal"),
        ],
    )?;
    let on_faces = gear.and_then(|gear| gear.cylindrical()?.on_faces.as_ref());
    if table.flexibility != Some(Flexibility::Modal) {
        let Some(faces) = on_faces else {
            return Ok(0);
        };
        let modes = faces.gear.modes(|omega| 0.5 * faces.damping_s * omega);
        return Ok(give(body, modes));
    }
    let model = gear.and_then(BodyGear::model).ok_or_else(|| {
        let problem = "is \"modal\", which needs a reduced gear (.h5) with modes";
        keys.error("flexibility", problem)
    })?;
    let ratio = table.modal_damping_ratio.map_or(0.0, f64::from);
    if let Some(faces) = on_faces {
        return Ok(give(body, faces.gear.modes(|_| ratio)));
    }
    let count = mode_count(table, model, keys)?;
    if count == 0 {
        let problem =
            "no mode of the model lies below; raise it, or write flexibility = \"reduced\"";
        return Err(keys.error("modes_up_to_Hz", problem));
    }
    let modal = modal_gear_body(model, count, ratio).map_err(|e| keys.error("flexibility", e))?;
    body.modes = modal.modes;
    Ok(count)
}

/// Natural modes of a model that a modal body takes.
pub(super) fn mode_count(
    table: &BodyTable,
    model: &ReducedGear,
    keys: &TableKeys<'_>,
) -> Result<usize, InputError> {
    Ok(match table.modes_up_to_hz {
        Some(up_to_hz) => {
            modes_up_to(model, up_to_hz).map_err(|e| keys.error("modes_up_to_Hz", e))?
        }
        None => {
            let basis = model.modal_basis();
            basis.map_err(|e| keys.error("flexibility", e))?.count()
        }
    })
}

/// Gives a body modes; how many they are.
fn give(body: &mut Body, modes: Modes) -> usize {
    body.modes = Some(modes);
    body.mode_count()
}

fn stated_mass(table: &BodyTable, keys: &TableKeys<'_>) -> Result<Body, InputError> {
    let whose = match table.gear {
        Some(_) => "a mass or inertia that is stated for a gear",
        None => "a body without gear",
    };
    let mass = keys.needed("mass_kg", table.mass_kg, whose)?;
    let inertia = keys.needed("inertia_kg_m2", table.inertia_kg_m2.as_ref(), whose)?;
    let tensor = match inertia[..] {
        [x, y, z] => Matrix3::from_diagonal(&Vector3::new(x, y, z)),
        [x, y, z, xy, xz, yz] => Matrix3::new(x, xy, xz, xy, y, yz, xz, yz, z),
        _ => {
            let problem = format!("found {} numbers, allowed are 3 or 6", inertia.len());
            return Err(keys.error("inertia_kg_m2", problem));
        }
    };
    Ok(Body {
        inertia_kg_m2: tensor,
        ..Body::rigid(&table.name, mass, [1.0; 3])
    })
}

/// A direction, scaled to length 1.
pub(super) fn direction(
    keys: &TableKeys<'_>,
    key: &str,
    values: [f64; 3],
) -> Result<Vector3<f64>, InputError> {
    let direction = Vector3::from(values);
    let length = direction.norm();
    let allowed = "a direction: its length must be more than 0";
    keys.require(key, length, length > 0.0, allowed)?;
    Ok(direction / length)
}

/// Axes with z along a direction; x and y are any that fit.
pub(super) fn axes_along(z_axis: &Vector3<f64>) -> UnitQuaternion<f64> {
    UnitQuaternion::rotation_between(&Vector3::z(), z_axis).unwrap_or_else(|| {
        UnitQuaternion::from_axis_angle(&Vector3::x_axis(), std::f64::consts::PI)
    })
}

/// The turn about x, the new y and the new z.
pub(super) fn cardan([x, y, z]: [f64; 3]) -> UnitQuaternion<f64> {
    let about = |axis: Vector3<f64>, angle| UnitQuaternion::from_scaled_axis(axis * angle);
    about(Vector3::x(), x) * about(Vector3::y(), y) * about(Vector3::z(), z)
}

/// A frame in the world at the start.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame {
    pub origin_m: Vector3<f64>,
    pub axes: UnitQuaternion<f64>,
}

impl Frame {
    /// The frame farther along its z.
    pub(super) fn raised(&self, by_m: f64) -> Self {
        Self {
            origin_m: self.origin_m + self.axes * Vector3::new(0.0, 0.0, by_m),
            axes: self.axes,
        }
    }
}

/// The two bodies of a connection, none for the ground, and its frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seat {
    pub ends: [Option<usize>; 2],
    pub frame: Frame,
}

/// All bodies, and their numbers once the system has them.
#[derive(Debug, Clone, Default)]
pub(super) struct Bodies {
    pub list: Vec<PlacedBody>,
    pub ids: Vec<BodyId>,
}

impl Bodies {
    /// Takes all bodies as if nobody had said how they move.
    pub(super) fn free_speeds(&mut self) {
        for placed in &mut self.list {
            (placed.speed_is_free, placed.velocity_is_free) = (true, true);
            placed.body.angular_velocity_rad_per_s = Vector3::zeros();
            placed.body.velocity_m_per_s = Vector3::zeros();
        }
    }

    /// Number of a body in the list; none for the ground.
    pub(super) fn find(
        &self,
        keys: &TableKeys<'_>,
        key: &str,
        name: &str,
    ) -> Result<Option<usize>, InputError> {
        if name == GROUND_NAME {
            return Ok(None);
        }
        if let Some(number) = self.number(name) {
            return Ok(Some(number));
        }
        let mut known = vec![GROUND_NAME];
        known.extend(self.names());
        let mut problem = unknown("body", name, &known);
        if name.ends_with("/ring") && !known.iter().any(|known| known.ends_with("/ring")) {
            problem += "; outer rings are bodies of bearings with a `housing`, which joints and other bearings cannot name";
        }
        Err(keys.error(key, problem))
    }

    /// Names of all.
    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.list.iter().map(|placed| placed.body.name.as_str())
    }

    /// Number of the body of a name; none where there is no such body.
    pub(super) fn number(&self, name: &str) -> Option<usize> {
        self.names().position(|other| other == name)
    }

    /// Angular velocity of a body at the start, world axes \[rad/s\]; 0 of the ground.
    pub(super) fn turning(&self, body: Option<usize>) -> Vector3<f64> {
        body.map_or_else(Vector3::zeros, |body| {
            let motion = self.list[body].motion();
            motion.rotation * motion.angular_velocity_rad_per_s
        })
    }

    /// Velocity of a place that moves with a body; 0 on the ground.
    pub(super) fn velocity_with(
        &self,
        body: Option<usize>,
        place_m: &Vector3<f64>,
    ) -> Vector3<f64> {
        body.map_or_else(Vector3::zeros, |number| {
            let own = &self.list[number].body;
            own.velocity_m_per_s + self.turning(body).cross(&(place_m - own.position_m))
        })
    }

    /// A part of the system on these bodies.
    pub(super) fn part(&self, name: &str, kind: &'static str, on: &[Option<usize>]) -> BuiltPart {
        BuiltPart {
            name: name.to_owned(),
            kind,
            bodies: on.iter().map(|body| self.name(*body).to_owned()).collect(),
        }
    }

    /// Number of a body that must not be the ground.
    pub(super) fn find_body(
        &self,
        keys: &TableKeys<'_>,
        key: &str,
        name: &str,
    ) -> Result<usize, InputError> {
        self.find(keys, key, name)?
            .ok_or_else(|| keys.error(key, "found the ground, allowed is a body"))
    }

    /// The two bodies of a connection, which must differ; the ground where none is named.
    pub(super) fn find_pair(
        &self,
        keys: &TableKeys<'_>,
        body_1: Option<&str>,
        body_2: &str,
    ) -> Result<[Option<usize>; 2], InputError> {
        let first = self.find(keys, "body_1", body_1.unwrap_or(GROUND_NAME))?;
        let second = self.find(keys, "body_2", body_2)?;
        if first == second {
            let problem =
                format!("found `{body_2}`, the same as body_1; two different bodies are needed");
            return Err(keys.error("body_2", problem));
        }
        Ok([first, second])
    }

    /// Name in the scene.
    pub(super) fn name(&self, body: Option<usize>) -> &str {
        body.map_or(GROUND_NAME, |index| &self.list[index].body.name)
    }

    /// Number in the system.
    pub(super) fn id(&self, body: Option<usize>) -> BodyId {
        body.map_or(GROUND, |index| self.ids[index])
    }

    /// Origin and axes of a body at the start.
    pub(super) fn frame(&self, body: Option<usize>) -> Frame {
        match body {
            None => Frame {
                origin_m: Vector3::zeros(),
                axes: UnitQuaternion::identity(),
            },
            Some(index) => {
                let body = &self.list[index].body;
                Frame {
                    origin_m: body.position_m,
                    axes: body.orientation,
                }
            }
        }
    }

    /// A frame of the world at the start, fixed on a body.
    pub(super) fn marker(&self, body: Option<usize>, frame: &Frame) -> Marker {
        let own = self.frame(body);
        let back = own.axes.inverse();
        let position = back * (frame.origin_m - own.origin_m);
        Marker::at(self.id(body), position.into()).oriented(back * frame.axes)
    }

    /// The markers of a seat on its bodies.
    pub(super) fn markers(&self, seat: &Seat) -> MarkerPair {
        let [a, b] = seat.ends.map(|end| self.marker(end, &seat.frame));
        MarkerPair { a, b }
    }

    /// The seat that a connection states: between its bodies, at a place, z along an axis; those of body 2 where not
    /// given.
    pub(super) fn seat(
        &self,
        keys: &TableKeys<'_>,
        (body_1, body_2): (&Option<String>, &str),
        (at_mm, axis): (Option<[f64; 3]>, Option<[f64; 3]>),
    ) -> Result<Seat, InputError> {
        let ends = self.find_pair(keys, body_1.as_deref(), body_2)?;
        let mut frame = self.frame(ends[1]);
        if let Some(at) = at_mm {
            frame.origin_m = MM * Vector3::from(at);
        }
        if let Some(axis) = axis {
            frame.axes = axes_along(&direction(keys, "axis", axis)?);
        }
        Ok(Seat { ends, frame })
    }
}
