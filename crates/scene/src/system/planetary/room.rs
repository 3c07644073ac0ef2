//! Planets of a set beside each other: whether they touch, and how many have room.

use std::f64::consts::TAU;

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::TableKeys;
use gearmesh_specification::gear_tables::MM;

use super::gears::SetGears;
use super::partners::Partners;

/// Planets of a set beside each other.
pub(super) struct Room<'a> {
    /// Distance of the axes from that of the set, and radius of the tip circles: planets.
    planets_m: [f64; 2],
    /// The same of their partners, and how far these are ahead.
    partners: Option<([f64; 2], &'a Partners)>,
}

impl<'a> Room<'a> {
    pub(super) fn of(gears: &SetGears, distance_m: f64, partners: Option<&'a Partners>) -> Self {
        let second_m = gears.second.iter().map(|gear| gear.teeth.tip_radius_m);
        let tip_m = second_m.fold(gears.planet.teeth.tip_radius_m, f64::max);
        let of = |partners: &'a Partners| {
            let row = &partners.row;
            ([row.distance_m, row.gear.teeth.tip_radius_m], partners)
        };
        Self {
            planets_m: [distance_m, tip_m],
            partners: partners.map(of),
        }
    }

    /// How many planets, or pairs of them, stand at equal angles without touching each other.
    pub(super) fn equal_angles(&self) -> usize {
        let [distance_m, tip_m] = self.planets_m;
        let angle_rad = 2.0 * (tip_m / distance_m).min(1.0).asin();
        let most = (TAU / angle_rad * (1.0 - 1e-12)).floor() as usize;
        let fits = |count: &usize| {
            let angle = |n| n as f64 / *count as f64 * TAU;
            let angles: Vec<f64> = (0..*count).map(angle).collect();
            self.touching(&angles).is_none()
        };
        match self.partners {
            Some(_) => (1..=most).rev().find(fits).unwrap_or(0),
            None => most,
        }
    }

    /// Two planets that touch each other: their names, how far their axes are apart, and how far they must be \[m\].
    fn touching(&self, angles_rad: &[f64]) -> Option<(String, [f64; 2])> {
        let planets = angles_rad
            .iter()
            .map(|angle| ("planet", *angle, self.planets_m));
        let mut all: Vec<_> = planets.enumerate().collect();
        if let Some((radii_m, partners)) = self.partners {
            let partners = angles_rad
                .iter()
                .map(|angle| ("partner", angle + partners.ahead_rad, radii_m));
            all.extend(partners.enumerate());
        }
        for (i, (n, (kind, angle, [arm_m, tip_m]))) in all.iter().enumerate() {
            for (m, (other, other_angle, [other_arm_m, other_tip_m])) in &all[i + 1..] {
                if n == m {
                    continue;
                }
                let half = (0.5 * (other_angle - angle)).sin();
                let found_m =
                    (arm_m - other_arm_m).hypot(2.0 * (arm_m * other_arm_m).sqrt() * half);
                let needed_m = tip_m + other_tip_m;
                if found_m <= needed_m {
                    let (n, m) = (n + 1, m + 1);
                    let names = match kind == other {
                        true => format!("{kind}s {n} and {m}"),
                        false => format!("{kind} {n} and {other} {m}"),
                    };
                    return Some((names, [found_m, needed_m]));
                }
            }
        }
        None
    }

    pub(super) fn check(&self, angles_rad: &[f64], keys: &TableKeys<'_>) -> Result<(), InputError> {
        let Some((names, [found_m, needed_m])) = self.touching(angles_rad) else {
            return Ok(());
        };
        let kind = if self.partners.is_some() {
            "pairs"
        } else {
            "planets"
        };
        let problem = format!(
            "{names} touch each other: their axes are {:.4} mm apart, their tip circles need more than {:.4} mm; at equal angles \
             {} {kind} or fewer have room",
            found_m / MM,
            needed_m / MM,
            self.equal_angles()
        );
        Err(keys.error("planets", problem))
    }
}
