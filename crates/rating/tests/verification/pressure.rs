//! Hertz pressure of a pair against the textbook and the figures stated for pair A (seed 004 in docs/sources.md).

use crate::teeth::{geometry, standard};
use gearmesh_geometry::{GearPair, Material, Misalignment, ToothDefinition};
use gearmesh_rating::{FlankPressureError, flank_pressure};
use std::f64::consts::PI;

const STEEL: Material = Material {
    young_pa: 210e9,
    poisson: 0.3,
    density_kg_per_m3: None,
};

/// Seed 004's pair: z 57/57, m 2.6 mm, a 150 mm.
fn pair() -> GearPair {
    let tooth = ToothDefinition {
        module_m: 2.6e-3,
        profile_shift: 0.33,
        rack_tip_radius: 0.38,
        ..standard(57)
    };
    GearPair::new(
        geometry(&tooth),
        geometry(&tooth),
        0.15,
        Misalignment::default(),
    )
    .unwrap()
}

#[test]
fn at_the_pitch_point_the_closed_form_holds() {
    let pair = pair();
    let roll = pair.working_pressure_angle_rad.tan();
    // 300 N·m on 23 mm; radii of curvature a sin α_w/2 each.
    let force = 300.0 / pair.gear_1.base_radius_m;
    let q = force / 23e-3;
    let found = flank_pressure(&pair, roll, q, [STEEL; 2]).unwrap();
    let radius = 0.25 * 0.15 * pair.working_pressure_angle_rad.sin();
    assert!((found.relative_radius_m - radius).abs() < 1e-12);
    // docs/sources.md: 27.87 mm each and a half width of 0.170 mm.
    assert!((2.0 * radius - 27.87e-3).abs() < 5e-6);
    assert!((found.half_width_m - 0.170e-3).abs() < 0.5e-6);
    // K. L. Johnson eq. 4.45: p₀ = √(q E*/(π ρ)).
    let modulus = 210e9 / (2.0 * (1.0 - 0.09));
    let expected = (q * modulus / (PI * radius)).sqrt();
    assert!((found.peak_pressure_pa / expected - 1.0).abs() < 1e-12);
    // The pressure's integral is the load.
    let load = 0.5 * PI * found.half_width_m * found.peak_pressure_pa;
    assert!((load / q - 1.0).abs() < 1e-12);
    assert_eq!(
        flank_pressure(&pair, roll, 0.0, [STEEL; 2])
            .unwrap()
            .peak_pressure_pa,
        0.0
    );
}

#[test]
fn what_is_no_contact_is_refused() {
    let pair = pair();
    let roll = pair.roll_end_1_rad;
    assert!(flank_pressure(&pair, roll, 1e5, [STEEL; 2]).is_ok());
    for off in [roll + 0.01, pair.roll_start_1_rad - 0.01, f64::NAN] {
        assert!(matches!(
            flank_pressure(&pair, off, 1e5, [STEEL; 2]),
            Err(FlankPressureError::OffPath { .. })
        ));
    }
    for load in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(flank_pressure(&pair, roll, load, [STEEL; 2]).is_err());
    }
    for (young_pa, poisson) in [(0.0, 0.3), (2e11, 0.6), (f64::NAN, 0.3), (2e11, f64::NAN)] {
        let bad = Material {
            young_pa,
            poisson,
            density_kg_per_m3: None,
        };
        assert!(flank_pressure(&pair, roll, 1e5, [STEEL, bad]).is_err());
    }
}
