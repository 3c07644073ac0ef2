//! Band-limited resampling: time to shaft angle, back, and from one rate to another.
//!
//! A value between samples is the sum over the neighbours with a sinc under a Kaiser window (A. V. Oppenheim, R. W.
//! Schafer, *Discrete-Time Signal Processing*, sections 4.6 and 7.5):
//!
//! ```text
//! x(p) = (1/s) Σ_{|p−j| ≤ L s} x_j sinc((p − j)/s) I₀(β √(1 − ((p − j)/(L s))²))/I₀(β)
//! ```
//!
//! with the position p in samples, L the half width, and s ≥ 1 the new step over the old one where the new grid is
//! coarser (the sinc is then also the filter against aliasing). β = √((πL(1 − b))² − π²) puts the window's main lobe
//! between b and 2 − b times the lower of the two Nyquist frequencies.
//!
//! # Accuracy
//! A tone of amplitude A below b times the lower Nyquist frequency comes out within A e^{−β}: 2.4e-9 with the default L
//! = 32, b = 0.8. Between b and 2 − b it is damped and folds into that same band, not below it. Nothing is invented at
//! the ends: the result begins and ends where all L s neighbours exist.
//!
//! The shaft's angle between its samples is the polynomial of degree five through the six nearest ones: its error falls
//! with the sixth power of the sampling step, and times the signal's slope it is the error of the signal.

use crate::error::{SeriesError, check_rate, check_samples, check_setting};
use std::f64::consts::{PI, TAU};

/// Most samples of a result (400 MB), so that a typing error does not fill the memory.
const MOST_SAMPLES: f64 = 50e6;

/// Points of the polynomial through the shaft's angles.
const ANGLE_POINTS: usize = 6;

/// Band-limited interpolation with a stated accuracy.
#[derive(Debug, Clone, PartialEq)]
pub struct Resampler {
    half_width: usize,
    band: f64,
    beta: f64,
    /// The window as a polynomial in 1 − (d/L)².
    window: Vec<f64>,
}

impl Default for Resampler {
    /// 32 neighbours on each side, exact to 2.4e-9 up to 0.8 of the Nyquist frequency.
    fn default() -> Self {
        Self::with(32, 0.8)
    }
}

/// A series on uniform angles, made from time samples.
#[derive(Debug, Clone, PartialEq)]
pub struct AngleSamples {
    /// Angle of the first value \[rad\], a whole number of steps from angle 0.
    pub start_rad: f64,
    /// Samples in one revolution: the step is 2π over this.
    pub samples_per_revolution: usize,
    /// The values.
    pub values: Vec<f64>,
    /// Position of each value in the time samples, as a fraction of samples.
    pub positions: Vec<f64>,
}

/// A run of samples on a uniform grid.
#[derive(Debug, Clone, PartialEq)]
pub struct GridSamples {
    /// Number of the grid point that the first value belongs to.
    pub first: usize,
    /// The values, point by point.
    pub values: Vec<f64>,
}

impl Resampler {
    /// An interpolation over `half_width` neighbours on each side that is right up to `band` (above 0, below 1) of the
    /// Nyquist frequency.
    ///
    /// # Errors
    /// [`SeriesError::Setting`] where half_width·(1 − band) is below 1.5: no window fits.
    pub fn new(half_width: usize, band: f64) -> Result<Self, SeriesError> {
        check_setting(
            "band as a fraction of the Nyquist frequency",
            band,
            band > 0.0 && band < 1.0,
            "above 0 and below 1",
        )?;
        check_setting(
            "half width in samples",
            half_width as f64,
            half_width as f64 * (1.0 - band) >= 1.5 && half_width <= 4096,
            "from 1.5/(1 - band) to 4096",
        )?;
        Ok(Self::with(half_width, band))
    }

    fn with(half_width: usize, band: f64) -> Self {
        let lobe = PI * half_width as f64 * (1.0 - band);
        let beta = (lobe * lobe - PI * PI).sqrt();
        Self {
            half_width,
            band,
            beta,
            window: kaiser_polynomial(beta),
        }
    }

    /// Largest error e^{−β} of a tone below [`Resampler::band`], as a fraction of its amplitude.
    pub fn error_bound(&self) -> f64 {
        (-self.beta).exp()
    }

    /// Neighbours on each side that a value needs.
    pub fn half_width(&self) -> usize {
        self.half_width
    }

    /// The last row not behind the begin of `rows` from which a shaft makes so many turns up to their end, beside the
    /// neighbours that resampling needs at both ends; the first row where it makes fewer.
    pub fn first_row_for(
        &self,
        turns: usize,
        angles_rad: &[f64],
        rows: &std::ops::Range<usize>,
    ) -> usize {
        let neighbours = 2 * self.half_width + 2;
        let last = rows.end.saturating_sub(1);
        let needed = TAU * turns as f64;
        let whole = |first: usize| {
            let from = first + neighbours;
            from <= last && (angles_rad[last] - angles_rad[from]).abs() >= needed
        };
        (0..=rows.start)
            .rev()
            .find(|first| whole(*first))
            .unwrap_or(0)
    }

