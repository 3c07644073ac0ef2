//! The gears of a planetary set, and whether they fit between each other.

use std::f64::consts::TAU;
use std::path::Path;

use gearmesh_geometry::input::TableKeys;
use gearmesh_geometry::{
    GearDefinition, GearPair, InputError, Misalignment, PairError, ToothGeometry,
};

use super::layout::SetTeeth;
use crate::model_shelf::ModelShelf;
use crate::system::tables::planetary::{MemberTable, PlanetaryTable, SupportWord};
use crate::system::tables::{MM, UM};

/// The teeth of a set.
pub(super) struct SetGears {
    pub sun: Option<ToothGeometry>,
    pub planet: ToothGeometry,
    /// Of stepped planets.
    pub second: Option<ToothGeometry>,
    pub ring: Option<ToothGeometry>,
}

/// The teeth of a gear file or a reduced gear.
pub(super) fn teeth_of(
    path: &Path,
    (keys, key): (&TableKeys<'_>, &str),
    models: &ModelShelf,
) -> Result<ToothGeometry, InputError> {
    let is_gear_file = path.extension().is_some_and(|ending| ending == "toml");
    if !models.knows(path) {
        let problem = format!("the gear {} does not exist", path.display());
        return Err(keys.error(key, problem));
    }
    if !is_gear_file {
        let shelved = models.model(path).map_err(|e| keys.error(key, e))?;
        let definition = shelved.model.input.definition_in(path.display())?;
        return Ok(definition.profile.clone());
    }
    Ok(GearDefinition::read(path)?.profile)
}

impl SetGears {
    pub(super) fn teeth(&self) -> SetTeeth {
        let count = |gear: &Option<ToothGeometry>| gear.as_ref().map(|gear| gear.teeth);
        SetTeeth {
            sun: count(&self.sun),
            planet: self.planet.teeth,
            planet_to_ring: self.to_ring().teeth,
            ring: count(&self.ring),
        }
    }

    fn to_ring(&self) -> &ToothGeometry {
        self.second.as_ref().unwrap_or(&self.planet)
    }

    /// That sun and planet, planet and ring run together at the set's one centre distance, that planets do not touch
    /// each other, and that no pin is displaced by more than the backlash lets through.
    ///
    /// # Errors
    /// [`InputError`] with the number that is missed.
    pub(super) fn check(
        &self,
        table: &PlanetaryTable,
        angles_rad: &[f64],
        keys: &TableKeys<'_>,
    ) -> Result<(), InputError> {
        for (key, gear, is_ring) in [
            ("sun.gear", &self.sun, false),
            ("planets.gear", &Some(self.planet.clone()), false),
            ("planets.second.gear", &self.second, false),
            ("ring.gear", &self.ring, true),
        ] {
            if let Some(gear) = gear
                && gear.internal != is_ring
            {
                let [found, allowed] = match is_ring {
                    true => [
                        "external",
                        "internal ones (a negative number in the gear file)",
                    ],
                    false => ["internal", "external ones"],
                };
                let problem = format!("the gear has {found} teeth, allowed are {allowed}");
                return Err(keys.error(key, problem));
            }
        }
        let distance_m = MM * f64::from(table.centre_distance_mm);
        self.check_neighbours(distance_m, angles_rad, keys)?;
        let mut free_m = 0.0;
        let pairs = [
            (&self.sun, &self.planet, "sun"),
            (&self.ring, self.to_ring(), "ring"),
        ];
        for (central, planet, which) in pairs {
            let Some(central) = central else { continue };
            let pair = GearPair::new(
                planet.clone(),
                central.clone(),
                distance_m,
                Misalignment::default(),
            );
            let pair = pair.map_err(|error: PairError| {
                let problem =
                    format!("planet and {which} do not run together at this distance: {error}");
                keys.error("centre_distance_mm", problem)
            })?;
            free_m += pair.backlash_m();
        }
        let is_rigid = |member: &Option<MemberTable>| {
            let support = member.as_ref().and_then(MemberTable::support);
            matches!(support, Some(SupportWord::Held | SupportWord::Turning))
        };
        if is_rigid(&table.sun) && is_rigid(&table.ring) {
            check_pins(table, free_m, keys)?;
        }
        Ok(())
    }

    /// How far the axes of planets are apart whose tip circles touch \[m\].
    fn planets_apart_m(&self) -> f64 {
        let second_m = self.second.iter().map(|gear| gear.tip_radius_m);
        2.0 * second_m.fold(self.planet.tip_radius_m, f64::max)
    }

    /// How many planets stand at equal angles without touching each other.
    pub(super) fn room(&self, distance_m: f64) -> usize {
        let share = 0.5 * self.planets_apart_m() / distance_m;
        let angle_rad = 2.0 * share.min(1.0).asin();
        (TAU / angle_rad * (1.0 - 1e-12)).floor() as usize
    }

    fn check_neighbours(
        &self,
        distance_m: f64,
        angles_rad: &[f64],
        keys: &TableKeys<'_>,
    ) -> Result<(), InputError> {
        let needed_m = self.planets_apart_m();
        for (i, first) in angles_rad.iter().enumerate() {
            for (k, second) in angles_rad.iter().enumerate().skip(i + 1) {
                let found_m = 2.0 * distance_m * (0.5 * (second - first)).sin().abs();
                if found_m <= needed_m {
                    let problem = format!(
                        "planets {} and {} touch each other: their axes are {:.4} mm apart, their tip circles need more than {:.4} mm; at equal angles \
                         {} planets or fewer have room",
                        i + 1,
                        k + 1,
                        found_m / MM,
                        needed_m / MM,
                        self.room(distance_m)
                    );
                    return Err(keys.error("planets", problem));
                }
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
    let deviations = &table.planets.deviation;
    // Planets that no table names stand where they should.
    let count = table.planets.count.map_or(0, |n| n.get());
    let count = count.max(table.planets.angles_deg.as_ref().map_or(0, Vec::len));
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
