//! Planets on their pins: places and tilts, bodies, joints and bearings.

use gearmesh_geometry::InputError;
use gearmesh_geometry::input::TableKeys;
use gearmesh_specification::gear_tables::MM;
use gearmesh_specification::system::body::BoreHold;
use gearmesh_specification::system::planetary::{
    PinnedKeys, PlanetDeviationTable, SetBearingTable, SupportWord,
};
use nalgebra::Vector3;
use toml::{Table, Value};

use super::expansion::Expansion;
use super::gears::SetGear;
use super::members::BearingSeat;

/// Where a pin is, in the set's axes.
pub(super) struct Pin {
    /// Its middle at the middle of the set \[mm\].
    at_mm: [f64; 2],
    /// Its axis (t_x, t_y, 1).
    pub lean: [f64; 2],
}

impl Pin {
    /// The point of its axis at a height above the middle of the set \[mm\].
    pub fn above_mm(&self, z_mm: f64) -> Vector3<f64> {
        let ([x, y], [t_x, t_y]) = (self.at_mm, self.lean);
        Vector3::new(x + t_x * z_mm, y + t_y * z_mm, z_mm)
    }
}

/// Planets of a kind, each on a pin: those that mesh with the sun, or their partners.
#[derive(Debug, Clone)]
pub(super) struct PlanetRow {
    /// Where they are stated: `planets`, `planets.partner`.
    pub key: &'static str,
    /// Their table as written.
    pub raw: Table,
    pub gear: SetGear,
    /// Distance of the pins from the axis of the set \[m\].
    pub distance_m: f64,
    /// How the pins hold them.
    pub pinned: PinnedKeys,
    /// Names of their bodies.
    pub bodies: Vec<String>,
}

impl PlanetRow {
    pub fn deviation(&self, planet: usize) -> Option<&PlanetDeviationTable> {
        let mut all = self.pinned.deviation.iter();
        all.find(|deviation| deviation.planet.get() == planet + 1)
    }

    /// That deviations are of planets that there are, and of each once.
    pub fn check_deviations(&self, count: usize, keys: &TableKeys<'_>) -> Result<(), InputError> {
        let deviations = &self.pinned.deviation;
        for (i, deviation) in deviations.iter().enumerate() {
            let number = deviation.planet.get();
            let twice = deviations[..i]
                .iter()
                .any(|other| other.planet == deviation.planet);
            if number > count || twice {
                let problem = match twice {
                    true => format!("planet {number} has a deviation already; join the two"),
                    false => format!("found {number}, the set has planets 1 to {count}"),
                };
                return Err(keys.error(&format!("{}.deviation.{i}.planet", self.key), problem));
            }
        }
        Ok(())
    }

    /// The joint between carrier and planet; none where bearings alone hold it.
    fn joint(&self, keys: &TableKeys<'_>) -> Result<Option<&'static str>, InputError> {
        let refusal =
            |key: &str, problem: &str| Err(keys.error(&format!("{}.{key}", self.key), problem));
        match (self.pinned.support, self.pinned.bearings.is_empty()) {
            (Some(SupportWord::Floating), _) => Ok(Some("planar")),
            (Some(SupportWord::Bearings) | None, false) => Ok(None),
            (Some(SupportWord::Bearings), true) => {
                let problem = "found \"bearings\", which needs bearings; give one or more";
                refusal("support", problem)
            }
            (_, false) => {
                let problem = "is not used by support = \"turning\"; remove it";
                refusal("bearings", problem)
            }
            (_, true) => Ok(Some("revolute")),
        }
    }
}

impl Expansion<'_> {
    /// Where the pin of a planet is.
    fn pin(&self, row: &PlanetRow, (planet, angle_rad): (usize, f64)) -> Pin {
        let (sin, cos) = angle_rad.sin_cos();
        let deviation = row.deviation(planet);
        let of = |part: fn(&PlanetDeviationTable) -> f64| 1e-3 * deviation.map_or(0.0, part);
        let turned = |out: f64, on: f64| [cos * out - sin * on, sin * out + cos * on];
        let out_mm = row.distance_m / MM + of(|d| d.radial_um);
        let [x, y] = turned(out_mm, of(|d| d.tangential_um));
        let shift = self.table.carrier_eccentricity.map_or([0.0; 2], |e| {
            let (sin, cos) = e.direction_deg.to_radians().sin_cos();
            [1e-3 * e.offset_um * cos, 1e-3 * e.offset_um * sin]
        });
        Pin {
            at_mm: [x + shift[0], y + shift[1]],
            lean: turned(of(|d| d.tilt_radial_mrad), of(|d| d.tilt_tangential_mrad)),
        }
    }

    pub(super) fn add_planet(
        &mut self,
        row: &PlanetRow,
        carrier: &str,
        (planet, angle_rad): (usize, f64),
    ) -> Result<(), InputError> {
        let name = &row.bodies[planet];
        let pin = self.pin(row, (planet, angle_rad));
        let axis = Vector3::new(pin.lean[0], pin.lean[1], 1.0);
        self.add_body((name, &row.raw), pin.above_mm(0.0), axis);
        let second = row.raw.get("second").and_then(Value::as_table);
        if let (Some(second), Some(raw)) = (&self.table.planets.1.second, second) {
            let own = format!("{name} second");
            self.add_body((&own, raw), pin.above_mm(second.z_mm), axis);
            self.add_joint((format!("{name} shaft"), "fixed"), Some(name), &own);
        }
        let joined = row.joint(&self.keys)?;
        let bearings = &row.pinned.bearings;
        let holds_mm = bearings.iter().map(|b| b.z_mm).chain(joined.map(|_| 0.0));
        let holds_mm: Vec<f64> = holds_mm.collect();
        let beam = self.add_pin_beam(row, (carrier, name, &pin), &holds_mm)?;
        let holder = |z_mm: f64| match &beam {
            Some(beam) => beam.body(z_mm),
            None => carrier.to_owned(),
        };
        if let Some(kind) = joined {
            self.add_joint((format!("{name} pin"), kind), Some(&holder(0.0)), name);
        }
        let seat = |b: &SetBearingTable| {
            // Rollers that press on the planet's bore run in it as in their outer ring.
            let (body_1, body_2) = match row.pinned.bore {
                Some(BoreHold::Rollers) => (name.clone(), holder(b.z_mm)),
                Some(BoreHold::Bonded | BoreHold::Sliding) | None => (holder(b.z_mm), name.clone()),
            };
            BearingSeat {
                body_1: Some(body_1),
                body_2,
                at_mm: self.in_world_mm(pin.above_mm(b.z_mm)),
            }
        };
        let seats = bearings.iter().map(seat).collect();
        self.add_bearings(name, seats, &row.raw);
        Ok(())
    }
}
