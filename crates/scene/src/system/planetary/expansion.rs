//! `[[planetary]]` to the tables that a scene would state without it: bodies, joints, bearings, motions, loads, meshes.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use gearmesh_geometry::InputError;
use gearmesh_geometry::definition::greatest_common_divisor;
use gearmesh_geometry::input::{Beside, DerivedTable, InputDocument, TableKeys};
use gearmesh_specification::gear_tables::MM;
use gearmesh_specification::system::SystemTables;
use gearmesh_specification::system::planetary::{MemberTable, PlanetaryTable};
use nalgebra::{Rotation3, Vector3};
use serde::Deserialize;
use serde::de::IgnoredAny;
use toml::{Table, Value};

use super::gears::{Heights, SetGear, SetGears};
use super::layout::fitted;
use super::partners::{OtherSet, Partners};
use super::pins::PlanetRow;
use super::room::Room;
use super::{PartnerLayout, PlanetarySet, SetMembers, keys};
use crate::model_shelf::ModelShelf;

/// Keys of `[[body]]` that members and planets have.
const BODY_KEYS: [&str; 10] = [
    "gear",
    "microgeometry",
    "mass_kg",
    "inertia_kg_m2",
    "centre_of_mass_mm",
    "flexibility",
    "coupling",
    "bore",
    "modes_up_to_Hz",
    "modal_damping_ratio",
];

#[derive(Deserialize)]
struct Marks {
    planetary: Option<IgnoredAny>,
}

/// The document with all that follows from its planetary sets, and the sets.
///
/// # Errors
/// [`InputError`] in the table of a set, or in a file of its gears.
pub(in crate::system) fn expand(
    document: InputDocument,
    files: (&Path, &ModelShelf),
) -> Result<(InputDocument, Vec<PlanetarySet>), InputError> {
    if document.glance::<Marks>()?.planetary.is_none() {
        return Ok((document, Vec::new()));
    }
    let tables = SystemTables::planetary_sets(&document)?;
    let raw = document.table()?;
    let mut gears = gears_of_bodies(&raw);
    let (mut items, mut known) = (Vec::new(), Vec::<Known>::new());
    for (i, table) in tables.iter().enumerate() {
        let key = format!("planetary.{i}");
        let raw = item(&raw, "planetary", i).cloned().unwrap_or_default();
        let mut expansion = Expansion {
            table,
            raw: &raw,
            keys: TableKeys::new(&document, &key),
            key: &key,
            axes: axes(table.axis, &TableKeys::new(&document, &key))?,
            items: Vec::new(),
        };
        let set = expansion.run((&mut gears, &known), files)?;
        items.append(&mut expansion.items);
        known.push(set);
    }
    let sets = known.into_iter().map(|known| known.set).collect();
    Ok((document.with_derived(items)?, sets))
}

fn item<'a>(table: &'a Table, list: &str, i: usize) -> Option<&'a Table> {
    table.get(list)?.as_array()?.get(i)?.as_table()
}

/// The gears of the bodies that stand in the file, by the bodies' names; none of those without.
fn gears_of_bodies(raw: &Table) -> BTreeMap<String, Option<PathBuf>> {
    let bodies = raw.get("body").and_then(Value::as_array);
    let text = |body: &Value, key: &str| body.get(key)?.as_str().map(str::to_owned);
    let bodies = bodies.into_iter().flatten();
    bodies
        .filter_map(|body| Some((text(body, "name")?, text(body, "gear").map(PathBuf::from))))
        .collect()
}

/// A set that has been expanded, for sets that follow.
#[derive(Debug, Clone)]
pub(super) struct Known {
    pub set: PlanetarySet,
    pub gears: SetGears,
    pub planets: PlanetRow,
    /// Neither stepped nor meshed planets.
    pub is_simple: bool,
    pub heights: Heights,
    /// Middle of the set in the world \[m\].
    pub middle_m: Vector3<f64>,
    pub axes: Rotation3<f64>,
}

