//! Nominal stresses of ISO 6336-2 and -3: a published calculation, the standard's own equations in their other form,
//! and limits.

use crate::bending::iso_root;
use crate::teeth::{geometry, standard};
use gearmesh_geometry::{GearPair, Material, Misalignment, ToothDefinition};
use gearmesh_rating::{
    IsoRoot, LoadPoint, NominalRating, RootConstruction, RootSection, VirtualGear,
};
use std::f64::consts::PI;

const STEEL: Material = Material {
    young_pa: 206e9,
    poisson: 0.3,
    density_kg_per_m3: None,
};

fn pair(teeth: &[ToothDefinition; 2], distance_m: f64) -> GearPair {
    let [first, second] = teeth.each_ref().map(geometry);
    GearPair::new(first, second, distance_m, Misalignment::default()).unwrap()
}

/// z 19/104, m 4 mm, x 0.5/0.15, b 48.64 mm, F_t 14103.4 N: the calculation printed with the public program din3990 (H.
/// Hansl, tests/test_1.py), after DIN 3990-11, whose factors for these are those of ISO 6336. Its root factors are
/// those of a load at the tip, its auxiliary angle ϑ is that of five iterations (5e-5 of s_Fn); converged, s_Fn and ρ_F
/// are 8.749195903508, 1.316142208827 and 9.239568746735, 1.325998977147 mm.
#[test]
fn a_published_calculation() {
    let tooth = |teeth: usize, profile_shift: f64, tip_mm: f64| ToothDefinition {
        module_m: 4e-3,
        profile_shift,
        rack_tip_radius: 0.25,
        tip_diameter_m: Some(tip_mm * 1e-3),
        face_width_m: 48.64e-3,
        ..standard(teeth)
    };
    let teeth = [tooth(19, 0.5, 88.0), tooth(104, 0.15, 425.2)];
    // Printed 248.506843355171 mm.
    let pair = pair(&teeth, 0.248_506_843_4);
    let rating = NominalRating::new(
        &pair,
        teeth.each_ref(),
        [STEEL; 2],
        [None; 2],
        (LoadPoint::Tip, None),
    )
    .unwrap();
    let near = |found: f64, printed: f64, share: f64| {
        assert!(
            (found / printed - 1.0).abs() < share,
            "{found} for {printed}"
        );
    };
    let iso = rating.iso_pressure;
    near(iso.zone_factor, 2.395_940_667, 2e-6);
    near(iso.contact_ratio_factor, 0.906_214_913, 2e-6);
    near(iso.elasticity_factor, 189.8e3, 1e-4);
    near(iso.pressure_pa(14_103.418_695), 875.382_738e6, 1e-4);
    assert_eq!(iso.helix_factor, 1.0);
    // s_Fn, h_Fa, ρ_F [mm], Y_Fa, Y_Sa.
    let printed = [
        [
            8.748_743_356,
            8.174_657_643,
            1.316_147_758,
            2.246_336_379,
            1.914_726_257,
        ],
        [
            9.239_504_611,
            7.834_245_947,
            1.325_999_193,
            2.161_656_680,
            2.008_781_658,
        ],
    ];
    let converged = [
        [8.749_195_903_508, 1.316_142_208_827],
        [9.239_568_746_735, 1.325_998_977_147],
    ];
    for ((tooth, printed), converged) in teeth.iter().zip(printed).zip(converged) {
        let gear = geometry(tooth);
        let section =
            RootSection::new(&gear, gear.flank_end_roll_rad, RootConstruction::Tangent30).unwrap();
        let found = [
            1e3 * section.thickness_m,
            1e3 * section.lever_m,
            1e3 * section.notch_radius_m,
            section.iso_form_factor(4e-3, tooth.pressure_angle_rad),
            section.stress_correction_factor(),
        ];
        for (found, printed) in found.into_iter().zip(printed) {
            near(found, printed, 1e-4);
        }
        near(found[0], converged[0], 1e-11);
        near(found[2], converged[1], 1e-11);
    }
}

