//! The meshes of a set, with the errors of their gears.

use gearmesh_specification::system::function::FunctionTable;
use gearmesh_specification::system::mesh_model::MeshKind;
use gearmesh_specification::system::planetary::{
    MemberTable, OutOfRoundTable, SenseWord, SetMeshTable,
};
use toml::{Table, Value};

use super::SetMembers;
use super::expansion::{Expansion, made, numbers};
use super::gears::SetGears;
use super::partners::Partners;
use super::pins::PlanetRow;

/// The gears of a kind of mesh, whose numbers are 1 and 2: a member, or a planet of a row.
#[derive(Clone, Copy)]
enum End<'a> {
    Member(&'a str),
    Planets(&'a PlanetRow),
    /// The second gears of stepped planets: what errors planets have is of the first ones.
    Seconds(&'a PlanetRow),
}

impl End<'_> {
    fn body(self, planet: usize) -> String {
        match self {
            Self::Member(name) => name.to_owned(),
            Self::Planets(row) => row.bodies[planet].clone(),
            Self::Seconds(row) => format!("{} second", row.bodies[planet]),
        }
    }
}

/// Sides of the teeth, by the sign of what turns: the sun pushed counter-clockwise pushes with left flanks.
fn side(is_left: bool) -> &'static str {
    if is_left { "left" } else { "right" }
}

impl Expansion<'_> {
    /// The sense of the torque on the sun at the start; `ratio`: turns of the ring for one of the sun, carrier held.
    fn sun_pushes_counter_clockwise(&self, ratio: Option<f64>) -> bool {
        if let Some(sense) = self.table.sun_torque {
            return sense == SenseWord::Positive;
        }
        // T_s + i T_r = 0, T_s + T_r + T_c = 0.
        let ratio = ratio.unwrap_or(-1.0);
        let members = [
            (self.table.sun.as_ref(), 1.0),
            (self.table.ring.as_ref(), -ratio),
            (Some(&self.table.carrier), 1.0 / (1.0 / ratio - 1.0)),
        ];
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

    /// The meshes of sun and planets, of planets and partners, and of these or planets and the ring.
    pub(super) fn add_meshes(
        &mut self,
        members: &SetMembers,
        (planets, partners): (&PlanetRow, Option<&Partners>),
        gears: &SetGears,
    ) -> [Vec<String>; 3] {
        let teeth = gears.teeth(partners);
        let sun_turns = self.sun_pushes_counter_clockwise(teeth.carrier_held_ratio());
        // A planet is pressed on one side of its teeth and presses with the other, and so does its partner. Sides are
        // counted by the ring's torque where that is stated.
        let ring_turns = match self.table.ring_torque {
            Some(sense) => sense == SenseWord::Positive,
            None => sun_turns != partners.is_some(),
        };
        let table = self.table;
        let own = partners.filter(|partners| partners.other().is_none());
        let to_ring = match (own, &table.planets.1.second) {
            (Some(own), _) => ("partner", End::Planets(&own.row)),
            (None, Some(_)) => ("planet", End::Seconds(planets)),
            (None, None) => ("planet", End::Planets(planets)),
        };
        let waves = self.waves(gears);
        let sun = members.sun.as_ref().zip(table.sun_mesh.as_ref());
        let sun = sun.map(|(sun, mesh)| {
            let ends = [End::Member(sun), End::Planets(planets)];
            (("sun_mesh", mesh), ends, side(sun_turns), "sun-planet {}")
        });
        let pair = partners.zip(table.pair_mesh.as_ref());
        let pair = pair.map(|(partners, mesh)| {
            let ends = [End::Planets(planets), End::Planets(&partners.row)];
            (
                ("pair_mesh", mesh),
                ends,
                side(!sun_turns),
                "planet {}-partner",
            )
        });
        let ring = members.ring.as_ref().zip(table.ring_mesh.as_ref());
        let ring = ring.map(|(ring, mesh)| {
            let name = match to_ring.0 {
                "partner" => "partner {}-ring",
                _ => "planet {}-ring",
            };
            let ends = [to_ring.1, End::Member(ring)];
            (("ring_mesh", mesh), ends, side(!ring_turns), name)
        });
        let mut names = [Vec::new(), Vec::new(), Vec::new()];
        let mut kinds = [sun, pair, ring]
            .into_iter()
            .enumerate()
            .collect::<Vec<_>>();
        if partners.is_some_and(|partners| partners.other().is_some()) {
            // Planets of another set are in mesh with that already: these are turned to fit them, then the sun.
            kinds.swap(0, 1);
        }
        for (kind, mesh) in kinds {
            let Some((mesh, ends, side, name)) = mesh else {
                continue;
            };
            for planet in 0..planets.bodies.len() {
                let name = name.replace("{}", &(planet + 1).to_string());
                let name = format!("{} {name}", table.name);
                let mut made = self.mesh_table(mesh, (&name, side), (ends, planet));
                if kind == 2 && !waves.is_empty() {
                    append(teeth_table(&mut made), "errors_2", waves.clone());
                }
                self.push("gear_mesh", made);
                names[kind].push(name);
            }
        }
        names
    }

    /// The ring's errors that are waves of its pitch circle.
    fn waves(&self, gears: &SetGears) -> Vec<Value> {
        let (Some(ring), Some(gear)) = (&self.table.ring, &gears.ring) else {
            return Vec::new();
        };
        let teeth = &gear.teeth;
        let angle_rad = (teeth.base_radius_m / teeth.reference_radius_m).acos();
        let waves = ring.out_of_round.iter();
        waves
            .flat_map(|wave| out_of_round(wave, teeth.teeth, angle_rad))
            .collect()
    }

    /// A mesh with what its planets have.
    fn mesh_table(
        &self,
        (key, mesh): (&str, &SetMeshTable),
        (name, side): (&str, &str),
        (ends, planet): ([End<'_>; 2], usize),
    ) -> Table {
        let mut table = self.below(key);
        table.insert("name".to_owned(), name.into());
        for (end, key) in ends.iter().zip(["gear_1", "gear_2"]) {
            table.insert(key.to_owned(), end.body(planet).into());
        }
        if mesh.model.kind() == MeshKind::Kinematic {
            return table;
        }
        let own = teeth_table(&mut table);
        own.insert("touching_at_start".to_owned(), side.into());
        for (end, gear) in ends.iter().zip(1..) {
            let End::Planets(row) = end else { continue };
            let errors = row.raw.get("errors").and_then(Value::as_array).cloned();
            let mut errors = errors.unwrap_or_default();
            if let Some(deviation) = row.deviation(planet) {
                if deviation.removed_um != 0.0 {
                    let all = vec![deviation.removed_um; row.gear.teeth.teeth];
                    errors.extend(["left", "right"].map(|side| pitch(side, &all)));
                }
                let written = row.raw.get("deviation").and_then(Value::as_array);
                let number = |d: &&Value| {
                    d.get("planet").and_then(Value::as_integer) == Some(planet as i64 + 1)
                };
                let written = written.and_then(|all| all.iter().find(number));
                if let Some(eccentricity) = written.and_then(|d| d.get("eccentricity")) {
                    own.insert(format!("eccentricity_{gear}"), eccentricity.clone());
                }
            }
            append(own, &format!("errors_{gear}"), errors);
        }
        table
    }
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

/// A wave as material removed from both sides of the ring's teeth, A cos(nφ) sin α ∓ A/n sin(nφ) cos α on right and
/// left flanks: what a tooth that moves by A cos(nφ) outwards and −(A/n) sin(nφ) along the circle, which is not
/// stretched, does along the normals (docs/theory/planetary_sets.md).
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
