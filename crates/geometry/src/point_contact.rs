//! Hertz contact of two bodies in a point, as a ball in a groove or two bevel flanks: half axes, approach and pressure
//! by the exact elliptic integrals.
//!
//! With the curvatures ρ of both bodies in the two principal planes, κ = a/b and m = 1 − 1/κ²,
//!
//! ```text
//! F(ρ) = |ρ_1 − ρ_2|/Σρ = ((κ² + 1) E − 2K)/((κ² − 1) E)
//! a³ = 3 κ² E Q/(π Σρ E*),  b = a/κ,  p₀ = 3Q/(2π a b)
//! Q = k δ^1.5,  k = 2π κ E* √(E/(4.5 Σρ K³))
//! ```
//!
//! with 1/E* = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂. Source: K. L. Johnson, *Contact Mechanics*, Cambridge 1985, section 4.2(b);
//! derivation and comparison with curve fits in docs/theory/rolling_bearings.md.

use std::f64::consts::PI;

use crate::elliptic::of_axis_ratio;

/// Contact of two bodies, as a ball and a race.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointContact {
    /// κ = a/b, long over short half axis of the contact ellipse.
    pub axis_ratio: f64,
    /// Σρ \[1/m\].
    pub curvature_sum_per_m: f64,
    /// k in Q = k δ^1.5 \[N/m^1.5\].
    pub stiffness_n_per_m15: f64,
    /// E(m), for the half axes and the spin moment.
    pub second_integral: f64,
    /// E* \[Pa\].
    pub contact_modulus_pa: f64,
}

/// Half axes and peak pressure under a load.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ContactEllipse {
    /// a, across the direction of rolling \[m\].
    pub half_length_m: f64,
    /// b, along the direction of rolling \[m\].
    pub half_width_m: f64,
    /// p₀ \[Pa\].
    pub peak_pressure_pa: f64,
}

impl PointContact {
    /// From the sum of the four curvatures and the difference of the two planes' sums \[1/m\], and E* \[Pa\].
    ///
    /// The long axis lies in the plane with the smaller curvature.
    #[must_use]
    pub fn new(curvature_sum_per_m: f64, difference_per_m: f64, contact_modulus_pa: f64) -> Self {
        let axis_ratio = axis_ratio((difference_per_m / curvature_sum_per_m).abs());
        let integrals = of_axis_ratio(axis_ratio);
        let (first, second) = (integrals.first, integrals.second);
        let stiffness = PI
            * axis_ratio
            * 2.0
            * contact_modulus_pa
            * (second / (4.5 * curvature_sum_per_m * first.powi(3))).sqrt();
        Self {
            axis_ratio,
            curvature_sum_per_m,
            stiffness_n_per_m15: stiffness,
            second_integral: second,
            contact_modulus_pa,
        }
    }

    /// Normal load Q \[N\] and its slope \[N/m\] at an approach δ \[m\]; both zero when open.
    #[inline]
    #[must_use]
    pub fn load(&self, approach_m: f64) -> (f64, f64) {
        if approach_m <= 0.0 {
            return (0.0, 0.0);
        }
        let slope = self.stiffness_n_per_m15 * approach_m.sqrt();
        (slope * approach_m, 1.5 * slope)
    }

    /// The ellipse under a load Q \[N\].
    #[must_use]
    pub fn ellipse(&self, load_n: f64) -> ContactEllipse {
        if load_n <= 0.0 {
            return ContactEllipse::default();
        }
        let cube = 3.0 * self.axis_ratio.powi(2) * self.second_integral * load_n
            / (PI * self.curvature_sum_per_m * self.contact_modulus_pa);
        let half_length_m = cube.cbrt();
        let half_width_m = half_length_m / self.axis_ratio;
        ContactEllipse {
            half_length_m,
            half_width_m,
            peak_pressure_pa: 1.5 * load_n / (PI * half_length_m * half_width_m),
        }
    }
}

/// κ of a ratio F(ρ) in 0 … 1: Newton's method in x = ln κ, kept between bounds by halving, with
///
/// ```text
/// dF/dm = (3 (K − E) − F (3E − K))/(2 m E),   dm/dx = 2 (1 − m)
/// ```
fn axis_ratio(curvature_ratio: f64) -> f64 {
    let (mut low, mut high) = (0.0_f64, 16.0_f64);
    // κ of long ellipses goes with the ratio of the curvatures to the power 2/π.
    let ratio = (1.0 + curvature_ratio) / (1.0 - curvature_ratio);
    let mut x = (std::f64::consts::FRAC_2_PI * ratio.ln()).clamp(1e-3, 15.0);
    for _ in 0..100 {
        let integrals = of_axis_ratio(x.exp());
        let (first, second) = (integrals.first, integrals.second);
        let found = integrals.curvature_ratio;
        if found < curvature_ratio {
            low = x;
        } else {
            high = x;
        }
        let m = -(-2.0 * x).exp_m1();
        let by_m = (3.0 * (first - second) - found * (3.0 * second - first)) / (2.0 * m * second);
        let newton = x - (found - curvature_ratio) / (2.0 * (1.0 - m) * by_m);
        let next = if newton > low && newton < high {
            newton
        } else {
            0.5 * (low + high)
        };
        let step = (next - x).abs();
        x = next;
        if step <= 4.0 * f64::EPSILON * x.max(1.0) {
            break;
        }
    }
    x.exp()
}

/// E* of two materials \[Pa\]: 1/E* = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂.
#[must_use]
pub fn contact_modulus_pa(first: (f64, f64), second: (f64, f64)) -> f64 {
    let compliance = |(young_pa, poisson): (f64, f64)| (1.0 - poisson * poisson) / young_pa;
    1.0 / (compliance(first) + compliance(second))
}
