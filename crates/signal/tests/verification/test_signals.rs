//! Signals for the tests.

use std::f64::consts::TAU;

/// Standard normal noise, always the same for a seed: SplitMix64 (G. Steele and others, 2014) and Box-Muller.
pub fn gaussian_noise(samples: usize, seed: u64) -> Vec<f64> {
    let mut state = seed;
    let mut uniform = move || {
        state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^= z >> 31;
        ((z >> 11) as f64 + 0.5) / (1u64 << 53) as f64
    };
    (0..samples)
        .map(|_| {
            let (u, v) = (uniform(), uniform());
            (-2.0 * u.ln()).sqrt() * (TAU * v).cos()
        })
        .collect()
}

/// Samples of a function of time.
pub fn sampled(samples: usize, rate_hz: f64, f: impl Fn(f64) -> f64) -> Vec<f64> {
    (0..samples).map(|i| f(i as f64 / rate_hz)).collect()
}

/// The largest |a − b|.
pub fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter()
        .zip(b)
        .fold(0.0, |largest, (a, b)| f64::max(largest, (a - b).abs()))
}
