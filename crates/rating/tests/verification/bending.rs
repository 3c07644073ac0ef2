//! Root section against the rack's closed form, ISO 6336-3's own equations, statics, and the published table.

use crate::teeth::{MODULE_M, geometry, standard};
use gearmesh_geometry::{
    Flank, GearPair, Misalignment, ProfileCurve, ToothDefinition, ToothGeometry, involute,
};
use gearmesh_rating::{
    RootConstruction, RootSection, RootSectionError, highest_single_contact_rolls_rad,
    lewis_stress_pa,
};
use std::f64::consts::PI;

fn at_tip(tooth: &ToothGeometry, construction: RootConstruction) -> RootSection {
    RootSection::new(tooth, tooth.flank_end_roll_rad, construction).unwrap()
}

fn lewis_factor(definition: &ToothDefinition) -> f64 {
    at_tip(&geometry(definition), RootConstruction::Parabola).lewis_factor(MODULE_M)
}

/// A rack tooth is a trapezium; the parabola from the load's vertex touches its straight flank where
/// Y = (8/3) y_t tan α (1 + tan²α), y_t = π/4 − h_a tan α half the tip's thickness in modules (docs/theory/rating.md).
/// With an addendum of 0.3 circular pitches, W. Lewis's own, that is 0.486 at 20°; his formula Y = π(0.154 − 0.912/z)
/// and the tables have 0.484.
#[test]
fn many_teeth_tend_to_the_rack() {
    let (tan, teeth) = (20f64.to_radians().tan(), 40_000);
    for (addendum, printed) in [(1.0, 0.4632), (0.3 * PI, 0.4862)] {
        let half_tip = 0.25 * PI - addendum * tan;
        let expected = 8.0 / 3.0 * half_tip * tan * (1.0 + tan * tan);
        let found = lewis_factor(&ToothDefinition {
            addendum,
            ..standard(teeth)
        });
        assert!((expected - printed).abs() < 1e-4, "{expected}");
        // The curvature of the flank leaves a term of the order of 1/z.
        assert!((found / expected - 1.0).abs() < 2e-4, "{found} {expected}");
    }
}

/// Values of the Lewis form factor Y, load at the tip, pressure angle 20°, full depth: R. G. Budynas, J. K. Nisbett,
/// *Shigley's Mechanical Engineering Design*, 9th ed., table 14-2 (found in several public codes).
const SHIGLEY: [(usize, f64); 20] = [
    (12, 0.245),
    (13, 0.261),
    (14, 0.277),
    (15, 0.290),
    (16, 0.296),
    (17, 0.303),
    (18, 0.309),
    (19, 0.314),
    (20, 0.322),
    (21, 0.328),
    (22, 0.331),
    (24, 0.337),
    (26, 0.346),
    (28, 0.353),
    (30, 0.359),
    (38, 0.384),
    (43, 0.397),
    (50, 0.409),
    (60, 0.422),
    (100, 0.447),
];

/// Smallest, mean and largest deviation from the table.
fn deviations(definition: impl Fn(usize) -> ToothDefinition) -> [f64; 3] {
    let all: Vec<f64> = SHIGLEY
        .iter()
        .map(|&(teeth, published)| lewis_factor(&definition(teeth)) / published - 1.0)
        .collect();
    [
        all.iter().copied().fold(f64::MAX, f64::min),
        all.iter().sum::<f64>() / all.len() as f64,
        all.iter().copied().fold(f64::MIN, f64::max),
    ]
}

