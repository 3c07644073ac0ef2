//! Amplitude spectrum and power spectral density of a uniform series, over time or over an angle.
//!
//! Throughout, a *unit* is what the sampling rate counts in: with samples per second the lines are in Hz, with samples
//! per revolution they are in orders. With N samples, rate f_s, weights w_j and X_k = Σ_j w_j x_j e^{−2πi jk/N}, line k
//! is at k f_s/N and
//!
//! ```text
//! amplitude   A_k = c_k |X_k| / Σ w_j                 the A of A cos(…), not its RMS;  k = 0: |mean|
//! density     S_k = c_k |X_k|² / (f_s Σ w_j²)         single-sided;  Σ_k S_k f_s/N = Σ (w x)²/Σ w²: the mean square
//! ```
//!
//! with c_k = 2, but 1 for k = 0 and for the Nyquist line of an even N. The mean is **not** taken off. Sources: G.
//! Heinzel, A. Rüdiger, R. Schilling, *Spectrum and spectral density estimation by the DFT*, MPI for Gravitational
//! Physics 2002; P. D. Welch, IEEE Trans. Audio Electroacoustics 15 (1967).

use crate::error::{SeriesError, check_rate, check_samples, check_setting};
use crate::fourier::RealFourier;
use crate::window::{Window, coherent_gain, power_gain};
use realfft::num_complex::Complex64;

/// Fewest samples of a block: mean, one line and the Nyquist line.
const FEWEST_SAMPLES: usize = 4;

/// Transforms blocks of one length and one window; planned once, used for every block.
#[derive(Clone)]
pub struct BlockTransform {
    fourier: RealFourier,
    weights: Vec<f64>,
    coherent_gain: f64,
    power_gain: f64,
    samples_per_unit: f64,
}

impl BlockTransform {
    /// Plans blocks of `samples` samples at `samples_per_unit` samples per second (or per revolution).
    ///
    /// # Errors
    /// [`SeriesError::TooShort`] below 4 samples, [`SeriesError::Setting`] for a rate that is not positive.
    pub fn new(samples: usize, samples_per_unit: f64, window: Window) -> Result<Self, SeriesError> {
        check_rate(samples_per_unit)?;
        if samples < FEWEST_SAMPLES {
            return Err(SeriesError::TooShort {
                what: "a block of a spectrum",
                found: samples,
                least: FEWEST_SAMPLES,
            });
        }
        let weights = window.weights(samples);
        Ok(Self {
            fourier: RealFourier::new(samples),
            coherent_gain: coherent_gain(&weights),
            power_gain: power_gain(&weights),
            weights,
            samples_per_unit,
        })
    }

    /// Distance of two lines in cycles per unit: f_s/N.
    pub fn line_spacing(&self) -> f64 {
        self.samples_per_unit / self.fourier.samples() as f64
    }

    /// Amplitudes A_k of one block.
    ///
    /// # Errors
    /// [`SeriesError::Lengths`] for a block of another length, [`SeriesError::NotFinite`].
    pub fn amplitudes(&self, block: &[f64]) -> Result<Vec<f64>, SeriesError> {
        let scale = 1.0 / (self.coherent_gain * block.len() as f64);
        let lines = self.lines(block)?;
        Ok(self.each(&lines, |c, x| c * x.norm() * scale))
    }

    /// Densities S_k of one block, in the square of the signal's unit per cycle per unit.
    ///
    /// # Errors
    /// As [`BlockTransform::amplitudes`].
    pub fn densities(&self, block: &[f64]) -> Result<Vec<f64>, SeriesError> {
        let scale = 1.0 / (self.samples_per_unit * self.power_gain * block.len() as f64);
        let lines = self.lines(block)?;
        Ok(self.each(&lines, |c, x| c * x.norm_sqr() * scale))
    }

    fn each(&self, lines: &[Complex64], value: impl Fn(f64, &Complex64) -> f64) -> Vec<f64> {
        lines
            .iter()
            .enumerate()
            .map(|(k, x)| value(self.fourier.pair_factor(k), x))
            .collect()
    }

    fn lines(&self, block: &[f64]) -> Result<Vec<Complex64>, SeriesError> {
        if block.len() != self.weights.len() {
            return Err(SeriesError::Lengths {
                first_what: "the block",
                first: block.len(),
                second_what: "the plan",
                second: self.weights.len(),
            });
        }
        check_samples("a block of a spectrum", block, FEWEST_SAMPLES)?;
        let mut weighted: Vec<f64> = block
            .iter()
            .zip(&self.weights)
            .map(|(x, w)| x * w)
            .collect();
        self.fourier.lines(&mut weighted)
    }
}

/// Values on uniform lines 0, Δ, 2Δ, … up to half the sampling rate.
#[derive(Debug, Clone, PartialEq)]
pub struct Spectrum {
    /// Amplitudes or densities, line by line.
    pub values: Vec<f64>,
    /// Distance Δ of two lines in cycles per unit (Hz, or orders).
    pub line_spacing: f64,
}

impl Spectrum {
    /// Place of a line in cycles per unit.
    pub fn at(&self, line: usize) -> f64 {
        line as f64 * self.line_spacing
    }

