//! The involute by its roll angle, and microgeometry, at any numbers.

use crate::property_cases::cases;
use gearmesh_geometry::Microgeometry;
use gearmesh_geometry::involute::{involute_function, polar_angle_rad, radius_m, roll_angle_rad};
use gearmesh_geometry::microgeometry::{
    EndRelief, FaceEnds, ProfileCrowning, ReliefShape, RootRelief, TipRelief, Topography,
};
use proptest::prelude::*;

/// All laws at once, amounts of either sign; roll angles in order.
fn microgeometry() -> impl Strategy<Value = Microgeometry> {
    let amount = || -30e-6f64..30e-6;
    (
        (0.2f64..1.2, 5e-3f64..0.1),
        proptest::array::uniform8(amount()),
        proptest::array::uniform5(0.1f64..0.95),
        proptest::array::uniform3(0usize..3),
        proptest::collection::vec(amount(), 12),
    )
        .prop_map(|((tip, width), amounts, starts, shapes, table)| {
            let form = 0.1 * starts[3] * tip;
            let shape = |number: usize, length_m: f64| match shapes[number] {
                0 => ReliefShape::Linear,
                1 => ReliefShape::Parabolic,
                _ => ReliefShape::Arc { length_m },
            };
            let at = |share: f64| form + share * (tip - form);
            let length_m = 0.5 * starts[4] * width;
            let places = |low: f64, high: f64, count: usize| {
                let share = |k: usize| k as f64 / (count - 1) as f64;
                (0..count).map(|k| low + share(k) * (high - low)).collect()
            };
            let table = Topography::new(
                places(at(0.1), at(0.9), 4),
                places(-0.4 * width, 0.4 * width, 3),
                table,
            );
            Microgeometry {
                form_roll_rad: form,
                tip_roll_rad: tip,
                face_width_m: width,
                profile_crowning: Some(ProfileCrowning {
                    amount_m: amounts[0],
                    centre_roll_rad: at(starts[0]),
                }),
                tip_relief: Some(TipRelief {
                    amount_m: amounts[1],
                    start_roll_rad: at(starts[1]),
                    shape: shape(0, 0.05 * (tip - at(starts[1]))),
                }),
                root_relief: Some(RootRelief {
                    amount_m: amounts[2],
                    start_roll_rad: at(starts[2]),
                    shape: shape(1, 0.05 * (at(starts[2]) - form)),
                }),
                profile_angle_m: amounts[3],
                lead_crowning_m: amounts[4],
                flank_angle_m: amounts[5],
                end_relief: Some(EndRelief {
                    amount_m: amounts[6],
                    length_m,
                    shape: shape(2, length_m),
                    ends: [FaceEnds::Both, FaceEnds::Positive, FaceEnds::Negative][shapes[0]],
                }),
                twist_m: amounts[7],
                topography: Some(table.unwrap()),
            }
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
        let (d_roll, d_z) = (1e-6 * flank.tip_roll_rad, 1e-6 * flank.face_width_m);
        // Between corners of the laws and of the table every slope is smooth: both sides of the place see the same.
        let slopes = |roll: f64, z: f64| {
            let at = flank.removed(roll, z);
            [at.slope_m_per_rad * flank.tip_roll_rad, at.slope_along_axis * flank.face_width_m]
        };
        let middle = slopes(roll, z);
        let near = [(d_roll, 0.0), (-d_roll, 0.0), (0.0, d_z), (0.0, -d_z)];
        let smooth = near.iter().all(|(r, h)| {
            let beside = slopes(roll + r, z + h);
            middle.iter().zip(beside).all(|(a, b)| (a - b).abs() < 1e-8)
        });
        prop_assume!(smooth && roll > d_roll);
        let along_roll = flank.removed_m(roll + d_roll, z) - flank.removed_m(roll - d_roll, z);
        let along_axis = flank.removed_m(roll, z + d_z) - flank.removed_m(roll, z - d_z);
        for (change, slope) in [along_roll, along_axis].into_iter().zip(middle) {
            prop_assert!((change / 2e-6 - slope).abs() < 2e-8, "{} {slope}", change / 2e-6);
        }
    }
}
