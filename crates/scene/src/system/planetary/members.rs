//! Sun, ring and carrier: bodies, what holds them, motions and loads; bearings of all bodies of a set.

use std::collections::BTreeMap;
use std::path::PathBuf;

use gearmesh_geometry::InputError;
use nalgebra::Vector3;
use toml::{Table, Value};

use super::expansion::{BODY_KEYS, Expansion, copied, made, numbers};
use crate::system::names;
use crate::system::tables::planetary::{MemberTable, SupportWord};

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

    /// The body of a member, what holds, drives and loads it.
    pub(super) fn add_member(
        &mut self,
        key: &'static str,
        member: &MemberTable,
        z_mm: f64,
    ) -> Result<(), InputError> {
        let name = self.called(key);
        let raw = self.below(key);
        let at_mm = self.axis_mm(z_mm);
        let mut body = copied(&raw, &BODY_KEYS);
        body.insert("name".to_owned(), name.clone().into());
        body.insert("position_mm".to_owned(), numbers(&at_mm));
        let cardan = self.cardan_deg(Vector3::z());
        body.extend(cardan.map(|cardan| ("cardan_deg".to_owned(), cardan)));
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
        use SupportWord::{Bearings, Floating, Free, Held, Turning};
        used("bearings", &[Bearings, Floating])?;
        used("speed_rpm", &[Turning, Floating])?;
        used("torque_Nm", &[Turning, Floating, Bearings, Free])?;
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
            Bearings | Free => None,
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
        let seats = member
            .bearings
            .iter()
            .map(|b| BearingSeat {
                body_1: None,
                body_2: name.clone(),
                at_mm: self.axis_mm(b.z_mm),
            })
            .collect();
        self.add_bearings(&name, seats, &raw);
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

    /// The bearings of a body, `owner`; `raw`: its table.
    pub(super) fn add_bearings(&mut self, owner: &str, seats: Vec<BearingSeat>, raw: &Table) {
        let written = raw.get("bearings").and_then(Value::as_array);
        let written = written.into_iter().flatten().filter_map(Value::as_table);
        for (i, (own, seat)) in written.zip(seats).enumerate() {
            let mut bearing = copied(own, &["model", "housing"]);
            bearing.insert(
                "name".to_owned(),
                format!("{owner} bearing {}", i + 1).into(),
            );
            bearing.insert("body_2".to_owned(), seat.body_2.into());
            bearing.insert("at_mm".to_owned(), numbers(&seat.at_mm));
            if let Some(on) = seat.body_1 {
                bearing.insert("body_1".to_owned(), on.into());
            }
            self.push("bearing", bearing);
        }
    }
}
