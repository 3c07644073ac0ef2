//! Energy lost in a blow: damping that fades in with the load and never pulls (K. H. Hunt, F. R. E.
//! Crossley, *Coefficient of restitution interpreted as damping in vibroimpact*, J. Appl. Mech. 42 (1975) 440-445).
//!
//! ```text
//! F = Q(δ) max(0, 1 + χ δ̇)
//! x − ln(1 + x) + e x + ln(1 − e x) = 0,   x = χ v
//! ```
//!
//! The second line is the exact balance of a free blow that begins with the speed v and ends with e v, whatever the law
//! Q(δ).

use crate::error::BearingError;

/// Damping of contacts; the default has none.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Rebound {
    /// χ \[s/m\].
    pub factor_s_per_m: f64,
}

impl Rebound {
    /// The damping with which a ball that hits a surface with the speed v \[m/s\] leaves it with e v. Slower blows lose
    /// less of their speed, faster ones more.
    ///
    /// # Errors
    /// [`BearingError::Parameter`] unless 0 < e ≤ 1 and the speed is positive.
    pub fn from_restitution(restitution: f64, speed_m_per_s: f64) -> Result<Self, BearingError> {
        BearingError::require(
            "the coefficient of restitution",
            restitution,
            restitution > 0.0 && restitution <= 1.0,
            "above 0 and at most 1",
        )?;
        BearingError::positive(
            "the speed that the coefficient of restitution holds at, in m/s",
            speed_m_per_s,
        )?;
        if restitution == 1.0 {
            return Ok(Self::default());
        }
        let balance = |x: f64| x - x.ln_1p() + restitution * x + (-restitution * x).ln_1p();
        // Positive at small x, −∞ at 1/e.
        let (mut low, mut high) = (0.0, 1.0 / restitution);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            // Both sides of the balance are of the second order in x: below it rounding decides, and x is small there.
            if middle < 1e-7 || balance(middle) > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        Ok(Self {
            factor_s_per_m: 0.5 * (low + high) / speed_m_per_s,
        })
    }

    /// max(0, 1 + χ δ̇), and whether it is above 0.
    #[inline]
    pub(crate) fn factor(&self, approach_rate_m_per_s: f64) -> (f64, f64) {
        let factor = 1.0 + self.factor_s_per_m * approach_rate_m_per_s;
        if factor > 0.0 {
            (factor, self.factor_s_per_m)
        } else {
            (0.0, 0.0)
        }
    }
}
