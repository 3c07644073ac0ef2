//! Area to which the K of a pair of teeth belongs: over it a penetration δ_ref alike everywhere gives the force K
//! δ_ref^e that the whole contact
//! gives at that approach.
//!
//! ```text
//! F = (K/A_ref) ∫ δ^e dA = K δ_ref^e    at the approach δ_ref = (F_nominal/K)^(1/e)
//! point:  δ = δ_ref − x²/2ρ₁ − y²/2ρ₂     A_ref = 2π √(ρ₁ρ₂) δ_ref/(e + 1)
//! line:   δ = δ_ref − x²/2ρ               A_ref = b √(2ρ δ_ref) ∫₋₁¹ (1 − s²)^e ds
//! ```
//!
//! Away from that approach F grows with δ^(e+1) (point) and δ^(e+½) (line), faster than the law: more nodes touch.
//! Ends of the flank are not counted.

/// Intervals of the integral over the line's width.
const INTERVALS: usize = 400;

/// A_ref \[m²\] of flanks that touch in a point, with both relative radii of curvature and δ_ref \[m\].
#[must_use]
pub fn point_contact_area_m2(radii_m: [f64; 2], approach_m: f64, exponent: f64) -> f64 {
    2.0 * std::f64::consts::PI * (radii_m[0] * radii_m[1]).sqrt() * approach_m / (exponent + 1.0)
}

/// A_ref \[m²\] of flanks that touch along a line of this length, with the relative radius of curvature across it and
/// δ_ref \[m\].
#[must_use]
pub fn line_contact_area_m2(length_m: f64, radius_m: f64, approach_m: f64, exponent: f64) -> f64 {
    // s = sin θ: the integrand is cos^(2e+1) θ, smooth at its ends.
    let step = std::f64::consts::PI / INTERVALS as f64;
    let cosines = (0..INTERVALS).map(|k| {
        let angle = -std::f64::consts::FRAC_PI_2 + (k as f64 + 0.5) * step;
        angle.cos().powf(2.0 * exponent + 1.0)
    });
    length_m * (2.0 * radius_m * approach_m).sqrt() * cosines.sum::<f64>() * step
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ∫(1 − s²)^1.5 ds = 3π/8; of e = 1 it is 4/3.
    #[test]
    fn the_width_of_a_line_is_that_of_the_beta_function() {
        for (exponent, integral) in [(1.5, 3.0 * std::f64::consts::PI / 8.0), (1.0, 4.0 / 3.0)] {
            let area = line_contact_area_m2(0.02, 0.01, 2e-5, exponent);
            let expected = 0.02 * (2.0_f64 * 0.01 * 2e-5).sqrt() * integral;
            assert!(
                (area / expected - 1.0).abs() < 1e-6,
                "{area:e}, {expected:e}"
            );
        }
    }
}
