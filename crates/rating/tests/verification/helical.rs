//! Helical teeth: the virtual gear against ISO 6336-3's equations, contact lines against counting, pressure against ISO
//! 6336-2's factors, and the limit of a vanishing helix.

use crate::bending::iso_root;
use crate::teeth::{MODULE_M, geometry, standard};
use gearmesh_geometry::{GearPair, Material, Misalignment, ToothDefinition};
use gearmesh_rating::{
    LoadPoint, NominalError, NominalRating, RootConstruction, RootSection, RootSectionError,
    VirtualGear, highest_single_contact_roll_rad, shortest_contact_length_m,
};
use std::f64::consts::PI;

const STEEL: Material = Material {
    young_pa: 210e9,
    poisson: 0.3,
    density_kg_per_m3: None,
};

fn helical(teeth: usize, helix_deg: f64) -> ToothDefinition {
    ToothDefinition {
        profile_shift: 0.1,
        helix_angle_rad: helix_deg.to_radians(),
        ..standard(teeth)
    }
}

/// The teeth of both gears and the pair, on a centre distance a little above the one without backlash.
fn pair(teeth: [usize; 2], helix_deg: f64, width_m: f64) -> ([ToothDefinition; 2], GearPair) {
    let of = |teeth, sign: f64| ToothDefinition {
        face_width_m: width_m,
        ..helical(teeth, sign * helix_deg)
    };
    let gears = [of(teeth[0], 1.0), of(teeth[1], -1.0)];
    let sum = (teeth[0] + teeth[1]) as f64;
    let distance_m = MODULE_M * (0.5 * sum / helix_deg.to_radians().cos() + 0.21);
    let pair = GearPair::new(
        geometry(&gears[0]),
        geometry(&gears[1]),
        distance_m,
        Misalignment::default(),
    )
    .unwrap();
    (gears, pair)
}

/// Form factor Y_F of a helical tooth with the load at the highest point of single contact: by the virtual gears of
/// this crate, and by the equations of ISO 6336-3:2006, 6.2, with a real number of teeth.
fn form_factors(d: &ToothDefinition, transverse_contact_ratio: f64) -> [f64; 2] {
    let gear = VirtualGear::new(d).unwrap();
    let ratio = gear.contact_ratio(transverse_contact_ratio);
    let ours = gear.interpolated(|tooth| {
        let roll = highest_single_contact_roll_rad(tooth, ratio)?;
        let section = RootSection::new(tooth, roll, RootConstruction::Tangent30)?;
        Ok::<_, RootSectionError>(section.iso_form_factor(MODULE_M, d.pressure_angle_rad))
    });
    // In modules, with the standard's own names.
    let (alpha_n, beta, z) = (d.pressure_angle_rad, d.helix_angle_rad, d.teeth as f64);
    let beta_b = (beta.sin() * alpha_n.cos()).asin();
    let z_n = z / (beta_b.cos().powi(2) * beta.cos());
    let d_an = z_n + 2.0 * (d.addendum + d.profile_shift);
    let (d_bn, p_bn) = (z_n * alpha_n.cos(), PI * alpha_n.cos());
    let ratio = transverse_contact_ratio / beta_b.cos().powi(2);
    let from_base = (0.25 * (d_an * d_an - d_bn * d_bn)).sqrt() - p_bn * (ratio - 1.0);
    let load_radius = from_base.hypot(0.5 * d_bn);
    [ours.unwrap(), iso_root(d, z_n, load_radius)[3]]
}

