//! Ratings and lives.

use crate::common::{B218, B6205, ROLLERS, bearing, close, definition, life_of_balls, on_springs};
use gearmesh_bearings::definition::BearingDefinition;
use gearmesh_bearings::life::Lubrication;
use gearmesh_bearings::ratings::{ball_dynamic_factor, ball_static_factor, roller_dynamic_factor};
use gearmesh_bearings::{AppliedBearingLoad, TiltCondition};
use gearmesh_bearings::{Life, Operation, QuasiStaticBearing, Ratings};

fn life(definition: &BearingDefinition, force_n: [f64; 3], tilt: TiltCondition) -> Life {
    let bearing = QuasiStaticBearing::new(definition).unwrap();
    let operation = Operation::default();
    let load = AppliedBearingLoad { force_n, tilt };
    let pose = bearing.equilibrium(&load, &operation).unwrap();
    let (_, loads) = bearing.loads(&pose, &operation).unwrap();
    Life::of(definition, &loads, force_n, &operation, None)
}

/// ISO 281, table 2, at γ = 0.05, 0.10, 0.16, 0.20: 46.7, 55.5, 59.6, 59.9 (printed with one digit).
#[test]
fn dynamic_factors_of_balls_are_those_of_the_table() {
    for (gamma, printed) in [(0.05, 46.7), (0.10, 55.5), (0.16, 59.6), (0.20, 59.9)] {
        close(ball_dynamic_factor(gamma), printed, 2.5e-3);
    }
    close(roller_dynamic_factor(0.2), 88.7, 1e-2);
}

/// ISO 76, table 1: f₀ at γ = 0, 0.05, 0.1, 0.2, 0.3 is 14.7, 15.7, 16.4, 14.0, 11.6.
#[test]
fn static_factors_of_balls_are_those_of_the_table() {
    for (gamma, printed) in [
        (0.0, 14.7),
        (0.05, 15.7),
        (0.10, 16.4),
        (0.20, 14.0),
        (0.30, 11.6),
    ] {
        close(ball_static_factor(gamma), printed, 1e-2);
    }
}

/// Every ball carries the same under pure thrust: L10r = (Q_c/Q)³ with Q_c of both races together, as Lundberg and
/// Palmgren have it.
#[test]
fn even_load_gives_the_theoretical_life() {
    let definition = definition(B218);
    let force = 5000.0;
    let bearing = QuasiStaticBearing::new(&definition).unwrap();
    let operation = Operation::default();
    let tilt = TiltCondition::Moments([0.0; 2]);
    let load = AppliedBearingLoad {
        force_n: [0.0, 0.0, force],
        tilt,
    };
    let pose = bearing.equilibrium(&load, &operation).unwrap();
    let (_, loads) = bearing.loads(&pose, &operation).unwrap();
    let q = loads.elements[0][0].inner_load_n;
    for ball in &loads.elements[0] {
        close(ball.inner_load_n, q, 1e-9);
        close(ball.outer_load_n, q, 1e-9);
    }
    let found = Life::of(&definition, &loads, load.force_n, &operation, None);
    // Capacity of one contact from C by the same standard's two shares, here written out anew.
    let c = Ratings::of(&definition).dynamic_n;
    let angle = 40.0_f64.to_radians();
    let gamma = 22.23 * angle.cos() / 125.3;
    let ratio = 1.044 * ((1.0 - gamma) / (1.0 + gamma)).powf(1.72);
    let even = c / (16.0 * angle.cos().powf(0.7));
    let inner = even / 0.407 * (1.0 + ratio.powf(10.0 / 3.0)).powf(0.3);
    let outer = even / 0.389 * (1.0 + ratio.powf(-10.0 / 3.0)).powf(0.3);
    let both = (inner.powf(-10.0 / 3.0) + outer.powf(-10.0 / 3.0)).powf(-0.3);
    close(found.reference_mrev, (both / q).powi(3), 1e-9);
}

/// Half the balls loaded, no clearance, many balls: what ISO 281's C stands for. L10r is then L10.
#[test]
fn a_load_zone_of_half_the_turn_gives_l10() {
    let text = B6205
        .replace("balls = 9", "balls = 60")
        .replace("ball_diameter_mm = 7.938", "ball_diameter_mm = 2.0")
        .replace("0.53", "0.52");
    let definition = definition(&text);
    let held = TiltCondition::Held([0.0; 2]);
    let found = life(&definition, [200.0, 0.0, 0.0], held);
    close(found.reference_mrev, found.basic_mrev.unwrap(), 1e-2);
    let rollers = ROLLERS
        .replace("rollers = 12", "rollers = 60")
        .replace("roller_diameter_mm = 7.5", "roller_diameter_mm = 1.7")
        .replace(
            "radial_clearance_um = 10.0",
            "profile = { kind = \"straight\" }",
        );
    let definition = crate::common::definition(&rollers);
    let found = life(&definition, [2000.0, 0.0, 0.0], held);
    // Line contact wears with the fourth power of the load; L10 has 10/3 for all rollers, and λν = 0.83 stands for what
    // a lamina lacks whose end has no stress riser, which takes 0.3429 of the life of 40 even laminae.
    let capacity = 0.83 * (found.reference_mrev / 0.342_876_6).powf(0.25) * 2000.0;
    close(capacity, Ratings::of(&definition).dynamic_n, 2e-2);
}

