//! Order spectra and the test-rig pipeline.
//!
//! | you have | you want | use |
//! | --- | --- | --- |
//! | a quantity over the angle of a shaft | a periodic function of the angle | [`AngleSeries`] |
//! | an [`AngleSeries`] | what a rig's post-processing would show | [`rig::process`] |
//! | uniform samples over whole revolutions | amplitudes and phases by order | [`OrderSpectrum`] |
//! | two signals on one grid | peak-to-peak, RMS, correlation, largest deviation | [`statistics`] |
//!
//! Angles are in rad, an *order* is a number of periods in one revolution of the shaft whose angle is the abscissa
//! (the driver's throughout gearmesh). Nothing here knows the unit of the quantity: what goes in comes out.

pub mod angle_series;
pub mod orders;
mod periodic_spline;
pub mod rig;
pub mod statistics;

pub use angle_series::{AngleSeries, AngleSeriesError};
pub use orders::{OrderError, OrderSpectrum};
pub use rig::{OrderFilter, RigError, RigSettings, RigSignal};
pub use statistics::StatisticsError;
