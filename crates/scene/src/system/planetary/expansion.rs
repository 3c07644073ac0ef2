//! `[[planetary]]` to the tables that a scene would state without it: bodies, joints, bearings, motions, loads, meshes.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::{DerivedTable, InputDocument, TableKeys};
use serde::Deserialize;
use serde::de::IgnoredAny;
use toml::{Table, Value};

use super::gears::{SetGears, teeth_of};
use super::{PlanetarySet, SetMembers};
use crate::system::names;
use crate::system::tables::MM;
use crate::system::tables::function::FunctionTable;
use crate::system::tables::mesh_model::MeshKind;
use crate::system::tables::planetary::{
    MemberTable, OutOfRoundTable, PlanetDeviationTable, PlanetaryTable, SenseWord, SetMeshTable,
    SupportWord,
};

/// Keys of `[[body]]` that members and planets have.
const BODY_KEYS: [&str; 8] = [
    "gear",
    "microgeometry",
    "mass_kg",
    "inertia_kg_m2",
    "centre_of_mass_mm",
    "flexibility",
    "modes_up_to_Hz",
    "modal_damping_ratio",
];

#[derive(Deserialize)]
struct Marks {
    planetary: Option<IgnoredAny>,
}

#[derive(Deserialize)]
struct Sets {
    planetary: Vec<PlanetaryTable>,
}

/// The document with all that follows from its planetary sets, and the sets.
///
/// # Errors
/// [`InputError`] in the table of a set, or in a file of its gears.
pub(in crate::system) fn expand(
    document: InputDocument,
    folder: &Path,
) -> Result<(InputDocument, Vec<PlanetarySet>), InputError> {
    if document.glance::<Marks>()?.planetary.is_none() {
        return Ok((document, Vec::new()));
    }
    let tables = document.parse::<Sets>()?.planetary;
    let raw: Table = document.glance()?;
    let mut gears = gears_of_bodies(&raw);
    let (mut items, mut sets) = (Vec::new(), Vec::new());
    for (i, table) in tables.iter().enumerate() {
        let key = format!("planetary.{i}");
        let raw = item(&raw, "planetary", i).cloned().unwrap_or_default();
        let mut expansion = Expansion {
            table,
            raw: &raw,
            keys: TableKeys::new(&document, &key),
            key: &key,
            items: Vec::new(),
        };
        let set = expansion.run(&mut gears, folder)?;
        items.append(&mut expansion.items);
        sets.push(set);
    }
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

/// A set on its way.
struct Expansion<'a> {
    table: &'a PlanetaryTable,
    /// Its table as written.
    raw: &'a Table,
    keys: TableKeys<'a>,
    key: &'a str,
    items: Vec<DerivedTable>,
}

/// Where a pin is.
struct Pin {
    /// Its middle at the sun's mid-face \[mm\].
    at_mm: [f64; 3],
    /// Its axis (t_x, t_y, 1).
    lean: [f64; 2],
}

impl Pin {
    /// The point of its axis at a height above the sun's mid-face \[mm\].
    fn above_mm(&self, z_mm: f64) -> [f64; 3] {
        let ([x, y, z], [t_x, t_y]) = (self.at_mm, self.lean);
        [x + t_x * z_mm, y + t_y * z_mm, z + z_mm]
    }

    /// Cardan angles that turn z into its axis: about x first, then about the new y.
    fn cardan_deg(&self) -> [f64; 2] {
        let [t_x, t_y] = self.lean;
        let length = t_x.hypot(t_y).hypot(1.0);
        [
            (-t_y).atan2(1.0).to_degrees(),
            (t_x / length).asin().to_degrees(),
        ]
    }
}

/// A table of the given keys.
fn made<const N: usize>(keys: [(&str, Value); N]) -> Table {
    keys.into_iter()
        .map(|(key, value)| (key.to_owned(), value))
        .collect()
}

