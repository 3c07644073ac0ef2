//! Elastic load and damping of a contact as one load, with its derivatives.
//!
//! | law | F |
//! | --- | --- |
//! | Hertz with [`Rebound`] | Q(δ) max(0, 1 + χ δ̇) |
//! | [`StatedContact`] | max(0, K δ^e + c STEP(δ; 0, 0, d, 1) δ̇), the impact function of multibody programs; STEP = s²(3 − 2s), s = δ/d |

use super::rebound::Rebound;
use super::surface_contact::ElasticLoad;
use crate::error::BearingError;

/// A contact of stated stiffness, in place of Hertz and [`Rebound`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StatedContact {
    /// K \[N/m^e\].
    pub stiffness_n_per_m_e: f64,
    /// e, at least 1.
    pub exponent: f64,
    /// c \[N·s/m\].
    pub damping_n_s_per_m: f64,
    /// d \[m\]: depth from which the damping acts in full.
    pub full_damping_depth_m: f64,
}

/// A load and its derivatives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct DampedLoad {
    /// F \[N\], not negative.
    pub load_n: f64,
    /// The elastic part of it.
    pub elastic_n: f64,
    /// ∂F/∂δ.
    pub by_depth: f64,
    /// ∂F/∂δ̇.
    pub by_rate: f64,
    /// Energy of the elastic part \[J\].
    pub stored_j: f64,
}

impl Rebound {
    /// The load at an approach that grows at a rate \[m/s\].
    #[inline]
    pub(crate) fn damped(&self, elastic: &ElasticLoad, rate_m_per_s: f64) -> DampedLoad {
        let (factor, chi) = self.factor(rate_m_per_s);
        DampedLoad {
            load_n: elastic.load_n * factor,
            elastic_n: elastic.load_n,
            by_depth: elastic.slope_n_per_m * factor,
            by_rate: elastic.load_n * chi,
            stored_j: elastic.stored_j,
        }
    }
}

impl StatedContact {
    /// The contact, if its numbers make sense.
    ///
    /// # Errors
    /// [`BearingError::Parameter`].
    pub fn validated(self) -> Result<Self, BearingError> {
        let exponent = self.exponent;
        let is_allowed = exponent >= 1.0 && exponent.is_finite();
        let allowed = "at least 1 and finite";
        BearingError::positive("the stiffness of the contact", self.stiffness_n_per_m_e)?;
        BearingError::require("the exponent of the contact", exponent, is_allowed, allowed)?;
        let damping = self.damping_n_s_per_m;
        BearingError::not_negative("the damping of the contact in N s/m", damping)?;
        BearingError::positive("the depth of full damping in m", self.full_damping_depth_m)?;
        Ok(self)
    }

    /// The load at a depth above 0 that grows at a rate \[m/s\].
    pub(crate) fn damped(&self, depth_m: f64, rate_m_per_s: f64) -> DampedLoad {
        let slope = self.stiffness_n_per_m_e * depth_m.powf(self.exponent - 1.0);
        let elastic_n = slope * depth_m;
        let s = (depth_m / self.full_damping_depth_m).min(1.0);
        let damping = self.damping_n_s_per_m * s * s * (3.0 - 2.0 * s);
        let damping_by = self.damping_n_s_per_m * 6.0 * s * (1.0 - s) / self.full_damping_depth_m;
        let load_n = elastic_n + damping * rate_m_per_s;
        let acts = if load_n > 0.0 { 1.0 } else { 0.0 };
        DampedLoad {
            load_n: load_n.max(0.0),
            elastic_n,
            by_depth: acts * (self.exponent * slope + damping_by * rate_m_per_s),
            by_rate: acts * damping,
            stored_j: elastic_n * depth_m / (self.exponent + 1.0),
        }
    }
}
