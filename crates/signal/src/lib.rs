#![doc = include_str!("../README.md")]
//! # Where things are
//!
//! Spectra, orders and figures of signals, and the test-rig pipeline.
//!
//! | you have | you want | use |
//! | --- | --- | --- |
//! | a quantity over the angle of a shaft | a periodic function of the angle | [`AngleSeries`] |
//! | an [`AngleSeries`] | what a rig's post-processing would show | [`rig::process`] |
//! | two signals of one period | the offset at which they agree best | [`best_offset`] |
//! | uniform samples over whole revolutions | amplitudes and phases by order, exact | [`OrderSpectrum`] |
//! | uniform samples of any length | amplitudes, power density, with a [`Window`] | [`spectrum`] |
//! | time samples and the shaft's angle | samples uniform in the angle, and back | [`Resampler`] |
//! | a run-up | speed × frequency, speed × order | [`campbell`] |
//! | an amplitude spectrum | lines at carrier ± n·modulator | [`sidebands`] |
//! | an amplitude-modulated band | its envelope | [`mod@envelope`] |
//! | samples uniform in the angle | what repeats with a shaft or a mesh, and the rest | [`mod@synchronous_average`] |
//! | one or two signals | RMS, kurtosis, crest factor, peak-to-peak, correlation, largest deviation | [`statistics`] |
//!
//! Angles are in rad, an *order* is a number of periods in one revolution of the shaft whose angle is the abscissa
//! (the driver's where nothing else is said). Nothing here knows the unit of the quantity: what goes in comes out.
//! Equations and accuracies: docs/theory/signals.md.

pub mod alignment;
pub mod angle_series;
mod bounded_cubic;
pub mod campbell;
pub mod envelope;
mod error;
mod fourier;
pub mod orders;
mod periodic_spline;
pub mod resampling;
pub mod rig;
pub mod shaft_period;
pub mod sidebands;
pub mod spectrum;
pub mod statistics;
pub mod synchronous_average;
pub mod window;

pub use alignment::{BestOffset, best_offset};
pub use angle_series::{AngleSeries, AngleSeriesError};
pub use campbell::{CampbellRow, FrequencyBlocks, OrderBlocks};
pub use envelope::{Band, Envelope, envelope};
pub use error::SeriesError;
pub use orders::{OrderError, OrderSpectrum};
pub use resampling::{AngleSamples, GridSamples, Resampler};
pub use rig::{OrderFilter, RigError, RigSettings, RigSignal};
pub use shaft_period::ShaftPeriod;
pub use sidebands::{Sideband, SidebandSettings, sideband_table};
pub use spectrum::{
    BlockTransform, Spectrum, WelchSettings, amplitude_spectrum, power_spectral_density,
};
pub use statistics::StatisticsError;
pub use synchronous_average::{SynchronousAverage, synchronous_average};
pub use window::Window;
