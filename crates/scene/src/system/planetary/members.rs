//! Sun, ring and carrier: bodies, what holds them, motions and loads; bearings of all bodies of a set.

use std::collections::BTreeMap;
use std::path::PathBuf;

use gearmesh_geometry::InputError;
use gearmesh_specification::names::unknown;
use gearmesh_specification::system::planetary::{MemberTable, SupportWord};
use nalgebra::Vector3;
use toml::{Table, Value};

use super::expansion::{Expansion, copied, made, numbers};

/// Where a bearing of a set stands.
pub(super) struct BearingSeat {
    /// None for the ground.
    pub body_1: Option<String>,
    pub body_2: String,
    /// In the world \[mm\].
    pub at_mm: [f64; 3],
}

impl Expansion<'_> {
    /// Name of the body that is a member; its gear is put among the known ones.
    pub(super) fn member_name(
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
            let problem = unknown("body", body, &known);
            return Err(self.keys.error(&format!("{key}.body"), problem));
        }
        let own = self.below(key);
        let is_other = |other: &&String| !["body", "out_of_round"].contains(&other.as_str());
        match own.keys().find(is_other) {
            None => Ok(Some(body.clone())),
            Some(other) => {
                let problem =
                    format!("is not used with `body`: `{body}` states it; remove one of the two");
                Err(self.keys.error(&format!("{key}.{other}"), problem))
            }
        }
    }

    /// The body of a member, what holds, drives and loads it.
    pub(super) fn add_member(
        &mut self,
        key: &'static str,
        member: &MemberTable,
        z_mm: f64,
    ) -> Result<(), InputError> {
        let (name, raw) = (self.called(key), self.below(key));
        let above = |z_mm: f64| Vector3::new(0.0, 0.0, z_mm);
        self.add_body((&name, &raw), above(z_mm), Vector3::z());
        let support = member.support().unwrap_or(SupportWord::Bearings);
        let used = |key: &str, users: &[SupportWord]| {
            let is_unused = raw.contains_key(key) && !users.contains(&support);
            let problem = format!("is not used by support = \"{}\"; remove it", support.name());
            let key = format!("{}.{key}", &name[self.table.name.len() + 1..]);
            self.keys.refuse(&[(&key, is_unused)], problem)
        };
        use SupportWord::{Bearings, Floating, Free, Held, Turning};
        used("bearings", &[Bearings, Floating])?;
        used("speed_rpm", &[Turning, Floating])?;
        used("torque_Nm", &[Turning, Floating, Bearings, Free])?;
        if support == Bearings && member.bearings.is_empty() {
            let problem = "support = \"bearings\" needs bearings; give one or more";
            return Err(self.keys.error(key, problem));
        }
        let joint = self.called(&format!("{key} axis"));
        let kind = match support {
            Held => Some("fixed"),
            Turning => Some("revolute"),
            Floating => Some("planar"),
            Bearings | Free => None,
        };
        if let Some(kind) = kind {
            self.add_joint((joint.clone(), kind), None, &name);
        }
        let seats = member.bearings.iter().map(|b| BearingSeat {
            body_1: None,
            body_2: name.clone(),
            at_mm: self.in_world_mm(above(b.z_mm)),
        });
        let seats = seats.collect();
        self.add_bearings(&name, seats, &raw);
        for (list, what, on, key_of_value) in [
            ("motion", "speed", ("joint", joint), "speed_rpm"),
            ("load", "torque", ("body", name), "torque_Nm"),
        ] {
            if let Some(value) = raw.get(key_of_value) {
                let own = self.called(&format!("{key} {what}"));
                let keys = [
                    ("name", own.into()),
                    (on.0, on.1.into()),
                    (key_of_value, value.clone()),
                ];
                self.push(list, made(keys));
            }
        }
        Ok(())
    }

    /// The bearings of a body, `owner`; `raw`: its table.
    pub(super) fn add_bearings(&mut self, owner: &str, seats: Vec<BearingSeat>, raw: &Table) {
        let written = raw.get("bearings").and_then(Value::as_array);
        let written = written.into_iter().flatten().filter_map(Value::as_table);
        for (i, (own, seat)) in written.zip(seats).enumerate() {
            let mut bearing = copied(own, &["model", "housing"]);
            bearing.extend(made([
                ("name", format!("{owner} bearing {}", i + 1).into()),
                ("body_2", seat.body_2.into()),
                ("at_mm", numbers(&seat.at_mm)),
            ]));
            bearing.extend(seat.body_1.map(|on| ("body_1".to_owned(), on.into())));
            self.push("bearing", bearing);
        }
    }
}
