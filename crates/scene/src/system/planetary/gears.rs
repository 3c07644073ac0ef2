//! The gears of a planetary set, and whether they fit between each other.

use std::path::Path;

use gearmesh_geometry::input::TableKeys;
use gearmesh_geometry::{
    GearDefinition, GearPair, InputError, Misalignment, PairError, ToothGeometry,
};
use gearmesh_specification::gear_tables::{MM, UM};
use gearmesh_specification::system::planetary::{MemberTable, PlanetaryTable, SupportWord};

use super::layout::SetTeeth;
use super::partners::{OtherSet, Partners};
use super::room::Room;
use crate::model_shelf::ModelShelf;

/// A gear of a set.
#[derive(Debug, Clone)]
pub(super) struct SetGear {
    pub teeth: ToothGeometry,
    face_width_m: f64,
}

/// The gears of a set.
#[derive(Debug, Clone)]
pub(super) struct SetGears {
    pub sun: Option<SetGear>,
    pub planet: SetGear,
    /// Of stepped planets.
    pub second: Option<SetGear>,
    pub ring: Option<SetGear>,
}

/// Mid-faces of sun and ring above that of the planets \[m\].
#[derive(Debug, Clone, Copy)]
pub(super) struct Heights {
    pub sun_m: f64,
    pub ring_m: f64,
}

impl SetGear {
    /// That of a gear file or a reduced gear.
    pub fn read(
        path: &Path,
        (keys, key): (&TableKeys<'_>, &str),
        models: &ModelShelf,
    ) -> Result<Self, InputError> {
        let is_gear_file = path.extension().is_some_and(|ending| ending == "toml");
        if !models.knows(path) {
            let problem = format!("the gear {} does not exist", path.display());
            return Err(keys.error(key, problem));
        }
        let of = |definition: &GearDefinition| Self {
            teeth: definition.profile.clone(),
            face_width_m: definition.tooth.face_width_m,
        };
        if !is_gear_file {
            let shelved = models.model(path).map_err(|e| keys.error(key, e))?;
            return Ok(of(shelved.model.input.definition_in(path.display())?));
        }
        Ok(of(&GearDefinition::read(path)?))
    }

    /// Whether its face is beside that of another gear, whose mid-face is above its own by so much.
    fn is_beside(&self, other: &Self, above_m: f64) -> bool {
        above_m.abs() < 0.5 * (self.face_width_m + other.face_width_m)
    }
}

impl SetGears {
    /// Numbers of teeth; `partner` is that of meshed planets.
    pub(super) fn teeth(&self, partners: Option<&Partners>) -> SetTeeth {
        let count = |gear: &SetGear| gear.teeth.teeth;
        let to_ring = partners.map_or(self.to_ring(), |partners| &partners.row.gear);
        let other = partners.and_then(Partners::other);
        let others = other.and_then(|other| other.known.gears.ring.as_ref());
        let ring = self.ring.as_ref().or(others);
        SetTeeth {
            sun: self.sun.as_ref().map(count),
            planet: count(&self.planet),
            planet_to_ring: count(to_ring),
            is_meshed: partners.is_some(),
            ring: ring.map(count),
        }
    }

    fn to_ring(&self) -> &SetGear {
        self.second.as_ref().unwrap_or(&self.planet)
    }

    /// That gears in mesh run together at their distances, that gears not in mesh do not touch each other, and that no
    /// pin is displaced by more than the backlash lets through (of sets whose planets have no partners).
    ///
    /// # Errors
    /// [`InputError`] with the number that is missed.
    pub(super) fn check(
        &self,
        table: &PlanetaryTable,
        (partners, heights): (Option<&Partners>, Heights),
        angles_rad: &[f64],
        keys: &TableKeys<'_>,
    ) -> Result<(), InputError> {
        self.check_kinds(partners, keys)?;
        let distance_m = MM * f64::from(table.centre_distance_mm);
        let room = Room::of(self, distance_m, partners);
        room.check(angles_rad, keys)?;
        let key = "centre_distance_mm";
        let own = (&self.planet, distance_m, key);
        let to_ring = match partners {
            Some(own) => {
                let key = "planets.partner.centre_distance_mm";
                (
                    (&own.row.gear, own.row.distance_m, key),
                    ["partner", "ring"],
                )
            }
            None => ((self.to_ring(), distance_m, key), ["planet", "ring"]),
        };
        let sun = self.sun.as_ref().map(|sun| (sun, own, ["planet", "sun"]));
        let ring = self.ring.as_ref();
        let ring = ring.map(|ring| (ring, to_ring.0, to_ring.1));
        let pair = partners.map(|p| {
            let key = "planets.partner.pair_distance_mm";
            let to_pair = (&self.planet, p.pair_distance_m, key);
            (&p.row.gear, to_pair, ["planet", "partner"])
        });
        let mut free_m = 0.0;
        let all = [sun, ring, pair].into_iter().flatten();
        for (mate, (planet, distance_m, key), [one, other]) in all {
            let teeth = (planet.teeth.clone(), mate.teeth.clone());
            let pair = GearPair::new(teeth.0, teeth.1, distance_m, Misalignment::default());
            let pair = pair.map_err(|error: PairError| {
                let problem =
                    format!("{one} and {other} do not run together at this distance: {error}");
                keys.error(key, problem)
            })?;
            free_m += pair.backlash_m();
        }
        if let Some(partners) = partners {
            return self.check_beside(distance_m, partners, heights, keys);
        }
        let is_rigid = |member: &Option<MemberTable>| {
            let held = member.as_ref().and_then(MemberTable::support);
            matches!(held, Some(SupportWord::Held | SupportWord::Turning))
        };
        if is_rigid(&table.sun) && is_rigid(&table.ring) {
            check_pins(table, free_m, keys)?;
        }
        Ok(())
    }

