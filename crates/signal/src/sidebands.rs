//! Sidebands of a carrier: the lines at carrier ± n·modulator of an amplitude spectrum.
//!
//! An amplitude-modulated tone A (1 + m cos 2πf_m t) cos 2πf_c t has the lines A at f_c and A m/2 at f_c ± f_m: the
//! ratio of the first sidebands is half the degree of modulation. Gears: carrier = mesh frequency or a multiple of it
//! (or an order), modulator = shaft frequency (or order 1).

use crate::error::{SeriesError, check_setting};
use crate::spectrum::Spectrum;

/// One line of a sideband table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sideband {
    /// n of carrier + n·modulator; 0 is the carrier itself.
    pub number: i32,
    /// Place of the line that was read, in cycles per unit.
    pub at: f64,
    /// Amplitude of that line, in the signal's unit.
    pub amplitude: f64,
    /// Amplitude over the carrier's.
    pub ratio: f64,
}

/// Which sidebands to read.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SidebandSettings {
    /// Place of the carrier in cycles per unit.
    pub carrier: f64,
    /// Distance of two sidebands in cycles per unit.
    pub modulator: f64,
    /// Sidebands on each side.
    pub pairs: u32,
    /// Lines on each side of the nearest one among which the largest is taken: 0 where carrier and sidebands are on
    /// lines.
    pub search_lines: usize,
}

/// The sidebands from −pairs to +pairs with the carrier in the middle.
///
/// # Errors
/// [`SeriesError::OutsideSpectrum`] where a sideband would lie below 0 or above the highest line,
/// [`SeriesError::SidebandsMerge`] where two sidebands would read the same line, [`SeriesError::Setting`] for a carrier
/// without amplitude or a modulator that is not positive.
pub fn sideband_table(
    spectrum: &Spectrum,
    settings: SidebandSettings,
) -> Result<Vec<Sideband>, SeriesError> {
    let SidebandSettings {
        carrier,
        modulator,
        pairs,
        search_lines,
    } = settings;
    check_setting("modulator", modulator, modulator > 0.0, "above 0")?;
    if modulator < (2.0 * search_lines as f64 + 1.0) * spectrum.line_spacing {
        return Err(SeriesError::SidebandsMerge {
            modulator,
            line_spacing: spectrum.line_spacing,
            search_lines,
        });
    }
    let read = |number: i32| -> Result<(f64, f64), SeriesError> {
        let middle = spectrum.nearest_line(carrier + f64::from(number) * modulator)?;
        let last = middle
            .saturating_add(search_lines)
            .min(spectrum.values.len() - 1);
        let (line, amplitude) = spectrum.peak(
            spectrum.at(middle.saturating_sub(search_lines)),
            spectrum.at(last),
        )?;
        Ok((spectrum.at(line), amplitude))
    };
    let (_, of_carrier) = read(0)?;
    check_setting(
        "amplitude of the carrier",
        of_carrier,
        of_carrier > 0.0,
        "above 0: sidebands are given relative to it",
    )?;
    let pairs = i32::try_from(pairs).unwrap_or(i32::MAX);
    (-pairs..=pairs)
        .map(|number| {
            let (at, amplitude) = read(number)?;
            Ok(Sideband {
                number,
                at,
                amplitude,
                ratio: amplitude / of_carrier,
            })
        })
        .collect()
}