    /// Fraction of the lower Nyquist frequency up to which the result is right.
    pub fn band(&self) -> f64 {
        self.band
    }

    /// Weights of a value's neighbours, 2·L·s + 1 of them, where one of every s = `factor` samples is kept: the kernel
    /// at whole distances, with the sum 1.
    #[must_use]
    pub fn decimation(&self, factor: usize) -> Vec<f64> {
        let factor = factor.max(1);
        let half = self.half_width * factor;
        let at = |j: usize| (j as f64 - half as f64) / factor as f64;
        let kernel = (0..=2 * half).map(|j| sinc(at(j)) * self.window(at(j)));
        let kernel: Vec<f64> = kernel.collect();
        let sum: f64 = kernel.iter().sum();
        kernel.into_iter().map(|weight| weight / sum).collect()
    }

    /// From uniform time samples to uniform shaft angles, `samples_per_revolution` a turn, on the grid through angle 0.
    ///
    /// `angle_rad`: the shaft's angle at each sample, increasing.
    ///
    /// # Errors
    /// [`SeriesError`]: lengths, values, angles that do not increase, a grid that is too fine, or a series that is too
    /// short.
    pub fn to_angle(
        &self,
        samples: &[f64],
        angle_rad: &[f64],
        samples_per_revolution: usize,
    ) -> Result<AngleSamples, SeriesError> {
        check_samples("resampling to angle", samples, ANGLE_POINTS)?;
        check_angles(angle_rad, samples.len())?;
        let step = TAU / samples_per_revolution as f64;
        let (first, last) = (
            (angle_rad[0] / step).ceil(),
            (angle_rad[angle_rad.len() - 1] / step).floor(),
        );
        check_setting(
            "samples per revolution",
            samples_per_revolution as f64,
            samples_per_revolution > 0 && last - first < MOST_SAMPLES,
            "1 or more, at most 5e7 in all",
        )?;
        let steps = (last - first).max(-1.0) as i64;
        let mut before = 0;
        let mut result = AngleSamples {
            start_rad: 0.0,
            samples_per_revolution,
            values: Vec::new(),
            positions: Vec::new(),
        };
        for k in 0..=steps {
            let angle = (first + k as f64) * step;
            while before + 2 < angle_rad.len() && angle_rad[before + 1] <= angle {
                before += 1;
            }
            let position = position_of_angle(angle_rad, before, angle);
            let stretch = step / (angle_rad[before + 1] - angle_rad[before]);
            match self.value(samples, position, stretch.max(1.0)) {
                Some(value) => {
                    if result.values.is_empty() {
                        result.start_rad = angle;
                    }
                    result.values.push(value);
                    result.positions.push(position);
                }
                None if result.values.is_empty() => {}
                None => break,
            }
        }
        self.not_empty(result.values.len(), samples.len())?;
        Ok(result)
    }

    /// From uniform angles back to the uniform times at which the shaft had `angle_rad` (increasing, rad).
    ///
    /// # Errors
    /// As [`Resampler::to_angle`].
    pub fn to_time(
        &self,
        series: &AngleSamples,
        angle_rad: &[f64],
    ) -> Result<GridSamples, SeriesError> {
        check_samples("resampling to time", &series.values, ANGLE_POINTS)?;
        check_angles(angle_rad, angle_rad.len())?;
        let step = TAU / series.samples_per_revolution.max(1) as f64;
        let at = |i: usize| {
            // The step of the time grid here, in steps of the angle grid.
            let next = (i + 1).min(angle_rad.len() - 1);
            let stretch = (angle_rad[next] - angle_rad[next - 1]) / step;
            let position = (angle_rad[i] - series.start_rad) / step;
            self.value(&series.values, position, stretch.max(1.0))
        };
        self.run(angle_rad.len(), series.values.len(), at)
    }

    /// From one uniform rate to another. Grid point i of the result is at the time i/`new_rate_hz` after the first
    /// sample.
    ///
    /// # Errors
    /// As [`Resampler::to_angle`].
    pub fn to_rate(
        &self,
        samples: &[f64],
        rate_hz: f64,
        new_rate_hz: f64,
    ) -> Result<GridSamples, SeriesError> {
        check_samples("resampling to another rate", samples, 2)?;
        check_rate(rate_hz)?;
        check_rate(new_rate_hz)?;
        let ratio = rate_hz / new_rate_hz;
        let points = (samples.len() - 1) as f64 / ratio;
        check_setting(
            "new sampling rate",
            new_rate_hz,
            points < MOST_SAMPLES,
            "at most 5e7 samples in all",
        )?;
        self.run(points as usize + 1, samples.len(), |i| {
            self.value(samples, i as f64 * ratio, ratio.max(1.0))
        })
    }

