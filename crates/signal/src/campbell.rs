//! Campbell map: spectra of short blocks of a run-up, each at its speed, over frequency or over order.
//!
//! Over frequency, the lines of an order m lie on the straight m·speed/2π and resonances stand upright; a block of T
//! seconds resolves 1/T, and while the speed changes by Δω in it an order m smears over m Δω/2π. Over order, the signal
//! is resampled to the shaft's angle first ([`crate::resampling`]): orders stand upright and do not smear, resonances
//! do.
//!
//! Each block goes in without its mean and trend: of what takes longer than a block nothing can be said.

use crate::error::{SeriesError, check_rate, check_samples, check_setting};
use crate::resampling::Resampler;
use crate::spectrum::{BlockTransform, Spectrum};
use crate::window::Window;
use std::f64::consts::TAU;

/// One block of a run-up.
#[derive(Debug, Clone, PartialEq)]
pub struct CampbellRow {
    /// Middle of the block after the first sample \[s\].
    pub time_s: f64,
    /// Mean speed of the shaft over the block \[rad/s\].
    pub speed_rad_per_s: f64,
    /// Amplitudes, over Hz or over orders.
    pub spectrum: Spectrum,
}

/// How a run-up is cut into blocks over time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrequencyBlocks {
    /// Samples of a block.
    pub block_samples: usize,
    /// Samples from one block to the next.
    pub step_samples: usize,
    /// Window of a block.
    pub window: Window,
}

/// How a run-up is cut into blocks over the angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrderBlocks {
    /// Samples of a revolution after resampling: orders up to half of that.
    pub samples_per_revolution: usize,
    /// Revolutions of a block: the lines are 1/this apart.
    pub block_revolutions: usize,
    /// Revolutions from one block to the next.
    pub step_revolutions: usize,
    /// Window of a block.
    pub window: Window,
}

/// Spectra over frequency. `angle_rad`: the shaft's angle at each sample.
///
/// # Errors
/// [`SeriesError`]: lengths, values, blocks that are too short or do not fit.
pub fn frequency_map(
    samples: &[f64],
    angle_rad: &[f64],
    sampling_rate_hz: f64,
    blocks: FrequencyBlocks,
) -> Result<Vec<CampbellRow>, SeriesError> {
    let n = blocks.block_samples;
    let transform = BlockTransform::new(n, sampling_rate_hz, blocks.window)?;
    check_step(blocks.step_samples)?;
    check_samples("a Campbell map", samples, n)?;
    check_samples("the shaft angle of a Campbell map", angle_rad, n)?;
    if samples.len() != angle_rad.len() {
        return Err(SeriesError::Lengths {
            first_what: "the shaft angle",
            first: angle_rad.len(),
            second_what: "the signal",
            second: samples.len(),
        });
    }
    (0..=samples.len() - n)
        .step_by(blocks.step_samples)
        .map(|first| {
            let turned = angle_rad[first + n - 1] - angle_rad[first];
            let duration_s = (n - 1) as f64 / sampling_rate_hz;
            Ok(CampbellRow {
                time_s: first as f64 / sampling_rate_hz + 0.5 * duration_s,
                speed_rad_per_s: turned / duration_s,
                spectrum: Spectrum {
                    values: transform.amplitudes(&without_trend(&samples[first..first + n]))?,
                    line_spacing: transform.line_spacing(),
                },
            })
        })
        .collect()
}

/// Spectra over order. `angle_rad`: the shaft's angle at each sample, increasing.
///
/// # Errors
/// [`SeriesError`]: as [`frequency_map`], and those of [`Resampler::to_angle`].
pub fn order_map(
    samples: &[f64],
    angle_rad: &[f64],
    sampling_rate_hz: f64,
    blocks: OrderBlocks,
    resampler: &Resampler,
) -> Result<Vec<CampbellRow>, SeriesError> {
    check_rate(sampling_rate_hz)?;
    check_step(blocks.step_revolutions)?;
    let per_turn = blocks.samples_per_revolution;
    let series = resampler.to_angle(samples, angle_rad, per_turn)?;
    let n = per_turn.saturating_mul(blocks.block_revolutions);
    check_samples(
        "an order map (after resampling)",
        &series.values,
        n.saturating_add(1),
    )?;
    let transform = BlockTransform::new(n, per_turn as f64, blocks.window)?;
    (0..series.values.len() - n)
        .step_by(per_turn.saturating_mul(blocks.step_revolutions))
        .map(|first| {
            let (from, to) = (series.positions[first], series.positions[first + n]);
            Ok(CampbellRow {
                time_s: 0.5 * (from + to) / sampling_rate_hz,
                speed_rad_per_s: TAU * blocks.block_revolutions as f64 * sampling_rate_hz
                    / (to - from),
                spectrum: Spectrum {
                    values: transform
                        .amplitudes(&without_trend(&series.values[first..first + n]))?,
                    line_spacing: transform.line_spacing(),
                },
            })
        })
        .collect()
}

/// A block less the straight line through it by least squares. Under a window its mean would stand in the first lines,
/// stronger than what vibrates: the Hann window leaves half of it in line 1.
fn without_trend(block: &[f64]) -> Vec<f64> {
    let count = block.len() as f64;
    let middle = 0.5 * (count - 1.0);
    let mean = block.iter().sum::<f64>() / count;
    let moment = block.iter().enumerate();
    let moment: f64 = moment.map(|(i, x)| (i as f64 - middle) * x).sum();
    // Σ (i − (n−1)/2)² = n (n² − 1)/12
    let slope = 12.0 * moment / (count * (count * count - 1.0));
    let line = |i: usize| mean + slope * (i as f64 - middle);
    let values = block.iter().enumerate();
    values.map(|(i, x)| x - line(i)).collect()
}

fn check_step(step: usize) -> Result<(), SeriesError> {
    check_setting(
        "step from one block to the next",
        step as f64,
        step > 0,
        "1 or more",
    )
}
