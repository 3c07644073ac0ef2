//! S-N curve, Goodman, Miner and life against closed forms; tables that are none.

use gearmesh_geometry::Material;
use gearmesh_rating::{
    AboveTable, BelowTable, Cycle, DamageError, MeanStress, Passage, SnCurve, SnError, SnPoint,
    SnTableError, SurfaceState, history_damage, miner_damage, rainflow, root_stress_pa,
};
use proptest::prelude::*;
use std::f64::consts::TAU;

fn point(cycles: f64, mpa: f64) -> SnPoint {
    SnPoint {
        cycles,
        amplitude_pa: mpa * 1e6,
    }
}

/// Two slopes: 5 from 1e3 to 1e5 cycles, 10 from there to 1e7.
fn table() -> [SnPoint; 3] {
    let knee = 800.0 * 100f64.powf(-0.2);
    [
        point(1e3, 800.0),
        point(1e5, knee),
        point(1e7, knee * 100f64.powf(-0.1)),
    ]
}

#[test]
fn between_its_points_the_curve_has_their_slopes() {
    let [first, middle, last] = table();
    let curve = SnCurve::new(
        &[first, middle, last],
        AboveTable::FirstSlope,
        BelowTable::Haibach,
    )
    .unwrap();
    let near = |found: f64, expected: f64| assert!((found / expected - 1.0).abs() < 1e-12);
    let life = |amplitude_pa: f64| curve.cycles_to_failure(amplitude_pa).unwrap();
    for p in [first, middle, last] {
        near(life(p.amplitude_pa), p.cycles);
        near(life(-p.amplitude_pa), p.cycles);
    }
    near(life(700e6), 1e3 * (800f64 / 700.0).powi(5));
    near(life(900e6), 1e3 * (800f64 / 900.0).powi(5));
    near(
        life(0.9 * middle.amplitude_pa),
        1e5 * (1.0 / 0.9f64).powi(10),
    );
    // Haibach: 2·10 − 1.
    near(life(0.5 * last.amplitude_pa), 1e7 * 2f64.powi(19));
    assert_eq!(life(0.0), f64::INFINITY);

    let below = |rule| {
        SnCurve::new(&table(), AboveTable::Refuse, rule)
            .unwrap()
            .cycles_to_failure(0.5 * last.amplitude_pa)
            .unwrap()
    };
    assert_eq!(below(BelowTable::EnduranceLimit), f64::INFINITY);
    near(below(BelowTable::LastSlope), 1e7 * 2f64.powi(10));
    near(below(BelowTable::Slope(3.0)), 1e7 * 8.0);

    let refusing = SnCurve::new(&table(), AboveTable::Refuse, BelowTable::LastSlope).unwrap();
    for amplitude in [801e6, f64::NAN, f64::INFINITY] {
        assert!(matches!(
            refusing.cycles_to_failure(amplitude),
            Err(SnError::AboveTable { .. })
        ));
    }
    let basquin = SnCurve::basquin(point(2e6, 300.0), 6.0, BelowTable::EnduranceLimit).unwrap();
    near(
        basquin.cycles_to_failure(600e6).unwrap(),
        2e6 * 0.5f64.powi(6),
    );
    near(basquin.cycles_to_failure(300e6).unwrap(), 2e6);
    assert_eq!(basquin.cycles_to_failure(299e6), Ok(f64::INFINITY));
}

#[test]
fn tables_that_are_none_name_the_row() {
    let new = |points: &[SnPoint]| {
        SnCurve::new(points, AboveTable::Refuse, BelowTable::LastSlope).unwrap_err()
    };
    let rising = new(&[point(1e3, 500.0), point(1e4, 400.0), point(1e5, 400.0)]);
    assert!(matches!(rising, SnError::NotDecreasing { row: 3, .. }));
    assert!(rising.to_string().starts_with("row 3 of the S-N table"));
    assert!(matches!(
        new(&[point(1e3, 500.0), point(1e3, 400.0)]),
        SnError::CyclesNotIncreasing { row: 2, .. }
    ));
    assert!(matches!(
        new(&[point(1e3, 500.0), point(1e4, -1.0)]),
        SnError::NotPositive { row: 2, .. }
    ));
    assert!(matches!(
        new(&[point(f64::NAN, 500.0), point(1e4, 1.0)]),
        SnError::NotPositive { row: 1, .. }
    ));
    assert!(matches!(
        new(&[point(1e3, 500.0)]),
        SnError::TooFewRows { found: 1 }
    ));
    for slope in [0.0, -3.0, f64::NAN, f64::INFINITY] {
        assert!(SnCurve::basquin(point(1e6, 300.0), slope, BelowTable::LastSlope).is_err());
        assert!(
            SnCurve::basquin(point(1e6, 300.0), 5.0, BelowTable::Slope(slope)).is_err(),
            "{slope}"
        );
    }
    assert!(SnCurve::basquin(point(1e6, 300.0), 0.5, BelowTable::Haibach).is_err());
}