/// The table seems to go back to layouts on paper with an addendum of 0.3 circular pitches (an inference). No source
/// says how exact it is; Lewis's own formula Y = π(0.154 − 0.912/z), for the same teeth, is off it by 5.3 % (root of
/// the mean square) and up to 8.2 %. What judges ours is that spread of the two sources: with that addendum, a dedendum
/// of 1.25 and a rack tip radius of 0.3 modules it is nearer to the table, −4.2 to +2.9 %, +0.4 % in the mean. Those
/// figures are held to a tenth of a per cent as well, so that a change is seen. The addendum of one module of today has
/// the load higher, so every tooth is weaker: −8.2 to −1.1 %. The fillet matters below 30 teeth: 0.1 modules of tip
/// radius are worth 3 to 4 %.
#[test]
fn the_published_table() {
    let formula = |teeth: usize| PI * (0.154 - 0.912 / teeth as f64);
    let off_formula = |&(teeth, published): &(usize, f64)| formula(teeth) / published - 1.0;
    let root_mean_square =
        |all: &[f64]| (all.iter().map(|x| x * x).sum::<f64>() / all.len() as f64).sqrt();
    let of_formula: Vec<f64> = SHIGLEY.iter().map(off_formula).collect();
    let factor = |addendum, teeth| {
        lewis_factor(&ToothDefinition {
            addendum,
            rack_tip_radius: 0.3,
            ..standard(teeth)
        })
    };
    let ours: Vec<f64> = SHIGLEY
        .iter()
        .map(|&(teeth, published)| factor(0.3 * PI, teeth) / published - 1.0)
        .collect();
    let largest = |all: &[f64]| all.iter().fold(0.0, |worst: f64, x| worst.max(x.abs()));
    assert!(
        root_mean_square(&ours) < root_mean_square(&of_formula),
        "{ours:?}"
    );
    assert!(largest(&ours) < largest(&of_formula), "{ours:?}");
    for (teeth, _) in SHIGLEY {
        assert!(factor(1.0, teeth) < factor(0.3 * PI, teeth), "z {teeth}");
    }
    let with = |addendum, rack_tip_radius| {
        deviations(|teeth| ToothDefinition {
            addendum,
            rack_tip_radius,
            ..standard(teeth)
        })
    };
    let lewis = with(0.3 * PI, 0.3);
    assert!(lewis[0] > -0.043 && lewis[2] < 0.030, "{lewis:?}");
    assert!(lewis[1].abs() < 0.005, "{lewis:?}");
    let today = with(1.0, 0.3);
    assert!(today[0] > -0.083 && today[2] < -0.010, "{today:?}");
    let sharp = with(1.0, 0.2);
    let fillet = (today[0] - sharp[0]) / 0.1;
    assert!((0.25..0.45).contains(&fillet), "{fillet}");
}

/// Lewis's formulas of 1892, y = 0.124 − 0.684/z for 14.5° (15° in his paper) and 0.154 − 0.912/z for 20°, Y = πy, from
/// 12 to 300 teeth. With his addendum of 0.3 circular pitches, a dedendum of 1.157 and a tip radius of 0.25 modules
/// ours lies within −4.6 and +3.9 %: two numbers for all teeth cannot follow the drawings any closer, they are up to 8
/// % off the table above.
#[test]
fn the_formulas_of_lewis() {
    for (degrees, a, b) in [(14.5f64, 0.124, 0.684), (20.0, 0.154, 0.912)] {
        for teeth in [12, 15, 20, 25, 30, 40, 50, 75, 100, 300] {
            let found = lewis_factor(&ToothDefinition {
                pressure_angle_rad: degrees.to_radians(),
                addendum: 0.3 * PI,
                dedendum: 1.157,
                rack_tip_radius: 0.25,
                ..standard(teeth)
            });
            let deviation = found / (PI * (a - b / teeth as f64)) - 1.0;
            assert!(
                (-0.046..0.039).contains(&deviation),
                "{degrees}°, z {teeth}: {deviation}"
            );
        }
    }
}