    /// The highest line.
    pub fn highest(&self) -> f64 {
        self.at(self.values.len().saturating_sub(1))
    }

    /// The line nearest to a place in cycles per unit.
    ///
    /// # Errors
    /// [`SeriesError::OutsideSpectrum`] below zero or above the highest line.
    pub fn nearest_line(&self, at: f64) -> Result<usize, SeriesError> {
        let line = at / self.line_spacing;
        if line.is_finite() && line >= 0.0 && (line.round() as usize) < self.values.len() {
            return Ok(line.round() as usize);
        }
        Err(SeriesError::OutsideSpectrum {
            what: "a line",
            found: at,
            highest: self.highest(),
        })
    }

    /// The largest line between two places, both included, and its value; the first one if several are equal.
    ///
    /// # Errors
    /// [`SeriesError::OutsideSpectrum`]; [`SeriesError::Setting`] if `from` is above `to`.
    pub fn peak(&self, from: f64, to: f64) -> Result<(usize, f64), SeriesError> {
        check_setting(
            "lower end of the band",
            from,
            from <= to,
            "at most the upper end",
        )?;
        let (first, last) = (self.nearest_line(from)?, self.nearest_line(to)?);
        let mut peak = (first, self.values[first]);
        for line in first + 1..=last {
            if self.values[line] > peak.1 {
                peak = (line, self.values[line]);
            }
        }
        Ok(peak)
    }

    /// Place of the largest line between two places, refined by the parabola through the logarithms of it and its
    /// neighbours: under Hann, a tone that stands alone is met within 0.02 lines.
    ///
    /// # Errors
    /// As [`Spectrum::peak`].
    pub fn peak_place(&self, from: f64, to: f64) -> Result<f64, SeriesError> {
        let (line, _) = self.peak(from, to)?;
        if line == 0 || line + 1 >= self.values.len() {
            return Ok(self.at(line));
        }
        let [left, middle, right] =
            [-1, 0, 1].map(|d: isize| self.values[line.wrapping_add_signed(d)].ln());
        let bend = left - 2.0 * middle + right;
        // Not a peak (the band's edge), or a neighbour of value zero: the line itself.
        if !(bend.is_finite() && bend < 0.0 && middle >= left && middle >= right) {
            return Ok(self.at(line));
        }
        Ok((line as f64 + 0.5 * (left - right) / bend) * self.line_spacing)
    }

    /// Of a density: the RMS value of what lies between two places, both lines included: √(Σ S_k Δ).
    ///
    /// # Errors
    /// As [`Spectrum::peak`].
    pub fn band_rms(&self, from: f64, to: f64) -> Result<f64, SeriesError> {
        check_setting(
            "lower end of the band",
            from,
            from <= to,
            "at most the upper end",
        )?;
        let (first, last) = (self.nearest_line(from)?, self.nearest_line(to)?);
        let power: f64 = self.values[first..=last].iter().sum();
        Ok((power * self.line_spacing).sqrt())
    }
}

/// Amplitude spectrum of the whole series as one block.
///
/// # Errors
/// As [`BlockTransform::new`] and [`BlockTransform::amplitudes`].
pub fn amplitude_spectrum(
    samples: &[f64],
    samples_per_unit: f64,
    window: Window,
) -> Result<Spectrum, SeriesError> {
    let transform = BlockTransform::new(samples.len(), samples_per_unit, window)?;
    Ok(Spectrum {
        values: transform.amplitudes(samples)?,
        line_spacing: transform.line_spacing(),
    })
}

/// How Welch's average cuts a series.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WelchSettings {
    /// Samples of a block.
    pub block_samples: usize,
    /// Samples that a block shares with the next, below `block_samples`; half a block suits Hann.
    pub overlap_samples: usize,
    /// Window of a block.
    pub window: Window,
}

/// Power spectral density as the mean over the blocks that fit (Welch). One block without window: Parseval holds
/// exactly.
///
/// Samples after the last whole block are not used.
///
/// # Errors
/// [`SeriesError::TooShort`] if not one block fits, [`SeriesError::Setting`] for an overlap that is not below the
/// block, otherwise as [`BlockTransform`].
pub fn power_spectral_density(
    samples: &[f64],
    samples_per_unit: f64,
    settings: WelchSettings,
) -> Result<Spectrum, SeriesError> {
    let WelchSettings {
        block_samples,
        overlap_samples,
        window,
    } = settings;
    let transform = BlockTransform::new(block_samples, samples_per_unit, window)?;
    check_setting(
        "overlap in samples",
        overlap_samples as f64,
        overlap_samples < block_samples,
        "less than the block",
    )?;
    check_samples("a power density", samples, block_samples)?;
    let mut mean = vec![0.0; block_samples / 2 + 1];
    let mut blocks = 0usize;
    for block in samples
        .windows(block_samples)
        .step_by(block_samples - overlap_samples)
    {
        for (sum, density) in mean.iter_mut().zip(transform.densities(block)?) {
            *sum += density;
        }
        blocks += 1;
    }
    mean.iter_mut().for_each(|v| *v /= blocks as f64);
    Ok(Spectrum {
        values: mean,
        line_spacing: transform.line_spacing(),
    })
}
