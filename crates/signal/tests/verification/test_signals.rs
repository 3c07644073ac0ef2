//! Signals for the tests.

use std::f64::consts::TAU;

/// Standard normal noise, always the same for a seed: the transform of Box and Muller.
pub fn gaussian_noise(samples: usize, seed: u64) -> Vec<f64> {
    let mut random = fastrand::Rng::with_seed(seed);
    (0..samples)
        .map(|_| {
            // 1 - u is never zero.
            let (u, v) = (random.f64(), random.f64());
            (-2.0 * (1.0 - u).ln()).sqrt() * (TAU * v).cos()
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
