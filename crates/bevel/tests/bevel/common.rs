//! Pairs of the tests.

use gearmesh_bevel::{Hand, PairBlank, PairData, Taper, ToothForm};

/// Seed 001's pair: 20/20, 3.5 mm, 35 degrees, cutter 88.9 mm.
pub fn data_20_20() -> PairData {
    PairData {
        form: ToothForm::Spiral,
        teeth: [20, 20],
        outer_module_m: 3.5e-3,
        face_width_m: [15e-3; 2],
        spiral_angle_rad: 35f64.to_radians(),
        pressure_angle_rad: 20f64.to_radians(),
        shaft_angle_rad: 90f64.to_radians(),
        pinion_hand: Hand::Right,
        taper: Taper::Standard,
        cutter_radius_m: 44.45e-3,
        thickness_shift: 0.0,
        backlash_m: 0.0,
    }
}

/// Seed 000's pair: 13/35, 5.5 mm; hand and cutter are assumptions.
pub fn data_13_35() -> PairData {
    PairData {
        teeth: [13, 35],
        outer_module_m: 5.5e-3,
        face_width_m: [30e-3, 28e-3],
        pinion_hand: Hand::Left,
        cutter_radius_m: 76.2e-3,
        ..data_20_20()
    }
}

pub fn blank(data: &PairData) -> PairBlank {
    PairBlank::new(data).unwrap()
}

pub fn near(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{found}, expected {expected} within {tolerance:e}"
    );
}