#[test]
fn tables_in_files() {
    let toml = "cycles = [1e3, 1e5, 2e6]\nstress_amplitude_MPa = [900, 520, 300]\nbelow = \"haibach\"\nabove = \"first-slope\"\n";
    let from_toml = SnCurve::from_toml(toml).unwrap();
    assert_eq!(from_toml.cycles_to_failure(300e6), Ok(2e6));

    let bad = |text: &str| SnCurve::from_toml(text).unwrap_err();
    assert!(matches!(
        bad(&toml.replace("520", "950")),
        SnTableError::Curve(SnError::NotDecreasing { row: 2, .. })
    ));
    assert!(matches!(
        bad(&toml.replace(", 300", "")),
        SnTableError::Lengths {
            cycles: 3,
            amplitudes: 2
        }
    ));
    assert_eq!(
        bad(&toml.replace("haibach", "slope")),
        SnTableError::SlopeBelow
    );
    assert_eq!(
        bad(&format!("{toml}slope_below = 3.0\n")),
        SnTableError::SlopeBelow
    );
    let unknown = bad(&format!("{toml}knee = 3.0\n")).to_string();
    assert!(unknown.contains("knee"), "{unknown}");
    assert!(matches!(bad("cycles = 3"), SnTableError::Toml { .. }));
}

/// Constant amplitude: D = n/N exactly, and the life that follows.
#[test]
fn constant_amplitude_fails_at_its_own_life() {
    let curve = SnCurve::basquin(point(2e6, 300.0), 6.0, BelowTable::EnduranceLimit).unwrap();
    let cycles = 20;
    let stress: Vec<f64> = (0..cycles * 64)
        .map(|i| 400e6 * (TAU * f64::from(i) / 64.0).sin())
        .collect();
    let damage = history_damage(&stress, Passage::Repeated, &curve, MeanStress::None).unwrap();
    let life = 2e6 * 0.75f64.powi(6);
    assert!((damage.cycles - f64::from(cycles)).abs() < 1e-12);
    assert!((damage.per_passage * life / f64::from(cycles) - 1.0).abs() < 1e-12);
    assert!((damage.life_in(f64::from(cycles)) / life - 1.0).abs() < 1e-12);
    // 20 cycles at 50 Hz last 0.4 s.
    assert!((damage.life_h(0.4) / (life / 50.0 / 3600.0) - 1.0).abs() < 1e-12);
    assert!((damage.most_damaging.unwrap().amplitude() - 400e6).abs() < 1.0);
    // Passed once, the first and the last quarter are half cycles of other ranges: less than one cycle of difference.
    let once = history_damage(&stress, Passage::Once, &curve, MeanStress::None).unwrap();
    assert!(once.per_passage <= damage.per_passage);
    assert!(once.per_passage > damage.per_passage * 18.9 / 20.0);

    let low: Vec<f64> = stress.iter().map(|s| 0.7 * s).collect();
    let none = history_damage(&low, Passage::Repeated, &curve, MeanStress::None).unwrap();
    assert_eq!((none.per_passage, none.most_damaging), (0.0, None));
    assert_eq!(none.life_h(1.0), f64::INFINITY);
}