/// Clearance narrows the load zone: shorter life, as by springs in a plane.
#[test]
fn clearance_shortens_life() {
    let tight = definition(B6205);
    let loose = definition(&format!("{B6205}radial_clearance_um = 20.0\n"));
    let held = TiltCondition::Moments([0.0; 2]);
    let force = [1000.0, 0.0, 0.0];
    let (a, b) = (life(&tight, force, held), life(&loose, force, held));
    assert_eq!(a.basic_mrev, b.basic_mrev);
    for (found, play_m) in [(a, 0.0), (b, 20e-6)] {
        let (_, loads) = on_springs(B6205, force, play_m, None);
        // Loads are within 5e-4 of such springs, lives go with their third power.
        close(found.reference_mrev, life_of_balls(B6205, &loads), 2e-3);
    }
    assert!(b.reference_mrev < a.reference_mrev, "{a:?} {b:?}");
}

/// a_ISO: 0.1 with a thin film, at most 50, grows with cleanliness.
#[test]
fn lubrication_changes_life_within_its_bounds() {
    let definition = definition(B6205);
    let bearing = bearing(B6205);
    let operation = Operation {
        inner_rad_per_s: 157.0,
        ..Operation::default()
    };
    let load = AppliedBearingLoad {
        force_n: [1500.0, 0.0, 0.0],
        tilt: TiltCondition::Moments([0.0; 2]),
    };
    let pose = bearing.equilibrium(&load, &operation).unwrap();
    let (_, loads) = bearing.loads(&pose, &operation).unwrap();
    let factor = |viscosity: f64, contamination: f64| {
        let lubrication = Lubrication {
            viscosity_mm2_per_s: viscosity,
            contamination,
        };
        let found = Life::of(
            &definition,
            &loads,
            load.force_n,
            &operation,
            Some(&lubrication),
        );
        found.modified_mrev.unwrap() / found.reference_mrev
    };
    close(factor(0.5, 0.5), 0.1, 1e-12);
    let clean: Vec<f64> = [0.1, 0.3, 0.6, 1.0].map(|e| factor(20.0, e)).into();
    assert!(clean.windows(2).all(|w| w[0] < w[1]), "{clean:?}");
    assert!(factor(1000.0, 1.0) <= 50.0);
    // κ passes the joints of the three equations without a step of more than their rounding.
    let reference = 4500.0 / (157.0_f64 * 30.0 / std::f64::consts::PI).sqrt() / 39.04_f64.sqrt();
    for joint in [0.4, 1.0] {
        let (below, above) = (
            factor(reference * joint * 0.999999, 0.5),
            factor(reference * joint * 1.000001, 0.5),
        );
        close(below, above, 1e-3);
    }
}

/// A ring that turns against the load carries it all round (power 3), one that stands carries it at one place (10/3);
/// rings that both turn have 3 each. One that rocks on its springs stands.
#[test]
fn lives_ask_which_rings_turn() {
    let definition = definition(B6205);
    let bearing = QuasiStaticBearing::new(&definition).unwrap();
    let force = [2000.0, 0.0, 0.0];
    let load = AppliedBearingLoad {
        force_n: force,
        tilt: TiltCondition::Held([0.0; 2]),
    };
    let pose = bearing.equilibrium(&load, &Operation::default()).unwrap();
    let (_, loads) = bearing.loads(&pose, &Operation::default()).unwrap();
    let of = |inner_rad_per_s: f64, outer_rad_per_s: f64| {
        let operation = Operation {
            inner_rad_per_s,
            outer_rad_per_s,
            ..Operation::default()
        };
        Life::of(&definition, &loads, force, &operation, None).reference_mrev
    };
    let (inner, outer, both) = (of(10.0, 0.0), of(0.0, -10.0), of(10.0, -7.0));
    // With u, v the damage of each ring by the power 3, and U, V by 10/3: u + V, U + v, u + v.
    let damage = |life: f64| life.powf(-10.0 / 9.0);
    let mean = |power: f64| {
        let sum: f64 = loads.elements[0]
            .iter()
            .map(|b| b.inner_load_n.powf(power))
            .sum();
        (sum / 9.0).powf(1.0 / power).powf(10.0 / 3.0)
    };
    let share = mean(10.0 / 3.0) / mean(3.0);
    // u + V = u + s v and U + v = s u + v.
    let (a, b) = (damage(inner), damage(outer));
    // Loads inside and outside differ by the square of displacement over radius.
    close(damage(both), (a + b) / (1.0 + share), 1e-7);
    assert!(both > inner && both > outer);
    assert_eq!(of(0.0, 0.0), inner);
    assert_eq!(of(10.0, 1e-4), inner);
    assert_eq!(of(-1e-4, 10.0), outer);
}
