//! The rig pipeline on a pair with unequal teeth: 23 drive 47, the wheel with six holes. Closed forms.

use gearmesh_signal::rig::{OrderFilter, RigSettings, process};
use gearmesh_signal::{AngleSeries, ShaftPeriod, best_offset};
use std::f64::consts::TAU;

const TEETH: [usize; 2] = [23, 47];
const HOLES: f64 = 6.0;
const POINTS_PER_PITCH: usize = 24;

/// Amplitude, order of the pinion, phase: eccentricity of the pinion and of the wheel, holes, mesh, its sidebands by
/// the holes.
fn lines() -> [(f64, f64, f64); 6] {
    let wheel = 23.0 / 47.0;
    [
        (9.0, 1.0, 0.3),
        (4.0, wheel, -1.0),
        (1.5, HOLES * wheel, 0.5),
        (0.8, 23.0, 0.7),
        (0.2, 23.0 - HOLES * wheel, 1.1),
        (0.3, 23.0 + HOLES * wheel, 2.0),
    ]
}

/// At an angle of the pinion.
fn te(angle_rad: f64) -> f64 {
    let of =
        |(amplitude, order, phase): (f64, f64, f64)| amplitude * (order * angle_rad + phase).cos();
    -30.0 + lines().into_iter().map(of).sum::<f64>()
}

/// Over so many pitches from a start, as a function of the angle of the shaft with `teeth` teeth.
fn series(teeth: usize, pitches: usize, start_rad: f64) -> AngleSeries {
    let step = TAU / (teeth * POINTS_PER_PITCH) as f64;
    let angle: Vec<f64> = (0..pitches * POINTS_PER_PITCH)
        .map(|k| start_rad + step * k as f64)
        .collect();
    let to_pinion = teeth as f64 / 23.0;
    let values: Vec<f64> = angle.iter().map(|a| te(a * to_pinion)).collect();
    AngleSeries::new(&angle, &values, ShaftPeriod::new(pitches, teeth).unwrap()).unwrap()
}

/// Eccentricity of the pinion does not come again after the wheel's revolution: both need the hunting period, on either
/// shaft.
#[test]
fn every_order_comes_out_on_either_shaft() {
    for (own, mate, turns) in [(23, 47, 47), (47, 23, 23)] {
        let input = series(own, 23 * 47, 0.4);
        let period = input.period();
        assert_eq!(period.whole_revolutions(), turns);
        let settings = RigSettings::default().in_blocks(turns, period);
        let signal = process(&input, &settings, OrderFilter::KeepAll).unwrap();
        let to_pinion = own as f64 / 23.0;
        for (amplitude, order, phase) in lines() {
            let order = order * to_pinion;
            let found = signal.spectrum.amplitude(order).unwrap();
            // 2.16/24^4 of the spline at the mesh order, more at its upper sideband: docs in rig.rs.
            assert!(
                (found / amplitude - 1.0).abs() < 2e-5,
                "order {order}: {found}"
            );
            let found = signal.spectrum.phase_rad(order).unwrap();
            assert!((found - phase).abs() < 1e-6, "order {order}: phase {found}");
        }
        let filter = OrderFilter::of_transmission_error(own, mate);
        let signal = process(&input, &settings, filter).unwrap();
        assert!((signal.mean_before_filter + 30.0).abs() < 1e-9);
        for order in [0.0, 1.0, own as f64 / mate as f64] {
            assert_eq!(signal.spectrum.amplitude(order), Ok(0.0), "order {order}");
        }
        let holes = HOLES * own as f64 / 47.0;
        assert!((signal.spectrum.amplitude(holes).unwrap() - 1.5).abs() < 1e-4);
    }
}

/// A tacho on the pinion that cuts every revolution keeps what is locked to the pinion and nothing of the wheel's
/// holes.
#[test]
fn blocks_of_one_turn_keep_what_is_locked_to_it() {
    let input = series(23, 23 * 47, 0.0);
    let settings = RigSettings::default().in_blocks(1, input.period());
    assert_eq!(
        (settings.revolutions_per_block, settings.revolutions),
        (1, 47)
    );
    let filter = OrderFilter::of_transmission_error(TEETH[0], TEETH[1]);
    let signal = process(&input, &settings, filter).unwrap();
    assert!((signal.spectrum.amplitude(23.0).unwrap() - 0.8).abs() < 2e-5);
    for order in [2.0, 3.0, 20.0, 26.0] {
        assert!(
            signal.spectrum.amplitude(order).unwrap() < 1e-4,
            "order {order}"
        );
    }
    assert!(!signal.spectrum.has(HOLES * 23.0 / 47.0));
}

/// A record whose angle begins elsewhere: the offset is found, and the signals are left as they are.
#[test]
fn the_best_offset_is_that_of_the_angles() {
    let filter = OrderFilter::of_transmission_error(23, 47);
    let through = |shift: f64| {
        let input = series(23, 23 * 47, 0.0);
        let angle: Vec<f64> = (0..47 * 23 * POINTS_PER_PITCH)
            .map(|k| TAU * k as f64 / (23 * POINTS_PER_PITCH) as f64)
            .collect();
        let values: Vec<f64> = angle.iter().map(|a| input.value(a - shift)).collect();
        let moved = AngleSeries::new(&angle, &values, input.period()).unwrap();
        let settings = RigSettings::default().in_blocks(47, moved.period());
        process(&moved, &settings, filter).unwrap()
    };
    let (ours, theirs) = (through(0.0), through(1.234));
    let best = best_offset(&ours.values, &theirs.values).unwrap().unwrap();
    assert!((best.angle_rad(47) - 1.234).abs() < 1e-4, "{best:?}");
    assert!(best.correlation > 0.99999);
    assert!((ours.angle_rad(5000) - TAU).abs() < 1e-12);
}
