//! The stress riser of roller ends, ISO/TS 16281 (60), and what it takes from L10r.

use crate::common::{ROLLERS, TAPERED, close, definition};
use gearmesh_bearings::definition::BearingGeometry;
use gearmesh_bearings::quasi_static::RowLoads;
use gearmesh_bearings::stress_riser::stress_riser;
use gearmesh_bearings::{
    AppliedBearingLoad, Life, Operation, QuasiStaticBearing, Ratings, RingPose, TiltCondition,
};

/// f of 30 laminae, by hand: ln(1.985/2) = −0.0075282, ln(1.985 · 27/58) = −0.0789860, ln(1.985/58) = −3.3747855.
#[test]
fn the_riser_is_that_of_the_standards_equation() {
    for (number, by_hand) in [
        (0, 2.328_327_06),
        (1, 1.126_602_74),
        (14, 1.002_963_12),
        (15, 1.002_963_12),
        (28, 1.126_602_74),
        (29, 2.328_327_06),
    ] {
        close(stress_riser(number, 30), by_hand, 1e-8);
    }
    // The lamina in the middle of an odd number has none.
    assert_eq!(stress_riser(15, 31), 1.0);
    assert_eq!(stress_riser(0, 1), 1.0);
}

/// Straight rollers under interference alone: every lamina of every roller carries the same, so that
///
/// L10r = [mean(f^4.5) ((Q/Q_ci)^4.5 + (Q/Q_ce)^4.5)]^(−8/9),   Q = 35 948 L^(8/9) (P/2)^(10/9)
///
/// is calculated by hand: mean(f^4.5)^(−8/9) of 30 laminae is 0.288 559 6.
#[test]
fn even_laminae_live_as_long_as_by_hand() {
    let text = ROLLERS.replace("radial_clearance_um = 10.0", "radial_clearance_um = -8.0");
    let text = format!("{text}laminae = 30\n[profile]\nkind = \"straight\"\n");
    let definition = definition(&text);
    let bearing = QuasiStaticBearing::new(&definition).unwrap();
    let still = Operation::default();
    let (_, loads) = bearing.loads(&RingPose::default(), &still).unwrap();
    let found = Life::of(&definition, &loads, [0.0; 3], &still, None);
    let q = 35_948.0 * 9.0_f64.powf(8.0 / 9.0) * 4e-3_f64.powf(10.0 / 9.0);
    // γ = 7.5/33.5: 1.038 ((1 − γ)/(1 + γ))^(143/108) = 0.567 913.
    let gamma: f64 = 7.5 / 33.5;
    let ratio = 1.038 * ((1.0 - gamma) / (1.0 + gamma)).powf(143.0 / 108.0);
    close(ratio, 0.567_913, 1e-5);
    let c = Ratings::of(&definition).dynamic_n / (0.83 * 12.0);
    let inner = c / 0.378 * (1.0 + ratio.powf(4.5)).powf(2.0 / 9.0);
    let outer = c / 0.364 * (1.0 + ratio.powf(-4.5)).powf(2.0 / 9.0);
    let smooth = ((q / inner).powf(4.5) + (q / outer).powf(4.5)).powf(-8.0 / 9.0);
    close(found.reference_mrev, 0.288_559_6 * smooth, 1e-6);
}

/// L10r of the laminae's loads with and without the riser, ISO/TS 16281 written out anew: the inner ring turns.
fn by_hand(text: &str, loads: &RowLoads, laminae: usize) -> [f64; 2] {
    let definition = definition(text);
    let BearingGeometry::Roller(g) = &definition.geometry else {
        panic!("rollers")
    };
    let cosine = g.taper.map_or(1.0, |taper| taper.contact_angle_rad.cos());
    let gamma = g.diameter_m * cosine / g.pitch_diameter_m;
    let ratio = 1.038 * ((1.0 - gamma) / (1.0 + gamma)).powf(143.0 / 108.0);
    let count = laminae as f64;
    let even = Ratings::of(&definition).dynamic_n
        / (0.83 * g.rollers as f64 * cosine * count.powf(7.0 / 9.0));
    let inner = even / 0.378 * (1.0 + ratio.powf(4.5)).powf(2.0 / 9.0);
    let outer = even / 0.364 * (1.0 + ratio.powf(-4.5)).powf(2.0 / 9.0);
    [true, false].map(|with| {
        let damage = |k: usize| {
            let riser = if with { stress_riser(k, laminae) } else { 1.0 };
            let of_lamina = || loads.laminae[0].iter().skip(k).step_by(laminae);
            let turning: f64 = of_lamina().map(|q| q.0.powi(4)).sum();
            let standing: f64 = of_lamina().map(|q| q.1.powf(4.5)).sum();
            let rollers = g.rollers as f64;
            (riser * (turning / rollers).powf(0.25) / inner).powf(4.5)
                + (riser / outer).powf(4.5) * standing / rollers
        };
        (0..laminae).map(damage).sum::<f64>().powf(-8.0 / 9.0)
    })
}

/// Lives of bearings in equilibrium, tilted and without a profile, too, are those of the sum by hand. Straight rollers
/// without tilt keep 0.343 of what they had without the riser.
#[test]
fn tilt_and_missing_profiles_cost_life() {
    let straight = format!("{ROLLERS}[profile]\nkind = \"straight\"\n");
    for (text, force_n, tilt_rad) in [
        (ROLLERS, [4000.0, 0.0, 0.0], 0.0),
        (ROLLERS, [4000.0, 0.0, 0.0], 4e-3),
        (&straight, [4000.0, 0.0, 0.0], 0.0),
        (&straight, [4000.0, 0.0, 0.0], 4e-3),
        (TAPERED, [4000.0, 0.0, 2000.0], 0.0),
    ] {
        let definition = definition(text);
        let bearing = QuasiStaticBearing::new(&definition).unwrap();
        let still = Operation::default();
        let load = AppliedBearingLoad {
            force_n,
            tilt: TiltCondition::Held([0.0, tilt_rad]),
        };
        let pose = bearing.equilibrium(&load, &still).unwrap();
        let (_, loads) = bearing.loads(&pose, &still).unwrap();
        let found = Life::of(&definition, &loads, force_n, &still, None).reference_mrev;
        let [with, without] = by_hand(text, &loads, 40);
        close(found, with, 1e-9);
        let is_even = text == straight && tilt_rad == 0.0;
        assert!(with < without && (!is_even || (with / without - 0.342_876_6).abs() < 1e-6));
    }
}
