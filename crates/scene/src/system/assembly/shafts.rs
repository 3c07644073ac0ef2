//! `[[shaft]]` to bodies, and to the beams or fixed joints that hold them together.
//!
//! A beam shaft has a body at each station with half of the sections on either side, so that mass, centre of mass and
//! polar inertia of the shaft are exact. A body on a seat takes the station's place. A gear that is cut into the shaft
//! has the shaft's core in its own mass and stiffness: beams begin at its faces, one at each, and nothing of the shaft
//! lies between them.

use gearmesh_dynamics::elements::BeamSection;
use gearmesh_dynamics::{Body, JointKind, MarkerPair};
use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{InputDocument, TableKeys};
use gearmesh_specification::gear_tables::MM;
use gearmesh_specification::system::shaft::{ShaftModel, ShaftTable};
use nalgebra::{Matrix3, UnitQuaternion, Vector3};

use super::bodies::{Bodies, Frame, PlacedBody, Seat, axes_along, direction};
use super::connections::Connections;
use super::cut_into_shaft::moving_end;
use super::lump::Lump;

/// A shaft whose bodies are in the list.
pub(super) struct PlacedShaft {
    name: String,
    key: String,
    model: ShaftModel,
    axes: UnitQuaternion<f64>,
    /// Places of the stations in the world \[m\].
    points_m: Vec<Vector3<f64>>,
    /// Ends of each section from the station before it \[m\].
    spans_m: Vec<[f64; 2]>,
    sections: Vec<BeamSection>,
    /// Inner and outer radius of each section \[m\].
    radii_m: Vec<[f64; 2]>,
    /// Body of each station; the shaft's one body for a rigid shaft.
    pub stations: Vec<usize>,
    /// Bodies that are fixed on a rigid shaft, with their stations.
    seated: Vec<(usize, usize)>,
}