    /// That the ring alone has internal teeth.
    fn check_kinds(
        &self,
        partners: Option<&Partners>,
        keys: &TableKeys<'_>,
    ) -> Result<(), InputError> {
        let own = partners.filter(|partners| partners.other().is_none());
        let own = own.map(|partners| partners.row.gear.clone());
        for (key, gear, is_ring) in [
            ("sun.gear", &self.sun, false),
            ("planets.gear", &Some(self.planet.clone()), false),
            ("planets.second.gear", &self.second, false),
            ("planets.partner.gear", &own, false),
            ("ring.gear", &self.ring, true),
        ] {
            if let Some(gear) = gear
                && gear.teeth.internal != is_ring
            {
                let problem = match is_ring {
                    true => {
                        "the gear has external teeth, allowed are internal ones (a negative number in the gear file)"
                    }
                    false => "the gear has internal teeth, allowed are external ones",
                };
                return Err(keys.error(key, problem));
            }
        }
        Ok(())
    }

    /// That a sun does not touch planets, nor a ring, with which it is not in mesh, where their faces are beside each
    /// other.
    fn check_beside(
        &self,
        distance_m: f64,
        partners: &Partners,
        heights: Heights,
        keys: &TableKeys<'_>,
    ) -> Result<(), InputError> {
        let (planets, partner) = ((&self.planet, distance_m), &partners.row);
        let other = partners.other();
        // Partners, and what is of the set to which they belong, are above the planets of this one by so much.
        let above_m = other.map_or(0.0, |other| other.above_m);
        let (ring, ring_m) = match other {
            Some(other) => (
                &other.known.gears.ring,
                above_m + other.known.heights.ring_m,
            ),
            None => (&self.ring, heights.ring_m),
        };
        let partner = (&partner.gear, partner.distance_m);
        let sun_m = heights.sun_m - above_m;
        let mut beside = vec![
            (&self.sun, partner, sun_m, ["the partners", "the sun"]),
            (ring, planets, ring_m, ["the planets", "the ring"]),
        ];
        if let Some(OtherSet { known, .. }) = other {
            let (sun, sun_m) = (&known.gears.sun, above_m + known.heights.sun_m);
            beside.push((sun, planets, sun_m, ["the planets", "the other sun"]));
        }
        for (central, (planet, axes_m), height_m, [one, two]) in beside {
            let is_beside = |gear: &&SetGear| gear.is_beside(planet, height_m);
            let Some(central) = central.as_ref().filter(is_beside) else {
                continue;
            };
            let (tip_m, own_m) = (central.teeth.tip_radius_m, planet.teeth.tip_radius_m);
            let clear_m = match central.teeth.internal {
                true => tip_m - axes_m - own_m,
                false => axes_m - tip_m - own_m,
            };
            if clear_m <= 0.0 {
                let problem = format!(
                    "{one} reach {:.4} mm into {two}, with which they do not mesh: axes {:.4} mm apart, tip diameters {:.4} and {:.4} mm; change distances \
                     or teeth, or set the faces apart",
                    -clear_m / MM,
                    axes_m / MM,
                    2.0 * own_m / MM,
                    2.0 * tip_m / MM
                );
                return Err(keys.error("planets.partner", problem));
            }
        }
        Ok(())
    }
}

/// That sun and ring, which turn about fixed axes, can be turned with all planets between them. Let j_s and j_r be the
/// backlash of both meshes along the pitch circles, a pin displaced by t along the turn, the sun turned by x and the
/// planet by y on its own circle. Its teeth are free in both meshes where |t + y − x| ≤ j_s/2 and |t − y| ≤ j_r/2,
/// hence where
/// |2t − x| ≤ (j_s + j_r)/2. Two planets have the same x: 2 |t_1 − t_2| ≤ j_s + j_r, and thinner teeth add to it.
fn check_pins(table: &PlanetaryTable, free_m: f64, keys: &TableKeys<'_>) -> Result<(), InputError> {
    let deviations = &table.planets.0.deviation;
    // Planets that no table names stand where they should.
    let count = table.planets.1.count.map_or(0, |n| n.get());
    let count = count.max(table.planets.1.angles_deg.as_ref().map_or(0, Vec::len));
    let others = (deviations.len() < count).then_some((0.0, 0.0));
    let all = deviations.iter().map(|d| (d.tangential_um, d.removed_um));
    let all: Vec<(f64, f64)> = all.chain(others).collect();
    for (i, one) in deviations.iter().enumerate() {
        for other in &all {
            let found_m = 2.0 * UM * (one.tangential_um - other.0).abs();
            // Along the normal, somewhat less than along the pitch circle.
            let allowed_m = free_m + 2.0 * UM * (one.removed_um + other.1);
            if found_m > allowed_m {
                let problem = format!(
                    "found {} um, {:.1} um from another pin: twice that is more than the backlash of sun and ring mesh together, {:.1} um on the pitch \
                     circles, and the set cannot be turned; give the gears more backlash or move the pin by less than {:.1} um",
                    one.tangential_um,
                    0.5 * found_m / UM,
                    allowed_m / UM,
                    0.5 * allowed_m / UM
                );
                return Err(keys.error(&format!("planets.deviation.{i}.tangential_um"), problem));
            }
        }
    }
    Ok(())
}
