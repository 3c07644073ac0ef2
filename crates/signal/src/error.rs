//! Why a uniform series cannot be processed: one error for everything that works on a slice and a sampling rate.

/// Why a uniform series cannot be processed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SeriesError {
    /// Too few samples for what is asked.
    #[error("{what}: {found} samples; at least {least} are needed")]
    TooShort {
        /// What was to be made of them.
        what: &'static str,
        /// Number of samples.
        found: usize,
        /// Smallest number.
        least: usize,
    },
    /// NaN or infinity among the samples.
    #[error("sample {index} is {value}; samples must be finite numbers")]
    NotFinite {
        /// Index of the sample, from 0.
        index: usize,
        /// Its value.
        value: f64,
    },
    /// Two series that belong together differ in length.
    #[error("{first_what} has {first} samples, {second_what} {second}; they must be as many")]
    Lengths {
        /// Name of the first series.
        first_what: &'static str,
        /// Its samples.
        first: usize,
        /// Name of the second series.
        second_what: &'static str,
        /// Its samples.
        second: usize,
    },
    /// A setting out of its range.
    #[error("{setting} = {found}; allowed is {allowed}")]
    Setting {
        /// Name of the setting with its unit.
        setting: &'static str,
        /// Its value.
        found: f64,
        /// The range in words.
        allowed: &'static str,
    },
    /// A band or line outside the spectrum.
    #[error(
        "{what} = {found}; the spectrum goes from 0 to {highest} (half the sampling rate), in the same unit"
    )]
    OutsideSpectrum {
        /// What was asked for.
        what: &'static str,
        /// Its place, in cycles per unit.
        found: f64,
        /// The Nyquist frequency, in cycles per unit.
        highest: f64,
    },
    /// Sidebands that share lines.
    #[error(
        "sidebands {modulator} apart cannot be separated on lines {line_spacing} apart with a search of {search_lines} lines: \
         take a longer series"
    )]
    SidebandsMerge {
        /// Spacing of the sidebands, in cycles per unit.
        modulator: f64,
        /// Spacing of the lines, in cycles per unit.
        line_spacing: f64,
        /// Lines searched on each side.
        search_lines: usize,
    },
    /// The shaft's angle does not grow.
    #[error(
        "the shaft angle {angle_rad} rad at sample {index} is not above its predecessor {before_rad} rad; angles must increase"
    )]
    AngleNotIncreasing {
        /// Index of the sample, from 0.
        index: usize,
        /// The angle there in rad.
        angle_rad: f64,
        /// The angle before it in rad.
        before_rad: f64,
    },
    /// Nothing is left between the ends, where the interpolation lacks neighbours.
    #[error(
        "no sample of the new grid has {half_width} neighbours on each side (in steps of the coarser grid): the series of \
         {found} samples is too short"
    )]
    NothingInside {
        /// Neighbours needed on each side.
        half_width: usize,
        /// Samples of the series.
        found: usize,
    },
    /// The Fourier transform refused its buffers.
    #[error("Fourier transform of {samples} samples failed: {reason}")]
    Transform {
        /// Number of samples.
        samples: usize,
        /// What the transform said.
        reason: String,
    },
}

/// Refuses NaN, infinity and fewer than `least` samples.
pub(crate) fn check_samples(
    what: &'static str,
    samples: &[f64],
    least: usize,
) -> Result<(), SeriesError> {
    if samples.len() < least {
        return Err(SeriesError::TooShort {
            what,
            found: samples.len(),
            least,
        });
    }
    match samples.iter().enumerate().find(|(_, v)| !v.is_finite()) {
        Some((index, &value)) => Err(SeriesError::NotFinite { index, value }),
        None => Ok(()),
    }
}

/// Refuses a setting unless `ok`.
pub(crate) fn check_setting(
    setting: &'static str,
    found: f64,
    ok: bool,
    allowed: &'static str,
) -> Result<(), SeriesError> {
    if found.is_finite() && ok {
        Ok(())
    } else {
        Err(SeriesError::Setting {
            setting,
            found,
            allowed,
        })
    }
}

/// Refuses a sampling rate that is no positive finite number.
pub(crate) fn check_rate(samples_per_unit: f64) -> Result<(), SeriesError> {
    check_setting(
        "sampling rate",
        samples_per_unit,
        samples_per_unit > 0.0,
        "a finite number above 0",
    )
}