impl PlacedShaft {
    /// All bodies that turn with the shaft.
    pub(super) fn bodies(&self) -> impl Iterator<Item = usize> + '_ {
        self.stations
            .iter()
            .copied()
            .chain(self.seated.iter().map(|(body, _)| *body))
    }

    pub(super) fn name(&self) -> &str {
        &self.name
    }

    /// The halves of all sections: body that carries it, frame in its middle, radii and length \[m\].
    pub(super) fn half_sections(&self) -> impl Iterator<Item = (usize, Frame, [f64; 2], f64)> + '_ {
        let of_section = move |number: usize| {
            let [from, to] = self.spans_m[number];
            let half = 0.5 * (to - from);
            [0.25, 0.75].map(|share| {
                let end = usize::from(share > 0.5);
                let station = self.stations.get(number + end).unwrap_or(&self.stations[0]);
                let frame = self.frame(number, from + share * (to - from));
                (*station, frame, self.radii_m[number], half)
            })
        };
        (0..self.spans_m.len()).flat_map(of_section)
    }

    /// Adds the shaft's bodies to the list and puts the seated ones in their places.
    pub(super) fn new(
        table: &ShaftTable,
        (document, key): (&InputDocument, String),
        bodies: &mut Bodies,
    ) -> Result<Self, InputError> {
        let keys = &TableKeys::new(document, key.clone());
        let origin = MM * Vector3::from(table.origin_mm);
        let axis = direction(keys, "axis", table.axis.unwrap_or([0.0, 0.0, 1.0]))?;
        let z = stations(table, keys)?;
        let radii_m = radii(table, keys, z.len() - 1)?;
        let omega = table
            .speed_rpm
            .map(|rpm| rpm * std::f64::consts::TAU / 60.0);
        let spans_m = spans(table, keys, bodies, &z)?;
        let lumps = lumps(table, keys, &spans_m, &z, &radii_m)?;
        let mut shaft = Self {
            name: table.name.clone(),
            model: table.model,
            axes: axes_along(&axis),
            points_m: z.iter().map(|z| origin + *z * axis).collect(),
            spans_m,
            sections: sections(table.model, &radii_m),
            radii_m,
            stations: Vec::new(),
            seated: Vec::new(),
            key,
        };
        let own = shaft.seat(table, keys, (&lumps, axis, omega), bodies)?;
        let mut add = |name: String, position_m: Vector3<f64>, lump: Lump| {
            let mut body = Body {
                position_m,
                orientation: shaft.axes,
                ..Body::rigid(&name, 1.0, [1.0; 3])
            };
            body.angular_velocity_rad_per_s.z = omega.unwrap_or(0.0);
            lump.put_on(&mut body);
            bodies.list.push(PlacedBody {
                speed_is_free: omega.is_none(),
                velocity_is_free: true,
                ..PlacedBody::placed(body, format!("shaft `{}`", table.name))
            });
            bodies.list.len() - 1
        };
        shaft.stations = match table.model {
            ShaftModel::Rigid {} => {
                let along = lumps
                    .iter()
                    .zip(&z)
                    .map(|(lump, z)| lump.moved(&Matrix3::identity(), &Vector3::new(0.0, 0.0, *z)));
                let all = Lump::sum(&along.collect::<Vec<_>>());
                vec![add(table.name.clone(), origin, all)]
            }
            ShaftModel::Beam { .. } => {
                let each = own.into_iter().enumerate().map(|(i, seated)| {
                    let name = || format!("{}/{i}", table.name);
                    seated.unwrap_or_else(|| add(name(), shaft.points_m[i], lumps[i]))
                });
                each.collect()
            }
        };
        Ok(shaft)
    }

    /// Puts bodies on their seats; the body that takes the place of each station's own.
    fn seat(
        &mut self,
        table: &ShaftTable,
        keys: &TableKeys<'_>,
        (lumps, axis, omega): (&[Lump], Vector3<f64>, Option<f64>),
        bodies: &mut Bodies,
    ) -> Result<Vec<Option<usize>>, InputError> {
        let mut own: Vec<Option<usize>> = vec![None; lumps.len()];
        for (i, seat) in table.seat.iter().enumerate() {
            let (key, station) = (format!("seat.{i}.station"), seat.station);
            refuse_unknown_station(station, lumps.len(), keys, &key)?;
            let index = bodies.find_body(keys, &format!("seat.{i}.body"), &seat.body)?;
            let placed = &mut bodies.list[index];
            if std::mem::take(&mut placed.place_is_free) {
                placed.body.position_m = self.points_m[station];
                if placed.body.orientation == UnitQuaternion::identity() {
                    placed.body.orientation = self.axes;
                }
            }
            if placed.speed_is_free
                && let Some(omega) = omega
            {
                let sense = placed.axis().dot(&axis).signum();
                placed.body.angular_velocity_rad_per_s = Vector3::new(0.0, 0.0, sense * omega);
                placed.speed_is_free = false;
            }
            if matches!(self.model, ShaftModel::Rigid {}) {
                self.seated.push((index, station));
                continue;
            }
            if own[station].replace(index).is_some() {
                let problem = format!(
                    "station {station} has a body already; a second one can be fixed to it by a joint"
                );
                return Err(keys.error(&key, problem));
            }
            let back = placed.body.orientation.inverse();
            let turn = *(back * self.axes).to_rotation_matrix().matrix();
            let shift = back * (self.points_m[station] - placed.body.position_m);
            let of_station = lumps[station].moved(&turn, &shift);
            Lump::sum(&[Lump::of(&placed.body), of_station]).put_on(&mut placed.body);
        }
        Ok(own)
    }

    /// Adds beams, or the joints that hold bodies on a rigid shaft.
    pub(super) fn connect(&self, connections: &mut Connections<'_>) -> Result<(), InputError> {
        let bodies = connections.bodies;
        let keys = TableKeys::new(&connections.scene.document, &self.key);
        for (number, (section, [from_m, to_m])) in
            self.sections.iter().zip(&self.spans_m).enumerate()
        {
            let ends = [self.stations[number], self.stations[number + 1]].map(Some);
            let pair = MarkerPair {
                a: bodies.marker(ends[0], &self.frame(number, *from_m)),
                b: bodies.marker(ends[1], &self.frame(number, *to_m)),
            };
            let length_m = to_m - from_m;
            let name = format!("{}/{number}-{}", self.name, number + 1);
            let beam = section
                .between(&name, pair, length_m)
                .map_err(|e| keys.error("", e))?;
            let mut moving = [None, None];
            for (end, sense) in [(0, 1.0), (1, -1.0)] {
                let placed = &bodies.list[self.stations[number + end]];
                let towards = sense * placed.axis().dot(&(self.axes * Vector3::z()));
                moving[end] = moving_end(placed, towards)
                    .map_err(|e| keys.error(&format!("stations_mm.{}", number + end), e))?;
            }
            let beam = beam.on_moving_ends(moving).map_err(|e| keys.error("", e))?;
            connections.element((&name, "beam"), &ends, beam);
        }
        for &(body, station) in &self.seated {
            let name = format!("seat of {}", bodies.name(Some(body)));
            let seat = Seat {
                ends: [Some(self.stations[0]), Some(body)],
                frame: self.frame(station, 0.0),
            };
            connections.joint(&keys, (&name, "fixed"), &seat, JointKind::Fixed)?;
        }
        Ok(())
    }

    /// The frame of the shaft at a place behind a station.
    fn frame(&self, station: usize, along_m: f64) -> Frame {
        Frame {
            origin_m: self.points_m[station] + self.axes * Vector3::new(0.0, 0.0, along_m),
            axes: self.axes,
        }
    }

    /// Kind in words.
    pub(super) fn describe(&self) -> String {
        match self.model {
            ShaftModel::Rigid {} => format!("shaft `{}`: `rigid`", self.name),
            ShaftModel::Beam { .. } => format!(
                "shaft `{}`: `beam`, {} stations",
                self.name,
                self.stations.len()
            ),
        }
    }
}

