//! Verification: in a run-up mesh orders are straight lines, and a resonance stands still.

use crate::test_signals::sampled;
use gearmesh_signal::campbell::{frequency_map, order_map};
use gearmesh_signal::{FrequencyBlocks, OrderBlocks, Resampler, SeriesError, Window};
use std::f64::consts::TAU;

const RATE_HZ: f64 = 10_000.0;

/// From 10 to 50 revolutions a second in 10 s, linearly.
fn angle(t: f64) -> f64 {
    TAU * (10.0 * t + 2.0 * t * t)
}

/// Mesh orders 17 (amplitude 1) and 34 (0.5), and a tone of fixed frequency (0.2).
fn run_up() -> (Vec<f64>, Vec<f64>) {
    let n = (10.0 * RATE_HZ) as usize;
    let angle_rad = sampled(n, RATE_HZ, angle);
    let x = angle_rad
        .iter()
        .enumerate()
        .map(|(i, a)| {
            (17.0 * a).cos()
                + 0.5 * (34.0 * a + 1.0).cos()
                + 0.2 * (TAU * 3000.0 * i as f64 / RATE_HZ).cos()
        })
        .collect();
    (x, angle_rad)
}

#[test]
fn over_frequency_orders_rise_with_the_speed_and_a_resonance_stands() {
    let (x, angle_rad) = run_up();
    let blocks = FrequencyBlocks {
        block_samples: 1000,
        step_samples: 500,
        window: Window::Hann,
    };
    let map = frequency_map(&x, &angle_rad, RATE_HZ, blocks).unwrap();
    assert_eq!(map.len(), 199);
    for row in &map {
        // Linear run-up: the mean speed of a block is that of its middle.
        let speed = TAU * (10.0 + 4.0 * row.time_s);
        assert!((row.speed_rad_per_s - speed).abs() < 1e-9 * speed);
        for (order, band) in [(17.0, 0.25), (34.0, 0.15)] {
            let expected = order * row.speed_rad_per_s / TAU;
            let found = row
                .spectrum
                .peak_place((1.0 - band) * expected, (1.0 + band) * expected)
                .unwrap();
            // A line is 10 Hz; the order smears over order·0.4 Hz, symmetrically about the middle.
            assert!(
                (found - expected).abs() < 0.1 * row.spectrum.line_spacing,
                "order {order} at {} s: {found} against {expected}",
                row.time_s
            );
        }
        let standing = row.spectrum.peak_place(2800.0, 3200.0).unwrap();
        assert!((standing - 3000.0).abs() < 0.1);
    }
}

#[test]
fn over_order_the_mesh_orders_stand() {
    let (x, angle_rad) = run_up();
    let blocks = OrderBlocks {
        samples_per_revolution: 100,
        block_revolutions: 8,
        step_revolutions: 4,
        window: Window::FlatTop,
    };
    let map = order_map(&x, &angle_rad, RATE_HZ, blocks, &Resampler::default()).unwrap();
    assert!(map.len() > 70);
    for row in &map {
        // 8 turns: the mean speed of the block is met where half of its time has passed.
        let speed = TAU * (10.0 + 4.0 * row.time_s);
        assert!((row.speed_rad_per_s - speed).abs() < 1e-6 * speed);
        for (order, amplitude) in [(17.0, 1.0), (34.0, 0.5)] {
            let (line, found) = row.spectrum.peak(order - 1.5, order + 1.5).unwrap();
            // The standing tone (order 60 to 300) is beyond order 50, or folds in only where the kernel lets pass:
            // above 0.8·50.
            assert!((row.spectrum.at(line) - order).abs() < 1e-12);
            assert!((found - amplitude).abs() < 1e-5, "{order}: {found}");
        }
    }
}

/// A tooth force: 1510 N in the mean, which rises with the run-up, and 30 N that vibrate. Nothing but these is a line.
#[test]
fn mean_and_trend_are_no_lines() {
    let (_, angle_rad) = run_up();
    let force = |(i, a): (usize, &f64)| 1510.0 + 2e-3 * i as f64 + 30.0 * (17.0 * a).cos();
    let x: Vec<f64> = angle_rad.iter().enumerate().map(force).collect();
    let blocks = OrderBlocks {
        samples_per_revolution: 100,
        block_revolutions: 4,
        step_revolutions: 4,
        window: Window::Hann,
    };
    let map = order_map(&x, &angle_rad, RATE_HZ, blocks, &Resampler::default()).unwrap();
    for row in &map {
        let (line, found) = row.spectrum.peak(0.0, 40.0).unwrap();
        assert!((row.spectrum.at(line) - 17.0).abs() < 1e-12 && (found - 30.0).abs() < 0.1);
        // A straight line in time bends over the angle: by ¼ · ½ · |d²t/dn²| of the block's turns squared where 10
        // turns a second become more by 4 in each. A line of the spectrum has at most twice that.
        let bent = 2e-3 * RATE_HZ * 0.125 * (4.0 / 10_f64.powi(3)) * 4_f64.powi(2);
        let (_, beside) = row.spectrum.peak(0.0, 15.0).unwrap();
        assert!(beside < 2.0 * bent, "{beside} {bent}");
    }
    let blocks = FrequencyBlocks {
        block_samples: 4000,
        step_samples: 2000,
        window: Window::Hann,
    };
    for row in frequency_map(&x, &angle_rad, RATE_HZ, blocks).unwrap() {
        let (line, _) = row.spectrum.peak(0.0, 2000.0).unwrap();
        assert!(row.spectrum.at(line) > 100.0, "{}", row.spectrum.at(line));
    }
}

#[test]
fn maps_that_cannot_be_made_are_refused() {
    let (mut x, mut angle_rad) = run_up();
    x.truncate(10_000);
    angle_rad.truncate(10_000);
    let blocks = FrequencyBlocks {
        block_samples: 1000,
        step_samples: 0,
        window: Window::Hann,
    };
    assert!(matches!(
        frequency_map(&x, &angle_rad, RATE_HZ, blocks),
        Err(SeriesError::Setting { .. })
    ));
    let blocks = FrequencyBlocks {
        step_samples: 10,
        block_samples: 200_000,
        ..blocks
    };
    assert!(matches!(
        frequency_map(&x, &angle_rad, RATE_HZ, blocks),
        Err(SeriesError::TooShort { .. })
    ));
    let blocks = FrequencyBlocks {
        block_samples: 100,
        ..blocks
    };
    assert!(matches!(
        frequency_map(&x, &angle_rad[..5000], RATE_HZ, blocks),
        Err(SeriesError::Lengths { .. })
    ));
    let orders = OrderBlocks {
        samples_per_revolution: 100,
        block_revolutions: 1000,
        step_revolutions: 1,
        window: Window::Hann,
    };
    let map = |orders| order_map(&x, &angle_rad, RATE_HZ, orders, &Resampler::default());
    assert!(matches!(map(orders), Err(SeriesError::TooShort { .. })));
    assert!(
        map(OrderBlocks {
            block_revolutions: usize::MAX,
            ..orders
        })
        .is_err()
    );
    assert!(
        map(OrderBlocks {
            block_revolutions: 0,
            ..orders
        })
        .is_err()
    );
}
