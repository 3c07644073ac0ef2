//! Load ratings by ISO 281 (dynamic, C) and ISO 76 (static, C₀), and the fatigue load limit C_u of ISO 281, annex B.
//!
//! Lengths in mm and forces in N inside the formulas, as the standards have them.

use crate::definition::{
    BallBearingKind, BallGeometry, BearingDefinition, BearingGeometry, RollerGeometry,
    StatedRatings,
};
use crate::point_contact::{PointContact, contact_modulus_pa};
use crate::thrust_ratings::{ball_size_factor, thrust_ball_dynamic_n, thrust_ball_static_n};

/// Ratings of a bearing as a whole.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ratings {
    /// C: the radial load under which 90 % of the bearings live for a million turns \[N\].
    pub dynamic_n: f64,
    /// C₀: the radial load that presses the most loaded element with 4200 MPa (balls) or 4000 MPa (rollers) \[N\].
    pub static_n: f64,
    /// C_u: the load at which the most stressed place reaches the fatigue limit \[N\].
    pub fatigue_n: f64,
    /// Number of rows.
    pub rows: usize,
}

/// Peak pressure of a ball that ISO 76 allows \[Pa\].
const BALL_STATIC_PRESSURE_PA: f64 = 4.2e9;

/// f_c of ISO 281, table 2, by the formula that the table is made of (ISO/TR 1281-1): grooves of 0.52 D.
#[must_use]
pub fn ball_dynamic_factor(gamma: f64) -> f64 {
    let ratio = 1.04 * ((1.0 - gamma) / (1.0 + gamma)).powf(1.72);
    // 98.0665 MPa^… × 0.41 with the reduction λ = 0.95, (2r/(2r − D))^0.41 = 26^0.41.
    0.95 * 0.41
        * 98.0665
        * 26.0_f64.powf(0.41)
        * (1.0 + ratio.powf(10.0 / 3.0)).powf(-0.3)
        * gamma.powf(0.3)
        * (1.0 - gamma).powf(1.39)
        / (1.0 + gamma).cbrt()
}

/// f_c of ISO 281 for radial roller bearings (table 7), by its formula (ISO/TR 1281-1) with λν = 0.83.
#[must_use]
pub fn roller_dynamic_factor(gamma: f64) -> f64 {
    let ratio = 1.04 * ((1.0 - gamma) / (1.0 + gamma)).powf(143.0 / 108.0);
    0.83 * 0.377
        * 551.13373
        * (1.0 + ratio.powf(4.5)).powf(-2.0 / 9.0)
        * gamma.powf(2.0 / 9.0)
        * (1.0 - gamma).powf(29.0 / 27.0)
        / (1.0 + gamma).powf(0.25)
}

/// f₀ of ISO 76, computed: the load of one ball at 4200 MPa on the tighter race over 5 D², grooves of 0.52 D inside
/// and 0.53 D outside, steel of 207 GPa, the standard's.
#[must_use]
pub fn ball_static_factor(gamma: f64) -> f64 {
    let modulus = contact_modulus_pa((207e9, 0.3), (207e9, 0.3));
    let load = |conformity: f64, along: f64| {
        let across = 1.0 / conformity;
        let contact = PointContact::new(4.0 - across + along, across + along, modulus);
        // Pressure grows with the cube root of the load.
        let unit = contact.ellipse(1.0).peak_pressure_pa;
        (BALL_STATIC_PRESSURE_PA / unit).powi(3)
    };
    let inner = load(0.52, 2.0 * gamma / (1.0 - gamma));
    let outer = load(0.53, -2.0 * gamma / (1.0 + gamma));
    // Per m² to per mm².
    1e-6 * inner.min(outer) / 5.0
}

/// C of one row of balls \[N\]: b_m f_c (cos α)^0.7 Z^⅔ D^1.8, from 25.4 mm on 3.647 D^1.4.
#[must_use]
pub fn ball_row_dynamic_n(balls: usize, diameter_m: f64, pitch_m: f64, angle_rad: f64) -> f64 {
    let cosine = angle_rad.cos();
    1.3 * ball_dynamic_factor(diameter_m * cosine / pitch_m)
        * cosine.powf(0.7)
        * (balls as f64).powf(2.0 / 3.0)
        * ball_size_factor(diameter_m)
}

/// C₀ of one row of balls \[N\]: f₀ Z D² cos α.
#[must_use]
pub fn ball_row_static_n(balls: usize, diameter_m: f64, pitch_m: f64, angle_rad: f64) -> f64 {
    let cosine = angle_rad.cos();
    ball_static_factor(diameter_m * cosine / pitch_m)
        * balls as f64
        * (diameter_m * 1e3).powi(2)
        * cosine
}

/// C of one row of rollers \[N\]: b_m f_c (L cos α)^(7/9) Z^(3/4) D^(29/27), b_m = 1.1.
#[must_use]
pub fn roller_row_dynamic_n(
    rollers: usize,
    (diameter_m, length_m): (f64, f64),
    pitch_m: f64,
    angle_rad: f64,
) -> f64 {
    let cosine = angle_rad.cos();
    1.1 * roller_dynamic_factor(diameter_m * cosine / pitch_m)
        * (length_m * 1e3 * cosine).powf(7.0 / 9.0)
        * (rollers as f64).powf(0.75)
        * (diameter_m * 1e3).powf(29.0 / 27.0)
}

