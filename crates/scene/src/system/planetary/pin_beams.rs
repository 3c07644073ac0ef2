//! Pins that bend: each a beam shaft with a station at every side plate, which is fixed to the carrier, and at every
//! place where the pin holds its planet.

use gearmesh_geometry::InputError;
use nalgebra::Vector3;
use toml::{Table, Value};

use super::expansion::{Expansion, made, numbers};
use super::pins::{Pin, PlanetRow};

/// Places nearer than this are one station \[mm\].
const SAME_MM: f64 = 1e-6;

/// The stations of a pin's beam.
pub(super) struct PinBeam {
    name: String,
    stations_mm: Vec<f64>,
}

impl PinBeam {
    /// The body of the station nearest to a place along the pin.
    pub fn body(&self, z_mm: f64) -> String {
        let apart = |i: &usize| (self.stations_mm[*i] - z_mm).abs();
        let all = 0..self.stations_mm.len();
        let nearest = all.min_by(|a, b| apart(a).total_cmp(&apart(b)));
        format!("{}/{}", self.name, nearest.unwrap_or_default())
    }
}

impl Expansion<'_> {
    /// The beam of the pin of a planet, fixed to the carrier; none of a rigid pin. `holds_mm`: where the pin holds the
    /// planet.
    pub(super) fn add_pin_beam(
        &mut self,
        row: &PlanetRow,
        (carrier, planet, pin): (&str, &str, &Pin),
        holds_mm: &[f64],
    ) -> Result<Option<PinBeam>, InputError> {
        let Some(table) = &row.pinned.pin else {
            return Ok(None);
        };
        let at = |key: &str| format!("{}.pin.{key}", row.key);
        let plates = &table.plates_mm;
        if !(1..=2).contains(&plates.len()) || plates.iter().any(|z| !z.is_finite()) {
            let problem = format!("found {} places, allowed are one or two", plates.len());
            return Err(self.keys.error(&at("plates_mm"), problem));
        }
        let (outer, inner) = (
            *table.diameter_mm,
            table.inner_diameter_mm.map_or(0.0, f64::from),
        );
        if inner >= outer {
            let problem = format!("found {inner}, allowed is less than diameter_mm, {outer}");
            return Err(self.keys.error(&at("inner_diameter_mm"), problem));
        }
        let mut stations_mm = [&plates[..], holds_mm].concat();
        stations_mm.sort_by(f64::total_cmp);
        stations_mm.dedup_by(|a, b| (*a - *b).abs() < SAME_MM);
        if stations_mm.len() < 2 {
            let problem = format!(
                "found {plates:?}, where the pin holds its planet: nothing of it bends; put the plate beside the planet, or remove `pin`"
            );
            return Err(self.keys.error(&at("plates_mm"), problem));
        }
        let beam = PinBeam {
            name: format!("{planet} pin beam"),
            stations_mm,
        };
        let of = |value: Option<f64>, steel: f64| Value::Float(value.unwrap_or(steel));
        let mut model = made([
            ("kind", "beam".into()),
            ("young_GPa", of(table.young_GPa.map(f64::from), 206.0)),
            ("poisson", of(table.poisson.map(f64::from), 0.3)),
        ]);
        let damping = table.damping_s.map(f64::from);
        model.extend(damping.map(|time| ("damping_s".to_owned(), time.into())));
        let sections = beam.stations_mm.len() - 1;
        let axis = self.axes * Vector3::new(pin.lean[0], pin.lean[1], 1.0);
        let shaft: Table = made([
            ("name", beam.name.clone().into()),
            ("model", Value::Table(model)),
            ("origin_mm", numbers(&self.in_world_mm(pin.above_mm(0.0)))),
            ("axis", numbers(axis.as_slice())),
            ("stations_mm", numbers(&beam.stations_mm)),
            ("outer_diameters_mm", numbers(&vec![outer; sections])),
            ("inner_diameters_mm", numbers(&vec![inner; sections])),
            (
                "density_kg_per_m3",
                of(table.density_kg_per_m3.map(f64::from), 7850.0),
            ),
        ]);
        self.push("shaft", shaft);
        for (number, plate_mm) in plates.iter().enumerate() {
            let name = format!("{planet} pin plate {}", number + 1);
            self.add_joint((name, "fixed"), Some(carrier), &beam.body(*plate_mm));
        }
        Ok(Some(beam))
    }
}
