//! The quantities of a reference record, and the units in which people read them.

use std::fmt;

/// A unit of display: value shown = value in SI units × `per_si`.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Unit {
    /// Symbol for heads and axes.
    pub symbol: &'static str,
    /// Factor from the SI value to the value shown.
    pub per_si: f64,
}

impl Unit {
    /// µm of a length in m.
    pub const MICROMETRE: Self = Self {
        symbol: "µm",
        per_si: 1e6,
    };
    /// µε (microstrain) of a strain.
    pub const MICROSTRAIN: Self = Self {
        symbol: "µε",
        per_si: 1e6,
    };
}

/// What a column of a reference record holds.
#[derive(Debug, Clone, PartialEq, Eq, Hash, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Transmission error r_b2·θ2 − r_b1·θ1, m, negative under load.
    TransmissionError,
    /// Surface strain of a gauge, tension positive, dimensionless.
    Strain {
        /// Name of the gauge.
        gauge: String,
    },
}

impl Quantity {
    /// The unit in which the quantity is written in files and shown.
    pub fn unit(&self) -> Unit {
        match self {
            Self::TransmissionError => Unit::MICROMETRE,
            Self::Strain { .. } => Unit::MICROSTRAIN,
        }
    }
}

impl Quantity {
    /// Symbol of the SI unit; "1" for a pure number.
    pub fn si_unit(&self) -> &'static str {
        match self {
            Self::TransmissionError => "m",
            Self::Strain { .. } => "1",
        }
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TransmissionError => write!(f, "TE"),
            Self::Strain { gauge } => write!(f, "strain {gauge}"),
        }
    }
}
