//! The equivalent load of ISO 281 for two rows of angular contact, of tapered rollers or of barrels that carry axial
//! loads both ways.

use crate::definition::{BallBearingKind, BearingDefinition, BearingGeometry};
use crate::ratings::outer_angle_rad;

/// ISO 281, table 3, double-row bearings: α in degrees, Y₁ (X₁ = 1), X₂, Y₂, e.
const ANGULAR_CONTACT: [[f64; 5]; 6] = [
    [20.0, 1.09, 0.70, 1.63, 0.57],
    [25.0, 0.92, 0.67, 1.41, 0.68],
    [30.0, 0.78, 0.63, 1.24, 0.80],
    [35.0, 0.66, 0.60, 1.07, 0.95],
    [40.0, 0.55, 0.57, 0.93, 1.14],
    [45.0, 0.47, 0.54, 0.81, 1.34],
];

/// P = F_r + Y₁ F_a up to F_a = e F_r, X₂ F_r + Y₂ F_a above; rollers Y₁ = 0.45 cot α, X₂ = 0.67, Y₂ = 0.67 cot α, e =
/// 1.5 tan α. None for tandem rows and angles that the standard does not list.
pub(crate) fn equivalent_of_two_rows_n(
    definition: &BearingDefinition,
    (radial_n, axial_n): (f64, f64),
) -> Option<f64> {
    if !definition.arrangement.is_opposed() {
        return None;
    }
    let [first, second_radial, second, limit] = match &definition.geometry {
        BearingGeometry::Ball(g) if g.kind == BallBearingKind::AngularContact => {
            factors(g.free_angle_rad.to_degrees())?
        }
        BearingGeometry::Ball(_) => return None,
        BearingGeometry::Roller(g) if g.taper.is_none() && g.barrel.is_none() => return None,
        BearingGeometry::Roller(g) => {
            let tangent = outer_angle_rad(g).tan();
            [0.45 / tangent, 0.67, 0.67 / tangent, 1.5 * tangent]
        }
    };
    let equivalent_n = if axial_n <= limit * radial_n {
        radial_n + first * axial_n
    } else {
        second_radial * radial_n + second * axial_n
    };
    (equivalent_n > 0.0).then_some(equivalent_n)
}

/// Y₁, X₂, Y₂, e between the rows of the table.
fn factors(degrees: f64) -> Option<[f64; 4]> {
    let upper = ANGULAR_CONTACT
        .iter()
        .position(|row| row[0] >= degrees - 1e-9)?;
    if degrees < ANGULAR_CONTACT[0][0] - 1e-9 {
        return None;
    }
    let (a, b) = (
        &ANGULAR_CONTACT[upper.saturating_sub(1)],
        &ANGULAR_CONTACT[upper],
    );
    let share = if b[0] > a[0] {
        (degrees - a[0]) / (b[0] - a[0])
    } else {
        0.0
    };
    Some(std::array::from_fn(|i| {
        a[i + 1] + share * (b[i + 1] - a[i + 1])
    }))
}
