//! What holds for the tooth of any definition that one can be cut from.

use crate::property_cases::cases;
use gearmesh_geometry::definition::ToothDefinition;
use gearmesh_geometry::{
    Flank, GeometryError, ProfileCurve, RootPosition, ToothGeometry, involute,
};
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI};

/// Teeth as they are made: most of these definitions give a gear.
pub fn ordinary() -> impl Strategy<Value = ToothDefinition> {
    let rack = (
        0.2e-3f64..12e-3,
        14.5f64..28.0,
        0.75f64..1.2,
        1.05f64..1.4,
        0.0f64..0.3,
    );
    let gear = (
        prop_oneof![8usize..30, 30usize..250],
        -0.5f64..0.8,
        prop_oneof![Just(0.0), 0.0f64..0.1],
        prop_oneof![Just(0.0), 0.01f64..0.15],
        prop_oneof![Just(0.0), -40.0f64..40.0],
    );
    (rack, gear).prop_map(|(rack, gear)| definition(rack, gear))
}

/// Anything that the gear file lets through key by key, and some of what it does not.
fn any_numbers() -> impl Strategy<Value = ToothDefinition> {
    let rack = (
        1e-5f64..0.2,
        10.0f64..35.0,
        -0.5f64..3.0,
        0.0f64..3.0,
        0.0f64..1.0,
    );
    let gear = (
        5usize..1000,
        -2.0f64..2.0,
        0.0f64..1.5,
        0.0f64..2.0,
        -44.9f64..44.9,
    );
    (
        rack,
        gear,
        prop_oneof![Just(None), (0.1f64..2.0).prop_map(Some)],
    )
        .prop_map(|(rack, gear, tip)| {
            let tooth = definition(rack, gear);
            let reference = tooth.module_m * tooth.teeth as f64 / tooth.helix_angle_rad.cos();
            ToothDefinition {
                tip_diameter_m: tip.map(|share| share * reference),
                ..tooth
            }
        })
}

/// Rack: module \[m\], pressure angle \[deg\], addendum, dedendum, tip radius. Gear: teeth, profile shift, thickness
/// allowance and chamfer in modules, helix angle \[deg\].
fn definition(
    rack: (f64, f64, f64, f64, f64),
    gear: (usize, f64, f64, f64, f64),
) -> ToothDefinition {
    let module_m = rack.0;
    ToothDefinition {
        teeth: gear.0,
        gearing: Default::default(),
        module_m,
        pressure_angle_rad: rack.1.to_radians(),
        profile_shift: gear.1,
        addendum: rack.2,
        dedendum: rack.3,
        rack_tip_radius: rack.4,
        tip_diameter_m: None,
        thickness_allowance_m: gear.2 * module_m,
        tip_chamfer_m: gear.3 * module_m,
        face_width_m: 10.0 * module_m,
        helix_angle_rad: gear.4.to_radians(),
    }
}

