//! Where a bearing's frequencies stand in a spectrum: FTF, BSF, BPFO, BPFI.

use super::outcome::{LineSpectrum, Outcome};
use crate::arguments::BearingLineArguments;
use crate::commands::bearing;
use gearmesh_operations::Failure;
use gearmesh_signal::Spectrum;

/// Multiples of each frequency that a page marks.
const MULTIPLES: usize = 3;

/// Frequencies of a bearing, in the unit of a spectrum's abscissa.
pub struct BearingLines {
    /// Name, that of the amplitude there, place.
    lines: [(&'static str, &'static str, f64); 4],
}

impl BearingLines {
    /// Those of the file that was named, if any; in orders of the shaft, or at the speed that was given.
    pub fn read(a: &BearingLineArguments, is_of_orders: bool) -> Result<Option<Self>, Failure> {
        let Some(path) = &a.bearing else {
            return Ok(None);
        };
        let per_turn = match (is_of_orders, a.speed_rpm) {
            (true, None) => 1.0,
            (false, Some(rpm)) if rpm.is_finite() && rpm != 0.0 && rpm.abs() <= 1e7 => rpm / 60.0,
            (false, Some(rpm)) => {
                return Err(Failure::input(format!(
                    "--speed-rpm: found {rpm}, allowed is -1e7 to 1e7 without 0"
                )));
            }
            (true, Some(_)) => {
                return Err(Failure::input(
                    "--speed-rpm: is not used with --shaft, whose orders need no speed; remove it",
                ));
            }
            (false, None) => {
                return Err(Failure::input(
                    "--bearing: its frequencies need the speed of the inner ring; give --speed-rpm, or --shaft for orders",
                ));
            }
        };
        let sizes = bearing::sizes(&bearing::read(path)?, a.contact_angle_deg)?;
        let f = sizes.frequencies(per_turn, 0.0);
        Ok(Some(Self {
            lines: [
                ("FTF", "amplitude at FTF", f.cage_hz.abs()),
                ("BSF", "amplitude at BSF", f.element_hz),
                ("BPFO", "amplitude at BPFO", f.outer_race_hz),
                ("BPFI", "amplitude at BPFI", f.inner_race_hz),
            ],
        }))
    }

    /// Tells the largest line within one line of each frequency, and marks them in the page's spectrum.
    pub fn mark(&self, spectrum: &Spectrum, outcome: &mut Outcome, unit: &str, place_unit: &str) {
        for (name, height, at) in self.lines {
            outcome.figure(name, at, place_unit);
            let line = (at / spectrum.line_spacing).round() as usize;
            let near = line.saturating_sub(1)..=line + 1;
            let largest = near
                .filter_map(|line| spectrum.values.get(line))
                .fold(f64::NAN, |a: f64, b| a.max(*b));
            outcome.figure(height, largest, unit);
        }
        if let Some(drawn) = &mut outcome.spectrum {
            drawn.marks = self.marks(drawn);
        }
    }

    fn marks(&self, drawn: &LineSpectrum) -> Vec<(f64, String)> {
        let highest = drawn.places.last().copied().unwrap_or(0.0);
        let multiples = self.lines.iter().flat_map(|(name, _, at)| {
            (1..=MULTIPLES).map(move |m| {
                let head = if m > 1 {
                    format!("{m} ")
                } else {
                    String::new()
                };
                (m as f64 * at, format!("{head}{name}"))
            })
        });
        multiples.filter(|(at, _)| *at <= highest).collect()
    }
}
