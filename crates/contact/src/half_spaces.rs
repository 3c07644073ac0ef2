//! Two half spaces pressed together along a line that is cut into slices: bodies that deflect at their surfaces only,
//! as Hertz has it.
//!
//! A slice of length l carries the line load q, with Hertz's pressure of half width a across the line and even along
//! it. A point load F on a half space deflects its surface by ½ k F/r (K. L. Johnson, Contact Mechanics, eq. 3.22b).
//! Taken at a distance ρ across the line, in the middle of slice i, for each body,
//!
//! ```text
//! δ_i = Σ_j ½ k q_j [asinh((d + ½) l/ρ) − asinh((d − ½) l/ρ)],     k = 2(1 − ν²)/(πE),  d = |i − j|
//! ```
//!
//! and with ln ρ = ln(a/2) − ½, its mean over Hertz's pressure, an endless line load deflects as it does there. ρ
//! changes with the load; the compliance has ρ₀ = `SMEAR` l, and the own local law the rest, δ = k q ln(ρ₀/ρ): right
//! where q changes little over ρ. Slices may be as short as 0.6 of the contact's width. How far that is from Hertz:
//! docs/theory/sliced_contact.md.

/// ρ₀ over the length of a slice: the local law's logarithm then grows with the load up to half widths of 0.9 slices.
const SMEAR: f64 = 0.53;

/// Slices that couple, at most.
const MOST_SLICES: usize = 256;

/// Materials of two half spaces, and how slices of one line feel each other.
#[derive(Debug, Clone, PartialEq)]
pub struct HalfSpaces {
    /// Young's modulus \[Pa\] and Poisson's ratio of gear 1 and gear 2.
    pub materials: [(f64, f64); 2],
    /// ½ Σ k \[m²/N\].
    half_k: f64,
    /// Of slices so far apart, per ½ k.
    couplings: Vec<f64>,
}

impl HalfSpaces {
    /// Of these materials: Young's modulus \[Pa\] and Poisson's ratio of gear 1 and gear 2.
    #[must_use]
    pub fn new(materials: [(f64, f64); 2]) -> Self {
        let half_k = materials.map(|(young_pa, poisson)| {
            (1.0 - poisson * poisson) / (std::f64::consts::PI * young_pa)
        });
        let coupling = |apart: usize| {
            let far = |place: f64| (place / SMEAR).asinh();
            far(apart as f64 + 0.5) - far(apart as f64 - 0.5)
        };
        Self {
            materials,
            half_k: half_k[0] + half_k[1],
            couplings: (0..MOST_SLICES).map(coupling).collect(),
        }
    }

    /// Deflection of both bodies at a slice per newton on another one of the line, or on itself \[m/N\]; `apart`: their
    /// numbers; `lengths_m`: of both.
    #[inline]
    #[must_use]
    pub fn between(&self, apart: usize, lengths_m: [f64; 2]) -> f64 {
        let far = self.couplings.get(apart).copied();
        let coupling = far.unwrap_or(1.0 / apart as f64);
        self.half_k * coupling / (lengths_m[0] * lengths_m[1]).sqrt()
    }

    /// Depth \[m\] of the logarithm of a gear's local law on a slice of this length: in proportion to the length.
    #[must_use]
    pub fn depth_m(&self, gear: usize, length_m: f64) -> f64 {
        let nu = self.materials[gear].1;
        length_m * SMEAR * (0.5 + nu / (2.0 * (1.0 - nu))).exp()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An endless even line load on slices deflects as an endless line load does: what falls short of ln(2R/ρ₀) is R's
    /// alone.
    #[test]
    fn an_even_load_deflects_as_a_line_load() {
        let bodies = HalfSpaces::new([(206e9, 0.3); 2]);
        let reach = 100;
        let sum: f64 = (1..=reach).map(|d| 2.0 * bodies.between(d, [1.0; 2])).sum();
        let found = (bodies.between(0, [1.0; 2]) + sum) / bodies.half_k;
        let expected = 2.0 * ((2.0 * reach as f64 + 1.0) / SMEAR).ln();
        assert!((found / expected - 1.0).abs() < 1e-5, "{found} {expected}");
    }

    /// So does the local law complete it: together k q [ln(2R/a) + ½] with ln ρ = ln(a/2) − ½.
    #[test]
    fn the_depth_is_that_of_the_smeared_line() {
        let nu = 0.3;
        let bodies = HalfSpaces::new([(206e9, nu); 2]);
        let length = 1.5e-3;
        let a = 2e-4;
        let law = (2.0 * bodies.depth_m(0, length) / a).ln() - nu / (2.0 * (1.0 - nu));
        let rho = 0.5 * a * (-0.5f64).exp();
        assert!((law - (SMEAR * length / rho).ln()).abs() < 1e-12);
    }
}
