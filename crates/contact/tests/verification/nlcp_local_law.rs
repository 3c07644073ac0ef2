//! The local law: its two numbers against the textbook formula, its continuation at both ends.
#![allow(clippy::unwrap_used, clippy::needless_range_loop)] // test code in index notation

use std::f64::consts::PI;

use gearmesh_contact::LocalContact;
use gearmesh_contact::nlcp::{
    ContactBody, EdgeContact, HALF_WIDTH_LIMIT, LEAST_SLOPE, LineContact, LocalLaw, LocalLawError,
    WEDGE_WIDTH,
};

fn contact() -> LineContact {
    LineContact {
        width_m: 4.6e-3,
        relative_radius_m: 13e-3,
        bodies: [
            ContactBody {
                youngs_modulus_pa: 210e9,
                poisson_ratio: 0.3,
                depth_m: 4.1e-3,
            },
            ContactBody {
                youngs_modulus_pa: 70e9,
                poisson_ratio: 0.33,
                depth_m: 3.2e-3,
            },
        ],
    }
}

/// Weber-Banaschek as printed, no collapse of constants.
fn textbook(contact: &LineContact, force: f64) -> f64 {
    let q = force / contact.width_m;
    let sum: f64 = contact
        .bodies
        .iter()
        .map(|b| (1.0 - b.poisson_ratio.powi(2)) / b.youngs_modulus_pa)
        .sum();
    let a = (4.0 * q * contact.relative_radius_m / PI * sum).sqrt();
    let body = |b: &ContactBody| {
        let k = 2.0 * (1.0 - b.poisson_ratio.powi(2)) / (PI * b.youngs_modulus_pa);
        k * q * ((2.0 * b.depth_m / a).ln() - b.poisson_ratio / (2.0 * (1.0 - b.poisson_ratio)))
    };
    contact.bodies.iter().map(body).sum()
}

#[test]
fn collapsed_law_is_the_textbook_formula() {
    let law = LocalLaw::weber_banaschek(&contact(), 1e-3).unwrap();
    for force in [1e-2, 1.0, 50.0, 1e3, 2e4] {
        assert!(force < law.cap_n());
        assert!((law.deflection(force) / textbook(&contact(), force) - 1.0).abs() < 1e-13);
    }
}

#[test]
fn half_width_of_a_steel_pair() {
    // Equal steel bodies, q = 100 N/mm, relative radius 10 mm: a = sqrt(8 q ρ (1 − ν²)/(π E)).
    let body = ContactBody {
        youngs_modulus_pa: 210e9,
        poisson_ratio: 0.3,
        depth_m: 1e-2,
    };
    let contact = LineContact {
        width_m: 1e-2,
        relative_radius_m: 1e-2,
        bodies: [body; 2],
    };
    let expected = (8.0 * 1e5 * 1e-2 * 0.91 / (PI * 210e9)).sqrt();
    assert!((contact.half_width_m(1e3) / expected - 1.0).abs() < 1e-14);
}

#[test]
fn law_is_monotone_and_smooth_at_both_ends() {
    let law = LocalLaw::weber_banaschek(&contact(), 1e-3).unwrap();
    assert!(law.is_monotone());
    assert_eq!(law.deflection(0.0), 0.0);
    let (mut force, mut last, mut last_slope) = (1e-9, 0.0, law.slope(0.0));
    while force < 1e9 {
        let (deflection, slope) = law.evaluate(force);
        assert!(deflection > last && slope > 0.0 && slope <= last_slope);
        (last, last_slope) = (deflection, slope);
        force *= 1.1;
    }
    for joint in [law.floor_n(), law.cap_n()] {
        let (below, above) = (
            law.evaluate(joint * (1.0 - 1e-12)),
            law.evaluate(joint * (1.0 + 1e-12)),
        );
        assert!((below.0 / above.0 - 1.0).abs() < 1e-11);
        assert!((below.1 / above.1 - 1.0).abs() < 1e-11);
    }
    assert!(law.is_below_floor(0.5e-3) && !law.is_below_floor(0.0) && !law.is_below_floor(1.0));
    assert!(law.is_above_cap(2.0 * law.cap_n()) && !law.is_above_cap(1.0));
}

#[test]
fn cap_is_where_the_half_width_reaches_its_limit() {
    let law = LocalLaw::weber_banaschek(&contact(), 1e-3).unwrap();
    let half_width = contact().half_width_m(law.cap_n());
    assert!((half_width / (HALF_WIDTH_LIMIT * 3.2e-3) - 1.0).abs() < 1e-13);
}