/// The parabola through the section touches the profile, and no other section is weaker.
#[test]
fn the_parabola_touches_the_profile_at_its_weakest_section() {
    for (teeth, profile_shift) in [(14, 0.0), (17, 0.0), (25, 0.4), (57, 0.33), (120, -0.2)] {
        let tooth = geometry(&ToothDefinition {
            profile_shift,
            ..standard(teeth)
        });
        let curve = ProfileCurve::new(&tooth);
        for share in [0.5, 1.0] {
            let roll =
                tooth.form_roll_rad + share * (tooth.flank_end_roll_rad - tooth.form_roll_rad);
            let section = RootSection::new(&tooth, roll, RootConstruction::Parabola).unwrap();
            let vertex = section.distance_from_axis_m + section.lever_m;
            // Angle of the profile against the centre line, from two points of the profile beside the section.
            let (mut low, mut high) = (0.0, curve.arc_length_at_roll_m(roll));
            for _ in 0..60 {
                let mid = 0.5 * (low + high);
                if curve.point_at(mid)[0] < section.distance_from_axis_m {
                    low = mid;
                } else {
                    high = mid;
                }
            }
            let (a, b) = (curve.point_at(low - 1e-7), curve.point_at(low + 1e-7));
            let tangent = (b[1] - a[1]) / (b[0] - a[0]);
            let of_parabola = 0.25 * section.thickness_m / section.lever_m;
            assert!(
                (tangent - of_parabola).abs() < 2e-3 * of_parabola,
                "z {teeth}, load at {share}: {tangent} {of_parabola}"
            );
            let weakness = section.lever_m / section.thickness_m.powi(2);
            for k in 0..5000 {
                let p = curve.point_at(curve.arc_length_at_roll_m(roll) * f64::from(k) / 5000.0);
                assert!((vertex - p[0]) / (4.0 * p[1] * p[1]) <= weakness * (1.0 + 1e-9));
            }
        }
    }
}

/// ISO 6336-3:2006, section 6.2: s_Fn, h_Fe and Y_F of an external gear by its auxiliary values E, G, H and ϑ; another
/// way to the same 30° tangent. Returns s_Fn/m, h_Fe/m, α_Fen, Y_F of a spur gear of z teeth, also of virtual ones, for
/// a load at the radius `load_radius` (modules).
pub fn iso_root(d: &ToothDefinition, z: f64, load_radius: f64) -> [f64; 4] {
    let alpha = d.pressure_angle_rad;
    let (h, rho, x) = (d.dedendum, d.rack_tip_radius, d.profile_shift);
    let e = 0.25 * PI - h * alpha.tan() - (1.0 - alpha.sin()) * rho / alpha.cos();
    let g = rho - h + x;
    let big_h = 2.0 / z * (0.5 * PI - e) - PI / 3.0;
    let mut theta = PI / 6.0;
    for _ in 0..200 {
        theta = 2.0 * g / z * theta.tan() - big_h;
    }
    let third = PI / 3.0 - theta;
    let thickness = z * third.sin() + 3f64.sqrt() * (g / theta.cos() - rho);
    let base = 0.5 * z * alpha.cos();
    let load_alpha = (base / load_radius).acos();
    let gamma = (0.5 * PI + 2.0 * alpha.tan() * x) / z + involute::involute_function(alpha)
        - involute::involute_function(load_alpha);
    let load_angle = load_alpha - gamma;
    let lever = 0.5
        * ((gamma.cos() - gamma.sin() * load_angle.tan()) * 2.0 * load_radius
            - z * third.cos()
            - (g / theta.cos() - rho));
    let form = 6.0 * lever * load_angle.cos() / (thickness * thickness * alpha.cos());
    [thickness, lever, load_angle, form]
}

#[test]
fn the_30_degree_tangent_is_that_of_iso_6336_3() {
    for (teeth, profile_shift, rack_tip_radius) in [
        (20, 0.0, 0.3),
        (17, 0.145, 0.38),
        (57, 0.33, 0.38),
        (103, -0.3, 0.2),
    ] {
        let d = ToothDefinition {
            profile_shift,
            rack_tip_radius,
            ..standard(teeth)
        };
        let tooth = geometry(&d);
        for share in [0.6, 1.0] {
            let roll =
                tooth.form_roll_rad + share * (tooth.flank_end_roll_rad - tooth.form_roll_rad);
            let section = RootSection::new(&tooth, roll, RootConstruction::Tangent30).unwrap();
            let radius = involute::radius_m(roll, tooth.base_radius_m) / MODULE_M;
            let expected = iso_root(&d, d.teeth as f64, radius);
            let found = [
                section.thickness_m / MODULE_M,
                section.lever_m / MODULE_M,
                section.load_angle_rad,
                section.iso_form_factor(MODULE_M, d.pressure_angle_rad),
            ];
            for (found, expected) in found.iter().zip(expected) {
                assert!((found - expected).abs() < 1e-10, "{found} {expected}");
            }
        }
    }
}

