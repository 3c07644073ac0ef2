//! What a gear test rig does to a signal, done to a computed one.
//!
//! Seed 004, section 4.2: the signal is sampled in time at 51.2 kHz while the gears turn slowly (10 rpm, 60 s);
//! encoders of 5000 pulses a turn bring it to the angle domain; a tacho cuts it into blocks of whole revolutions (of
//! one, there); the order spectra of the blocks are averaged (as complex numbers); for the transmission error the mean
//! and once per revolution of either shaft (eccentricity; orders 0 and 1, there, with equal teeth) are removed; the
//! spectrum is brought back to the angle domain. Both sides of a comparison go through [`process`], so whatever the
//! pipeline does to a signal it does to both.
//!
//! # What the pipeline does to a signal
//! - Series to time: the periodic spline of [`AngleSeries`]; an order with p points per period loses 2.16/p⁴ of its
//!   amplitude.
//! - Time to angle: four-point Lagrange interpolation between the samples. With h the angle of one sampling interval an
//!   order m loses at most (3/128)(m h)⁴. At 10 rpm one turn has 307 200 samples: 4e-14 at order 57.
//! - Aliasing: orders above half the pulses (2500) fold back. The spline's images of order m that lie there are weaker
//!   than m by (m/5000)⁴ or more for a series of up to 2500 points a turn (order 57: 2e-8); content of denser series
//!   above order 2500 folds as it does on the rig.

use crate::angle_series::AngleSeries;
use crate::orders::{OrderError, OrderSpectrum};
use crate::shaft_period::{ShaftPeriod, least_common_multiple};
use std::f64::consts::TAU;

/// Most pulses that one run may produce, so that a typing error does not fill the memory (80 MB).
const MOST_PULSES: usize = 10_000_000;

/// Fewest encoder pulses a turn: order 1 and its neighbours must be lines of the spectrum.
const FEWEST_PULSES_PER_REVOLUTION: usize = 8;

/// The settings of the rig; the default is the one of *Transmission Error and Strain Analysis of Lightweight Gears*
/// (seed 004 in docs/sources.md).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RigSettings {
    /// Sampling rate of the front end in Hz.
    pub sampling_rate_hz: f64,
    /// Speed of the shaft in rad/s.
    pub speed_rad_per_s: f64,
    /// Encoder pulses in one revolution.
    pub pulses_per_revolution: usize,
    /// Revolutions in a block, between two cuts of the tacho: lines of the spectrum are 1/this apart.
    pub revolutions_per_block: usize,
    /// Revolutions recorded; their blocks are averaged.
    pub revolutions: usize,
}

impl Default for RigSettings {
    /// 51.2 kHz, 10 rpm, 5000 pulses a turn, 10 revolutions (60 s).
    fn default() -> Self {
        Self {
            sampling_rate_hz: 51_200.0,
            speed_rad_per_s: 10.0 * TAU / 60.0,
            pulses_per_revolution: 5000,
            revolutions_per_block: 1,
            revolutions: 10,
        }
    }
}

impl RigSettings {
    /// The same rig with blocks of so many revolutions, recording at least as long as before and whole periods of a
    /// series, each part of it equally often.
    #[must_use]
    pub fn in_blocks(self, revolutions_per_block: usize, period: ShaftPeriod) -> Self {
        let common =
            least_common_multiple(revolutions_per_block.max(1), period.whole_revolutions());
        Self {
            revolutions_per_block,
            revolutions: self.revolutions.div_ceil(common).max(1) * common,
            ..self
        }
    }
}

/// What is taken out of the averaged spectrum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum OrderFilter {
    /// Nothing: for strain.
    KeepAll,
    /// Order 0 (mean) and once per revolution of either shaft (eccentricity): for the transmission error.
    RemoveMeanAndEccentricity {
        /// Revolutions of the other shaft in one of the shaft whose angle counts: teeth of this one over those of the
        /// other.
        other_shaft: f64,
    },
}