#[test]
fn slope_and_energy_are_derivative_and_integral() {
    let law = LocalLaw::weber_banaschek(&contact(), 1.0).unwrap();
    for force in [0.3, 0.9, 1.5, 800.0, 0.9 * law.cap_n(), 3.0 * law.cap_n()] {
        let h = 1e-4 * force;
        let difference = (law.deflection(force + h) - law.deflection(force - h)) / (2.0 * h);
        // Truncation of the central difference, O(h²/F²) = 1e-8.
        assert!((difference / law.slope(force) - 1.0).abs() < 1e-7);
        let work = (law.stored_energy(force + h) - law.stored_energy(force - h)) / (2.0 * h);
        assert!((work / (force * law.slope(force)) - 1.0).abs() < 1e-6);
    }
    assert_eq!(law.stored_energy(0.0), 0.0);
}

/// A slice that touches over a share of its width: the complementary energy changes with the share at constant force as
/// the rate says, below the floor, on the logarithm and beyond the cap.
#[test]
fn the_energy_grows_with_the_width_as_the_rate_says() {
    let share = 0.37;
    for (local, growths) in [
        (LocalContact::WeberBanaschek, [0.0, 0.0]),
        (LocalContact::Calibrated, [-0.3, -0.2]),
    ] {
        let at = |share_now: f64| {
            let mut contact = contact();
            contact.width_m *= share_now;
            for (body, growth) in contact.bodies.iter_mut().zip(growths) {
                body.depth_m *= (growth * (share_now - share)).exp();
            }
            (contact, local.law(&contact, 1e-3).unwrap())
        };
        let (contact, law) = at(share);
        let rate = local.law_rate_by_share((&contact, &law), growths, share);
        for force in [5e-4, 1.0, 300.0, 2.0 * law.cap_n()] {
            let h = 1e-5;
            let [more, less] = [share + h, share - h].map(|s| at(s).1.complementary_energy(force));
            let expected = (more - less) / (2.0 * h);
            let found = law.complementary_energy_rate(force, rate.alpha, rate.cap)
                + rate.beta * law.complementary_energy_by_beta(force);
            assert!(
                (found / expected - 1.0).abs() < 1e-7,
                "{local:?} {force}: {found} {expected}"
            );
        }
    }
}

#[test]
fn no_law_and_bad_laws() {
    assert_eq!(LocalLaw::none().evaluate(1e3), (0.0, 0.0));
    assert_eq!(LocalLaw::none().stored_energy(1e3), 0.0);
    assert!(LocalLaw::none().is_monotone());
    let mut bad = contact();
    bad.bodies[1].poisson_ratio = 0.6;
    assert_eq!(
        LocalLaw::weber_banaschek(&bad, 1.0),
        Err(LocalLawError::PoissonRatio { found: 0.6 })
    );
    assert!(matches!(
        LocalLaw::weber_banaschek(
            &LineContact {
                width_m: 0.0,
                ..contact()
            },
            1.0
        ),
        Err(LocalLawError::NotPositive { .. })
    ));
    let too_large = LocalLaw::weber_banaschek(&contact(), 1e9).unwrap_err();
    assert!(matches!(too_large, LocalLawError::FloorAboveCap { .. }));
    let words = "the load is too large for teeth of this size";
    assert!(too_large.to_string().contains(words), "{too_large}");
    assert!(matches!(
        LocalLaw::logarithmic(f64::NAN, 0.0, 1.0, 2.0),
        Err(LocalLawError::Coefficient { what: "alpha", .. })
    ));
    assert!(matches!(
        LocalLaw::logarithmic(0.0, -1.0, 1.0, 2.0),
        Err(LocalLawError::Coefficient { what: "beta", .. })
    ));
}

/// Effective depths of a calibration are those of the hats, smaller than the half widths that Weber and Banaschek's cap
/// allows: the law goes on as far as its slope is positive.
#[test]
fn calibrated_law_follows_the_logarithm_until_its_slope_is_used_up() {
    let mut shallow = contact();
    for body in &mut shallow.bodies {
        body.depth_m = 3e-4;
    }
    let law = LocalLaw::calibrated(&shallow, 1e-3).unwrap();
    let weber = LocalLaw::weber_banaschek(&shallow, 1e-3).unwrap();
    assert!(law.is_monotone());
    assert!(
        law.cap_n() > 2.0 * weber.cap_n(),
        "{} {}",
        law.cap_n(),
        weber.cap_n()
    );
    for share in [1e-6, 1e-3, 0.1, 0.5, 0.999] {
        let force = share * law.cap_n();
        let expected = textbook(&shallow, force);
        assert!((law.deflection(force) / expected - 1.0).abs() < 1e-12);
        assert!(law.slope(force) > 0.0);
    }
    assert!((law.slope(law.cap_n()) / (LEAST_SLOPE * law.beta()) - 1.0).abs() < 1e-9);
    // Within 1 % of where the slope is zero.
    let zero = (law.alpha() / law.beta() - 1.0).exp();
    assert!(law.cap_n() < zero && law.cap_n() > 0.99 * zero);
}

