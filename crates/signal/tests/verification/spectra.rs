//! Verification: amplitudes and densities against closed forms.

use crate::test_signals::{gaussian_noise, sampled};
use gearmesh_signal::{
    SeriesError, Spectrum, WelchSettings, Window, amplitude_spectrum, power_spectral_density,
};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

const WINDOWS: [Window; 3] = [Window::None, Window::Hann, Window::FlatTop];

#[test]
fn a_sine_on_a_line_has_its_amplitude() {
    for window in WINDOWS {
        let x = sampled(2000, 1000.0, |t| {
            -0.7 + 2.5 * (TAU * 60.0 * t + 0.3).cos() + 1e-4 * (TAU * 141.5 * t).sin()
        });
        let spectrum = amplitude_spectrum(&x, 1000.0, window).unwrap();
        let at = |f| spectrum.values[spectrum.nearest_line(f).unwrap()];
        assert!((spectrum.line_spacing - 0.5).abs() < 1e-15);
        assert!((at(60.0) - 2.5).abs() < 1e-10, "{window:?}");
        assert!((at(141.5) - 1e-4).abs() < 1e-10, "{window:?}");
        assert!((at(0.0) - 0.7).abs() < 1e-10, "{window:?}");
        // Beyond the main lobes there is nothing.
        assert!(at(100.0) < 1e-12, "{window:?}");
    }
}

/// Between two lines a tone loses what the window's transform says: sin(πd)/(πd) without window, sin(πd)/(πd (1 − d²))
/// under Hann, in general sin(πd)/(πd)·Σ_m (−1)^m (a_m/a_0) d²/(d² − m²), at d = ½.
#[test]
fn a_sine_between_two_lines_loses_what_the_window_says() {
    let flat_top = {
        let a: [f64; 5] = [
            0.215_578_95,
            0.416_631_58,
            0.277_263_158,
            0.083_578_947,
            0.006_947_368,
        ];
        let d = 0.5;
        let sum: f64 = (1..5)
            .map(|m| {
                let sign = if m % 2 == 0 { 1.0 } else { -1.0 };
                sign * a[m] * d * d / (d * d - (m * m) as f64)
            })
            .sum();
        (PI * d).sin() / (PI * d) * (1.0 + sum / a[0])
    };
    for (window, expected) in [
        (Window::None, 2.0 / PI),
        (Window::Hann, 8.0 / (3.0 * PI)),
        (Window::FlatTop, flat_top),
    ] {
        let x = sampled(4000, 1000.0, |t| (TAU * 200.125 * t).cos());
        let spectrum = amplitude_spectrum(&x, 1000.0, window).unwrap();
        let (_, found) = spectrum.peak(199.0, 201.0).unwrap();
        // The tone's mirror image at −f leaks with the window's side lobes: 1/(2·800) lines away without window.
        let leak = if window == Window::None { 1e-3 } else { 1e-5 };
        assert!(
            (found - expected).abs() < leak,
            "{window:?}: {found} against {expected}"
        );
    }
    assert!((flat_top - 1.0).abs() < 1.2e-3, "{flat_top}");
}

#[test]
fn a_lone_tone_is_found_between_the_lines() {
    for offset in [0.0, 0.1, 0.25, 0.4, 0.5] {
        let f = 200.0 + 0.25 * offset;
        let x = sampled(4000, 1000.0, |t| (TAU * f * t).cos());
        let spectrum = amplitude_spectrum(&x, 1000.0, Window::Hann).unwrap();
        let found = spectrum.peak_place(190.0, 210.0).unwrap();
        assert!(
            (found - f).abs() < 0.02 * 0.25,
            "offset {offset}: {found} against {f}"
        );
    }
}