/// A set on its way.
pub(super) struct Expansion<'a> {
    pub table: &'a PlanetaryTable,
    /// Its table as written.
    pub raw: &'a Table,
    pub keys: TableKeys<'a>,
    key: &'a str,
    /// Axes of the set in the world.
    pub axes: Rotation3<f64>,
    items: Vec<DerivedTable>,
}

/// Axes whose z is the given one, turned about x and then y.
fn axes(axis: Option<[f64; 3]>, keys: &TableKeys<'_>) -> Result<Rotation3<f64>, InputError> {
    let Some(axis) = axis else {
        return Ok(Rotation3::identity());
    };
    let Some(axis) = Vector3::from(axis).try_normalize(0.0) else {
        return Err(keys.error("axis", "found [0, 0, 0], allowed are directions"));
    };
    let [about_x, about_y] = cardan_rad(axis);
    let turned = Rotation3::from_axis_angle(&Vector3::x_axis(), about_x);
    Ok(turned * Rotation3::from_axis_angle(&Vector3::y_axis(), about_y))
}

/// Angles about x and the new y that turn z into a direction: (sin b, −sin a cos b, cos a cos b).
fn cardan_rad(direction: Vector3<f64>) -> [f64; 2] {
    let [x, y, z] = direction.normalize().into();
    let is_along_x = y.hypot(z) < 1e-12;
    let about_x = if is_along_x { 0.0 } else { (-y).atan2(z) };
    [about_x, x.clamp(-1.0, 1.0).asin()]
}

/// A table of the given keys.
pub(super) fn made<const N: usize>(keys: [(&str, Value); N]) -> Table {
    let keys = keys.into_iter();
    keys.map(|(key, value)| (key.to_owned(), value)).collect()
}

pub(super) fn numbers(values: &[f64]) -> Value {
    Value::Array(values.iter().map(|value| Value::Float(*value)).collect())
}

pub(super) fn copied(table: &Table, keys: &[&str]) -> Table {
    let own = table.iter().filter(|(key, _)| keys.contains(&key.as_str()));
    own.map(|(key, value)| (key.clone(), value.clone()))
        .collect()
}