/// The teeth of ISO/TR 6336-30:2017, example 1: m_n 8 mm, z 17/103, β 15.8°, x 0.145/0, b 100 mm, a 500 mm, h_fP 1.4 m.
/// Its tips are not at hand: those of a full addendum. Y_F and Y_S against the equations of ISO 6336-3:2006, 6.2 and
/// 7.2, with their own ρ_F and a real number of teeth.
#[test]
fn helical_teeth_by_the_standards_equations() {
    let beta = 15.8f64.to_radians();
    let tooth = |teeth: usize, x: f64, sign: f64| ToothDefinition {
        module_m: 8e-3,
        profile_shift: x,
        dedendum: 1.4,
        rack_tip_radius: 0.39,
        helix_angle_rad: sign * beta,
        face_width_m: 0.1,
        ..standard(teeth)
    };
    let teeth = [tooth(17, 0.145, 1.0), tooth(103, 0.0, -1.0)];
    let pair = pair(&teeth, 0.5);
    let overlap = 0.1 * beta.sin() / (PI * 8e-3);
    assert!((pair.overlap_ratio(0.1) - overlap).abs() < 1e-12 && overlap > 1.0);
    let rating = NominalRating::new(
        &pair,
        teeth.each_ref(),
        [STEEL; 2],
        [None; 2],
        (LoadPoint::HighestSingleContact, None),
    )
    .unwrap();
    let alpha_n = 20f64.to_radians();
    let beta_b = (beta.sin() * alpha_n.cos()).asin();
    let tangential_n = 20e3;
    let found = rating
        .under(tangential_n / ((alpha_n.tan() / beta.cos()).atan().cos() * beta_b.cos()))
        .unwrap();
    for (k, d) in teeth.iter().enumerate() {
        let z_n = d.teeth as f64 / (beta_b.cos().powi(2) * beta.cos());
        let ratio = pair.contact_ratio() / beta_b.cos().powi(2);
        let (d_an, d_bn) = (
            z_n + 2.0 * (d.addendum + d.profile_shift),
            z_n * alpha_n.cos(),
        );
        let from_base =
            (0.25 * (d_an * d_an - d_bn * d_bn)).sqrt() - PI * alpha_n.cos() * (ratio - 1.0);
        let [thickness, lever, _, form] = iso_root(d, z_n, from_base.hypot(0.5 * d_bn));
        let g = d.rack_tip_radius - d.dedendum + d.profile_shift;
        // ϑ from s_Fn = z_n sin(π/3 − ϑ) + √3 (G/cos ϑ − ρ), by bisection.
        let of = |theta: f64| {
            z_n * (PI / 3.0 - theta).sin() + 3f64.sqrt() * (g / theta.cos() - d.rack_tip_radius)
        };
        let (mut low, mut high) = (0.0, 1.2);
        for _ in 0..100 {
            let mid = 0.5 * (low + high);
            if of(mid) > thickness {
                low = mid;
            } else {
                high = mid;
            }
        }
        let notch_radius =
            d.rack_tip_radius + 2.0 * g * g / (low.cos() * (z_n * low.cos().powi(2) - 2.0 * g));
        let l = thickness / lever;
        let notch =
            (1.2 + 0.13 * l) * (0.5 * thickness / notch_radius).powf(1.0 / (1.21 + 2.3 / l));
        let iso = rating.iso_roots[k].unwrap();
        assert!(
            (iso.form_factor / form - 1.0).abs() < 3e-4,
            "{iso:?} {form}"
        );
        assert!(
            (iso.stress_correction_factor / notch - 1.0).abs() < 3e-4,
            "{iso:?} {notch}"
        );
        // ε_β no more than 1.
        assert!((iso.helix_factor - (1.0 - 15.8 / 120.0)).abs() < 1e-12);
        let stress = tangential_n / (0.1 * 8e-3) * form * notch * (1.0 - 15.8 / 120.0);
        assert!((found.iso_root_pa[k].unwrap() / stress - 1.0).abs() < 6e-4);
        println!("gear {}: Y_F {form:.4}, Y_S {notch:.4}", k + 1);
    }
    assert!((rating.iso_pressure.helix_factor - beta.cos().sqrt().recip()).abs() < 1e-15);
    let share = rating.iso_pressure.contact_ratio_factor.powi(2) * pair.contact_ratio();
    assert!((share - 1.0).abs() < 1e-12);
}

