//! Microgeometry in words, for plans and reports.

use super::{FaceEnds, GearMicrogeometry, Microgeometry};
use crate::involute;

/// A number as a person writes it, four decimals at most.
fn short(value: f64) -> f64 {
    (value * 1e4).round() / 1e4
}

fn um(metres: f64) -> f64 {
    short(metres * 1e6)
}

impl Microgeometry {
    /// Its laws, in micrometres and millimetres, on a flank of this base radius \[m\]; none where nothing is removed.
    #[must_use]
    pub fn description(&self, base_radius_m: f64) -> Option<String> {
        let diameter_mm = |roll: f64| short(2e3 * involute::radius_m(roll, base_radius_m));
        let mut laws: Vec<String> = Vec::new();
        for (end, relief) in [("tip", self.tip_relief), ("root", self.root_relief)] {
            if let Some(r) = relief.filter(|r| r.amount_m != 0.0) {
                let (from, shape) = (diameter_mm(r.start_roll_rad), r.shape.name());
                let amount = um(r.amount_m);
                laws.push(format!("{end} relief {amount} um {shape} from {from} mm"));
            }
        }
        if let Some(c) = self.profile_crowning.filter(|c| c.amount_m != 0.0) {
            let about = diameter_mm(c.centre_roll_rad);
            laws.push(format!(
                "profile crowning {} um about {about} mm",
                um(c.amount_m)
            ));
        }
        for (name, amount_m) in [
            ("profile angle", self.profile_angle_m),
            ("lead crowning", self.lead_crowning_m),
            ("flank angle", self.flank_angle_m),
            ("twist", self.twist_m),
        ] {
            if amount_m != 0.0 {
                laws.push(format!("{name} {} um", um(amount_m)));
            }
        }
        if let Some(r) = self.end_relief.filter(|r| r.amount_m != 0.0) {
            let end = match r.ends {
                FaceEnds::Both => "both ends",
                FaceEnds::Positive => "the end towards +z",
                FaceEnds::Negative => "the end towards -z",
            };
            let (amount, shape, length) = (um(r.amount_m), r.shape.name(), short(1e3 * r.length_m));
            laws.push(format!(
                "end relief {amount} um {shape} over {length} mm at {end}"
            ));
        }
        if let Some(table) = &self.topography {
            let ([rolls, heights], [high, low]) = (table.size(), table.extremes_m());
            laws.push(format!(
                "topography of {rolls} x {heights} points, {} to {} um",
                um(low),
                um(high)
            ));
        }
        (!laws.is_empty()).then(|| laws.join(", "))
    }
}

impl GearMicrogeometry {
    /// The laws of both sides, in micrometres and millimetres; none where nothing is removed.
    #[must_use]
    pub fn description(&self, base_radius_m: f64) -> Option<String> {
        let words = |flank: &Microgeometry| flank.description(base_radius_m);
        match (words(&self.right), words(&self.left)) {
            (None, None) => None,
            (Some(right), Some(_)) if self.right == self.left => Some(right),
            (right, left) => {
                let or_none = |side: Option<String>| side.unwrap_or_else(|| "none".to_owned());
                Some(format!(
                    "right flanks {}; left flanks {}",
                    or_none(right),
                    or_none(left)
                ))
            }
        }
    }
}
