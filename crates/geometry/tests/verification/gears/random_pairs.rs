//! What holds for any two gears that run together.

use crate::gears::random_teeth::ordinary;
use crate::property_cases::cases;
use gearmesh_geometry::definition::ToothDefinition;
use gearmesh_geometry::{Flank, GearPair, Misalignment, ProfileCurve, ToothGeometry, involute};
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Two gears of one rack and opposite hands; the second has its own teeth, shift and allowance.
fn gears() -> impl Strategy<Value = [ToothDefinition; 2]> {
    let second = (
        prop_oneof![12usize..30, 30usize..150],
        -0.3f64..0.8,
        0.0f64..0.1,
    );
    // Not too short teeth, or most pairs would lose contact.
    (ordinary(), 12usize..150, 0.9f64..1.1, 0.2f64..0.4, second).prop_map(
        |(d, teeth, addendum, clearance, second)| {
            let first = ToothDefinition {
                teeth,
                addendum,
                dedendum: addendum + clearance,
                tip_chamfer_m: 0.0,
                ..d
            };
            let second = ToothDefinition {
                teeth: second.0,
                profile_shift: second.1,
                thickness_allowance_m: second.2 * first.module_m,
                helix_angle_rad: -first.helix_angle_rad,
                ..first.clone()
            };
            [first, second]
        },
    )
}

/// The root of a function that grows, between two places.
fn root(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if f(middle) < 0.0 {
            low = middle
        } else {
            high = middle
        }
    }
    0.5 * (low + high)
}

/// Centre distance without backlash by the textbook: inv α_w = inv α_t + 2 tan α_n (x₁ + x₂)/(z₁ + z₂), each allowance
/// as so much less shift. None where the shifts are too negative for any.
fn tight_centre_distance_m(gears: &[ToothDefinition; 2]) -> Option<f64> {
    let d = &gears[0];
    let (cos, tan_n) = (d.helix_angle_rad.cos(), d.pressure_angle_rad.tan());
    let alpha_t = (tan_n / cos).atan();
    let allowance =
        |g: &ToothDefinition| 0.5 * g.thickness_allowance_m * cos / (g.module_m * tan_n);
    let shifts: f64 = gears.iter().map(|g| g.profile_shift - allowance(g)).sum();
    let teeth = (gears[0].teeth + gears[1].teeth) as f64;
    let inv = involute::involute_function(alpha_t) + 2.0 * tan_n * shifts / teeth;
    let references = 0.5 * d.module_m * teeth / cos;
    let working = root(0.0, 1.5, |angle| involute::involute_function(angle) - inv);
    (inv > 1e-4).then(|| references * alpha_t.cos() / working.cos())
}

/// The pair at a centre distance a little over the tight one, where there is one.
fn pair(gears: &[ToothDefinition; 2], wider: f64) -> Option<GearPair> {
    let centre = tight_centre_distance_m(gears)? + wider * gears[0].module_m;
    let [one, two] = gears;
    let (one, two) = (ToothGeometry::new(one).ok()?, ToothGeometry::new(two).ok()?);
    GearPair::new(one, two, centre, Misalignment::default()).ok()
}

/// A point in the frame of gear 1's axis, from gear 1 or gear 2 turned by `angle`.
fn placed(p: [f64; 2], angle: f64, centre_x: f64) -> [f64; 2] {
    let (s, c) = angle.sin_cos();
    [centre_x + c * p[0] - s * p[1], s * p[0] + c * p[1]]
}

/// Angles of both gears at a driver angle, by the pitch point alone: there both unmodified right flanks are at θ₁ = 0.
fn angles(pair: &GearPair, driver_angle: f64) -> [f64; 2] {
    let working = pair.working_pressure_angle_rad.tan();
    let ratio = pair.gear_1.teeth as f64 / pair.gear_2.teeth as f64;
    [
        pair.gear_1.half_angle_rad(working) - driver_angle,
        PI + pair.gear_2.half_angle_rad(working) + driver_angle * ratio,
    ]
}

