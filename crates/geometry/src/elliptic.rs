//! Complete elliptic integrals by the arithmetic-geometric mean.
//!
//! Source: M. Abramowitz, I. Stegun, *Handbook of Mathematical Functions*, 17.6.

/// Complete elliptic integrals of one modulus.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EllipticIntegrals {
    /// K(m), the first kind.
    pub first: f64,
    /// E(m), the second kind.
    pub second: f64,
    /// F(ρ) = ((κ² + 1) E − 2 K)/((κ² − 1) E), the ratio of curvatures whose contact ellipse has these half axes;
    /// found without cancellation near a circle.
    pub curvature_ratio: f64,
}

/// K, E and F(ρ) for an ellipse of the axis ratio κ = a/b ≥ 1, that is m = 1 − 1/κ².
///
/// ```text
/// a₀ = 1, b₀ = 1/κ, a' = (a + b)/2, b' = √(ab), c' = (a − b)/2
/// K = π/(2a∞),  E = K (1 − S),  S = m/2 + Σ 2ⁿ⁻¹ c_n²  (n ≥ 1)
/// F = (m²/2 − (2 − m) Σ)/(m (1 − S)),  Σ = S − m/2
/// ```
#[must_use]
pub fn of_axis_ratio(kappa: f64) -> EllipticIntegrals {
    let m = 1.0 - 1.0 / (kappa * kappa);
    let (mut a, mut b, mut weight, mut sum) = (1.0, 1.0 / kappa, 1.0, 0.0);
    while a - b > 1e-16 * a {
        let c = 0.5 * (a - b);
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
        sum += weight * c * c;
        weight *= 2.0;
        if weight > 1e6 {
            break;
        }
    }
    let first = std::f64::consts::FRAC_PI_2 / a;
    let share = 1.0 - 0.5 * m - sum;
    let curvature_ratio = if m > 0.0 {
        (0.5 * m * m - (2.0 - m) * sum) / (m * share)
    } else {
        0.0
    };
    EllipticIntegrals {
        first,
        second: first * share,
        curvature_ratio,
    }
}
