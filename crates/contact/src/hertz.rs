//! Hertz contact of two cylinders along a line: half width and peak pressure.
//!
//! Source: K. L. Johnson, *Contact Mechanics*, Cambridge 1985, section 4.2(c); seed 004 eq. 12.

use std::f64::consts::PI;

/// Half width a \[m\] of the contact: a² = (4 q ρ/π) (1/E*), with the line load q \[N/m\], the relative radius ρ \[m\]
/// (1/ρ = 1/ρ₁ + 1/ρ₂) and 1/E* = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂ \[1/Pa\].
pub fn half_width_m(
    line_load_n_per_m: f64,
    relative_radius_m: f64,
    contact_compliance_per_pa: f64,
) -> f64 {
    (4.0 * relative_radius_m * contact_compliance_per_pa * line_load_n_per_m / PI).sqrt()
}

/// Peak pressure p₀ = 2q/(πa) \[Pa\] of a line load q \[N/m\] over the half width a \[m\]; zero where the half width
/// is.
pub fn peak_pressure_pa(line_load_n_per_m: f64, half_width_m: f64) -> f64 {
    if half_width_m > 0.0 {
        2.0 * line_load_n_per_m / (PI * half_width_m)
    } else {
        0.0
    }
}