    /// The values of a grid between the ends that lack neighbours.
    fn run(
        &self,
        points: usize,
        found: usize,
        at: impl Fn(usize) -> Option<f64>,
    ) -> Result<GridSamples, SeriesError> {
        let first = (0..points).find(|&i| at(i).is_some()).unwrap_or(points);
        let values: Vec<f64> = (first..points).map_while(at).collect();
        self.not_empty(values.len(), found)?;
        Ok(GridSamples { first, values })
    }

    fn not_empty(&self, values: usize, found: usize) -> Result<(), SeriesError> {
        if values > 0 {
            Ok(())
        } else {
            Err(SeriesError::NothingInside {
                half_width: self.half_width,
                found,
            })
        }
    }

    /// x(p), or none where a neighbour is missing. `stretch` s ≥ 1.
    fn value(&self, samples: &[f64], position: f64, stretch: f64) -> Option<f64> {
        let reach = self.half_width as f64 * stretch;
        let (low, high) = ((position - reach).ceil(), (position + reach).floor());
        if !(low >= 0.0 && high <= (samples.len() - 1) as f64) {
            return None;
        }
        let first = low as usize;
        let sum: f64 = samples[first..=high as usize]
            .iter()
            .enumerate()
            .map(|(j, x)| {
                let distance = (position - (first + j) as f64) / stretch;
                x * sinc(distance) * self.window(distance)
            })
            .sum();
        Some(sum / stretch)
    }

    /// I₀(β √(1 − (d/L)²))/I₀(β).
    fn window(&self, distance: f64) -> f64 {
        let share = distance / self.half_width as f64;
        let y = (1.0 - share * share).max(0.0);
        self.window.iter().rev().fold(0.0, |sum, c| sum * y + c)
    }
}

fn sinc(x: f64) -> f64 {
    if x == 0.0 {
        1.0
    } else {
        (PI * x).sin() / (PI * x)
    }
}

/// Coefficients c_k of I₀(β √y)/I₀(β) = Σ_k c_k y^k for 0 ≤ y ≤ 1, from I₀(x) = Σ_k ((x/2)^k/k!)². All are positive, so
/// that the sum is exact to rounding.
fn kaiser_polynomial(beta: f64) -> Vec<f64> {
    let quarter = 0.25 * beta * beta;
    let mut coefficients = vec![1.0];
    let (mut term, mut sum, mut k) = (1.0, 1.0, 1.0);
    while term > 1e-17 * sum {
        term *= quarter / (k * k);
        sum += term;
        coefficients.push(term);
        k += 1.0;
    }
    coefficients.iter_mut().for_each(|c| *c /= sum);
    coefficients
}

fn check_angles(angle_rad: &[f64], samples: usize) -> Result<(), SeriesError> {
    if angle_rad.len() != samples {
        return Err(SeriesError::Lengths {
            first_what: "the shaft angle",
            first: angle_rad.len(),
            second_what: "the signal",
            second: samples,
        });
    }
    check_samples("a shaft angle", angle_rad, ANGLE_POINTS)?;
    match angle_rad.windows(2).position(|pair| pair[1] <= pair[0]) {
        Some(i) => Err(SeriesError::AngleNotIncreasing {
            index: i + 1,
            angle_rad: angle_rad[i + 1],
            before_rad: angle_rad[i],
        }),
        None => Ok(()),
    }
}

/// Position, in samples, at which the shaft has an angle between those of the samples `before` and `before` + 1.
fn position_of_angle(angle_rad: &[f64], before: usize, angle: f64) -> f64 {
    let base = before
        .saturating_sub(ANGLE_POINTS / 2 - 1)
        .min(angle_rad.len() - ANGLE_POINTS);
    let nodes = &angle_rad[base..base + ANGLE_POINTS];
    let excess = |position: f64| lagrange(nodes, position - base as f64) - angle;
    // Regula falsi with Illinois' rule (the end that stays twice counts half): it needs no slope and stays between the
    // samples.
    let (mut a, mut b) = (before as f64, (before + 1) as f64);
    let (mut fa, mut fb) = (angle_rad[before] - angle, angle_rad[before + 1] - angle);
    let rounding = 4.0 * f64::EPSILON * angle.abs();
    let mut last_below = None;
    for _ in 0..60 {
        let middle = b - fb * (b - a) / (fb - fa);
        let f = excess(middle);
        if f.abs() <= rounding || b - a <= 1e-14 * b {
            return middle;
        }
        let below = f < 0.0;
        if below {
            (a, fa) = (middle, f);
            if last_below == Some(true) {
                fb *= 0.5;
            }
        } else {
            (b, fb) = (middle, f);
            if last_below == Some(false) {
                fa *= 0.5;
            }
        }
        last_below = Some(below);
    }
    0.5 * (a + b)
}

/// The polynomial through `nodes` at 0, 1, 2, …, at x.
fn lagrange(nodes: &[f64], x: f64) -> f64 {
    nodes
        .iter()
        .enumerate()
        .map(|(i, value)| {
            let weight: f64 = (0..nodes.len())
                .filter(|&j| j != i)
                .map(|j| (x - j as f64) / (i as f64 - j as f64))
                .product();
            weight * value
        })
        .sum()
}
