//! Static safety by ISO 76:2006: s₀ = C₀/P₀ with the static equivalent load
//!
//! ```text
//! P₀ = max(X₀ F_r + Y₀ F_a, F_r)
//! ```
//!
//! | bearing | X₀, Y₀ of one row, or of rows in tandem | of two rows O or X |
//! | --- | --- | --- |
//! | deep groove | 0.6, 0.5 | |
//! | angular contact, 5, 10, … 45 degrees | 0.5 and 0.52, 0.5, 0.46, 0.42, 0.38, 0.33, 0.29, 0.26, 0.22 | 1, twice as much |
//! | tapered roller | 0.5, 0.22 cot α | 1, 0.44 cot α |
//! | cylindrical roller | 1, 0 | |
//!
//! Moments, clearance and preload are not in it: largest pressures say what they do.

use crate::definition::{BallBearingKind, BearingDefinition, BearingGeometry};
use crate::life::between;
use crate::ratings::{Ratings, nominal_angle_rad, outer_angle_rad};

/// s₀ and what it is made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StaticSafety {
    /// P₀ \[N\].
    pub equivalent_n: f64,
    /// s₀ = C₀/P₀; infinite without load.
    pub factor: f64,
}

/// Y₀ of single rows of balls by degrees.
const BY_ANGLE: [[f64; 2]; 9] = [
    [5.0, 0.52],
    [10.0, 0.50],
    [15.0, 0.46],
    [20.0, 0.42],
    [25.0, 0.38],
    [30.0, 0.33],
    [35.0, 0.29],
    [40.0, 0.26],
    [45.0, 0.22],
];

/// Degrees by which a contact angle may lie beside the ends of the table.
const BESIDE_DEG: f64 = 0.5;

impl StaticSafety {
    /// Under a force on the inner ring; none where ISO 76 gives no factors: four-point bearings, thrust bearings with a
    /// radial load, contact angles of balls outside 5 to 45 degrees.
    #[must_use]
    pub fn of(
        definition: &BearingDefinition,
        ratings: &Ratings,
        force_n: [f64; 3],
    ) -> Option<Self> {
        let opposed = definition.arrangement.is_opposed();
        let inclined = |y: f64| if opposed { (1.0, 2.0 * y) } else { (0.5, y) };
        let (x, y) = match &definition.geometry {
            BearingGeometry::Ball(g) => match g.kind {
                BallBearingKind::DeepGroove => (0.6, 0.5),
                BallBearingKind::AngularContact => {
                    inclined(axial_factor(nominal_angle_rad(g).to_degrees())?)
                }
                BallBearingKind::FourPoint { .. } => return None,
                // P₀ₐ = F_a of 90°.
                BallBearingKind::Thrust => (0.0, 1.0),
            },
            BearingGeometry::Roller(g) if outer_angle_rad(g) == 0.0 => (1.0, 0.0),
            BearingGeometry::Roller(g) => inclined(0.22 / outer_angle_rad(g).tan()),
        };
        let radial = force_n[0].hypot(force_n[1]);
        let thrust = matches!(&definition.geometry, BearingGeometry::Ball(g) if g.kind == BallBearingKind::Thrust);
        if thrust && radial > 1e-6 * force_n[2].abs() {
            return None;
        }
        let equivalent_n = (x * radial + y * force_n[2].abs()).max(radial);
        Some(Self {
            equivalent_n,
            factor: ratings.static_n / equivalent_n,
        })
    }
}

/// Y₀ between the angles of the table.
pub(crate) fn axial_factor(degrees: f64) -> Option<f64> {
    let [first, last] = [BY_ANGLE[0][0], BY_ANGLE[BY_ANGLE.len() - 1][0]];
    if !(first - BESIDE_DEG..=last + BESIDE_DEG).contains(&degrees) {
        return None;
    }
    Some(between(&BY_ANGLE, degrees)[1])
}