/// An edge shrinks the half width from Hertz's to the wedge's and the rounded edge's; the deflection is that of the
/// smooth contact with the smaller half width, grows with the force, and its energy is its integral.
#[test]
fn an_edge_shrinks_the_half_width() {
    let contact = contact();
    let smooth = LocalLaw::weber_banaschek(&contact, 1e-3).unwrap();
    let edge_radius = 1e-4;
    assert_eq!(EdgeContact::new(&contact, 0.0, edge_radius), None);
    for tilt in [-1e-6, -1e-3, 0.01, 0.06] {
        let edge = EdgeContact::new(&contact, tilt, edge_radius).unwrap();
        let law = smooth.with_edge(Some(edge));
        assert_eq!(law.evaluate(0.0).0, 0.0);
        let mut last = (0.0, f64::INFINITY);
        for k in 0..60 {
            let force = 1e-2 * 1.3f64.powi(k);
            let narrower = -2.0 * smooth.beta() * force * edge.half_width_share(force).ln();
            let expected = smooth.deflection(force) + narrower;
            let (deflection, slope) = law.evaluate(force);
            assert!((deflection / expected - 1.0).abs() < 1e-12);
            assert!(deflection > last.0 && slope > 0.0 && slope <= last.1);
            last = (deflection, slope);
            let h = 1e-4 * force;
            let difference = (law.deflection(force + h) - law.deflection(force - h)) / (2.0 * h);
            assert!((difference / slope - 1.0).abs() < 1e-6, "{tilt} {force}");
            let work = (law.stored_energy(force + h) - law.stored_energy(force - h)) / (2.0 * h);
            assert!(
                (work / (force * slope) - 1.0).abs() < 1e-5,
                "{tilt} {force}"
            );
        }
    }
    // The three limits: no tilt, a sharp edge under a steep angle, a light load on a rounded edge.
    let share = |tilt, radius, force| {
        EdgeContact::new(&contact, tilt, radius)
            .unwrap()
            .half_width_share(force)
    };
    assert!((share(1e-7, edge_radius, 1e3) - 1.0).abs() < 1e-6);
    let (force, tilt) = (1e3, 0.3);
    let compliance: f64 = contact
        .bodies
        .iter()
        .map(|b| (1.0 - b.poisson_ratio.powi(2)) / b.youngs_modulus_pa)
        .sum();
    let wedge = WEDGE_WIDTH * force / contact.width_m * compliance / tilt;
    let found = share(tilt, 0.0, force) * contact.half_width_m(force);
    assert!((found / wedge - 1.0).abs() < 1e-3, "{found} {wedge}");
    let rounded = LineContact {
        relative_radius_m: edge_radius,
        ..contact
    };
    let found = share(tilt, edge_radius, 1e-4) * contact.half_width_m(1e-4);
    assert!((found / rounded.half_width_m(1e-4) - 1.0).abs() < 1e-3);
}

/// Rates of α against differences: a body that grows deeper, a contact that grows flatter.
#[test]
fn alpha_moves_with_depths_and_radius_as_its_rate_says() {
    let alpha = |depth_shares: [f64; 2], radius_share: f64| {
        let mut contact = contact();
        contact.relative_radius_m *= 1.0 + radius_share;
        for (body, share) in contact.bodies.iter_mut().zip(depth_shares) {
            body.depth_m *= 1.0 + share;
        }
        LocalLaw::weber_banaschek(&contact, 1e-3).unwrap().alpha()
    };
    let h = 1e-5;
    let rates = [
        (contact().alpha_rate(0, 1.0, 0.0), [h, 0.0], 0.0),
        (contact().alpha_rate(1, 1.0, 0.0), [0.0, h], 0.0),
        (contact().alpha_rate(0, 0.0, 1.0), [0.0, 0.0], h),
        (contact().alpha_rate(1, 0.3, -0.7), [0.0, 0.3 * h], -0.7 * h),
    ];
    for (rate, depths, radius) in rates {
        let slope =
            (alpha(depths, radius) - alpha(depths.map(|share| -share), -radius)) / (2.0 * h);
        assert!((rate / slope - 1.0).abs() < 1e-8, "{rate:e} {slope:e}");
    }
}

/// K. L. Johnson, Contact Mechanics, section 4.2(c): a² = 4 q ρ/(π E*), p₀² = q E*/(π ρ), and the load is the
/// pressure's integral π a p₀/2.
#[test]
fn hertz_pressure_carries_the_load() {
    let (q, radius, modulus) = (150e3_f64, 8e-3, 115e9);
    let a = gearmesh_contact::hertz::half_width_m(q, radius, 1.0 / modulus);
    let p = gearmesh_contact::hertz::peak_pressure_pa(q, a);
    assert!((p / (q * modulus / (PI * radius)).sqrt() - 1.0).abs() < 1e-14);
    assert!((0.5 * PI * a * p / q - 1.0).abs() < 1e-14);
}
