//! Why cycles have no damage.

use crate::rainflow::RainflowError;
use crate::sn_curve::SnError;

/// Why cycles have no damage.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum DamageError {
    /// A tensile strength that is none.
    #[error("tensile strength {found_pa} Pa; it must be a finite number above 0")]
    TensileStrength {
        /// The strength.
        found_pa: f64,
    },
    /// The mean alone breaks the tooth.
    #[error(
        "a cycle's mean stress of {mean_mpa:.3} MPa reaches the tensile strength of {tensile_strength_mpa:.3} MPa: this fails \
         at once, and Goodman's line does not hold"
    )]
    MeanAboveStrength {
        /// The mean.
        mean_mpa: f64,
        /// The strength.
        tensile_strength_mpa: f64,
    },
    /// An amplitude that the S-N curve does not know.
    #[error(transparent)]
    Curve(#[from] SnError),
    /// The history cannot be counted.
    #[error(transparent)]
    Rainflow(#[from] RainflowError),
}
