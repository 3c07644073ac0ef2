//! Load ratings of thrust ball bearings (contact angle 90°) by ISO 281 (C_a) and ISO 76 (C_0a).
//!
//! ```text
//! C_a = 1.3 f_c Z^⅔ D^1.8 (from 25.4 mm on 3.647 D^1.4),  f_c = 98.0665 · 0.6 · 2^(−0.3) (2f/(2f − 1))^0.41 (D/d_m)^0.3,  f = 0.535
//! C_0a = f₀ Z D²,  f₀ D² the load of a ball at 4200 MPa between grooves of 0.54 D
//! ```
//!
//! After Lundberg and Palmgren as ISO/TR 1281-1 has it, λη = 0.9 (1 − ⅓) at 90°: both races are alike, and every ball
//! carries C_a/Z. The formula gives the values of the table of ISO 281 for 90° (36.7 at D/d_m = 0.01, 73.3 at 0.10).
//! Lengths in mm and forces in N inside.

use crate::point_contact::{PointContact, contact_modulus_pa};

/// C_a of a row of balls between washers \[N\].
#[must_use]
pub fn thrust_ball_dynamic_n(balls: usize, diameter_m: f64, pitch_m: f64) -> f64 {
    let size = ball_size_factor(diameter_m);
    1.3 * thrust_ball_dynamic_factor(diameter_m / pitch_m) * (balls as f64).powf(2.0 / 3.0) * size
}

/// D^1.8, from 25.4 mm on 3.647 D^1.4, D in mm.
pub(crate) fn ball_size_factor(diameter_m: f64) -> f64 {
    match diameter_m * 1e3 {
        d if d <= 25.4 => d.powf(1.8),
        d => 3.647 * d.powf(1.4),
    }
}

/// f_c of ISO 281 for thrust ball bearings of 90°, from D/d_m.
#[must_use]
pub fn thrust_ball_dynamic_factor(ratio: f64) -> f64 {
    let conformity: f64 = 0.535;
    98.0665
        * 0.6
        * 2.0_f64.powf(-0.3)
        * (2.0 * conformity / (2.0 * conformity - 1.0)).powf(0.41)
        * ratio.powf(0.3)
}

/// C_0a of a row of balls between washers \[N\].
#[must_use]
pub fn thrust_ball_static_n(balls: usize, diameter_m: f64) -> f64 {
    thrust_ball_static_factor() * balls as f64 * (diameter_m * 1e3).powi(2)
}

/// f₀ of ISO 76 at 90°, computed: the load of one ball at 4200 MPa over D², grooves of 0.54 D, steel of 207 GPa.
#[must_use]
pub fn thrust_ball_static_factor() -> f64 {
    let modulus = contact_modulus_pa((207e9, 0.3), (207e9, 0.3));
    let across = 1.0 / 0.54;
    let unit = PointContact::new(4.0 - across, across, modulus)
        .ellipse(1.0)
        .peak_pressure_pa;
    1e-6 * (4.2e9 / unit).powi(3)
}
