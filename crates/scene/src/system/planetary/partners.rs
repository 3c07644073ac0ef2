//! Meshed planets: each planet has a partner, which meshes with it and with the ring. Partners are of the set itself,
//! or they are the planets of another one; both are then a Ravigneaux set.
//!
//! ```text
//! cos δ = (a_1² + a_2² − d²)/(2 a_1 a_2)      δ: angle from a planet to its partner, seen from the axis of the set
//! ```
//!
//! a_1, a_2: distances of their pins from the axis; d: centre distance of both.

use std::path::Path;

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::Beside;
use gearmesh_specification::gear_tables::MM;
use gearmesh_specification::names::unknown;
use gearmesh_specification::system::planetary::{PartnerKeys, PartnerSide};
use nalgebra::Vector3;
use toml::Table;

use super::SetMembers;
use super::expansion::{Expansion, Known};
use super::gears::SetGear;
use super::pins::PlanetRow;
use crate::model_shelf::ModelShelf;

/// What a partner that is a planet of another set states.
const BESIDE_PLANETS_OF: [&str; 3] = ["planets_of", "pair_distance_mm", "side"];

/// Sets whose axes or places differ by less have one axis: rounding \[m\].
const ON_AXIS_M: f64 = 1e-9;

/// The partners of a set's planets.
pub(super) struct Partners {
    pub row: PlanetRow,
    /// Distance of planet and partner \[m\].
    pub pair_distance_m: f64,
    /// δ, positive where partners are ahead \[rad\].
    pub ahead_rad: f64,
    pub from: Origin,
}

/// Where partners come from.
pub(super) enum Origin {
    /// The set itself.
    Own,
    /// Another set.
    Other(Box<OtherSet>),
}

/// The set whose planets are partners.
pub(super) struct OtherSet {
    pub known: Known,
    /// How far its middle is above that of this set \[m\].
    pub above_m: f64,
}

impl Partners {
    /// The other set; none where partners are of the set itself.
    pub fn other(&self) -> Option<&OtherSet> {
        match &self.from {
            Origin::Own => None,
            Origin::Other(other) => Some(other),
        }
    }
}

impl Expansion<'_> {
    /// Keys of partners that another set states.
    pub(super) fn refuse_beside_planets_of(&self) -> Result<(), InputError> {
        let own = self.below("planets.partner");
        // The gear first: all else is of it.
        let keys = own.get_key_value("gear").into_iter().chain(&own);
        let mut keys = keys.map(|(key, _)| key.as_str());
        match keys.find(|key| !BESIDE_PLANETS_OF.contains(key)) {
            Some(key) if own.contains_key("planets_of") => {
                let problem = "is not used with planets_of: that set states its planets; remove it";
                Err(self.keys.error(&format!("planets.partner.{key}"), problem))
            }
            _ => Ok(()),
        }
    }

    /// The partners, where the set has any; their bodies have no names yet where they are its own.
    pub(super) fn partners(
        &self,
        known: &[Known],
        members: &SetMembers,
        (folder, models): (&Path, &ModelShelf),
    ) -> Result<Option<Partners>, InputError> {
        let Some(Beside(pinned, table)) = &self.table.planets.1.partner else {
            return Ok(None);
        };
        let (row, from) = match &table.planets_of {
            Some(name) => {
                let other = self.other_set(name, known, members)?;
                (other.known.planets.clone(), Origin::Other(Box::new(other)))
            }
            None => {
                let needed_by = "`partner` without `planets_of`";
                let key = "planets.partner.gear";
                let gear = self.keys.needed(key, table.gear.as_ref(), needed_by)?;
                let gear = SetGear::read(&folder.join(gear), (&self.keys, key), models)?;
                let key = "planets.partner.centre_distance_mm";
                let distance_mm = self.keys.needed(key, table.centre_distance_mm, needed_by)?;
                let row = PlanetRow {
                    key: "planets.partner",
                    raw: self.below("planets.partner"),
                    gear,
                    distance_m: MM * f64::from(distance_mm),
                    pinned: pinned.clone(),
                    bodies: Vec::new(),
                };
                (row, Origin::Own)
            }
        };
        let ahead_rad = self.ahead_rad(table, row.distance_m)?;
        Ok(Some(Partners {
            row,
            pair_distance_m: MM * f64::from(table.pair_distance_mm),
            ahead_rad,
            from,
        }))
    }

    /// δ.
    fn ahead_rad(&self, table: &PartnerKeys, partner_m: f64) -> Result<f64, InputError> {
        let own_m = MM * f64::from(self.table.centre_distance_mm);
        let apart_m = MM * f64::from(table.pair_distance_mm);
        let cos =
            (own_m * own_m + partner_m * partner_m - apart_m * apart_m) / (2.0 * own_m * partner_m);
        if cos.abs() >= 1.0 {
            let problem = format!(
                "found {} mm; with pins {:.4} and {:.4} mm from the axis allowed are distances between {:.4} and {:.4} mm",
                apart_m / MM,
                own_m / MM,
                partner_m / MM,
                (own_m - partner_m).abs() / MM,
                (own_m + partner_m) / MM
            );
            return Err(self.keys.error("planets.partner.pair_distance_mm", problem));
        }
        Ok(match table.side {
            PartnerSide::Ahead => cos.acos(),
            PartnerSide::Behind => -cos.acos(),
        })
    }

    /// The set of a name, which has simple planets and a ring, and axis and carrier in common with this one.
    fn other_set(
        &self,
        name: &str,
        known: &[Known],
        members: &SetMembers,
    ) -> Result<OtherSet, InputError> {
        let key = "planets.partner.planets_of";
        let refusal = |problem: String| Err(self.keys.error(key, problem));
        let Some(known) = known.iter().find(|known| known.set.name == name) else {
            let names: Vec<&String> = known.iter().map(|known| &known.set.name).collect();
            return refusal(match names.is_empty() {
                true => format!(
                    "found `{name}`, and no planetary set stands before this one; put it first"
                ),
                false => unknown("planetary set before this one", name, &names),
            });
        };
        if known.set.ring_meshes.is_empty() {
            return refusal(format!("the set `{name}` has no ring; give it one"));
        }
        if !known.is_simple {
            return refusal(format!(
                "the planets of `{name}` are stepped or have partners already, allowed are simple ones"
            ));
        }
        if known.set.members.carrier != members.carrier {
            let problem = format!(
                "has the carrier of `{name}`, on which its partners are: give carrier = {{ body = \"{}\" }}",
                known.set.members.carrier
            );
            return Err(self.keys.error("carrier", problem));
        }
        let axis = self.axes * Vector3::z();
        let up_m = known.middle_m - self.middle_m();
        let is_beside = up_m.cross(&axis).norm() > ON_AXIS_M;
        if is_beside || (known.axes * Vector3::z() - axis).norm() > ON_AXIS_M {
            return refusal(format!(
                "the axis of `{name}` is another one; give both sets the same `axis`, and a `position_mm` on it"
            ));
        }
        Ok(OtherSet {
            above_m: up_m.dot(&axis),
            known: known.clone(),
        })
    }

    /// The part of the table at a dotted path.
    pub(super) fn below(&self, path: &str) -> Table {
        let part = path
            .split('.')
            .try_fold(self.raw, |table, key| table.get(key)?.as_table());
        part.cloned().unwrap_or_default()
    }
}
