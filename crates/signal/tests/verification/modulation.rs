//! Verification: sidebands, envelope, synchronous average and shape figures against closed forms.

use crate::test_signals::{gaussian_noise, largest_difference, sampled};
use gearmesh_signal::statistics::{crest_factor, kurtosis};
use gearmesh_signal::{
    Band, SeriesError, SidebandSettings, Window, amplitude_spectrum, envelope, sideband_table,
    synchronous_average,
};
use std::f64::consts::{PI, TAU};

/// A mesh tone of 600 Hz with degree of modulation 0.4 at 25 Hz and 0.1 at its double.
fn modulated(t: f64) -> f64 {
    let degree = 0.4 * (TAU * 25.0 * t + 0.8).cos() + 0.1 * (TAU * 50.0 * t).cos();
    3.0 * (1.0 + degree) * (TAU * 600.0 * t - 0.3).cos()
}

#[test]
fn sidebands_of_an_amplitude_modulated_tone_are_exact() {
    let x = sampled(5000, 5000.0, modulated);
    for window in [Window::None, Window::Hann, Window::FlatTop] {
        let spectrum = amplitude_spectrum(&x, 5000.0, window).unwrap();
        let table = sideband_table(
            &spectrum,
            SidebandSettings {
                carrier: 600.0,
                modulator: 25.0,
                pairs: 3,
                search_lines: 0,
            },
        )
        .unwrap();
        assert_eq!(table.len(), 7);
        for (row, ratio) in table.iter().zip([0.0, 0.05, 0.2, 1.0, 0.2, 0.05, 0.0]) {
            assert!((row.at - (600.0 + 25.0 * f64::from(row.number))).abs() < 1e-12);
            assert!((row.ratio - ratio).abs() < 1e-10, "{window:?} {row:?}");
            assert!(
                (row.amplitude - 3.0 * ratio).abs() < 1e-10,
                "{window:?} {row:?}"
            );
        }
    }
}

#[test]
fn the_search_meets_a_carrier_that_drifted() {
    // Carrier three lines off its nominal place, sidebands with it.
    let x = sampled(5000, 5000.0, |t| {
        (1.0 + 0.5 * (TAU * 25.0 * t).cos()) * (TAU * 603.0 * t).cos()
    });
    let spectrum = amplitude_spectrum(&x, 5000.0, Window::Hann).unwrap();
    let settings = SidebandSettings {
        carrier: 600.0,
        modulator: 25.0,
        pairs: 1,
        search_lines: 5,
    };
    let table = sideband_table(&spectrum, settings).unwrap();
    assert!((table[1].at - 603.0).abs() < 1e-12);
    assert!((table[2].ratio - 0.25).abs() < 1e-10);
    assert!(matches!(
        sideband_table(
            &spectrum,
            SidebandSettings {
                search_lines: 13,
                ..settings
            }
        ),
        Err(SeriesError::SidebandsMerge { .. })
    ));
    for bad in [
        SidebandSettings {
            pairs: 30,
            ..settings
        },
        SidebandSettings {
            pairs: u32::MAX,
            ..settings
        },
        SidebandSettings {
            carrier: 2490.0,
            ..settings
        },
        SidebandSettings {
            modulator: 0.0,
            ..settings
        },
        SidebandSettings {
            search_lines: usize::MAX,
            ..settings
        },
    ] {
        assert!(sideband_table(&spectrum, bad).is_err(), "{bad:?}");
    }
}

#[test]
fn the_envelope_of_a_modulated_tone_is_its_modulation() {
    // A second tone outside the band, and a record that is no period of the signal.
    let rate = 5000.0;
    let x = sampled(5123, rate, |t| {
        modulated(t) + 2.0 * (TAU * 1733.0 * t).cos()
    });
    let found = envelope(
        &x,
        rate,
        Band {
            low: 400.0,
            high: 800.0,
            edge: 100.0,
        },
    )
    .unwrap();
    let truth = sampled(5123, rate, |t| {
        3.0 * (1.0 + 0.4 * (TAU * 25.0 * t + 0.8).cos() + 0.1 * (TAU * 50.0 * t).cos())
    });
    let error = |range: std::ops::Range<usize>| {
        largest_difference(&found.envelope[range.clone()], &truth[range])
    };
    assert!(error(1000..4123) < 1e-4, "{:e}", error(1000..4123));
    assert!(error(200..4923) < 1e-2, "{:e}", error(200..4923));

    // Whole periods: exact everywhere.
    let x = sampled(5000, rate, modulated);
    let band = Band {
        low: 500.0,
        high: 700.0,
        edge: 0.0,
    };
    let found = envelope(&x, rate, band).unwrap();
    assert!(largest_difference(&found.envelope, &truth[..5000]) < 1e-10);
    assert!(largest_difference(&found.filtered, &x) < 1e-10);
}

#[test]
fn bands_that_are_none_are_refused() {
    let x = sampled(100, 100.0, f64::sin);
    for (low, high, edge) in [
        (-1.0, 20.0, 0.0),
        (20.0, 20.0, 0.0),
        (10.0, 51.0, 0.0),
        (10.0, 20.0, 6.0),
        (10.0, 20.0, -1.0),
        (f64::NAN, 20.0, 0.0),
        (10.0, f64::NAN, 0.0),
        (10.0, 20.0, f64::NAN),
    ] {
        assert!(
            envelope(&x, 100.0, Band { low, high, edge }).is_err(),
            "{low} {high} {edge}"
        );
    }
}