proptest! {
    #![proptest_config(cases(200))]

    /// Profile shift against centre distance: at the textbook's distance there is no backlash, and further away
    /// the backlash grows by 2 tan α_w for each metre.
    #[test]
    fn the_backlash_follows_from_the_profile_shifts(gears in gears(), wider in 0.0f64..0.2) {
        let pair = pair(&gears, wider);
        prop_assume!(pair.is_some());
        let pair = pair.unwrap();
        let m = gears[0].module_m;
        let tight = pair.centre_distance_m - wider * m;
        let at = |centre_distance_m: f64| {
            let sum = pair.gear_1.base_radius_m + pair.gear_2.base_radius_m;
            GearPair { working_pressure_angle_rad: (sum / centre_distance_m).acos(), centre_distance_m, ..pair.clone() }
        };
        prop_assert!(at(tight).backlash_m().abs() < 1e-9 * m, "{}", at(tight).backlash_m());
        let step = 1e-5 * m;
        let growth = (at(pair.centre_distance_m + step).backlash_m() - at(pair.centre_distance_m - step).backlash_m())
            / (2.0 * step);
        // Not the plain 2 tan α_w: that is the tight pair's; the thicknesses are taken on circles that grow, too.
        let plain = 2.0 * pair.working_pressure_angle_rad.tan() + pair.backlash_m() / pair.centre_distance_m;
        prop_assert!((growth - plain).abs() < 1e-5, "{growth}, expected {plain}");
    }

    /// Rolling: at every driver angle the flanks touch in one point with one normal, on the line of action.
    #[test]
    fn conjugate_flanks_touch_all_along_the_path(gears in gears(), wider in 0.0f64..0.2, share in 0.0f64..1.0) {
        let pair = pair(&gears, wider);
        prop_assume!(pair.is_some());
        let pair = pair.unwrap();
        let roll_1 = pair.roll_start_1_rad + share * (pair.roll_end_1_rad - pair.roll_start_1_rad);
        let driver = roll_1 - pair.working_pressure_angle_rad.tan();
        prop_assert!((pair.roll_1_rad(driver, 0) - roll_1).abs() < 1e-13);
        let roll_2 = pair.roll_2_rad(roll_1);
        let [angle_1, angle_2] = angles(&pair, driver);
        let a = pair.centre_distance_m;
        let p = placed(pair.gear_1.flank_point_m(Flank::Right, roll_1), angle_1, 0.0);
        let q = placed(pair.gear_2.flank_point_m(Flank::Right, roll_2), angle_2, a);
        prop_assert!((p[0] - q[0]).hypot(p[1] - q[1]) < 1e-12 * a);
        let normal = |g: &ToothGeometry, roll, angle| placed(g.flank_frame(Flank::Right, roll).0, angle, 0.0);
        let (n_1, n_2) = (normal(&pair.gear_1, roll_1, angle_1), normal(&pair.gear_2, roll_2, angle_2));
        prop_assert!((n_1[0] + n_2[0]).hypot(n_1[1] + n_2[1]) < 1e-12);
        // From the pitch point along the common normal.
        let r_w1 = a * gears[0].teeth as f64 / (gears[0].teeth + gears[1].teeth) as f64;
        let (x, y) = (p[0] - r_w1, p[1]);
        prop_assert!((x * n_1[1] - y * n_1[0]).abs() < 1e-12 * a);
        prop_assert!((x.hypot(y) - pair.path_from_pitch_point_m(roll_1).abs()).abs() < 1e-12 * a);
        // Sliding: difference of the velocities of the two material points, along gear 1's tangent to the root.
        let speeds = [-1.0, gears[0].teeth as f64 / gears[1].teeth as f64];
        let (v_1, v_2) = ([-speeds[0] * p[1], speeds[0] * p[0]], [-speeds[1] * p[1], speeds[1] * (p[0] - a)]);
        let tangent = placed(pair.gear_1.flank_frame(Flank::Right, roll_1).1, angle_1, 0.0);
        let sliding = -(v_1[0] - v_2[0]) * tangent[0] - (v_1[1] - v_2[1]) * tangent[1];
        prop_assert!((sliding - pair.sliding_velocity_m_per_s(roll_1, 1.0)).abs() < 1e-12 * a);
        let across = (v_1[0] - v_2[0]) * n_1[0] + (v_1[1] - v_2[1]) * n_1[1];
        prop_assert!(across.abs() < 1e-12 * a, "the flanks stay in touch");
    }

    /// Exchanged, the pair has the same figures; on left flanks it is the mirror image.
    #[test]
    fn exchange_and_flank_change_no_figure(gears in gears(), wider in 0.0f64..0.2, driver in -3.0f64..3.0) {
        let pair = pair(&gears, wider);
        prop_assume!(pair.is_some());
        let pair = pair.unwrap();
        let (one, two) = (pair.gear_2.clone(), pair.gear_1.clone());
        let swapped = GearPair::new(one, two, pair.centre_distance_m, Misalignment::default());
        prop_assert!(swapped.is_ok());
        let swapped = swapped.unwrap();
        prop_assert!((swapped.contact_ratio() - pair.contact_ratio()).abs() < 1e-12);
        prop_assert!((swapped.backlash_m() - pair.backlash_m()).abs() < 1e-12 * pair.centre_distance_m);
        prop_assert!((pair.roll_2_rad(pair.roll_end_1_rad) - swapped.roll_start_1_rad).abs() < 1e-12);
        // The path by the two tip circles.
        let reach = |g: &ToothGeometry| (g.tip_radius_m.powi(2) - g.base_radius_m.powi(2)).sqrt();
        let line = pair.centre_distance_m * pair.working_pressure_angle_rad.sin();
        let base_pitch = TAU * pair.gear_1.base_radius_m / pair.gear_1.teeth as f64;
        let ratio = (reach(&pair.gear_1) + reach(&pair.gear_2) - line) / base_pitch;
        prop_assert!((ratio - pair.contact_ratio()).abs() < 1e-9 * ratio);
        // As many pairs touch as the contact ratio says, and no others.
        let touching = pair.pairs_in_contact(driver).count();
        prop_assert!(touching == ratio.floor() as usize || touching == ratio.floor() as usize + 1);
        let left = pair.clone().on_flanks(Flank::Left);
        let pairs: Vec<_> = pair.pairs_in_contact(driver).collect();
        prop_assert_eq!(left.pairs_in_contact(driver).collect::<Vec<_>>(), pairs.clone());
        for p in pairs {
            let mirrored = |teeth: [usize; 2]| {
                [(pair.gear_1.teeth - teeth[0]) % pair.gear_1.teeth, (pair.gear_2.teeth - teeth[1]) % pair.gear_2.teeth]
            };
            prop_assert_eq!(left.teeth_of(p), mirrored(pair.teeth_of(p)));
        }
    }
}

