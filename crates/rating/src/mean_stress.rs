//! What the mean of a stress cycle does to its damage.

use crate::damage_error::DamageError;
use crate::rainflow::Cycle;

/// The amplitude at zero mean that is as damaging as a cycle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MeanStress {
    /// The mean is not looked at.
    None,
    /// J. Goodman 1899: σ_ar = σ_a/(1 − σ_m/R_m). A compressive mean is given no credit: σ_ar = σ_a.
    Goodman {
        /// Tensile strength R_m \[Pa\].
        tensile_strength_pa: f64,
    },
}

impl MeanStress {
    /// The equivalent amplitude σ_ar \[Pa\] of a stress cycle.
    ///
    /// # Errors
    /// [`DamageError::TensileStrength`] for a strength that is not positive, [`DamageError::MeanAboveStrength`] for a
    /// mean that reaches it.
    pub fn equivalent_amplitude_pa(&self, cycle: &Cycle) -> Result<f64, DamageError> {
        let Self::Goodman {
            tensile_strength_pa: strength,
        } = *self
        else {
            return Ok(cycle.amplitude());
        };
        if !(strength.is_finite() && strength > 0.0) {
            return Err(DamageError::TensileStrength { found_pa: strength });
        }
        let mean = cycle.mean().max(0.0);
        if mean >= strength {
            return Err(DamageError::MeanAboveStrength {
                mean_mpa: mean * 1e-6,
                tensile_strength_mpa: strength * 1e-6,
            });
        }
        Ok(cycle.amplitude() / (1.0 - mean / strength))
    }
}