/// Between whole numbers of virtual teeth ours is linear: at most 3e-4 off here, of the order of 1/z³. At a whole
/// number it is exact.
#[test]
fn the_virtual_gear_is_that_of_iso_6336_3() {
    let mut worst = [0.0_f64; 2];
    for (case, teeth) in [17, 40].into_iter().enumerate() {
        for helix_deg in [0.0, -3.0, 10.0, 15.8, 22.0, 30.0] {
            let [ours, iso] = form_factors(&helical(teeth, helix_deg), 1.45);
            worst[case] = worst[case].max((ours / iso - 1.0).abs());
        }
    }
    assert!(worst[0] < 3e-4 && worst[0] > 1e-6, "{worst:?}");
    assert!(worst[1] < 0.15 * worst[0], "{worst:?}");
    // The helix at which 20 teeth are like 25.
    let virtual_teeth = |degrees: f64| geometry(&helical(20, degrees)).virtual_teeth();
    let (mut low, mut high) = (10.0, 30.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if virtual_teeth(middle) < 25.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    let [ours, iso] = form_factors(&helical(20, low), 1.45);
    assert!((ours / iso - 1.0).abs() < 1e-9, "{ours} {iso}");
}

/// Total length of the contact lines over a mesh cycle, counted section by section.
#[test]
fn contact_lines_are_as_short_as_counted() {
    for (teeth, helix_deg, width_m) in [
        ([17, 40], 12.0, 6e-3),
        ([17, 40], 22.0, 12e-3),
        ([25, 25], 30.0, 9e-3),
        ([40, 63], 8.0, 30e-3),
        ([40, 63], 0.5, 10e-3),
    ] {
        let (_, pair) = pair(teeth, helix_deg, width_m);
        let slope = pair.roll_slope_1_rad_per_m();
        let total = |angle_rad: f64| -> f64 {
            (-12..=12)
                .map(|number| {
                    // Where along the axis this pair's line begins and ends.
                    let at = |roll: f64| (roll - pair.roll_1_rad(angle_rad, number)) / slope;
                    let ends = [at(pair.roll_start_1_rad), at(pair.roll_end_1_rad)];
                    let low = ends[0].min(ends[1]).max(-0.5 * width_m);
                    let high = ends[0].max(ends[1]).min(0.5 * width_m);
                    (high - low).max(0.0)
                })
                .sum()
        };
        let steps = 20_000;
        let counted = (0..steps)
            .map(|k| total(pair.pitch_1_rad() * f64::from(k) / f64::from(steps)))
            .fold(f64::MAX, f64::min)
            / pair.base_helix_angle_rad().cos();
        let found = shortest_contact_length_m(&pair, width_m);
        // The shortest position is met to a step: 25 lines at most, each changing by the cycle's length over the steps.
        let step_m = pair.pitch_1_rad() / slope.abs() / f64::from(steps);
        assert!(
            (found - counted).abs() < 4.0 * step_m + 1e-12,
            "{teeth:?} {helix_deg}: {found} {counted}"
        );
    }
}

/// σ_H0 = Z_H Z_E Z_ε √(F_t/(d₁ b) (u + 1)/u) of ISO 6336-2:2006 with Z_ε² = 1/ε_α: where the overlap ratio is a whole
/// number the contact lines are as long all the time as the standard takes them to be. (Its Z_β, from experience, is no
/// part of Hertz's pressure.)
#[test]
fn the_pressure_is_that_of_iso_6336_2() {
    let (alpha_n, helix_deg) = (20f64.to_radians(), 18.0f64);
    let beta = helix_deg.to_radians();
    for overlap in [1.0, 2.0] {
        let width_m = overlap * PI * MODULE_M / beta.sin();
        let (gears, pair) = pair([23, 61], helix_deg, width_m);
        let rating = NominalRating::new(
            &pair,
            [&gears[0], &gears[1]],
            [STEEL; 2],
            [None; 2],
            (LoadPoint::Tip, None),
        )
        .unwrap();
        let tangential_n = 3000.0;
        let alpha_t = (alpha_n.tan() / beta.cos()).atan();
        let beta_b = (beta.sin() * alpha_n.cos()).asin();
        let found = rating
            .under(tangential_n / (alpha_t.cos() * beta_b.cos()))
            .unwrap();
        let alpha_wt = pair.working_pressure_angle_rad;
        let zone =
            (2.0 * beta_b.cos() * alpha_wt.cos() / (alpha_t.cos().powi(2) * alpha_wt.sin())).sqrt();
        let elastic = (1.0 / (PI * 2.0 * (1.0 - 0.09) / 210e9)).sqrt();
        // The standard's table: 189.8 √(N/mm²) for 206 GPa.
        assert!((elastic * (206.0 / 210.0_f64).sqrt() / 1e3 - 189.8).abs() < 0.05);
        let (ratio, diameter_m) = (61.0 / 23.0, 23.0 * MODULE_M / beta.cos());
        let expected = zone * elastic / pair.contact_ratio().sqrt()
            * (tangential_n / (diameter_m * width_m) * (ratio + 1.0) / ratio).sqrt();
        let off = found.flank_pressure_pa / expected - 1.0;
        assert!(off.abs() < 1e-9, "overlap {overlap}: {off:e}");
        // The standard's own has Z_β = 1/√cos β as well.
        let iso = found.iso_pressure_pa / (expected / beta.cos().sqrt());
        assert!((iso - 1.0).abs() < 1e-9, "overlap {overlap}: {iso}");
        // Lewis with the tangential force at the reference circle.
        let lewis = tangential_n / (width_m * MODULE_M * rating.lewis_factors[0]);
        assert!((found.lewis_pa[0] / lewis - 1.0).abs() < 1e-12);
    }
}

/// The narrower gear carries the force: a wider mate changes nothing, whichever of the two it is.
#[test]
fn a_wider_mate_changes_nothing() {
    let load = LoadPoint::HighestSingleContact;
    for helix_deg in [0.0, 18.0] {
        let (gears, pair) = pair([17, 40], helix_deg, 12e-3);
        let wider = gears.clone().map(|gear| ToothDefinition {
            face_width_m: 20e-3,
            ..gear
        });
        let of = |teeth: [&ToothDefinition; 2]| {
            let rating =
                NominalRating::new(&pair, teeth, [STEEL; 2], [None; 2], (load, None)).unwrap();
            rating.under(2000.0).unwrap()
        };
        let alike = of([&gears[0], &gears[1]]);
        assert_eq!(of([&wider[0], &gears[1]]), alike);
        assert_eq!(of([&gears[0], &wider[1]]), alike);
    }
}

/// As the helix vanishes everything tends to the spur pair: Y with β² (through z_n), the pressure with the overlap,
/// hence with β.
#[test]
fn a_vanishing_helix_is_a_spur_pair() {
    let load = LoadPoint::HighestSingleContact;
    let stresses = |helix_deg: f64| {
        let (gears, pair) = pair([17, 40], helix_deg, 12e-3);
        let rating = NominalRating::new(
            &pair,
            [&gears[0], &gears[1]],
            [STEEL; 2],
            [None; 2],
            (load, None),
        )
        .unwrap();
        let found = rating.under(2000.0).unwrap();
        [
            found.lewis_pa[0],
            found.lewis_pa[1],
            found.flank_pressure_pa,
        ]
    };
    let spur = stresses(0.0);
    let off = |helix_deg: f64| -> [f64; 3] {
        let found = stresses(helix_deg);
        std::array::from_fn(|k| (found[k] / spur[k] - 1.0).abs())
    };
    let (near, nearer) = (off(0.2), off(0.02));
    for (quantity, power) in [(0, 2), (1, 2), (2, 1)] {
        let order = (near[quantity] / nearer[quantity]).log10();
        assert!(
            (order - f64::from(power)).abs() < 0.05,
            "{quantity}: {near:?} {nearer:?}"
        );
    }
    assert!(near[0] < 2e-4 && near[2] < 2e-2, "{near:?}");
}

#[test]
fn what_cannot_be_rated_is_refused() {
    let (gears, helix) = pair([17, 40], 20.0, 12e-3);
    let rate = |load| {
        NominalRating::new(
            &helix,
            [&gears[0], &gears[1]],
            [STEEL; 2],
            [None; 2],
            (load, None),
        )
    };
    let rating = rate(LoadPoint::Tip).unwrap();
    for force in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0] {
        assert!(matches!(
            rating.under(force),
            Err(NominalError::Force { .. })
        ));
    }
    // 1.8 transverse pairs on teeth of 40 degrees are more than two in the normal section.
    let gear = VirtualGear::new(&helical(40, 40.0)).unwrap();
    assert!(gear.contact_ratio(1.8) > 2.0);
    assert!(matches!(
        gear.lewis_factor(LoadPoint::HighestSingleContact, 1.8),
        Err(RootSectionError::NoSingleContact { .. })
    ));
    assert!(gear.lewis_factor(LoadPoint::Tip, 1.8).unwrap() > 0.3);
}
