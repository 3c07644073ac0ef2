//! Verification: resampling is as accurate as stated, at constant and at varying speed, there and back.

use crate::test_signals::{largest_difference, sampled};
use gearmesh_signal::{
    OrderSpectrum, Resampler, SeriesError, Window, amplitude_spectrum, synchronous_average,
};
use std::f64::consts::TAU;

/// Largest error over tones up to the band's edge, resampled from 1000 Hz to `new_rate`.
fn largest_error(resampler: &Resampler, new_rate: f64) -> f64 {
    let lower_nyquist = 0.5 * f64::min(1000.0, new_rate);
    (0..=8)
        .map(|i| {
            let f = resampler.band() * lower_nyquist * f64::from(i) / 8.0;
            let tone = |t: f64| (TAU * f * t + 0.4).cos();
            let x = sampled(400, 1000.0, tone);
            let y = resampler.to_rate(&x, 1000.0, new_rate).unwrap();
            let expected: Vec<f64> = (0..y.values.len())
                .map(|i| tone((y.first + i) as f64 / new_rate))
                .collect();
            largest_difference(&y.values, &expected)
        })
        .fold(0.0, f64::max)
}

#[test]
fn a_tone_in_the_band_is_met_within_the_stated_error() {
    // Up, to an incommensurable rate, and down (where aliasing must be kept out of the band).
    for new_rate in [3217.7, 1000.0 / 0.97, 431.3] {
        for (half_width, band) in [(12, 0.6), (32, 0.8), (40, 0.5)] {
            let resampler = Resampler::new(half_width, band).unwrap();
            let found = largest_error(&resampler, new_rate);
            // Phases of up to 1300 rad are known to 3e-13 only.
            let stated = resampler.error_bound().max(5e-13);
            assert!(
                found < stated,
                "{half_width}, {band}, {new_rate} Hz: {found:e} against {stated:e}"
            );
        }
    }
}

#[test]
fn the_error_falls_exponentially_with_the_half_width() {
    // e^{−β}, β → π L (1 − b): eight more neighbours on each side at b = 0.7 are worth a factor of e^{2.4π} = 1881 or
    // more.
    let errors: Vec<f64> = [8, 16, 24]
        .map(|l| largest_error(&Resampler::new(l, 0.7).unwrap(), 2317.0))
        .to_vec();
    for pair in errors.windows(2) {
        let factor = pair[0] / pair[1];
        assert!((1000.0..20_000.0).contains(&factor), "{errors:?}");
    }
}

#[test]
fn above_the_band_the_stated_error_does_not_hold() {
    // Negative test: the accuracy above comes from the band, not from a lenient comparison.
    let resampler = Resampler::default();
    let f = 0.98 * 500.0;
    let x = sampled(1500, 1000.0, |t| (TAU * f * t).cos());
    let y = resampler.to_rate(&x, 1000.0, 2317.0).unwrap();
    let expected: Vec<f64> = (0..y.values.len())
        .map(|i| (TAU * f * (y.first + i) as f64 / 2317.0).cos())
        .collect();
    assert!(largest_difference(&y.values, &expected) > 0.01);
}

/// A shaft at 20 revolutions a second that swings 10 % in speed three times a turn.
fn swinging_angle(t: f64) -> f64 {
    TAU * (20.0 * t + 0.1 / 3.0 * (TAU * 60.0 * t).sin() / TAU)
}

/// Largest error of order 57 after resampling to the angle of the swinging shaft.
fn angle_error(rate: f64) -> f64 {
    let n = (0.5 * rate) as usize;
    let angle = sampled(n, rate, swinging_angle);
    let x: Vec<f64> = angle.iter().map(|a| (57.0 * a + 0.2).cos()).collect();
    let y = Resampler::new(48, 0.6)
        .unwrap()
        .to_angle(&x, &angle, 400)
        .unwrap();
    let expected: Vec<f64> = (0..y.values.len())
        .map(|i| (57.0 * (y.start_rad + TAU * i as f64 / 400.0) + 0.2).cos())
        .collect();
    largest_difference(&y.values, &expected)
}

#[test]
fn the_angle_between_samples_converges_with_the_sixth_power_of_the_step() {
    let errors = [5000.0, 7500.0, 11_250.0].map(angle_error);
    for pair in errors.windows(2) {
        let order = (pair[0] / pair[1]).ln() / 1.5f64.ln();
        assert!((5.6..6.5).contains(&order), "{order}: {errors:?}");
    }
}

