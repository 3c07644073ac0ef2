//! The meshes of a set with sun and ring, with the errors of their gears.

use toml::{Table, Value};

use super::SetMembers;
use super::expansion::{Expansion, made, numbers};
use super::gears::SetGears;
use crate::system::tables::function::FunctionTable;
use crate::system::tables::mesh_model::MeshKind;
use crate::system::tables::planetary::{MemberTable, OutOfRoundTable, SenseWord, SetMeshTable};

impl Expansion<'_> {
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

    pub(super) fn add_sun_meshes(
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
        let mut names = Vec::new();
        for (planet, body) in planets.iter().enumerate() {
            let name = format!("{} sun-planet {}", self.table.name, planet + 1);
            let ends = [sun.as_str(), body];
            let table = self.mesh_table(
                ("sun_mesh", mesh),
                (&name, ends, side),
                (2, planet, gears.planet.teeth),
            );
            self.push("gear_mesh", table);
            names.push(name);
        }
        names
    }

    pub(super) fn add_ring_meshes(
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
        let mut names = Vec::new();
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
            names.push(name);
        }
        names
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