proptest! {
    #![proptest_config(cases(60))]

    /// A pair that is accepted does not overlap: no point of either outline lies in a tooth of the other, whatever the
    /// driver angle. Flanks touch; the outline is tabulated to 1e-6 of a piece.
    #[test]
    fn the_teeth_of_a_pair_stay_out_of_each_other(gears in gears(), wider in 0.0f64..0.2, share in 0.0f64..1.0) {
        let pair = pair(&gears, wider);
        prop_assume!(pair.is_some());
        let pair = pair.unwrap();
        let [angle_1, angle_2] = angles(&pair, share * pair.pitch_1_rad());
        let poses = [(&pair.gear_1, angle_1, 0.0), (&pair.gear_2, angle_2, pair.centre_distance_m)];
        let curves = [ProfileCurve::new(&pair.gear_1), ProfileCurve::new(&pair.gear_2)];
        for (own, mate) in [(0, 1), (1, 0)] {
            let (gear, angle, x) = poses[own];
            let (other, other_angle, other_x) = poses[mate];
            let line = if x > other_x { PI } else { 0.0 };
            let nearest = ((line - angle) / (TAU / gear.teeth as f64)).round();
            for tooth in -1..=1 {
                let turn = angle + (nearest + f64::from(tooth)) * TAU / gear.teeth as f64;
                for k in 0..=40 {
                    for side in [1.0, -1.0] {
                        let [px, py] = curves[own].point_at(curves[own].length_m() * f64::from(k) / 40.0);
                        let p = placed([px, side * py], turn, x);
                        let q = placed([p[0] - other_x, p[1]], -other_angle, 0.0);
                        let radius = q[0].hypot(q[1]);
                        if radius >= other.tip_radius_m {
                            continue;
                        }
                        prop_assert!(radius > other.root_radius_m - 1e-9, "below the root circle");
                        let pitch = TAU / other.teeth as f64;
                        let within = (q[1].atan2(q[0]) / pitch).round();
                        let r = placed(q, -within * pitch, 0.0);
                        let (place, inside) = curves[mate].place_of([r[0], -r[1].abs()]);
                        // Measured along the normal: fillets run into the root circle, tips end at the tip circle.
                        let slope = curves[mate].tangent_angle_at_rad(place) - (FRAC_PI_2 - r[1].abs().atan2(r[0]));
                        let depth = (inside * slope.sin().abs()).min(other.tip_radius_m - radius);
                        if place > curves[mate].root_arc_end_m() {
                            let allowed = 2e-6 * other.base_radius_m;
                            prop_assert!(depth < allowed, "{depth} m inside at radius {radius}, tooth {tooth}, point {k}");
                        }
                    }
                }
            }
        }
    }
}