/// The moment of the load about the section's centre, from the point and direction of the force.
#[test]
fn the_stress_is_that_of_statics() {
    let tooth = geometry(&standard(31));
    let (force, width) = (5000.0, 20e-3);
    for construction in [RootConstruction::Parabola, RootConstruction::Tangent30] {
        let roll = 0.9 * tooth.flank_end_roll_rad;
        let section = RootSection::new(&tooth, roll, construction).unwrap();
        let p = tooth.flank_point_m(Flank::Right, roll);
        let (normal, _) = tooth.flank_frame(Flank::Right, roll);
        let moment = force * ((p[0] - section.distance_from_axis_m) * normal[1] - p[1] * normal[0]);
        let modulus = width * section.thickness_m.powi(2) / 6.0;
        let bending = section.bending_stress_pa(force, width);
        assert!((bending - moment / modulus).abs() < 1e-9 * bending);
        let pressed = section.compressive_stress_pa(force, width);
        assert!(
            (pressed + force * normal[0] / (width * section.thickness_m)).abs() < 1e-9 * pressed
        );
        // Lewis's formula with F_t = F cos φ is the same stress.
        let lewis = lewis_stress_pa(
            force * section.load_angle_rad.cos(),
            width,
            MODULE_M,
            section.lewis_factor(MODULE_M),
        );
        assert!((lewis - bending).abs() < 1e-12 * bending);
    }
}

#[test]
fn the_highest_point_of_single_contact() {
    let (a, b) = (geometry(&standard(17)), geometry(&standard(25)));
    let pair = GearPair::new(a, b, 21.01e-3, Misalignment::default()).unwrap();
    let [on_1, on_2] = highest_single_contact_rolls_rad(&pair).unwrap();
    // One base pitch (in roll) above the lowest point of contact of the same flank.
    let lowest_2 = pair.roll_2_rad(pair.roll_end_1_rad);
    assert!((on_1 - pair.roll_start_1_rad - 2.0 * PI / 17.0).abs() < 1e-12);
    assert!((on_2 - lowest_2 - 2.0 * PI / 25.0).abs() < 1e-12);
    // There the load bends less than at the tip.
    for (tooth, roll) in [(&pair.gear_1, on_1), (&pair.gear_2, on_2)] {
        let below = RootSection::new(tooth, roll, RootConstruction::Parabola).unwrap();
        assert!(
            below.lewis_factor(MODULE_M)
                > 1.2 * at_tip(tooth, RootConstruction::Parabola).lewis_factor(MODULE_M)
        );
    }
}

#[test]
fn what_has_no_root_section_is_refused() {
    let tooth = geometry(&standard(20));
    for roll in [0.0, tooth.flank_end_roll_rad + 0.01, f64::NAN] {
        assert!(matches!(
            RootSection::new(&tooth, roll, RootConstruction::Parabola),
            Err(RootSectionError::LoadOffFlank { .. })
        ));
    }
    let helical = geometry(&ToothDefinition {
        helix_angle_rad: 0.3,
        ..standard(20)
    });
    assert!(matches!(
        RootSection::new(
            &helical,
            helical.flank_end_roll_rad,
            RootConstruction::Parabola
        ),
        Err(RootSectionError::Helical { .. })
    ));
    // Many teeth, long addenda: contact ratio above 2.
    let long = |teeth| {
        geometry(&ToothDefinition {
            addendum: 1.25,
            dedendum: 1.5,
            rack_tip_radius: 0.1,
            pressure_angle_rad: 16f64.to_radians(),
            ..standard(teeth)
        })
    };
    let pair = GearPair::new(long(90), long(90), 90.02e-3, Misalignment::default()).unwrap();
    assert!(matches!(
        highest_single_contact_rolls_rad(&pair),
        Err(RootSectionError::NoSingleContact { .. })
    ));
}