#[test]
fn a_mesh_order_at_varying_speed_becomes_one_line() {
    let rate = 25_600.0;
    let angle = sampled(26_000, rate, swinging_angle);
    let x: Vec<f64> = angle
        .iter()
        .map(|a| 0.3 + 2.0 * (57.0 * a).cos() + 0.5 * (58.0 * a).sin())
        .collect();
    let series = Resampler::default().to_angle(&x, &angle, 400).unwrap();
    let turns = series.values.len() / 400;
    assert!(turns >= 19);
    let spectrum = OrderSpectrum::from_samples(&series.values[..400 * turns], turns).unwrap();
    assert!((spectrum.amplitude(57.0).unwrap() - 2.0).abs() < 1e-7);
    assert!((spectrum.amplitude(58.0).unwrap() - 0.5).abs() < 1e-7);
    assert!(spectrum.amplitude(54.0).unwrap() < 1e-7);
    // Over time the same order smears into sidebands at three times the shaft's frequency.
    let over_time = amplitude_spectrum(&x[..25_600], rate, Window::Hann).unwrap();
    assert!(over_time.values[over_time.nearest_line(57.0 * 20.0 + 60.0).unwrap()] > 0.1);
    // The average over the turns is the signal of one turn.
    let average = synchronous_average(&series.values, 400, turns).unwrap();
    assert!(average.residual.iter().all(|v| v.abs() < 1e-6));
}

#[test]
fn there_and_back() {
    let rate = 25_600.0;
    let angle = sampled(26_000, rate, swinging_angle);
    let x = sampled(26_000, rate, |t| {
        (TAU * 1140.0 * t).cos() + (TAU * 333.3 * t).sin()
    });
    let resampler = Resampler::default();
    // 2048 samples a turn are 41 kHz: finer than the time samples.
    let series = resampler.to_angle(&x, &angle, 2048).unwrap();
    let back = resampler.to_time(&series, &angle).unwrap();
    let error = largest_difference(&back.values, &x[back.first..back.first + back.values.len()]);
    assert!(back.values.len() > 25_800);
    assert!(error < 1e-7, "{error:e}");
}

#[test]
fn down_sampling_to_few_orders_keeps_high_orders_out() {
    // 100 samples a turn reach order 50; order 90 would fold to order 10.
    let rate = 25_600.0;
    let angle = sampled(26_000, rate, swinging_angle);
    let x: Vec<f64> = angle
        .iter()
        .map(|a| (10.0 * a).cos() + 3.0 * (90.0 * a).cos())
        .collect();
    let series = Resampler::default().to_angle(&x, &angle, 100).unwrap();
    let expected: Vec<f64> = (0..series.values.len())
        .map(|i| (10.0 * (series.start_rad + TAU * i as f64 / 100.0)).cos())
        .collect();
    let error = largest_difference(&series.values, &expected);
    // Over time order 90 is a phase-modulated tone with sidebands 60 Hz = 3 orders apart. The twelfth, 3 J₁₂(3) = 7e-7,
    // reaches the band where the kernel begins to pass.
    assert!(error < 7e-7, "{error:e}");
}

#[test]
fn what_cannot_be_resampled_is_refused() {
    let resampler = Resampler::default();
    let x = vec![0.0; 500];
    let angle = sampled(500, 100.0, |t| TAU * t);
    assert!(matches!(
        resampler.to_angle(&x, &angle[..499], 100),
        Err(SeriesError::Lengths { .. })
    ));
    let mut back = angle.clone();
    back[200] = back[199];
    assert!(matches!(
        resampler.to_angle(&x, &back, 100),
        Err(SeriesError::AngleNotIncreasing { index: 200, .. })
    ));
    for per_turn in [0, usize::MAX] {
        assert!(matches!(
            resampler.to_angle(&x, &angle, per_turn),
            Err(SeriesError::Setting { .. })
        ));
    }
    assert!(matches!(
        resampler.to_angle(&x[..60], &angle[..60], 100),
        Err(SeriesError::NothingInside { half_width: 32, .. })
    ));
    assert!(matches!(
        resampler.to_rate(&x, 1.0, 1e12),
        Err(SeriesError::Setting { .. })
    ));
    assert!(resampler.to_rate(&x, 1.0, f64::NAN).is_err());
    for (half_width, band) in [
        (32, 0.0),
        (32, 1.0),
        (2, 0.8),
        (100_000, 0.5),
        (4, f64::NAN),
    ] {
        assert!(
            Resampler::new(half_width, band).is_err(),
            "{half_width} {band}"
        );
    }
}

/// The drive of the tutorial: 0.94 turns in the second half of its run.
#[test]
fn rows_begin_early_enough_for_a_turn() {
    let rows = 4000;
    let angle = |row: usize| 1.88 * TAU * row as f64 / (rows - 1) as f64;
    let angles: Vec<f64> = (0..rows).map(angle).collect();
    let half = rows / 2..rows;
    let resampler = Resampler::default();
    let first = resampler.first_row_for(1, &angles, &half);
    let held = (angles[rows - 1] - angles[first]) / TAU;
    // A turn, and the neighbours of its first row: some tens of rows of 2100.
    assert!(
        first < half.start && (1.0..1.05).contains(&held),
        "{first} {held}"
    );
    assert_eq!(resampler.first_row_for(1, &angles, &(100..rows)), 100);
    assert_eq!(resampler.first_row_for(2, &angles, &half), 0);
}