/// The largest amplitude is the most damaging one, though only half a cycle of it is counted and a smaller one does
/// more in all.
#[test]
fn the_most_damaging_cycle_is_that_of_the_shortest_life() {
    let curve = SnCurve::basquin(point(2e6, 300.0), 6.0, BelowTable::LastSlope).unwrap();
    let cycle = |amplitude: f64, count: f64| Cycle {
        minimum: -amplitude,
        maximum: amplitude,
        count,
    };
    let cycles = [cycle(290e6, 1.0), cycle(300e6, 0.5), cycle(300e6, 0.5)];
    let damage = miner_damage(&cycles, &curve, MeanStress::None).unwrap();
    assert_eq!(damage.most_damaging, Some(cycles[1]));
    let expected = ((290.0_f64 / 300.0).powi(6) + 1.0) / 2e6;
    assert!((damage.per_passage / expected - 1.0).abs() < 1e-12);
}

/// A tooth's root is loaded once a turn from zero: σ_m = σ_a. Goodman: σ_ar = σ_a/(1 − σ_a/R_m).
#[test]
fn goodman_raises_a_pulsating_stress() {
    let curve = SnCurve::basquin(point(2e6, 300.0), 6.0, BelowTable::LastSlope).unwrap();
    let strength = MeanStress::Goodman {
        tensile_strength_pa: 1200e6,
    };
    let pulse = [0.0, 600e6, 0.0];
    let damage = history_damage(&pulse, Passage::Repeated, &curve, strength).unwrap();
    let expected = 2e6 * (1.0 - 0.25f64).powi(6);
    assert!((damage.passages_to_failure() / expected - 1.0).abs() < 1e-12);
    // Compression is given no credit.
    let pressed = [0.0, -600e6, 0.0];
    let found = history_damage(&pressed, Passage::Repeated, &curve, strength).unwrap();
    let without = history_damage(&pressed, Passage::Repeated, &curve, MeanStress::None).unwrap();
    assert_eq!(found.per_passage, without.per_passage);

    let high = [1100e6, 1400e6];
    assert!(matches!(
        history_damage(&high, Passage::Repeated, &curve, strength),
        Err(DamageError::MeanAboveStrength { .. })
    ));
    for tensile_strength_pa in [0.0, -1.0, f64::NAN] {
        let bad = MeanStress::Goodman {
            tensile_strength_pa,
        };
        assert!(matches!(
            history_damage(&pulse, Passage::Repeated, &curve, bad),
            Err(DamageError::TensileStrength { .. })
        ));
    }
}

#[test]
fn strain_becomes_stress() {
    let steel = Material {
        young_pa: 210e9,
        poisson: 0.3,
        density_kg_per_m3: None,
    };
    let strain = [1e-3, -5e-4];
    assert_eq!(
        root_stress_pa(&strain, steel, SurfaceState::Uniaxial),
        [210e6, -105e6]
    );
    let held = root_stress_pa(&strain, steel, SurfaceState::PlaneStrain);
    assert!((held[0] - 210e6 / 0.91).abs() < 1.0);
}

proptest! {
    #[test]
    fn damage_is_linear_in_the_repetition(
        x in prop::collection::vec(-500e6..500e6f64, 2..60), times in 1usize..6, strength in 600e6..2000e6f64,
    ) {
        let curve = SnCurve::basquin(point(2e6, 300.0), 5.0, BelowTable::Haibach).unwrap();
        for mean in [MeanStress::None, MeanStress::Goodman { tensile_strength_pa: strength }] {
            let of = |x: &[f64]| history_damage(x, Passage::Repeated, &curve, mean).unwrap().per_passage;
            let (one, many) = (of(&x), of(&x.repeat(times)));
            prop_assert!((many - times as f64 * one).abs() <= 1e-10 * many);
        }
    }

    #[test]
    fn more_stress_is_more_damage(x in prop::collection::vec(-300e6..300e6f64, 2..60), factor in 1.0..1.9f64) {
        // Scaled by a factor, damage grows at least with the smaller slope.
        let curve = SnCurve::new(&table(), AboveTable::FirstSlope, BelowTable::LastSlope).unwrap();
        let of = |x: &[f64]| {
            miner_damage(&rainflow(x, Passage::Once).unwrap(), &curve, MeanStress::None).unwrap().per_passage
        };
        let scaled: Vec<f64> = x.iter().map(|v| factor * v).collect();
        prop_assert!(of(&scaled) >= of(&x) * factor.powi(5) * (1.0 - 1e-12));
    }
}
