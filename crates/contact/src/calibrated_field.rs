//! What the calibrated local contact knows of one flank: the near field that its mesh lacks.

use crate::profile_shares::{ProfilePlace, SHARES};
use gearmesh_model::{BevelNearField, ContactCurve, ReducedGear, ReducedGearError};

/// The calibration of one flank.
#[derive(Debug, Clone)]
pub(crate) struct CalibratedField {
    pub half_width_m: f64,
    stations: usize,
    /// One of a cylindrical gear; of a bevel gear those along the tooth.
    sections: Vec<CalibratedSection>,
    /// The section below each slice's middle, and the share of the one above; empty where there is one section.
    between: Vec<(usize, f64)>,
}

/// A section of a tooth.
#[derive(Debug, Clone)]
struct CalibratedSection {
    contact: ContactCurve,
    /// W, `[profile station][profile station]` \[m²/N\].
    mesh_m2_per_n: Vec<f64>,
}

impl CalibratedField {
    pub fn new(gear: &ReducedGear, flank_index: usize) -> Result<Self, ReducedGearError> {
        let field = gear.calibration()?;
        let stations = gear.grid.roll_angles_rad.len();
        let size = stations * stations;
        Ok(Self {
            half_width_m: field.half_width_m,
            stations,
            sections: vec![CalibratedSection {
                contact: field.contact_curve(gear.signed_base_radius_m()),
                mesh_m2_per_n: field.mesh_m2_per_n[flank_index * size..][..size].to_vec(),
            }],
            between: Vec::new(),
        })
    }

    /// That of a bevel tooth, for slices whose middles stand at these places along it \[m\].
    pub fn of_bevel(
        field: &BevelNearField,
        flank_index: usize,
        stations: usize,
        middles_m: impl Iterator<Item = f64>,
    ) -> Self {
        let at = &field.sections_m;
        let section = |number: usize| CalibratedSection {
            contact: field.contact_curve(flank_index, number),
            mesh_m2_per_n: field.mesh_block(flank_index, number, stations).to_vec(),
        };
        let between = middles_m.map(|middle_m| between(at, middle_m));
        Self {
            half_width_m: field.half_width_m,
            stations,
            sections: (0..at.len()).map(section).collect(),
            between: if at.len() > 1 {
                between.collect()
            } else {
                Vec::new()
            },
        }
    }

    /// c₀ − share · w_h with w_h = Φᵀ W Φ, of a slice.
    pub fn missing(
        &self,
        roll_rad: f64,
        place: &ProfilePlace,
        (slice, share): (usize, f64),
    ) -> Missing {
        let Some(&(low, above)) = self.between.get(slice) else {
            return self.missing_in(0, roll_rad, place, share);
        };
        let [a, b] = [low, low + 1].map(|n: usize| self.missing_in(n, roll_rad, place, share));
        let mixed = |a: f64, b: f64| (1.0 - above) * a + above * b;
        Missing {
            value: mixed(a.value, b.value),
            by_roll: mixed(a.by_roll, b.by_roll),
            by_share: mixed(a.by_share, b.by_share),
        }
    }

    fn missing_in(
        &self,
        section: usize,
        roll_rad: f64,
        place: &ProfilePlace,
        share: f64,
    ) -> Missing {
        let section = &self.sections[section];
        let (contact, rate) = section.contact.at(roll_rad);
        let (mut mesh, mut mesh_rate) = (0.0, 0.0);
        let (shares, rates) = (place.all_shares(), place.all_rates());
        for a in 0..SHARES.min(self.stations) {
            let first = (place.first() + a) * self.stations + place.first();
            let row = &section.mesh_m2_per_n[first..];
            for b in 0..SHARES.min(self.stations) {
                mesh += shares[a] * shares[b] * row[b];
                mesh_rate += (rates[a] * shares[b] + shares[a] * rates[b]) * row[b];
            }
        }
        Missing {
            value: contact - share * mesh,
            by_roll: rate - share * mesh_rate,
            by_share: -mesh,
        }
    }
}

/// The section below a place and the share of the one above; held at the ends.
pub(crate) fn between(sections_m: &[f64], middle_m: f64) -> (usize, f64) {
    let last = sections_m.len() - 1;
    let low = sections_m
        .partition_point(|s| *s <= middle_m)
        .clamp(1, last.max(1))
        - 1;
    let high = (low + 1).min(last);
    let length = sections_m[high] - sections_m[low];
    let share = if length > 0.0 {
        ((middle_m - sections_m[low]) / length).clamp(0.0, 1.0)
    } else {
        0.0
    };
    (low, share)
}

/// What the mesh lacks of a slice's own deflection \[m²/N\], and its derivatives by the roll angle and the share of the
/// width.
pub(crate) struct Missing {
    pub value: f64,
    pub by_roll: f64,
    pub by_share: f64,
}
