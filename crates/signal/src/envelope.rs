//! Envelope of a band of a signal by the Hilbert transform.
//!
//! The band-passed signal x and its Hilbert transform y make the analytic signal x + iy, whose spectrum has no negative
//! frequencies; its modulus is the envelope (A. V. Oppenheim, R. W. Schafer, *Discrete-Time Signal Processing*, ch.
//! 12). Band-pass and Hilbert transform are made in one go in the Fourier domain, on the series as it is.
//!
//! # What the ends do
//! The transform takes the series as one period. If it is not, the jump from its end to its start rings through the
//! band: about 1/edge width (in units of time) at both ends is not to be trusted. The middle is exact for a signal
//! whose modulated band lies between `low + edge` and `high − edge`.

use crate::error::{SeriesError, check_rate, check_samples, check_setting};
use crate::fourier::RealFourier;
use realfft::num_complex::Complex64;
use std::f64::consts::PI;

/// Fewest samples of a band-pass.
const FEWEST_SAMPLES: usize = 8;

/// A band in cycles per unit (Hz, or orders). The gain is 1 from `low + edge` to `high − edge` and falls to 0 at `low`
/// and `high` by half a cosine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band {
    /// Lower end; 0 or above.
    pub low: f64,
    /// Upper end; at most half the sampling rate.
    pub high: f64,
    /// Width of each edge; 0 for a sharp band.
    pub edge: f64,
}

impl Band {
    /// Gain at a frequency.
    fn gain(&self, at: f64) -> f64 {
        if at < self.low || at > self.high {
            return 0.0;
        }
        let inside = (at - self.low).min(self.high - at);
        if inside >= self.edge {
            1.0
        } else {
            0.5 - 0.5 * (PI * inside / self.edge).cos()
        }
    }

    fn check(&self, nyquist: f64) -> Result<(), SeriesError> {
        check_setting(
            "lower end of the band",
            self.low,
            self.low >= 0.0,
            "0 or above",
        )?;
        if !(self.high.is_finite() && self.high <= nyquist) {
            return Err(SeriesError::OutsideSpectrum {
                what: "upper end of the band",
                found: self.high,
                highest: nyquist,
            });
        }
        check_setting(
            "upper end of the band",
            self.high,
            self.high > self.low,
            "above the lower end",
        )?;
        check_setting(
            "edge of the band",
            self.edge,
            self.edge >= 0.0 && 2.0 * self.edge <= self.high - self.low,
            "0 to half the band's width",
        )
    }
}

/// A band of a signal and its envelope, on the samples of the signal.
#[derive(Debug, Clone, PartialEq)]
pub struct Envelope {
    /// The band-passed signal.
    pub filtered: Vec<f64>,
    /// Its envelope √(x² + y²), never negative; in the signal's unit.
    pub envelope: Vec<f64>,
}

/// Band-passes a series and takes its envelope.
///
/// # Errors
/// [`SeriesError::TooShort`] below 8 samples, [`SeriesError::NotFinite`], [`SeriesError::Setting`] or
/// [`SeriesError::OutsideSpectrum`] for a band that is none.
pub fn envelope(
    samples: &[f64],
    samples_per_unit: f64,
    band: Band,
) -> Result<Envelope, SeriesError> {
    check_rate(samples_per_unit)?;
    check_samples("an envelope", samples, FEWEST_SAMPLES)?;
    band.check(0.5 * samples_per_unit)?;
    let n = samples.len();
    let fourier = RealFourier::new(n);
    let mut passed = fourier.lines(&mut samples.to_vec())?;
    for (k, line) in passed.iter_mut().enumerate() {
        *line *= band.gain(k as f64 * samples_per_unit / n as f64);
    }
    // Hilbert: −i for positive frequencies; mean and Nyquist line have no transform.
    let mut turned = passed.clone();
    for (k, line) in turned.iter_mut().enumerate() {
        *line = if fourier.pair_factor(k) == 2.0 {
            Complex64::new(line.im, -line.re)
        } else {
            Complex64::ZERO
        };
    }
    let filtered = fourier.samples_of(&mut passed)?;
    let hilbert = fourier.samples_of(&mut turned)?;
    let envelope = filtered
        .iter()
        .zip(&hilbert)
        .map(|(x, y)| x.hypot(*y))
        .collect();
    Ok(Envelope { filtered, envelope })
}