/// The gears of the FZG test, type C (ISO 14635-1), by hand after ISO 6336-3:2006, 6.2 and 7.2, with a rack of h_fP =
/// 1.25 m and ρ_fP = 0.25 m, F = 4000 N across the flanks, F_t = F cos 20°:
///
/// ```text
/// α_w = 22.43879°, ε_α = 1.4430935        gear 1        gear 2
/// d_en = 2 √((g − π m cos α (ε_α − 1))² + d_b²/4), g = √(d_a² − d_b²)/2
///                                         76.376064     112.788660 mm
/// G = ρ_fP − h_fP + x                    −0.818        −0.829
/// H = (2/z)(π/2 − E/m) − π/3             −0.87027095   −0.92924648
/// ϑ = (2 G/z) tan ϑ − H                   44.171403°    48.731411°
/// s_Fn/m = z sin(π/3 − ϑ) + √3 (G/cos ϑ − ρ_fP)
///                                         1.95583130    2.07987756
/// ρ_F/m = ρ_fP + 2 G²/(cos ϑ (z cos² ϑ − 2 G))
///                                         0.43908633    0.42222696
/// α_en = acos(d_b/d_en)                   27.643481°    25.868714°
/// γ_e = (π/2 + 2 x tan α)/z + inv α − inv α_en
///                                         4.587971°     2.987158°
/// α_Fen = α_en − γ_e                      23.055510°    22.881556°
/// h_Fe/m                                  1.16869340    1.22418189
/// Y_F = 6 h_Fe/m cos α_Fen/((s_Fn/m)² cos α)
///                                         1.79494225    1.66472279
/// Y_S, L = s_Fn/h_Fe, q_s = s_Fn/2ρ_F     1.93241888    2.01950837
/// σ_F0 = F_t/(b m) Y_F Y_S                206.945988    200.582408 MPa
/// ```
///
/// Each line has nine figures, so that the last may be off by 1e-8 of it, and Y_F by some of that.
#[test]
fn fzg_type_c() {
    const FIGURES: f64 = 1e-7;
    let tooth = |teeth: usize, profile_shift: f64, tip_mm: f64| ToothDefinition {
        module_m: 4.5e-3,
        profile_shift,
        rack_tip_radius: 0.25,
        tip_diameter_m: Some(tip_mm * 1e-3),
        face_width_m: 14e-3,
        ..standard(teeth)
    };
    let teeth = [tooth(16, 0.182, 82.5), tooth(24, 0.171, 118.4)];
    let pair = pair(&teeth, 91.5e-3);
    let rating = NominalRating::new(
        &pair,
        teeth.each_ref(),
        [STEEL; 2],
        [None; 2],
        (LoadPoint::HighestSingleContact, None),
    )
    .unwrap();
    let found = rating.under(4000.0).unwrap();
    let near = |found: f64, expected: f64| {
        assert!(
            (found / expected - 1.0).abs() < FIGURES,
            "{found}, {expected} by hand"
        );
    };
    near(pair.contact_ratio(), 1.443_093_538);
    let by_hand = [
        [
            1.955_831_298,
            1.168_693_395,
            0.439_086_326,
            1.794_942_251,
            1.932_418_878,
            206.945_987_6,
        ],
        [
            2.079_877_558,
            1.224_181_894,
            0.422_226_963,
            1.664_722_792,
            2.019_508_372,
            200.582_408_5,
        ],
    ];
    for (k, by_hand) in by_hand.into_iter().enumerate() {
        let gear = geometry(&teeth[k]);
        let below_tip = (pair.contact_ratio() - 1.0) * 2.0 * PI / teeth[k].teeth as f64;
        let roll = gear.flank_end_roll_rad - below_tip;
        let section = RootSection::new(&gear, roll, RootConstruction::Tangent30).unwrap();
        let iso = rating.iso_roots[k].unwrap();
        let ours = [
            section.thickness_m / 4.5e-3,
            section.lever_m / 4.5e-3,
            section.notch_radius_m / 4.5e-3,
            iso.form_factor,
            iso.stress_correction_factor,
            1e-6 * found.iso_root_pa[k].unwrap(),
        ];
        for (ours, by_hand) in ours.into_iter().zip(by_hand) {
            near(ours, by_hand);
        }
    }
    near(rating.iso_pressure.zone_factor, 2.341_929_714);
    near(rating.iso_pressure.contact_ratio_factor, 0.923_202_12);
}