#[test]
fn white_noise_has_a_flat_density_of_its_variance() {
    // Variance 1 over the band 0 … f_s/2: S = 2/f_s. Of K Hann blocks half overlapped the mean over many lines scatters
    // by well below 1 %.
    let rate = 5000.0;
    let x = gaussian_noise(400_000, 7);
    let density = power_spectral_density(
        &x,
        rate,
        WelchSettings {
            block_samples: 2000,
            overlap_samples: 1000,
            window: Window::Hann,
        },
    )
    .unwrap();
    let mean_of = |from: f64, to: f64| {
        let (a, b) = (
            density.nearest_line(from).unwrap(),
            density.nearest_line(to).unwrap(),
        );
        density.values[a..b].iter().sum::<f64>() / (b - a) as f64
    };
    for (from, to) in [(50.0, 800.0), (800.0, 1600.0), (1600.0, 2450.0)] {
        // 300 lines × 400 blocks: 0.4 % standard deviation at most; four of them.
        let found = mean_of(from, to) / (2.0 / rate);
        assert!((found - 1.0).abs() < 0.016, "{from} to {to}: {found}");
    }
    assert!((density.band_rms(0.0, 2500.0).unwrap() - 1.0).abs() < 0.01);
}

/// A tone's energy does not depend on the window: Σ S Δ over its main lobe is A²/2.
#[test]
fn a_tone_has_the_same_energy_under_every_window() {
    for window in WINDOWS {
        let x = sampled(2000, 1000.0, |t| 3.0 * (TAU * 60.0 * t).cos());
        let density = power_spectral_density(
            &x,
            1000.0,
            WelchSettings {
                block_samples: 2000,
                overlap_samples: 0,
                window,
            },
        )
        .unwrap();
        let lobe = window.lobe_lines() as f64 * density.line_spacing;
        let found = density.band_rms(60.0 - lobe, 60.0 + lobe).unwrap();
        assert!(
            (found - 3.0 / 2f64.sqrt()).abs() < 1e-10,
            "{window:?}: {found}"
        );
    }
}

#[test]
fn what_cannot_be_transformed_is_refused_with_the_reason() {
    let x = vec![1.0; 100];
    assert!(matches!(
        amplitude_spectrum(&x[..3], 1.0, Window::Hann),
        Err(SeriesError::TooShort {
            found: 3,
            least: 4,
            ..
        })
    ));
    for rate in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(
            amplitude_spectrum(&x, rate, Window::Hann),
            Err(SeriesError::Setting { .. })
        ));
    }
    let mut bad = x.clone();
    bad[17] = f64::NAN;
    assert!(matches!(
        amplitude_spectrum(&bad, 1.0, Window::Hann),
        Err(SeriesError::NotFinite { index: 17, .. })
    ));
    let welch = |block_samples, overlap_samples| {
        power_spectral_density(
            &x,
            1.0,
            WelchSettings {
                block_samples,
                overlap_samples,
                window: Window::None,
            },
        )
    };
    assert!(matches!(welch(50, 50), Err(SeriesError::Setting { .. })));
    assert!(matches!(
        welch(101, 0),
        Err(SeriesError::TooShort { least: 101, .. })
    ));
    let spectrum = amplitude_spectrum(&x, 1.0, Window::None).unwrap();
    for at in [-0.1, 0.6, f64::NAN] {
        assert!(matches!(
            spectrum.nearest_line(at),
            Err(SeriesError::OutsideSpectrum { .. })
        ));
    }
    assert!(spectrum.peak(0.3, 0.2).is_err());
}

proptest! {
    #[test]
    fn parseval(x in prop::collection::vec(-1e3..1e3f64, 4..200), rate in 0.1..1e4f64) {
        let n = x.len();
        for window in WINDOWS {
            let settings = WelchSettings { block_samples: n, overlap_samples: 0, window };
            let density = power_spectral_density(&x, rate, settings).unwrap();
            let weights = window.weights(n);
            let expected = x.iter().zip(&weights).map(|(x, w)| (x * w).powi(2)).sum::<f64>()
                / weights.iter().map(|w| w * w).sum::<f64>();
            let found = density.band_rms(0.0, density.highest()).unwrap().powi(2);
            prop_assert!((found - expected).abs() <= 1e-11 * expected.max(1e-300), "{window:?}");
        }
    }
}

#[test]
fn of_equal_lines_the_first_is_the_peak() {
    let spectrum = Spectrum {
        values: vec![0.0, 3.0, 1.0, 3.0, 2.0],
        line_spacing: 0.5,
    };
    assert_eq!(spectrum.peak(0.0, 2.0).unwrap(), (1, 3.0));
    assert_eq!(spectrum.peak(1.0, 2.0).unwrap(), (3, 3.0));
}