/// b_m of spherical roller bearings over that of the others, ISO 281, table 6.
pub(crate) const BARREL_SHARE: f64 = 1.15 / 1.1;

/// C₀ of one row of rollers \[N\]: 44 (1 − D cos α/d_m) Z L D cos α.
#[must_use]
pub fn roller_row_static_n(
    rollers: usize,
    (diameter_m, length_m): (f64, f64),
    pitch_m: f64,
    angle_rad: f64,
) -> f64 {
    let cosine = angle_rad.cos();
    44.0 * (1.0 - diameter_m * cosine / pitch_m)
        * rollers as f64
        * (length_m * 1e3)
        * (diameter_m * 1e3)
        * cosine
}

impl Ratings {
    /// Of a definition: what it states, the rest by the standards.
    #[must_use]
    pub fn of(definition: &BearingDefinition) -> Self {
        let rows = definition.arrangement.rows().len();
        let (dynamic_row, static_row, more_rows) = match &definition.geometry {
            BearingGeometry::Ball(g) if g.kind == BallBearingKind::Thrust => (
                thrust_ball_dynamic_n(g.balls, g.ball_diameter_m, g.pitch_diameter_m),
                thrust_ball_static_n(g.balls, g.ball_diameter_m),
                0.7,
            ),
            BearingGeometry::Ball(g) => {
                let angle = nominal_angle_rad(g);
                (
                    ball_row_dynamic_n(g.balls, g.ball_diameter_m, g.pitch_diameter_m, angle),
                    ball_row_static_n(g.balls, g.ball_diameter_m, g.pitch_diameter_m, angle),
                    0.7,
                )
            }
            BearingGeometry::Roller(g) => {
                let size = (g.diameter_m, g.length_m);
                let angle = outer_angle_rad(g);
                // b_m is 1.15 for spherical roller bearings, 1.1 for the others.
                let made = if g.barrel.is_some() {
                    BARREL_SHARE
                } else {
                    1.0
                };
                (
                    made * roller_row_dynamic_n(g.rollers, size, g.pitch_diameter_m, angle),
                    roller_row_static_n(g.rollers, size, g.pitch_diameter_m, angle),
                    7.0 / 9.0,
                )
            }
        };
        let stated = &definition.stated_ratings;
        let count = rows as f64;
        let static_n = stated.static_n.unwrap_or(count * static_row);
        Self {
            dynamic_n: stated
                .dynamic_n
                .unwrap_or(dynamic_row * count.powf(more_rows)),
            static_n,
            fatigue_n: stated
                .fatigue_n
                .unwrap_or_else(|| fatigue_limit_n(&definition.geometry, static_n)),
            rows,
        }
    }
}

impl StatedRatings {
    /// Ratings of a row of bearings whose own these are: 0.7 (balls) or 7/9 (rollers) is the power of their number in
    /// C, ISO 281. C_u is that of all.
    #[must_use]
    pub(crate) fn of_several(
        self,
        bearings: usize,
        geometry: &BearingGeometry,
        fatigue_n: Option<f64>,
    ) -> Self {
        let count = bearings as f64;
        let power = match geometry {
            BearingGeometry::Ball(_) => 0.7,
            BearingGeometry::Roller(_) => 7.0 / 9.0,
        };
        Self {
            dynamic_n: self.dynamic_n.map(|c| c * count.powf(power)),
            static_n: self.static_n.map(|c| c * count),
            fatigue_n,
        }
    }
}

/// C_u = C₀/22 (balls), C₀/8.2 (rollers), less above a pitch diameter of 100 mm; ISO 281, annex B, the simplified
/// estimate.
fn fatigue_limit_n(geometry: &BearingGeometry, static_n: f64) -> f64 {
    let (pitch_m, part, power) = match geometry {
        BearingGeometry::Ball(g) => (g.pitch_diameter_m, 22.0, 0.5),
        BearingGeometry::Roller(g) => (g.pitch_diameter_m, 8.2, 0.3),
    };
    static_n / part * (0.1 / pitch_m).min(1.0).powf(power)
}

/// Contact angle that ISO 281 calls nominal: 0 for deep-groove bearings \[rad\].
pub(crate) fn nominal_angle_rad(g: &BallGeometry) -> f64 {
    match g.kind {
        BallBearingKind::DeepGroove => 0.0,
        BallBearingKind::AngularContact
        | BallBearingKind::FourPoint { .. }
        | BallBearingKind::Thrust => g.free_angle_rad,
    }
}

/// Angle of the outer race of a roller bearing \[rad\].
pub(crate) fn outer_angle_rad(g: &RollerGeometry) -> f64 {
    let of_barrel = g.barrel.map_or(0.0, |b| b.contact_angle_rad);
    g.taper.map_or(of_barrel, |t| t.contact_angle_rad)
}