/// Y_B = 1.6 ln(2.242 h_t/s_R): 1.29179 for a rim of one tooth height, continuous at 1.2, none below one half; Y_DT of
/// teeth of which three pairs may carry, and no σ_F0 from a contact ratio of 2.5 on.
#[test]
fn rims_and_deep_teeth() {
    let teeth = [standard(30), standard(40)];
    let gears = pair(&teeth, 35.1e-3);
    let own = geometry(&teeth[0]);
    let height_m = own.tip_radius_m - own.root_radius_m;
    let factor = |heights: f64| {
        IsoRoot::new(
            (&teeth[0], &own),
            &gears,
            10e-3,
            (Some(heights * height_m), None),
        )
        .unwrap()
        .map(|root| root.rim_factor)
    };
    assert!((factor(1.0).unwrap() - 1.29179).abs() < 1e-5);
    assert!((factor(0.8).unwrap() - 1.64882).abs() < 1e-5);
    assert!((factor(1.2 - 1e-9).unwrap() - 1.0).abs() < 2e-4);
    assert_eq!((factor(1.3), factor(0.49)), (Some(1.0), None));
    let long = [30, 40].map(|teeth| ToothDefinition {
        addendum: 1.35,
        dedendum: 1.6,
        rack_tip_radius: 0.15,
        ..standard(teeth)
    });
    let gears = pair(&long, 35.1e-3);
    let ratio = gears.contact_ratio();
    assert!(ratio > 2.05 && ratio < 2.5, "{ratio}");
    let own = geometry(&long[0]);
    let root = |class: Option<usize>| {
        let root = IsoRoot::new((&long[0], &own), &gears, 10e-3, (None, class));
        root.unwrap().unwrap()
    };
    // The standard's own lines, 1 and 0.7 at their ends within rounding of the coefficients.
    let fine = 2.366 - 0.666 * ratio;
    for class in [0, 4] {
        assert!((root(Some(class)).deep_tooth_factor - fine).abs() < 1e-12);
        assert_eq!(root(Some(class)).share_of_fine_classes(), None);
    }
    for class in [None, Some(5), Some(12)] {
        assert_eq!(root(class).deep_tooth_factor, 1.0);
        assert!((root(class).share_of_fine_classes().unwrap() - fine).abs() < 1e-12);
    }
    let [plain, shared] = [None, Some(4)].map(|class| root(class).stress_pa(1e3, 10e-3, 1e-3));
    assert!((shared / plain - fine).abs() < 1e-12);
    // The load stands one pitch above the lower end of the path, where the inner stretch of three pairs begins.
    let [z_n, alpha] = [30.0, 20f64.to_radians()];
    let (tip, base) = (0.5 * z_n + long[0].addendum, 0.5 * z_n * alpha.cos());
    let from_base = (tip * tip - base * base).sqrt() - PI * alpha.cos() * (ratio - 1.0);
    let [_, _, _, form] = iso_root(&long[0], z_n, from_base.hypot(base));
    assert!((root(None).form_factor / form - 1.0).abs() < 1e-9);
    assert!(VirtualGear::new(&long[0]).is_ok());
    // Deeper still there is none.
    let deeper = [60, 70].map(|teeth| ToothDefinition {
        addendum: 1.7,
        dedendum: 1.9,
        rack_tip_radius: 0.1,
        ..standard(teeth)
    });
    let gears = pair(&deeper, 65.1e-3);
    assert!(gears.contact_ratio() > 2.5, "{}", gears.contact_ratio());
    let own = geometry(&deeper[0]);
    let root = IsoRoot::new((&deeper[0], &own), &gears, 10e-3, (None, Some(3)));
    assert_eq!(root, Ok(None));
}