impl Expansion<'_> {
    pub(super) fn push(&mut self, list: &'static str, table: Table) {
        self.items.push(DerivedTable {
            list,
            table,
            from: self.key.to_owned(),
        });
    }

    /// Adds a body with what its table, `raw`, says of it: at a place, its z in a direction, both in the set's axes.
    pub(super) fn add_body(
        &mut self,
        (name, raw): (&str, &Table),
        at_mm: Vector3<f64>,
        direction: Vector3<f64>,
    ) {
        let mut body = copied(raw, &BODY_KEYS);
        let at_mm = self.in_world_mm(at_mm);
        body.extend(made([
            ("name", name.into()),
            ("position_mm", numbers(&at_mm)),
        ]));
        // None where it is z of the world.
        let angles = cardan_rad(self.axes * direction).map(f64::to_degrees);
        if angles != [0.0; 2] {
            body.insert("cardan_deg".to_owned(), numbers(&angles));
        }
        self.push("body", body);
    }

    /// Adds a joint between two bodies, or the ground and one.
    pub(super) fn add_joint(&mut self, (name, kind): (String, &str), on: Option<&str>, body: &str) {
        let mut joint = made([
            ("name", name.into()),
            ("kind", kind.into()),
            ("body_2", body.into()),
        ]);
        joint.extend(on.map(|on| ("body_1".to_owned(), on.into())));
        self.push("joint", joint);
    }

    pub(super) fn called(&self, part: &str) -> String {
        format!("{} {part}", self.table.name)
    }

    fn run(
        &mut self,
        (gears, known): (&mut BTreeMap<String, Option<PathBuf>>, &[Known]),
        files: (&Path, &ModelShelf),
    ) -> Result<Known, InputError> {
        let table = self.table;
        self.refuse_beside_planets_of()?;
        keys::check(table, &self.keys)?;
        let mut members = SetMembers {
            sun: self.member_name("sun", table.sun.as_ref(), gears)?,
            ring: self.member_name("ring", table.ring.as_ref(), gears)?,
            carrier: self
                .member_name("carrier", Some(&table.carrier), gears)?
                .unwrap_or_default(),
        };
        let mut partners = self.partners(known, &members, files)?;
        let teeth = self.gears(&members, gears, files)?;
        let distance_m = MM * f64::from(table.centre_distance_mm);
        let room = Room::of(&teeth, distance_m, partners.as_ref()).equal_angles();
        let angles_rad = self.angles(&teeth, partners.as_ref(), room)?;
        let heights = self.heights();
        teeth.check(table, (partners.as_ref(), heights), &angles_rad, &self.keys)?;
        self.add_members(heights)?;
        let called = |part: &str| -> Vec<String> {
            let numbers = 1..=angles_rad.len();
            numbers
                .map(|n| self.called(&format!("{part} {n}")))
                .collect()
        };
        let planets = PlanetRow {
            key: "planets",
            raw: self.below("planets"),
            gear: teeth.planet.clone(),
            distance_m,
            pinned: table.planets.0.clone(),
            bodies: called("planet"),
        };
        if let Some(own) = partners.as_mut().filter(|own| own.other().is_none()) {
            own.row.bodies = called("partner");
        }
        self.add_planets(&planets, &members.carrier, &angles_rad)?;
        if let Some(own) = partners.as_ref().filter(|own| own.other().is_none()) {
            let angles = angles_rad.iter().map(|angle| angle + own.ahead_rad);
            self.add_planets(&own.row, &members.carrier, &angles.collect::<Vec<f64>>())?;
        }
        let meshes = self.add_meshes(&members, (&planets, partners.as_ref()), &teeth);
        let [sun_meshes, pair_meshes, mut ring_meshes] = meshes;
        if let Some(other) = partners.as_ref().and_then(Partners::other) {
            members.ring.clone_from(&other.known.set.members.ring);
            ring_meshes.clone_from(&other.known.set.ring_meshes);
        }
        let layout = partners.as_ref().map(|partners| PartnerLayout {
            bodies: partners.row.bodies.clone(),
            ahead_rad: partners.ahead_rad,
            distance_m: partners.row.distance_m,
            meshes: pair_meshes,
        });
        let set = PlanetarySet {
            name: table.name.clone(),
            teeth: teeth.teeth(partners.as_ref()),
            angles_rad,
            centre_distance_m: distance_m,
            members,
            axis: (self.axes * Vector3::z()).into(),
            planets: planets.bodies.clone(),
            partners: layout.unwrap_or_default(),
            sun_meshes,
            ring_meshes,
        };
        Ok(Known {
            set,
            is_simple: partners.is_none() && teeth.second.is_none(),
            gears: teeth,
            planets,
            heights,
            middle_m: self.middle_m(),
            axes: self.axes,
        })
    }

    /// Mid-faces of sun and ring.
    fn heights(&self) -> Heights {
        let height_m = |member: &Option<MemberTable>, planet_m: f64| {
            let own_mm = member.as_ref().and_then(|member| member.z_mm);
            MM * (own_mm.unwrap_or(0.0) + planet_m)
        };
        let second = self.table.planets.1.second.as_ref();
        Heights {
            sun_m: height_m(&self.table.sun, 0.0),
            ring_m: height_m(&self.table.ring, second.map_or(0.0, |second| second.z_mm)),
        }
    }

    /// Adds the members that are bodies of the set itself.
    fn add_members(&mut self, heights: Heights) -> Result<(), InputError> {
        let table = self.table;
        for (key, member, height_m) in [
            ("sun", table.sun.as_ref(), heights.sun_m),
            ("ring", table.ring.as_ref(), heights.ring_m),
            ("carrier", Some(&table.carrier), 0.0),
        ] {
            if let Some(member) = member.filter(|member| member.body.is_none()) {
                self.add_member(key, member, height_m / MM)?;
            }
        }
        Ok(())
    }

    /// The gears of the set; `gears`: files of those that are members, by their bodies.
    fn gears(
        &self,
        members: &SetMembers,
        gears: &BTreeMap<String, Option<PathBuf>>,
        (folder, models): (&Path, &ModelShelf),
    ) -> Result<SetGears, InputError> {
        let read =
            |file: &Path, key: &str| SetGear::read(&folder.join(file), (&self.keys, key), models);
        let of_member = |name: &Option<String>, key: &str| {
            let Some(name) = name else { return Ok(None) };
            let file = gears.get(name).and_then(Option::as_ref);
            let file = file.ok_or_else(|| {
                let problem = format!("missing; `{name}` needs teeth");
                self.keys.error(key, problem)
            })?;
            read(file, key).map(Some)
        };
        let planets = &self.table.planets.1;
        let second = planets.second.as_ref();
        let second = second.map(|second| read(&second.gear, "planets.second.gear"));
        Ok(SetGears {
            sun: of_member(&members.sun, "sun.gear")?,
            ring: of_member(&members.ring, "ring.gear")?,
            planet: read(&planets.gear, "planets.gear")?,
            second: second.transpose()?,
        })
    }

    fn add_planets(
        &mut self,
        row: &PlanetRow,
        carrier: &str,
        angles_rad: &[f64],
    ) -> Result<(), InputError> {
        row.check_deviations(angles_rad.len(), &self.keys)?;
        for planet in angles_rad.iter().copied().enumerate() {
            self.add_planet(row, carrier, planet)?;
        }
        Ok(())
    }

    /// The angles of the planets, where they fit \[rad\]; `room`: how many have room at equal ones.
    fn angles(
        &self,
        gears: &SetGears,
        partners: Option<&Partners>,
        room: usize,
    ) -> Result<Vec<f64>, InputError> {
        let Beside(_, planets) = &self.table.planets;
        let own_places = gears.teeth(partners).places();
        if let Some(partners) = partners
            && let Some(OtherSet { known, .. }) = partners.other()
        {
            let name = &known.set.name;
            let key = match (planets.count, &planets.angles_deg) {
                (Some(_), _) => "planets.count",
                (None, Some(_)) => "planets.angles_deg",
                (None, None) => "",
            };
            if !key.is_empty() {
                let problem = format!(
                    "is not used with planets_of: the angles follow from those of `{name}`; remove it"
                );
                return Err(self.keys.error(key, problem));
            }
            // Both sets are to fit.
            let both = known.set.teeth.places().zip(own_places);
            let places = both.map(|(one, other)| greatest_common_divisor(one, other));
            let angles = fitted(&known.set.angles_rad, places.or(own_places), room);
            let angles = angles.map_err(|misfit| {
                let problem =
                    format!("{misfit}; angles are those of `{name}`, where both sets fit");
                self.keys.error("planets.partner.planets_of", problem)
            })?;
            let angles = angles.iter().map(|angle| angle - partners.ahead_rad);
            return Ok(angles.collect());
        }
        let (key, angles): (_, Vec<f64>) = match (planets.count, &planets.angles_deg) {
            (Some(count), None) => {
                let angle = |n| n as f64 / count.get() as f64 * std::f64::consts::TAU;
                ("planets.count", (0..count.get()).map(angle).collect())
            }
            (None, Some(angles)) if (1..=24).contains(&angles.len()) => {
                let angles = angles.iter().map(|angle| angle.to_radians());
                ("planets.angles_deg", angles.collect())
            }
            (None, Some(angles)) => {
                let problem = format!("found {} angles, allowed are 1 to 24", angles.len());
                return Err(self.keys.error("planets.angles_deg", problem));
            }
            _ => {
                let problem = "give either count (equal angles) or angles_deg";
                return Err(self.keys.error("planets", problem));
            }
        };
        fitted(&angles, own_places, room).map_err(|misfit| self.keys.error(key, misfit))
    }

    /// Middle of the set in the world \[m\].
    pub(super) fn middle_m(&self) -> Vector3<f64> {
        MM * Vector3::from(self.table.position_mm.unwrap_or_default())
    }

    /// A point of the set's axes, z = 0 in its middle, in the world \[mm\].
    pub(super) fn in_world_mm(&self, point_mm: Vector3<f64>) -> [f64; 3] {
        let middle_mm = Vector3::from(self.table.position_mm.unwrap_or_default());
        (middle_mm + self.axes * point_mm).into()
    }
}
