//! Planets on their pins: places and tilts, bodies, joints and bearings.

use gearmesh_geometry::InputError;
use nalgebra::Vector3;
use toml::Value;

use super::expansion::{BODY_KEYS, Expansion, copied, made, numbers};
use crate::system::tables::body::BoreHold;
use crate::system::tables::planetary::{PlanetDeviationTable, SetBearingTable, SupportWord};

/// Where a pin is, in the set's axes.
struct Pin {
    /// Its middle at the sun's mid-face \[mm\].
    at_mm: [f64; 2],
    /// Its axis (t_x, t_y, 1).
    lean: [f64; 2],
}

impl Pin {
    /// The point of its axis at a height above the sun's mid-face \[mm\].
    fn above_mm(&self, z_mm: f64) -> Vector3<f64> {
        let ([x, y], [t_x, t_y]) = (self.at_mm, self.lean);
        Vector3::new(x + t_x * z_mm, y + t_y * z_mm, z_mm)
    }
}

impl Expansion<'_> {
    pub(super) fn deviation(&self, planet: usize) -> Option<&PlanetDeviationTable> {
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
        Pin {
            at_mm: [x + shift[0], y + shift[1]],
            lean: turned(of(|d| d.tilt_radial_mrad), of(|d| d.tilt_tangential_mrad)),
        }
    }

    pub(super) fn add_planet(
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
            let at_mm = self.in_world_mm(pin.above_mm(z_mm));
            body.insert("position_mm".to_owned(), numbers(&at_mm));
            let cardan = self.cardan_deg(Vector3::new(pin.lean[0], pin.lean[1], 1.0));
            body.extend(cardan.map(|cardan| ("cardan_deg".to_owned(), cardan)));
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
        let place = |b: &SetBearingTable| self.in_world_mm(pin.above_mm(b.z_mm));
        let places = planets.bearings.iter().map(place);
        // Rollers that press on the planet's bore run in it as in their outer ring.
        let ends = match planets.bore {
            Some(BoreHold::Rollers) => (Some(name), carrier),
            Some(BoreHold::Bonded | BoreHold::Sliding) | None => (Some(carrier), name),
        };
        self.add_bearings(name, ends, places.collect(), &raw);
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
}