impl OrderFilter {
    /// What is taken out of the transmission error of a pair, over the angle of the gear with `teeth` teeth that runs
    /// with one of `mate` teeth.
    pub fn of_transmission_error(teeth: usize, mate: usize) -> Self {
        Self::RemoveMeanAndEccentricity {
            other_shaft: teeth as f64 / mate.max(1) as f64,
        }
    }
}

/// Why the pipeline refuses.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RigError {
    /// A setting that is no positive finite number.
    #[error("{setting} = {found}; it must be a finite number above 0")]
    NotPositive {
        /// Name of the setting.
        setting: &'static str,
        /// Its value.
        found: f64,
    },
    /// Fewer samples than pulses.
    #[error(
        "{samples_per_revolution:.0} samples a turn do not resolve {pulses_per_revolution} pulses a turn; turn more slowly \
         or sample faster"
    )]
    TooFast {
        /// Time samples in one revolution.
        samples_per_revolution: f64,
        /// Encoder pulses in one revolution.
        pulses_per_revolution: usize,
    },
    /// Number of pulses or revolutions out of range.
    #[error(
        "{revolutions} revolutions of {pulses_per_revolution} pulses; allowed are at least 1 revolution, at least \
         {FEWEST_PULSES_PER_REVOLUTION} pulses a turn and {MOST_PULSES} pulses in all"
    )]
    Counts {
        /// Revolutions asked for.
        revolutions: usize,
        /// Pulses a turn asked for.
        pulses_per_revolution: usize,
    },
    /// The average would not hold every part of the series equally often.
    #[error(
        "{revolutions} revolutions are no whole number of blocks of {revolutions_per_block}, or no multiple of the \
         {period_revolutions} revolutions that the series repeats after"
    )]
    UnevenAverage {
        /// Revolutions asked for.
        revolutions: usize,
        /// Revolutions in a block.
        revolutions_per_block: usize,
        /// Period of the series in revolutions.
        period_revolutions: usize,
    },
    /// The spectrum could not be made.
    #[error(transparent)]
    Orders(#[from] OrderError),
}

/// A signal as the rig's post-processing shows it: one block, uniform in the angle, first sample at angle 0.
#[derive(Debug, Clone, PartialEq)]
pub struct RigSignal {
    /// The averaged, filtered signal over one block; see [`RigSignal::angle_rad`].
    pub values: Vec<f64>,
    /// Revolutions in the block.
    pub revolutions: usize,
    /// The averaged, filtered spectrum over one block.
    pub spectrum: OrderSpectrum,
    /// The mean before the filter.
    pub mean_before_filter: f64,
    /// Amplitude of order 1 before the filter.
    pub first_order_before_filter: f64,
}

impl RigSignal {
    /// Angle of a sample in rad, from 0 to the end of the block.
    pub fn angle_rad(&self, sample: usize) -> f64 {
        TAU * (self.revolutions * sample) as f64 / self.values.len() as f64
    }
}

/// Sends a series through the rig: time samples, encoder pulses, blocks of revolutions, averaged spectrum, filter,
/// angle.
///
/// The shaft passes angle 0 at time 0 and turns at constant speed in its positive sense. Amplitudes and phases refer to
/// the angle of the series: nothing is shifted.
///
/// # Errors
/// [`RigError`], see its variants.
pub fn process(
    series: &AngleSeries,
    settings: &RigSettings,
    filter: OrderFilter,
) -> Result<RigSignal, RigError> {
    check(series, settings)?;
    let per_block = settings.revolutions_per_block;
    let pulses = settings.pulses_per_revolution * per_block;
    let blocks = settings.revolutions / per_block;
    let mut spectra = Vec::with_capacity(blocks);
    for block in 0..blocks {
        let signal: Vec<f64> = (0..pulses)
            .map(|pulse| at_pulse(series, settings, block * pulses + pulse))
            .collect();
        spectra.push(OrderSpectrum::from_samples(&signal, per_block)?);
    }
    let mut spectrum = OrderSpectrum::average(&spectra)?;
    let mean_before_filter = spectrum.mean();
    let first_order_before_filter = spectrum.amplitude(1.0)?;
    match filter {
        OrderFilter::KeepAll => {}
        OrderFilter::RemoveMeanAndEccentricity { other_shaft } => {
            spectrum.remove(0.0)?;
            spectrum.remove(1.0)?;
            // Between two lines it averages out: there is nothing to remove.
            if spectrum.has(other_shaft) {
                spectrum.remove(other_shaft)?;
            }
        }
    }
    Ok(RigSignal {
        values: spectrum.to_samples()?,
        revolutions: per_block,
        spectrum,
        mean_before_filter,
        first_order_before_filter,
    })
}