fn stations(table: &ShaftTable, keys: &TableKeys<'_>) -> Result<Vec<f64>, InputError> {
    let z = &table.stations_mm;
    if z.len() < 2 {
        let problem = format!("found {} stations, at least 2 are needed", z.len());
        return Err(keys.error("stations_mm", problem));
    }
    for (i, value) in z.iter().enumerate() {
        let (key, ok) = (format!("stations_mm.{i}"), i == 0 || *value > z[i - 1]);
        keys.require(&key, *value, ok, "more than the station before")?;
    }
    Ok(z.iter().map(|z| MM * z).collect())
}

fn refuse_unknown_station(
    station: usize,
    count: usize,
    keys: &TableKeys<'_>,
    key: &str,
) -> Result<(), InputError> {
    if station < count {
        return Ok(());
    }
    let problem = format!("found {station}, the shaft has stations 0 to {}", count - 1);
    Err(keys.error(key, problem))
}

/// Inner and outer radius of each section \[m\].
fn radii(
    table: &ShaftTable,
    keys: &TableKeys<'_>,
    count: usize,
) -> Result<Vec<[f64; 2]>, InputError> {
    let inner = table.inner_diameters_mm.as_ref();
    for (key, found) in [
        ("outer_diameters_mm", table.outer_diameters_mm.len()),
        ("inner_diameters_mm", inner.map_or(count, Vec::len)),
    ] {
        if found != count {
            let problem = format!(
                "found {found} diameters, {count} are needed: one between each station and the next"
            );
            return Err(keys.error(key, problem));
        }
    }
    let mut radii = Vec::new();
    for (i, &outer) in table.outer_diameters_mm.iter().enumerate() {
        let inner = inner.map_or(0.0, |inner| *inner[i]);
        let key = format!("outer_diameters_mm.{i}");
        keys.require(&key, outer, outer > inner, "more than the inner diameter")?;
        radii.push([0.5 * MM * inner, 0.5 * MM * outer]);
    }
    Ok(radii)
}