fn numbers(values: &[f64]) -> Value {
    Value::Array(values.iter().map(|value| Value::Float(*value)).collect())
}

impl Expansion<'_> {
    fn push(&mut self, list: &'static str, table: Table) {
        self.items.push(DerivedTable {
            list,
            table,
            from: self.key.to_owned(),
        });
    }

    fn called(&self, part: &str) -> String {
        format!("{} {part}", self.table.name)
    }

    /// The part of the table below a key.
    fn below(&self, key: &str) -> Table {
        let part = self.raw.get(key).and_then(Value::as_table);
        part.cloned().unwrap_or_default()
    }

    fn run(
        &mut self,
        gears: &mut BTreeMap<String, Option<PathBuf>>,
        folder: &Path,
    ) -> Result<PlanetarySet, InputError> {
        let table = self.table;
        self.check_keys()?;
        let members = SetMembers {
            sun: self.member_name("sun", table.sun.as_ref(), gears)?,
            ring: self.member_name("ring", table.ring.as_ref(), gears)?,
            carrier: self
                .member_name("carrier", Some(&table.carrier), gears)?
                .unwrap_or_default(),
        };
        let of_member = |name: &Option<String>, key: &str| {
            let Some(name) = name else { return Ok(None) };
            let key = format!("{key}.gear");
            match gears.get(name).cloned().flatten() {
                Some(file) => teeth_of(&folder.join(file), (&self.keys, &key)).map(Some),
                None => Err(self
                    .keys
                    .error(&key, format!("missing; `{name}` needs teeth"))),
            }
        };
        let of_planet = |file: &Path, key| teeth_of(&folder.join(file), (&self.keys, key));
        let second = table.planets.second.as_ref();
        let teeth = SetGears {
            sun: of_member(&members.sun, "sun")?,
            ring: of_member(&members.ring, "ring")?,
            planet: of_planet(&table.planets.gear, "planets.gear")?,
            second: second
                .map(|second| of_planet(&second.gear, "planets.second.gear"))
                .transpose()?,
        };
        let angles_rad = self.angles(&teeth)?;
        teeth.check(table, &angles_rad, &self.keys)?;
        for (key, member) in [
            ("sun", table.sun.as_ref()),
            ("ring", table.ring.as_ref()),
            ("carrier", Some(&table.carrier)),
        ] {
            if let Some(member) = member.filter(|member| member.body.is_none()) {
                self.add_member(key, member)?;
            }
        }
        let planets: Vec<String> = (1..=angles_rad.len())
            .map(|n| self.called(&format!("planet {n}")))
            .collect();
        for (planet, angle_rad) in angles_rad.iter().enumerate() {
            self.add_planet(&planets[planet], &members.carrier, (planet, *angle_rad))?;
        }
        let sun_meshes = self.add_sun_meshes(&members, &planets, &teeth);
        let ring_meshes = self.add_ring_meshes(&members, &planets, &teeth);
        Ok(PlanetarySet {
            name: table.name.clone(),
            teeth: teeth.teeth(),
            angles_rad,
            centre_distance_m: MM * f64::from(table.centre_distance_mm),
            members,
            planets,
            sun_meshes,
            ring_meshes,
        })
    }

    /// Keys that need or exclude each other.
    fn check_keys(&self) -> Result<(), InputError> {
        let (table, keys) = (self.table, &self.keys);
        if table.sun.is_none() && table.ring.is_none() {
            return Err(keys.error("", "has neither sun nor ring; give one of them or both"));
        }
        for (key, mesh_key, member, mesh) in [
            ("sun", "sun_mesh", &table.sun, &table.sun_mesh),
            ("ring", "ring_mesh", &table.ring, &table.ring_mesh),
        ] {
            match (member, mesh) {
                (Some(_), None) => {
                    keys.needed(mesh_key, None::<()>, &format!("a set with a {key}"))?
                }
                (None, Some(_)) => {
                    return Err(
                        keys.error(mesh_key, format!("is not used without a {key}; remove it"))
                    );
                }
                _ => {}
            }
            if let Some(teeth) = mesh.as_ref().and_then(|mesh| mesh.teeth.as_ref()) {
                let of_planets = match key {
                    "sun" => [
                        ("errors_2", !teeth.errors_2.is_empty()),
                        ("eccentricity_2", teeth.eccentricity_2.is_some()),
                    ],
                    _ => [
                        ("errors_1", !teeth.errors_1.is_empty()),
                        ("eccentricity_1", teeth.eccentricity_1.is_some()),
                    ],
                };
                for (name, given) in of_planets {
                    if given {
                        let key = format!("{mesh_key}.teeth.{name}");
                        return Err(keys.error(&key, "are those of planets: state them in planets.errors or planets.deviation"));
                    }
                }
                if teeth.touching_at_start.is_some() {
                    let key = format!("{mesh_key}.teeth.touching_at_start");
                    return Err(keys.error(
                        &key,
                        "follows from the torque on the sun; state sun_torque instead",
                    ));
                }
            }
        }
        if table
            .sun
            .as_ref()
            .is_some_and(|sun| !sun.out_of_round.is_empty())
        {
            return Err(keys.error("sun.out_of_round", "belongs to the ring; remove it"));
        }
        if !table.carrier.out_of_round.is_empty() {
            return Err(keys.error("carrier.out_of_round", "belongs to the ring; remove it"));
        }
        if table.carrier.gear.is_some() {
            return Err(keys.error("carrier.gear", "a carrier has no teeth of this set; remove it, and fix the gear's own [[body]] to it by a [[joint]]"));
        }
        if table.planets.second.is_some() && table.ring.is_none() {
            return Err(keys.error(
                "planets.second",
                "meshes with a ring, which the set has not; remove it",
            ));
        }
        if matches!(table.planets.support, Some(SupportWord::Held)) {
            return Err(keys.error(
                "planets.support",
                "found \"held\", allowed are \"turning\", \"floating\" and \"bearings\"",
            ));
        }
        if let Some(i) = table
            .planets
            .bearings
            .iter()
            .position(|b| b.housing.is_some())
        {
            return Err(keys.error(
                &format!("planets.bearings.{i}.housing"),
                "is not used by planets; remove it",
            ));
        }
        Ok(())
    }

    /// Name of the body that is a member; its gear is put among the known ones.
    fn member_name(
        &self,
        key: &str,
        member: Option<&MemberTable>,
        gears: &mut BTreeMap<String, Option<PathBuf>>,
    ) -> Result<Option<String>, InputError> {
        let Some(member) = member else {
            return Ok(None);
        };
        let Some(body) = &member.body else {
            let name = self.called(key);
            gears.insert(name.clone(), member.gear.clone());
            return Ok(Some(name));
        };
        if !gears.contains_key(body) {
            let known: Vec<&String> = gears.keys().collect();
            let problem = names::unknown("body", body, &known);
            return Err(self.keys.error(&format!("{key}.body"), problem));
        }
        let own = self.below(key);
        let others = own
            .keys()
            .find(|other| !["body", "out_of_round"].contains(&other.as_str()));
        match others {
            None => Ok(Some(body.clone())),
            Some(other) => {
                let problem =
                    format!("is not used with `body`: `{body}` states it; remove one of the two");
                Err(self.keys.error(&format!("{key}.{other}"), problem))
            }
        }
    }

    /// The angles of the planets, where they fit \[rad\].
    fn angles(&self, gears: &SetGears) -> Result<Vec<f64>, InputError> {
        let planets = &self.table.planets;
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
        for (i, deviation) in planets.deviation.iter().enumerate() {
            let number = deviation.planet.get();
            let twice = planets.deviation[..i]
                .iter()
                .any(|other| other.planet.get() == number);
            if number > angles.len() || twice {
                let problem = match twice {
                    true => format!("planet {number} has a deviation already; join the two"),
                    false => format!("found {number}, the set has planets 1 to {}", angles.len()),
                };
                return Err(self
                    .keys
                    .error(&format!("planets.deviation.{i}.planet"), problem));
            }
        }
        let fitted = gears.teeth().fitted(&angles);
        fitted.map_err(|misfit| self.keys.error(key, misfit))
    }

    /// Middle of the set in the world, at a height above the sun's mid-face \[mm\].
    fn axis_mm(&self, z_mm: f64) -> [f64; 3] {
        let [x, y, z] = self.table.position_mm.unwrap_or_default();
        [x, y, z + z_mm]
    }

    fn add_member(&mut self, key: &'static str, member: &MemberTable) -> Result<(), InputError> {
        let name = self.called(key);
        let raw = self.below(key);
        let second = self.table.planets.second.as_ref().filter(|_| key == "ring");
        let at_mm = self.axis_mm(second.map_or(0.0, |second| second.z_mm));
        let mut body = copied(&raw, &BODY_KEYS);
        body.insert("name".to_owned(), name.clone().into());
        body.insert("position_mm".to_owned(), numbers(&at_mm));
        self.push("body", body);
        let support = member.support().unwrap_or(SupportWord::Bearings);
        let used = |key: &str, users: &[SupportWord]| {
            if raw.contains_key(key) && !users.contains(&support) {
                let problem = format!("is not used by support = \"{}\"; remove it", support.name());
                return Err(self.keys.error(
                    &format!("{}.{key}", &name[self.table.name.len() + 1..]),
                    problem,
                ));
            }
            Ok(())
        };
        use SupportWord::{Bearings, Floating, Held, Turning};
        used("bearings", &[Bearings, Floating])?;
        used("speed_rpm", &[Turning, Floating])?;
        used("torque_Nm", &[Turning, Floating, Bearings])?;
        if support == Bearings && member.bearings.is_empty() {
            return Err(self.keys.error(
                key,
                "support = \"bearings\" needs bearings; give one or more",
            ));
        }
        let joint = self.called(&format!("{key} axis"));
        let kind = match support {
            Held => Some("fixed"),
            Turning => Some("revolute"),
            Floating => Some("planar"),
            Bearings => None,
        };
        if let Some(kind) = kind {
            self.push(
                "joint",
                made([
                    ("name", joint.clone().into()),
                    ("kind", kind.into()),
                    ("body_2", name.clone().into()),
                ]),
            );
        }
        let places = member
            .bearings
            .iter()
            .map(|b| self.axis_mm(b.z_mm))
            .collect();
        self.add_bearings((None, &name), places, &raw);
        if let Some(speed) = raw.get("speed_rpm") {
            let motion = self.called(&format!("{key} speed"));
            self.push(
                "motion",
                made([
                    ("name", motion.into()),
                    ("joint", joint.into()),
                    ("speed_rpm", speed.clone()),
                ]),
            );
        }
        if let Some(torque) = raw.get("torque_Nm") {
            let load = self.called(&format!("{key} torque"));
            self.push(
                "load",
                made([
                    ("name", load.into()),
                    ("body", name.into()),
                    ("torque_Nm", torque.clone()),
                ]),
            );
        }
        Ok(())
    }

    /// The bearings of a body at places in the world \[mm\]; `raw`: its table.
    fn add_bearings(
        &mut self,
        (on, body): (Option<&str>, &str),
        places: Vec<[f64; 3]>,
        raw: &Table,
    ) {
        let written = raw.get("bearings").and_then(Value::as_array);
        let written = written.into_iter().flatten().filter_map(Value::as_table);
        for (i, (own, at_mm)) in written.zip(places).enumerate() {
            let mut bearing = copied(own, &["model", "housing"]);
            bearing.insert(
                "name".to_owned(),
                format!("{body} bearing {}", i + 1).into(),
            );
            bearing.insert("body_2".to_owned(), body.into());
            bearing.insert("at_mm".to_owned(), numbers(&at_mm));
            if let Some(on) = on {
                bearing.insert("body_1".to_owned(), on.into());
            }
            self.push("bearing", bearing);
        }
    }

    fn deviation(&self, planet: usize) -> Option<&PlanetDeviationTable> {
        let mut all = self.table.planets.deviation.iter();
        all.find(|deviation| deviation.planet.get() == planet + 1)
    }

    /// Where the pin of a planet is.
    fn pin(&self, planet: usize, angle_rad: f64) -> Pin {
        let table = self.table;
        let (sin, cos) = angle_rad.sin_cos();
        let deviation = self.deviation(planet);
        let of = |part: fn(&PlanetDeviationTable) -> f64| 1e-3 * deviation.map_or(0.0, part);
        let turned = |out: f64, on: f64| [cos * out - sin * on, sin * out + cos * on];
        let out_mm = f64::from(table.centre_distance_mm) + of(|d| d.radial_um);
        let [x, y] = turned(out_mm, of(|d| d.tangential_um));
        let shift = table.carrier_eccentricity.map_or([0.0; 2], |e| {
            let (sin, cos) = e.direction_deg.to_radians().sin_cos();
            [1e-3 * e.offset_um * cos, 1e-3 * e.offset_um * sin]
        });
        let [x0, y0, z0] = self.axis_mm(0.0);
        Pin {
            at_mm: [x0 + x + shift[0], y0 + y + shift[1], z0],
            lean: turned(of(|d| d.tilt_radial_mrad), of(|d| d.tilt_tangential_mrad)),
        }
    }

    fn add_planet(
        &mut self,
        name: &str,
        carrier: &str,
        (planet, angle_rad): (usize, f64),
    ) -> Result<(), InputError> {
        let planets = &self.table.planets;
        let pin = self.pin(planet, angle_rad);
        let raw = self.below("planets");
        let mut bodies = vec![(name.to_owned(), copied(&raw, &BODY_KEYS), 0.0)];
        let second = raw.get("second").and_then(Value::as_table);
        if let (Some(second), Some(own)) = (&planets.second, second) {
            bodies.push((
                format!("{name} second"),
                copied(own, &BODY_KEYS),
                second.z_mm,
            ));
        }
        for (name, mut body, z_mm) in bodies.clone() {
            body.insert("name".to_owned(), name.into());
            body.insert("position_mm".to_owned(), numbers(&pin.above_mm(z_mm)));
            if pin.lean != [0.0; 2] {
                body.insert("cardan_deg".to_owned(), numbers(&pin.cardan_deg()));
            }
            self.push("body", body);
        }
        let joint = |name: String, kind: &str, on: &str, body: &str| {
            made([
                ("name", name.into()),
                ("kind", kind.into()),
                ("body_1", on.into()),
                ("body_2", body.into()),
            ])
        };
        if let Some((second, ..)) = bodies.get(1) {
            self.push(
                "joint",
                joint(format!("{name} shaft"), "fixed", name, second),
            );
        }
        if let Some(kind) = self.planet_joint()? {
            self.push("joint", joint(format!("{name} pin"), kind, carrier, name));
        }
        let places = planets.bearings.iter().map(|b| pin.above_mm(b.z_mm));
        self.add_bearings((Some(carrier), name), places.collect(), &raw);
        Ok(())
    }

    /// The joint between carrier and planet; none where bearings alone hold it.
    fn planet_joint(&self) -> Result<Option<&'static str>, InputError> {
        let planets = &self.table.planets;
        match (planets.support, planets.bearings.is_empty()) {
            (Some(SupportWord::Floating), _) => Ok(Some("planar")),
            (Some(SupportWord::Bearings) | None, false) => Ok(None),
            (Some(SupportWord::Bearings), true) => Err(self.keys.error(
                "planets.support",
                "found \"bearings\", which needs bearings; give one or more",
            )),
            (_, false) => Err(self.keys.error(
                "planets.bearings",
                "is not used by support = \"turning\"; remove it",
            )),
            (_, true) => Ok(Some("revolute")),
        }
    }

    /// The sense of the torque on the sun at the start.
    fn sun_pushes_counter_clockwise(&self) -> bool {
        if let Some(sense) = self.table.sun_torque {
            return sense == SenseWord::Positive;
        }
        let members = [
            (self.table.sun.as_ref(), 1.0),
            (self.table.ring.as_ref(), 1.0),
            (Some(&self.table.carrier), -1.0),
        ];
        // Torques on sun and ring have the sense of that on the sun, the carrier's the other: T_s/z_s = T_r/z_r, sum 0.
        let of = |part: fn(&MemberTable) -> Option<&FunctionTable>| {
            members.iter().find_map(|(member, sense)| {
                let value = part((*member)?)?.first_value()?;
                (value != 0.0).then_some(value * sense)
            })
        };
        of(|m| m.torque_Nm.as_ref())
            .or_else(|| of(|m| m.speed_rpm.as_ref()))
            .unwrap_or(1.0)
            > 0.0
    }

    fn add_sun_meshes(
        &mut self,
        members: &SetMembers,
        planets: &[String],
        gears: &SetGears,
    ) -> Vec<String> {
        let (Some(sun), Some(mesh)) = (&members.sun, &self.table.sun_mesh) else {
            return Vec::new();
        };
        // The sun's torque counter-clockwise: it pushes with left flanks.
        let side = if self.sun_pushes_counter_clockwise() {
            "left"
        } else {
            "right"
        };
        let mut made = Vec::new();
        for (planet, body) in planets.iter().enumerate() {
            let name = format!("{} sun-planet {}", self.table.name, planet + 1);
            let ends = [sun.as_str(), body];
            let table = self.mesh_table(
                ("sun_mesh", mesh),
                (&name, ends, side),
                (2, planet, gears.planet.teeth),
            );
            self.push("gear_mesh", table);
            made.push(name);
        }
        made
    }

    fn add_ring_meshes(
        &mut self,
        members: &SetMembers,
        planets: &[String],
        gears: &SetGears,
    ) -> Vec<String> {
        let (Some(ring), Some(mesh), Some(teeth)) =
            (&members.ring, &self.table.ring_mesh, &gears.ring)
        else {
            return Vec::new();
        };
        // A planet is pressed on one side of its teeth and presses with the other.
        let side = if self.sun_pushes_counter_clockwise() {
            "right"
        } else {
            "left"
        };
        let waves = self
            .table
            .ring
            .as_ref()
            .map_or(&[][..], |ring| &ring.out_of_round);
        let waves: Vec<Value> = waves
            .iter()
            .flat_map(|wave| {
                out_of_round(
                    wave,
                    teeth.teeth,
                    (teeth.base_radius_m / teeth.reference_radius_m).acos(),
                )
            })
            .collect();
        let mut made = Vec::new();
        for (planet, body) in planets.iter().enumerate() {
            let name = format!("{} planet {}-ring", self.table.name, planet + 1);
            let (gear, of_planet) = match &self.table.planets.second {
                Some(_) => (format!("{body} second"), None),
                None => (body.clone(), Some(planet)),
            };
            let ends = [gear.as_str(), ring];
            let numbers = (1, of_planet.unwrap_or(usize::MAX), gears.planet.teeth);
            let mut table = self.mesh_table(("ring_mesh", mesh), (&name, ends, side), numbers);
            if !waves.is_empty() {
                append(teeth_table(&mut table), "errors_2", waves.clone());
            }
            self.push("gear_mesh", table);
            made.push(name);
        }
        made
    }

    /// A mesh with what the planet has: `gear` its number in the mesh.
    fn mesh_table(
        &self,
        (key, mesh): (&str, &SetMeshTable),
        (name, ends, side): (&str, [&str; 2], &str),
        (gear, planet, teeth): (usize, usize, usize),
    ) -> Table {
        let mut table = self.below(key);
        table.insert("name".to_owned(), name.into());
        table.insert("gear_1".to_owned(), ends[0].into());
        table.insert("gear_2".to_owned(), ends[1].into());
        if mesh.model.kind() == MeshKind::Kinematic {
            return table;
        }
        let own = teeth_table(&mut table);
        own.insert("touching_at_start".to_owned(), side.into());
        if planet == usize::MAX {
            return table;
        }
        let raw = self.below("planets");
        let errors = raw.get("errors").and_then(Value::as_array).cloned();
        let mut errors = errors.unwrap_or_default();
        if let Some(deviation) = self.deviation(planet) {
            if deviation.removed_um != 0.0 {
                let all = vec![deviation.removed_um; teeth];
                errors.extend(["left", "right"].map(|side| pitch(side, &all)));
            }
            let written = raw.get("deviation").and_then(Value::as_array);
            let number =
                |d: &&Value| d.get("planet").and_then(Value::as_integer) == Some(planet as i64 + 1);
            let written = written.and_then(|all| all.iter().find(number));
            if let Some(eccentricity) = written.and_then(|d| d.get("eccentricity")) {
                own.insert(format!("eccentricity_{gear}"), eccentricity.clone());
            }
        }
        append(own, &format!("errors_{gear}"), errors);
        table
    }
}

