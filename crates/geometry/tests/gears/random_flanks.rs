//! The involute by its roll angle, and microgeometry, at any numbers.

use crate::property_cases::cases;
use gearmesh_geometry::Microgeometry;
use gearmesh_geometry::involute::{involute_function, polar_angle_rad, radius_m, roll_angle_rad};
use gearmesh_geometry::microgeometry::{ProfileCrowning, ReliefShape, TipRelief};
use proptest::prelude::*;

/// All amounts of either sign; roll angles in order.
fn microgeometry() -> impl Strategy<Value = Microgeometry> {
    let amount = || -30e-6f64..30e-6;
    (
        0.2f64..1.2,
        5e-3f64..0.1,
        [amount(), amount(), amount(), amount()],
        [0.1f64..0.95, 0.1f64..0.95],
        0..4,
    )
        .prop_map(|(tip, width, amounts, starts, kinds)| Microgeometry {
            tip_roll_rad: tip,
            face_width_m: width,
            profile_crowning: Some(ProfileCrowning {
                amount_m: amounts[0],
                centre_roll_rad: starts[0] * tip,
            }),
            tip_relief: (kinds < 3).then_some(TipRelief {
                amount_m: amounts[1],
                start_roll_rad: starts[1] * tip,
                shape: if kinds < 2 {
                    ReliefShape::Parabolic
                } else {
                    ReliefShape::Linear
                },
            }),
            lead_crowning_m: amounts[2],
            flank_angle_m: amounts[3],
        })
}

proptest! {
    #![proptest_config(cases(1000))]

    #[test]
    fn the_involute_and_its_inverse_agree(base in 1e-4f64..2.0, roll in 1e-4f64..4.0) {
        let radius = radius_m(roll, base);
        // Close to the base circle the inverse loses digits: dξ/dr = r/(r_b² ξ).
        let lost = 4.0 * f64::EPSILON * (1.0 + 1.0 / (roll * roll));
        prop_assert!((roll_angle_rad(radius, base) / roll - 1.0).abs() < lost);
        // inv of the profile angle, which cos α_y = r_b/r gives as well.
        let inv = involute_function((base / radius).acos());
        let polar = polar_angle_rad(roll);
        prop_assert!((inv - polar).abs() < 1e-11 + 1e-13 * roll);
        // The thread: from the base circle at the angle ξ, a length r_b ξ along the tangent.
        let (sin, cos) = roll.sin_cos();
        let thread = [base * (cos + roll * sin), base * (sin - roll * cos)];
        let (s, c) = polar.sin_cos();
        prop_assert!((thread[0] - radius * c).hypot(thread[1] - radius * s) < 1e-13 * radius);
    }

    /// The slopes are the derivatives, and no more is added anywhere on the flank than the bound says.
    #[test]
    fn microgeometry_has_its_slopes_and_its_bound(
        flank in microgeometry(), u in 0.0f64..1.0, v in -0.5f64..0.5,
    ) {
        let (roll, z) = (u * flank.tip_roll_rad, v * flank.face_width_m);
        prop_assert!(flank.removed_m(roll, z) >= -flank.most_added_m() - 1e-18);
        let corner = flank.tip_relief.map_or(f64::INFINITY, |r| (r.start_roll_rad - roll).abs());
        prop_assume!(corner > 2e-5);
        let (d_roll, d_z) = (1e-5, 1e-5 * flank.face_width_m);
        let along_roll = (flank.removed_m(roll + d_roll, z) - flank.removed_m(roll - d_roll, z)) / (2.0 * d_roll);
        let along_axis = (flank.removed_m(roll, z + d_z) - flank.removed_m(roll, z - d_z)) / (2.0 * d_z);
        // The functions are parabolas: central differences are exact but for rounding of amounts below 1e-2 m.
        let scale = 30e-6 / flank.tip_roll_rad;
        prop_assert!((along_roll - flank.removed_slope_m_per_rad(roll)).abs() < 1e-6 * scale * 400.0);
        prop_assert!((along_axis - flank.removed_slope_along_axis(z)).abs() < 1e-6 * 120e-6 / flank.face_width_m);
    }
}
