//! What is wrong with the numbers of a local law.

use thiserror::Error;

/// Error of the constructors of [`LocalLaw`](super::LocalLaw).
#[derive(Debug, Clone, PartialEq, Error)]
pub enum LocalLawError {
    /// A length, modulus or force is not a positive finite number.
    #[error("{what} is {found}; it must be a positive finite number")]
    NotPositive {
        /// Name of the input with its unit.
        what: &'static str,
        /// The value.
        found: f64,
    },
    /// Poisson's ratio is outside its range.
    #[error("Poisson's ratio is {found}; it must be at least 0 and at most 0.5")]
    PoissonRatio {
        /// The value.
        found: f64,
    },
    /// A coefficient of the law is out of range.
    #[error(
        "the coefficient {what} is {found} m/N; alpha must be finite and beta finite and not negative"
    )]
    Coefficient {
        /// `alpha` or `beta`.
        what: &'static str,
        /// The value \[m/N\].
        found: f64,
    },
    /// The floor is not below the cap, so that no load follows the logarithm.
    #[error(
        "the load is too large for teeth of this size: a share of {floor_n:.3e} N already presses the contact as wide as the tooth is thick, which {cap_n:.3e} N do; check the units of the load, of Young's modulus and of the sizes"
    )]
    FloorAboveCap {
        /// Force below which the logarithm is continued by its tangent \[N\].
        floor_n: f64,
        /// Force above which the slope is frozen \[N\].
        cap_n: f64,
    },
}

pub(super) fn require_positive(what: &'static str, found: f64) -> Result<(), LocalLawError> {
    if found.is_finite() && found > 0.0 {
        Ok(())
    } else {
        Err(LocalLawError::NotPositive { what, found })
    }
}
