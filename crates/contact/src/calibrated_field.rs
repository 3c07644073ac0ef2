//! What the calibrated local contact knows of one flank: the near field that its mesh lacks.

use crate::profile_shares::{ProfilePlace, SHARES};
use gearmesh_model::{ContactCurve, ReducedGear, ReducedGearError};

/// The calibration of one flank.
#[derive(Debug, Clone)]
pub(crate) struct CalibratedField {
    pub half_width_m: f64,
    contact: ContactCurve,
    /// W, `[roll station][roll station]` \[m²/N\].
    mesh_m2_per_n: Vec<f64>,
    stations: usize,
}

impl CalibratedField {
    pub fn new(gear: &ReducedGear, flank_index: usize) -> Result<Self, ReducedGearError> {
        let field = gear.calibration()?;
        let stations = gear.grid.roll_angles_rad.len();
        let size = stations * stations;
        Ok(Self {
            half_width_m: field.half_width_m,
            contact: field.contact_curve(gear.base_radius_m),
            mesh_m2_per_n: field.mesh_m2_per_n[flank_index * size..][..size].to_vec(),
            stations,
        })
    }

    /// c₀ − share · w_h with w_h = Φᵀ W Φ.
    pub fn missing(&self, roll_rad: f64, place: &ProfilePlace, share: f64) -> Missing {
        let (contact, rate) = self.contact.at(roll_rad);
        let (mut mesh, mut mesh_rate) = (0.0, 0.0);
        let (shares, rates) = (place.all_shares(), place.all_rates());
        for a in 0..SHARES.min(self.stations) {
            let row = &self.mesh_m2_per_n[(place.first() + a) * self.stations + place.first()..];
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

/// What the mesh lacks of a slice's own deflection \[m²/N\], and its derivatives by the roll angle and the share of the width.
pub(crate) struct Missing {
    pub value: f64,
    pub by_roll: f64,
    pub by_share: f64,
}