/// Tooth thickness on a circle \[m\] by the textbook's formula s_y = 2 r_y (s/(2r) + inv α_t − inv α_y).
fn thickness_m(d: &ToothDefinition, radius_m: f64) -> f64 {
    let cos = d.helix_angle_rad.cos();
    let alpha_t = (d.pressure_angle_rad.tan() / cos).atan();
    let reference = 0.5 * d.module_m * d.teeth as f64 / cos;
    let at_reference =
        d.module_m * (FRAC_PI_2 + 2.0 * d.profile_shift * d.pressure_angle_rad.tan()) / cos
            - d.thickness_allowance_m;
    let alpha_y = (reference * alpha_t.cos() / radius_m).acos();
    let inv = involute::involute_function;
    2.0 * radius_m * (0.5 * at_reference / reference + inv(alpha_t) - inv(alpha_y))
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// What must hold of any tooth that is made, whatever its numbers.
fn check_tooth(d: &ToothDefinition, g: &ToothGeometry) -> Result<(), TestCaseError> {
    let m = d.module_m;
    // Undercut by the closed formula, but for definitions on the limit to rounding.
    let (sin_n, alpha_t) = (
        d.pressure_angle_rad.sin(),
        (d.pressure_angle_rad.tan() / d.helix_angle_rad.cos()).atan(),
    );
    let limit = d.dedendum
        - d.rack_tip_radius * (1.0 - sin_n)
        - 0.5 * d.teeth as f64 / d.helix_angle_rad.cos() * alpha_t.sin().powi(2);
    if (d.profile_shift - limit).abs() > 1e-9 {
        prop_assert_eq!(g.undercut, d.profile_shift < limit);
    }
    // Fillet and flank meet, smoothly where nothing is undercut; the fillet begins on the root circle.
    let (end, start) = (
        g.fillet.point_m(g.fillet_end),
        g.flank_point_m(Flank::Right, g.form_roll_rad),
    );
    prop_assert!(
        distance(end, start) < 1e-8 * m,
        "a gap of {} m",
        distance(end, start)
    );
    if !g.undercut {
        let (_, tangent) = g.flank_frame(Flank::Right, g.form_roll_rad);
        let corner = g.fillet.tangent_angle_rad(g.fillet_end) - tangent[1].atan2(tangent[0]);
        prop_assert!(corner.abs() < 1e-7, "a corner of {corner} rad");
    }
    let deepest = g.fillet.point_m(0.0);
    prop_assert!((deepest[0].hypot(deepest[1]) - g.root_radius_m).abs() < 1e-9 * g.root_radius_m);
    // From root to tip.
    let radius = |roll: f64| involute::radius_m(roll, g.base_radius_m);
    prop_assert!(0.0 < g.root_radius_m && g.root_radius_m < radius(g.form_roll_rad) * (1.0 + 1e-9));
    prop_assert!(0.0 <= g.form_roll_rad && g.form_roll_rad < g.flank_end_roll_rad);
    prop_assert!(g.flank_end_roll_rad <= g.tip_roll_rad);
    prop_assert!((radius(g.tip_roll_rad) - g.tip_radius_m).abs() < 1e-12 * g.tip_radius_m);
    prop_assert!(g.tip_half_angle_rad() > 0.0);
    // The thickness, all along the flank.
    for k in 0..=4 {
        let roll = g.form_roll_rad + (g.tip_roll_rad - g.form_roll_rad) * f64::from(k) / 4.0;
        let found = 2.0 * radius(roll) * g.half_angle_rad(roll);
        prop_assert!((found - thickness_m(d, radius(roll))).abs() < 1e-6 * m);
    }
    // The whole outline lies between the middle of the space and the middle of the tooth.
    let curve = ProfileCurve::new(g);
    for k in 0..=300 {
        let p = curve.point_at(curve.length_m() * f64::from(k) / 300.0);
        let angle = p[1].atan2(p[0]);
        prop_assert!(
            (-PI / g.teeth as f64 - 1e-9..=1e-9).contains(&angle),
            "the outline reaches the angle {angle}: half a pitch is {}",
            PI / g.teeth as f64
        );
    }
    Ok(())
}

proptest! {
    #![proptest_config(cases(600))]

    /// No definition panics; what is refused is refused for the reason that the textbook's formulas give.
    #[test]
    fn a_definition_gives_a_tooth_or_the_right_reason(d in any_numbers()) {
        let cos = d.helix_angle_rad.cos();
        let reference = 0.5 * d.module_m * d.teeth as f64 / cos;
        let tip = d.tip_diameter_m
            .map_or(reference + d.module_m * (d.addendum + d.profile_shift), |diameter| 0.5 * diameter);
        match ToothGeometry::new(&d) {
            Ok(tooth) => check_tooth(&d, &tooth)?,
            Err(GeometryError::PointedTooth { .. }) => {
                let base = reference * (d.pressure_angle_rad.tan() / cos).atan().cos();
                prop_assert!(tip <= base || thickness_m(&d, tip) < 1e-9 * d.module_m);
            }
            Err(GeometryError::ImpossibleRadii { .. }) => {
                let root = reference - d.module_m * (d.dedendum - d.profile_shift);
                prop_assert!(root < 1e-9 * reference || tip < root * (1.0 + 1e-9));
            }
            Err(GeometryError::RackTipTooNarrow { allowed, .. }) => {
                prop_assert!(d.rack_tip_radius > allowed * (1.0 - 1e-9));
            }
            Err(GeometryError::ChamferTooLarge { allowed_mm, chamfer_mm, .. }) => {
                prop_assert!(chamfer_mm > allowed_mm * (1.0 - 1e-9) || d.tip_chamfer_m > 0.0);
            }
            Err(e @ GeometryError::Undercut { .. }) => {
                prop_assert!(!e.to_string().contains("NaN"));
            }
            Err(of_a_ring) => prop_assert!(false, "{of_a_ring}"),
        }
    }
}

proptest! {
    #![proptest_config(cases(300))]

    /// Half of the definitions at least must give a tooth, or these tests would say nothing; proptest gives up
    /// otherwise.
    #[test]
    fn teeth_of_ordinary_racks_are_whole(d in ordinary()) {
        let tooth = ToothGeometry::new(&d);
        prop_assume!(tooth.is_ok());
        check_tooth(&d, &tooth.unwrap())?;
    }

    /// The base pitch along the normal is the rack's: π m cos α, whatever the helix.
    #[test]
    fn gears_of_one_rack_have_one_base_pitch(d in ordinary()) {
        let tooth = ToothGeometry::new(&d);
        prop_assume!(tooth.is_ok());
        let tooth = tooth.unwrap();
        let transverse = 2.0 * PI * tooth.base_radius_m / tooth.teeth as f64;
        let normal = transverse * tooth.base_helix_angle_rad().cos();
        let rack = PI * d.module_m * d.pressure_angle_rad.cos();
        prop_assert!((normal / rack - 1.0).abs() < 1e-13);
    }

    /// The other hand has the same section and the mirrored normals; the left flank is the mirrored right one.
    #[test]
    fn the_other_hand_is_the_mirror_image(d in ordinary(), share in 0.0f64..1.0) {
        let other = ToothDefinition { helix_angle_rad: -d.helix_angle_rad, ..d.clone() };
        let (right, left) = (ToothGeometry::new(&d), ToothGeometry::new(&other));
        prop_assert_eq!(right.is_ok(), left.is_ok());
        prop_assume!(right.is_ok());
        let (right, left) = (right.unwrap(), left.unwrap());
        prop_assert_eq!(right.twist_rad_per_m(), -left.twist_rad_per_m());
        prop_assert_eq!(right.overlap_ratio(d.face_width_m), left.overlap_ratio(d.face_width_m));
        let roll = right.form_roll_rad + share * (right.tip_roll_rad - right.form_roll_rad);
        let [x, y] = right.flank_point_m(Flank::Right, roll);
        prop_assert_eq!(left.flank_point_m(Flank::Left, roll), [x, -y]);
        let [nx, ny, nz] = right.flank_normal(Flank::Right, roll);
        prop_assert_eq!(left.flank_normal(Flank::Left, roll), [nx, -ny, nz]);
        prop_assert_eq!(left.flank_normal(Flank::Right, roll), [nx, ny, -nz]);
    }

    /// Places on the outline: by roll angle, by radius, by tangent, and back from the point.
    #[test]
    fn a_place_on_the_outline_is_found_again(d in ordinary(), share in 0.001f64..0.999) {
        let tooth = ToothGeometry::new(&d);
        prop_assume!(tooth.is_ok());
        let tooth = tooth.unwrap();
        let curve = ProfileCurve::new(&tooth);
        // The arc length between two samples is interpolated: 1e-6 of a piece is stated.
        let off = 1e-5 * curve.length_m();
        let roll = tooth.form_roll_rad + share * (tooth.flank_end_roll_rad - tooth.form_roll_rad);
        let at_roll = curve.point_at(curve.arc_length_at_roll_m(roll));
        prop_assert!(distance(at_roll, tooth.flank_point_m(Flank::Right, roll)) < off);

        let below_tip = share * curve.tip_start_m();
        let p = curve.point_at(below_tip);
        let (found, beside) = curve.place_of(p);
        prop_assert!((found - below_tip).abs() < off && beside.abs() < off, "{below_tip}: {found}, {beside}");

        let end = involute::radius_m(tooth.flank_end_roll_rad, tooth.base_radius_m);
        let radius = tooth.root_radius_m + share * (end - tooth.root_radius_m);
        let q = curve.point_at(curve.arc_length_at(RootPosition::Radius(radius)).unwrap());
        prop_assert!((q[0].hypot(q[1]) - radius).abs() < off);

        let steepest = tooth.fillet.tangent_angle_rad(0.0);
        let tangent = steepest + share * (tooth.fillet.tangent_angle_rad(tooth.fillet_end) - steepest);
        let place = curve.arc_length_at(RootPosition::TangentAngle(tangent)).unwrap();
        let parameter = tooth.fillet.parameter_at_tangent(tangent, tooth.fillet_end).unwrap();
        prop_assert!(distance(curve.point_at(place), tooth.fillet.point_m(parameter)) < off);
    }
}
