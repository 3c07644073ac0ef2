//! Two half spaces pressed together along a line that is cut into slices: bodies that give way at their surfaces only,
//! as Hertz has it.
//!
//! A slice of length l carries the line load q, with Hertz's pressure of half width a across the line and even along it.
//! A point load F on a half space deflects its surface by ½ k F/r (K. L. Johnson, Contact Mechanics, eq. 3.22b), so that
//! in the middle of slice i, for each body,
//!
//! ```text
//! δ_i = k q_i [ln(2l/a) + ½] + Σ_{j≠i} ½ k q_j ln[(2d + 1)/(2d − 1)],     k = 2(1 − ν²)/(πE),  d = |i − j|
//! ```
//!
//! ⟨ln ρ⟩ = ln(a/2) − ½ over Hertz's pressure gives the first term. The compliance holds ½ k [`OWN`] of it, so that it is
//! positive definite, the logarithm of the local law the rest. The load falls within a slice and other slices are not as
//! narrow as a line: errors of the order of the square of the contact's width over its length, and of the slice's length
//! over the contact's.

/// ρ₀ over the length of a slice.
const SMEAR: f64 = 0.45;

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

    /// An endless even line load deflects each slice alike, and alternating loads see a compliance above zero.
    #[test]
    fn an_alternating_load_meets_resistance() {
        let half_spaces = HalfSpaces::new([(206e9, 0.3); 2]);
        let own = half_spaces.between(0, [1.0; 2]);
        let sum = |n: usize| {
            let terms = (1..n).map(|d| {
                let sign = if d % 2 == 0 { 2.0 } else { -2.0 };
                sign * half_spaces.between(d, [1.0; 2])
            });
            terms.sum::<f64>()
        };
        let alternating = own + 0.5 * (sum(200) + sum(201));
        assert!(
            alternating > 0.05 * own && alternating < 0.1 * own,
            "{}",
            alternating / own
        );
    }
}
