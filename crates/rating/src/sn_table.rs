//! S-N tables in files: TOML arrays, megapascals in the key.

use crate::sn_curve::{AboveTable, BelowTable, SnCurve, SnError, SnPoint};
use serde::Deserialize;

/// Why a file is no S-N table.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SnTableError {
    /// Not TOML, or with other keys.
    #[error("no S-N table: {reason}")]
    Toml {
        /// What the reader says, with the place.
        reason: String,
    },
    /// Arrays of different length.
    #[error(
        "{cycles} values in cycles, {amplitudes} in stress_amplitude_MPa; every row needs both"
    )]
    Lengths {
        /// Values in `cycles`.
        cycles: usize,
        /// Values in `stress_amplitude_MPa`.
        amplitudes: usize,
    },
    /// A slope that the chosen rule does not use, or lacks.
    #[error(
        "below = \"slope\" and slope_below belong together: give both, or another rule and no slope_below"
    )]
    SlopeBelow,
    /// The rows are no S-N curve.
    #[error(transparent)]
    Curve(#[from] SnError),
}

/// Rule for amplitudes below the table, by its word in files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum BelowWord {
    EnduranceLimit,
    LastSlope,
    Haibach,
    Slope,
}

/// Rule for amplitudes above the table, by its word in files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum AboveWord {
    #[default]
    Refuse,
    FirstSlope,
}

/// An S-N table as written in a TOML file.
///
/// ```toml
/// cycles               = [1e3, 1e5, 2e6]
/// stress_amplitude_MPa = [900, 520, 300]      # at zero mean, of the same kind of stress as the history: local or nominal
/// below = "haibach"                           # or "endurance-limit", "last-slope", "slope" (with slope_below)
/// above = "first-slope"                       # or "refuse", the default
/// ```
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct SnTable {
    cycles: Vec<f64>,
    stress_amplitude_MPa: Vec<f64>,
    below: BelowWord,
    slope_below: Option<f64>,
    #[serde(default)]
    above: AboveWord,
}

impl SnTable {
    /// The curve that the table says.
    ///
    /// # Errors
    /// [`SnTableError`], see its variants.
    pub fn curve(&self) -> Result<SnCurve, SnTableError> {
        if self.cycles.len() != self.stress_amplitude_MPa.len() {
            return Err(SnTableError::Lengths {
                cycles: self.cycles.len(),
                amplitudes: self.stress_amplitude_MPa.len(),
            });
        }
        let below = match (self.below, self.slope_below) {
            (BelowWord::EnduranceLimit, None) => BelowTable::EnduranceLimit,
            (BelowWord::LastSlope, None) => BelowTable::LastSlope,
            (BelowWord::Haibach, None) => BelowTable::Haibach,
            (BelowWord::Slope, Some(slope)) => BelowTable::Slope(slope),
            _ => return Err(SnTableError::SlopeBelow),
        };
        let above = match self.above {
            AboveWord::Refuse => AboveTable::Refuse,
            AboveWord::FirstSlope => AboveTable::FirstSlope,
        };
        let points: Vec<SnPoint> = self
            .cycles
            .iter()
            .zip(&self.stress_amplitude_MPa)
            .map(|(&cycles, &mpa)| SnPoint {
                cycles,
                amplitude_pa: mpa * 1e6,
            })
            .collect();
        Ok(SnCurve::new(&points, above, below)?)
    }
}

impl SnCurve {
    /// Reads an [`SnTable`] in TOML.
    ///
    /// # Errors
    /// [`SnTableError`], see its variants.
    pub fn from_toml(text: &str) -> Result<Self, SnTableError> {
        let table: SnTable = toml::from_str(text).map_err(|e| SnTableError::Toml {
            reason: e.message().trim_end().to_owned(),
        })?;
        table.curve()
    }
}