fn copied(table: &Table, keys: &[&str]) -> Table {
    let own = table.iter().filter(|(key, _)| keys.contains(&key.as_str()));
    own.map(|(key, value)| (key.clone(), value.clone()))
        .collect()
}

fn teeth_table(mesh: &mut Table) -> &mut Table {
    let teeth = mesh
        .entry("teeth")
        .or_insert_with(|| Value::Table(Table::new()));
    match teeth {
        Value::Table(teeth) => teeth,
        // The table has been read as a mesh before.
        _ => unreachable!("`teeth` of a mesh is a table"),
    }
}

fn append(table: &mut Table, key: &str, more: Vec<Value>) {
    if more.is_empty() {
        return;
    }
    let list = table.entry(key).or_insert_with(|| Value::Array(Vec::new()));
    if let Value::Array(list) = list {
        list.extend(more);
    }
}

/// An error of kind "pitch".
fn pitch(side: &str, removed_um: &[f64]) -> Value {
    Value::Table(made([
        ("kind", "pitch".into()),
        ("side", side.into()),
        ("removed_um", numbers(removed_um)),
    ]))
}

/// A wave as material removed from both sides of the ring's teeth, A cos(nφ) sin α ∓ A/n sin(nφ) cos α on right and left flanks:
/// what a tooth that moves by A cos(nφ) outwards and −(A/n) sin(nφ) along the circle, which is not stretched, does along
/// the normals (docs/theory/planetary_sets.md).
fn out_of_round(wave: &OutOfRoundTable, teeth: usize, pressure_angle_rad: f64) -> [Value; 2] {
    let (sin_a, cos_a) = pressure_angle_rad.sin_cos();
    let lobes = wave.lobes.get() as f64;
    let removed = |sigma: f64| {
        let of = |tooth: usize| {
            let phi = std::f64::consts::TAU * tooth as f64 / teeth as f64;
            let (sin, cos) = (lobes * (phi - wave.crest_deg.to_radians())).sin_cos();
            wave.amplitude_um * (cos * sin_a - sigma * sin / lobes * cos_a)
        };
        (0..teeth).map(of).collect::<Vec<f64>>()
    };
    [pitch("right", &removed(1.0)), pitch("left", &removed(-1.0))]
}
