//! Frequencies of a rolling bearing: cage, ball or roller, and passing of the races.
//!
//! ```text
//! γ = D cos α/d_m
//! FTF  = (f_i (1 − γ) + f_o (1 + γ))/2         BSF  = |f_i − f_o| (d_m/D)(1 − γ²)/2
//! BPFO = Z |f_i − f_o| (1 − γ)/2               BPFI = Z |f_i − f_o| (1 + γ)/2
//! ```
//!
//! by pure rolling; derived in docs/theory/rolling_bearings.md. BSF is the element's speed about its own axis seen from
//! the cage: a fault on it meets a race twice a turn, at 2·BSF.

use crate::build_rows::half_taper_rad;
use crate::definition::{BearingDefinition, BearingGeometry};
use crate::ratings::{nominal_angle_rad, outer_angle_rad};

/// Frequencies in Hz, or in multiples of a ring's speed where that is 1 Hz.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BearingFrequencies {
    /// Speed of the cage: fundamental train frequency; negative where it turns the other way.
    pub cage_hz: f64,
    /// Speed of a ball or roller about its own axis, seen from the cage: ball spin frequency.
    pub element_hz: f64,
    /// Elements that pass a place of the outer race.
    pub outer_race_hz: f64,
    /// Elements that pass a place of the inner race.
    pub inner_race_hz: f64,
}

/// Sizes that the frequencies depend on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RollingSizes {
    /// Z.
    pub elements: usize,
    /// D \[m\].
    pub element_diameter_m: f64,
    /// d_m \[m\].
    pub pitch_diameter_m: f64,
    /// α \[rad\].
    pub contact_angle_rad: f64,
}

impl BearingDefinition {
    /// Sizes at the nominal contact angle: 0 for deep-groove and cylindrical roller bearings; of tapered ones the angle
    /// of the rollers' axes, so that D cos α reaches from contact to contact.
    #[must_use]
    pub fn rolling_sizes(&self) -> RollingSizes {
        match &self.geometry {
            BearingGeometry::Ball(g) => RollingSizes {
                elements: g.balls,
                element_diameter_m: g.ball_diameter_m,
                pitch_diameter_m: g.pitch_diameter_m,
                contact_angle_rad: nominal_angle_rad(g),
            },
            BearingGeometry::Roller(g) => RollingSizes {
                elements: g.rollers,
                element_diameter_m: g.diameter_m,
                pitch_diameter_m: g.pitch_diameter_m,
                contact_angle_rad: outer_angle_rad(g) - half_taper_rad(g),
            },
        }
    }
}

impl RollingSizes {
    /// At the speeds of the inner and outer ring \[Hz\].
    #[must_use]
    pub fn frequencies(&self, inner_hz: f64, outer_hz: f64) -> BearingFrequencies {
        let ratio = self.element_diameter_m / self.pitch_diameter_m;
        let gamma = ratio * self.contact_angle_rad.cos();
        let relative = (inner_hz - outer_hz).abs();
        let count = self.elements as f64;
        BearingFrequencies {
            cage_hz: 0.5 * (inner_hz * (1.0 - gamma) + outer_hz * (1.0 + gamma)),
            element_hz: 0.5 * relative * (1.0 - gamma * gamma) / ratio,
            outer_race_hz: 0.5 * count * relative * (1.0 - gamma),
            inner_race_hz: 0.5 * count * relative * (1.0 + gamma),
        }
    }
}