/// Sections of the beams; none of a rigid shaft.
fn sections(model: ShaftModel, radii: &[[f64; 2]]) -> Vec<BeamSection> {
    let ShaftModel::Beam {
        young_GPa: young,
        poisson,
        damping_s,
    } = model
    else {
        return Vec::new();
    };
    let round = |[inner, outer]: &[f64; 2]| BeamSection {
        damping_s: damping_s.map_or(0.0, f64::from),
        ..BeamSection::round(*outer, *inner, 1e9 * young, *poisson)
    };
    radii.iter().map(round).collect()
}

/// Ends of each section from the station before it \[m\]: the stations, and the faces of gears that are cut into the
/// shaft.
fn spans(
    table: &ShaftTable,
    keys: &TableKeys<'_>,
    bodies: &Bodies,
    z: &[f64],
) -> Result<Vec<[f64; 2]>, InputError> {
    // Half the face width of such a gear at each station, and its name.
    let mut faces: Vec<(f64, &str)> = vec![(0.0, ""); z.len()];
    for (i, seat) in table.seat.iter().enumerate() {
        let index = bodies.find_body(keys, &format!("seat.{i}.body"), &seat.body)?;
        let gear = bodies.list[index].cylindrical();
        let gear = gear.map(|gear| &gear.definition);
        let cut = gear.filter(|gear| gear.blank.cut_into_shaft().is_some());
        if let (Some(gear), Some(face)) = (cut, faces.get_mut(seat.station)) {
            *face = (0.5 * gear.tooth.face_width_m, &seat.body);
        }
    }
    let span = |i: usize| -> Result<[f64; 2], InputError> {
        let whole = z[i + 1] - z[i];
        let (from, to) = (faces[i].0, whole - faces[i + 1].0);
        if to - from < 1e-6 * whole {
            let (half, name) = faces[i + usize::from(faces[i].0 < faces[i + 1].0)];
            let problem = format!(
                "stations {i} and {} are {:.4} mm apart, but the gear `{name}` is cut into the shaft and reaches {:.4} mm to either side of its station: put no \
                 station within its face",
                i + 1,
                whole / MM,
                half / MM
            );
            return Err(keys.error(&format!("stations_mm.{}", i + 1), problem));
        }
        Ok([from, to])
    };
    (0..z.len() - 1).map(span).collect()
}

/// What each station carries, from the station, in the shaft's axes.
fn lumps(
    table: &ShaftTable,
    keys: &TableKeys<'_>,
    spans_m: &[[f64; 2]],
    z: &[f64],
    radii: &[[f64; 2]],
) -> Result<Vec<Lump>, InputError> {
    let mut parts: Vec<Vec<Lump>> = vec![Vec::new(); z.len()];
    for (i, (radii, [from, to])) in radii.iter().zip(spans_m).enumerate() {
        let (middle, whole) = (0.5 * (from + to), z[i + 1] - z[i]);
        let tube = |ends: [f64; 2]| Lump::tube(*radii, *table.density_kg_per_m3, ends);
        parts[i].push(tube([*from, middle]));
        parts[i + 1].push(tube([middle - whole, to - whole]));
    }
    for (i, part) in table.part.iter().enumerate() {
        refuse_unknown_station(part.station, z.len(), keys, &format!("part.{i}.station"))?;
        let inertia = Vector3::from(part.inertia_kg_m2.map(f64::from));
        parts[part.station].push(Lump {
            mass_kg: *part.mass_kg,
            centre_m: Vector3::zeros(),
            inertia_kg_m2: Matrix3::from_diagonal(&inertia),
        });
    }
    Ok(parts.iter().map(|parts| Lump::sum(parts)).collect())
}