/// The signal at an encoder pulse, interpolated from the four time samples around it.
///
/// Only the samples that a pulse reads are evaluated; the others would change nothing.
fn at_pulse(series: &AngleSeries, settings: &RigSettings, pulse: usize) -> f64 {
    let samples_per_revolution = settings.sampling_rate_hz * TAU / settings.speed_rad_per_s;
    let position = pulse as f64 / settings.pulses_per_revolution as f64 * samples_per_revolution;
    let before = position.floor();
    let sample = |offset: f64| series.value((before + offset) / samples_per_revolution * TAU);
    let t = position - before;
    // Lagrange's cubic through the samples at -1, 0, 1, 2.
    -t * (t - 1.0) * (t - 2.0) / 6.0 * sample(-1.0)
        + (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0 * sample(0.0)
        - (t + 1.0) * t * (t - 2.0) / 2.0 * sample(1.0)
        + (t + 1.0) * t * (t - 1.0) / 6.0 * sample(2.0)
}

fn check(series: &AngleSeries, settings: &RigSettings) -> Result<(), RigError> {
    let positive = |setting, found: f64| {
        if found.is_finite() && found > 0.0 {
            Ok(())
        } else {
            Err(RigError::NotPositive { setting, found })
        }
    };
    positive("sampling rate in Hz", settings.sampling_rate_hz)?;
    positive("speed in rad/s", settings.speed_rad_per_s)?;
    let RigSettings {
        pulses_per_revolution,
        revolutions_per_block,
        revolutions,
        ..
    } = *settings;
    let in_all = revolutions.checked_mul(pulses_per_revolution);
    if pulses_per_revolution < FEWEST_PULSES_PER_REVOLUTION
        || !in_all.is_some_and(|n| (1..=MOST_PULSES).contains(&n))
    {
        return Err(RigError::Counts {
            revolutions,
            pulses_per_revolution,
        });
    }
    let samples_per_revolution = settings.sampling_rate_hz * TAU / settings.speed_rad_per_s;
    if samples_per_revolution < pulses_per_revolution as f64 {
        return Err(RigError::TooFast {
            samples_per_revolution,
            pulses_per_revolution,
        });
    }
    let period_revolutions = series.period().whole_revolutions();
    let is_even = [revolutions_per_block, period_revolutions]
        .iter()
        .all(|part| *part > 0 && revolutions.is_multiple_of(*part));
    if !is_even {
        return Err(RigError::UnevenAverage {
            revolutions,
            revolutions_per_block,
            period_revolutions,
        });
    }
    Ok(())
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn series(points: usize, f: impl Fn(f64) -> f64) -> AngleSeries {
        let values: Vec<f64> = (0..points)
            .map(|i| f(TAU * i as f64 / points as f64))
            .collect();
        AngleSeries::uniform(0.0, &values, 1).unwrap()
    }

    fn through(series: &AngleSeries, filter: OrderFilter) -> RigSignal {
        process(series, &RigSettings::default(), filter).unwrap()
    }

    #[test]
    fn the_mesh_order_passes_with_the_stated_loss() {
        for points_per_pitch in [24, 12, 8] {
            let signal = through(
                &series(57 * points_per_pitch, |a| 10.0 * (57.0 * a + 0.7).cos()),
                OrderFilter::KeepAll,
            );
            // Unser's closed form for the spline; the later steps lose far less.
            let p = points_per_pitch as f64;
            let images: f64 = (1..200)
                .map(f64::from)
                .map(|k| (1.0 + k * p).powi(-4) + (1.0 - k * p).powi(-4))
                .sum();
            let stated = 1.0 - 1.0 / (1.0 + images);
            let found = 1.0 - signal.spectrum.amplitude(57.0).unwrap() / 10.0;
            // 1e-7: the strongest image above the pulses' Nyquist order folds back near this level.
            assert!(
                (found - stated).abs() < 1e-7,
                "{points_per_pitch}: {found} against {stated}"
            );
            assert!(points_per_pitch < 24 || found < 7e-6);
            assert!((signal.spectrum.phase_rad(57.0).unwrap() - 0.7).abs() < 1e-7);
        }
    }

    #[test]
    fn images_are_as_weak_as_stated() {
        let points = 57 * 24;
        let signal = through(&series(points, |a| (57.0 * a).cos()), OrderFilter::KeepAll);
        let strongest = (0..=2500)
            .filter(|&m| m != 57)
            .map(|m| signal.spectrum.amplitude(f64::from(m)).unwrap())
            .fold(0.0, f64::max);
        let stated = (57.0f64 / (points as f64 - 57.0)).powi(4);
        assert!(
            (strongest / stated - 1.0).abs() < 0.01,
            "{strongest} against {stated}"
        );
    }

    #[test]
    fn orders_0_and_1_vanish_and_order_3_stays() {
        let input = series(1368, |a| {
            -30.0 + 4.0 * (a + 0.2).cos() + 1.5 * (3.0 * a).cos() + 0.8 * (57.0 * a).cos()
        });
        let signal = through(&input, OrderFilter::of_transmission_error(57, 57));
        assert!((signal.mean_before_filter + 30.0).abs() < 1e-9);
        assert!((signal.first_order_before_filter - 4.0).abs() < 1e-9);
        assert_eq!(signal.spectrum.amplitude(0.0), Ok(0.0));
        assert_eq!(signal.spectrum.amplitude(1.0), Ok(0.0));
        assert!((signal.spectrum.amplitude(3.0).unwrap() - 1.5).abs() < 1e-9);
        for (j, value) in signal.values.iter().enumerate() {
            let a = signal.angle_rad(j);
            assert!((value - 1.5 * (3.0 * a).cos() - 0.8 * (57.0 * a).cos()).abs() < 2e-5);
        }
    }

    #[test]
    fn uneven_grid_and_start_angle_change_nothing() {
        let f = |a: f64| (57.0 * a).cos() + 0.3 * (3.0 * a).sin();
        let angle: Vec<f64> = (0..2300)
            .map(|i| {
                let t = f64::from(i) / 2300.0;
                1.0 + TAU * (t + 0.02 * (TAU * 3.0 * t).sin() / 3.0)
            })
            .collect();
        let values: Vec<f64> = angle.iter().map(|&a| f(a)).collect();
        let signal = through(
            &AngleSeries::one_revolution(&angle, &values).unwrap(),
            OrderFilter::KeepAll,
        );
        for (j, value) in signal.values.iter().enumerate() {
            assert!((value - f(signal.angle_rad(j))).abs() < 1e-5);
        }
    }

    #[test]
    fn what_is_not_locked_to_the_turn_averages_out() {
        // Three revolutions in which order 2/3 is present: its average over the revolutions is zero, the mesh order
        // stays.
        let values: Vec<f64> = (0..4200)
            .map(|i| {
                let a = 3.0 * TAU * f64::from(i) / 4200.0;
                (57.0 * a).cos() + (2.0 * a / 3.0).cos()
            })
            .collect();
        let input = AngleSeries::uniform(0.0, &values, 3).unwrap();
        let settings = RigSettings {
            revolutions: 9,
            ..RigSettings::default()
        };
        let signal = process(&input, &settings, OrderFilter::KeepAll).unwrap();
        for (j, value) in signal.values.iter().enumerate() {
            assert!((value - (57.0 * signal.angle_rad(j)).cos()).abs() < 2e-5);
        }
        let uneven = process(&input, &RigSettings::default(), OrderFilter::KeepAll);
        assert_eq!(
            uneven,
            Err(RigError::UnevenAverage {
                revolutions: 10,
                revolutions_per_block: 1,
                period_revolutions: 3
            })
        );
    }

    #[test]
    fn a_speed_whose_turn_is_no_whole_number_of_samples_is_fine() {
        let input = series(1368, |a| (57.0 * a).cos());
        let settings = RigSettings {
            speed_rad_per_s: 47.3,
            ..RigSettings::default()
        };
        let signal = process(&input, &settings, OrderFilter::KeepAll).unwrap();
        assert!((signal.spectrum.amplitude(57.0).unwrap() - 1.0).abs() < 1e-5);
    }

    #[test]
    fn senseless_settings_are_refused() {
        let input = series(100, f64::cos);
        let run = |settings| process(&input, &settings, OrderFilter::KeepAll).unwrap_err();
        let good = RigSettings::default();
        assert!(matches!(
            run(RigSettings {
                speed_rad_per_s: 0.0,
                ..good
            }),
            RigError::NotPositive { .. }
        ));
        assert!(matches!(
            run(RigSettings {
                sampling_rate_hz: f64::NAN,
                ..good
            }),
            RigError::NotPositive { .. }
        ));
        assert!(matches!(
            run(RigSettings {
                speed_rad_per_s: 100.0,
                ..good
            }),
            RigError::TooFast { .. }
        ));
        assert!(matches!(
            run(RigSettings {
                revolutions: 0,
                ..good
            }),
            RigError::Counts { .. }
        ));
        assert!(matches!(
            run(RigSettings {
                revolutions: usize::MAX,
                ..good
            }),
            RigError::Counts { .. }
        ));
        assert!(matches!(
            run(RigSettings {
                pulses_per_revolution: 1,
                ..good
            }),
            RigError::Counts { .. }
        ));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        #[test]
        fn linear_in_the_signal(x in prop::collection::vec(-10.0..10.0f64, 40..120), factor in -3.0..3.0f64) {
            let settings = RigSettings { revolutions: 1, pulses_per_revolution: 500, ..RigSettings::default() };
            let run = |v: &[f64]| {
                let input = AngleSeries::uniform(0.0, v, 1).unwrap();
                process(&input, &settings, OrderFilter::of_transmission_error(57, 57)).unwrap().values
            };
            let scaled: Vec<f64> = x.iter().map(|v| factor * v + 5.0).collect();
            for (a, b) in run(&x).iter().zip(run(&scaled)) {
                prop_assert!((factor * a - b).abs() < 1e-8);
            }
        }

        #[test]
        fn a_turn_by_whole_pulses_turns_the_result(x in prop::collection::vec(-10.0..10.0f64, 40..120), by in 0usize..500) {
            let settings = RigSettings { revolutions: 1, pulses_per_revolution: 500, ..RigSettings::default() };
            let run = |start| {
                let input = AngleSeries::uniform(start, &x, 1).unwrap();
                process(&input, &settings, OrderFilter::KeepAll).unwrap().values
            };
            let mut expected = run(0.0);
            expected.rotate_right(by);
            // The time samples fall elsewhere between the knots of the spline: not the same to the last bit.
            for (a, b) in expected.iter().zip(run(TAU * by as f64 / 500.0)) {
                prop_assert!((a - b).abs() < 1e-7);
            }
        }
    }
}