/// A tone of ν periods per period of the average is damped by the comb |sin(πnν)/(n sin πν)|, at most 1/(n |sin πν|).
#[test]
fn the_average_takes_other_tones_away_as_one_over_their_number() {
    let per_turn = 360;
    let other = 3.0 + 0.381_966;
    let x: Vec<f64> = (0..per_turn * 512)
        .map(|i| {
            let a = TAU * i as f64 / per_turn as f64;
            (17.0 * a + 0.1).cos() + 0.8 * (other * a).cos()
        })
        .collect();
    for turns in [1usize, 3, 8, 64, 512] {
        let found = synchronous_average(&x, per_turn, turns).unwrap();
        let rest: Vec<f64> = (0..per_turn)
            .map(|i| found.average[i] - (17.0 * TAU * i as f64 / per_turn as f64 + 0.1).cos())
            .collect();
        let n = turns as f64;
        let gain = ((PI * n * other).sin() / (n * (PI * other).sin())).abs();
        // What is left is 0.8·gain·cos(other·a + phase): its largest sample over more than three periods.
        let largest = rest.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        assert!(
            (largest - 0.8 * gain).abs() < 2e-3 * 0.8 * gain + 1e-12,
            "{turns}: {largest} against {}",
            0.8 * gain
        );
        assert!(largest <= 0.8 / (n * (PI * other).sin().abs()) * (1.0 + 1e-9));
    }
}

#[test]
fn noise_falls_with_the_root_of_the_number_and_stays_in_the_residual() {
    let (per_turn, turns) = (1000, 100);
    let noise = gaussian_noise(per_turn * turns, 11);
    let x: Vec<f64> = noise
        .iter()
        .enumerate()
        .map(|(i, v)| 5.0 * (TAU * 17.0 * i as f64 / per_turn as f64).cos() + v)
        .collect();
    let found = synchronous_average(&x, per_turn, turns).unwrap();
    let left: f64 = (0..per_turn)
        .map(|i| (found.average[i] - 5.0 * (TAU * 17.0 * i as f64 / per_turn as f64).cos()).powi(2))
        .sum();
    // 1000 samples of variance 1/100: √(2/1000) = 4.5 % of scatter in the variance, four of them.
    assert!((left / per_turn as f64 * 100.0 - 1.0).abs() < 0.18);
    let kurtosis = found.residual_kurtosis.unwrap();
    assert!((kurtosis - 3.0).abs() < 4.0 * (24.0f64 / 1e5).sqrt());

    // One impulse a turn on another shaft shows in the residual's kurtosis, not in the average.
    let mut hit = x.clone();
    (0..hit.len()).step_by(1370).for_each(|i| hit[i] += 15.0);
    let found = synchronous_average(&hit, per_turn, turns).unwrap();
    assert!(found.residual_kurtosis.unwrap() > 10.0);
}

#[test]
fn a_periodic_signal_leaves_no_residual_and_bad_counts_are_refused() {
    let x: Vec<f64> = (0..1000)
        .map(|i| (TAU * f64::from(i % 100) / 100.0).sin())
        .collect();
    let found = synchronous_average(&x, 100, 10).unwrap();
    assert_eq!(found.residual_kurtosis, None);
    assert!(largest_difference(&found.average, &x[..100]) < 1e-14);
    assert!(matches!(
        synchronous_average(&x, 100, 11),
        Err(SeriesError::TooShort { least: 1100, .. })
    ));
    assert!(synchronous_average(&x, 0, 1).is_err());
    assert!(synchronous_average(&x, 1, 0).is_err());
    assert!(synchronous_average(&x, usize::MAX, usize::MAX).is_err());
}

#[test]
fn kurtosis_and_crest_factor_of_known_shapes() {
    let sine = sampled(1000, 1000.0, |t| 4.0 * (TAU * 10.0 * t + 0.2).sin());
    assert!((kurtosis(&sine).unwrap() - 1.5).abs() < 1e-12);
    let sine = sampled(1000, 1000.0, |t| 4.0 * (TAU * 10.0 * t).sin());
    assert!((crest_factor(&sine).unwrap() - 2f64.sqrt()).abs() < 1e-12);
    let square = sampled(1000, 1000.0, |t| {
        if (10.0 * t + 0.005).fract() < 0.5 {
            2.0
        } else {
            -2.0
        }
    });
    assert!((kurtosis(&square).unwrap() - 1.0).abs() < 1e-12);
    assert!((crest_factor(&square).unwrap() - 1.0).abs() < 1e-12);
    // Uniform triangle wave: 9/5.
    let triangle: Vec<f64> = (0..100_000).map(|i| f64::from(i) + 0.5).collect();
    assert!((kurtosis(&triangle).unwrap() - 1.8).abs() < 1e-8);
    for seed in 1..6 {
        let n = 200_000;
        let found = kurtosis(&gaussian_noise(n, seed)).unwrap();
        // Standard deviation √(24/n); four of them.
        assert!(
            (found - 3.0).abs() < 4.0 * (24.0 / n as f64).sqrt(),
            "{found}"
        );
    }
    // An offset changes the crest factor, not the kurtosis.
    let lifted: Vec<f64> = sine.iter().map(|v| v + 100.0).collect();
    assert!((kurtosis(&lifted).unwrap() - 1.5).abs() < 1e-9);
    assert!(crest_factor(&lifted).unwrap() < 1.05);
    assert!(kurtosis(&[0.1; 7]).is_err());
    assert!(crest_factor(&[0.0; 7]).is_err());
}
