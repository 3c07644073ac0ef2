//! Line contact of a roller and a race, cut into laminae.
//!
//! ISO/TS 16281 (2008), section 5: a roller between two races carries Q = 35 948 L^{8/9} δ^{10/9} (N, mm; steel), δ the
//! approach of both races together. One contact alone takes half of δ, so that with the length L of the roller and a
//! lamina of length l
//!
//! ```text
//! q = c l δ^{10/9},  c = 2^{10/9} · 35 948 N/mm^{19/9} · L^{−1/9} · E*/E*_steel
//! ```
//!
//! E*_steel is that of 206 GPa and 0.3. There is no exact Hertz law for the approach of a line contact: it depends on
//! the bodies' depth; this is Palmgren's fit, whose small dependence on L is kept.

/// E* of the steel that the law is stated for \[Pa\]: 206 GPa, 0.3.
const STEEL_CONTACT_MODULUS_PA: f64 = 206e9 / (2.0 * 0.91);

/// Contact of a roller and one race.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineContact {
    /// c in q = c δ^{10/9}, q the load per length \[N/m^{19/9}\].
    pub stiffness: f64,
    /// 1/ρ of the contact \[1/m\].
    pub curvature_per_m: f64,
    /// E* \[Pa\].
    pub contact_modulus_pa: f64,
}

impl LineContact {
    /// For a roller of the effective length L \[m\], the sum of the curvatures across it \[1/m\] and E* \[Pa\].
    #[must_use]
    pub fn new(length_m: f64, curvature_per_m: f64, contact_modulus_pa: f64) -> Self {
        // N/mm^(8/9 + 10/9) = N/mm² of L^{8/9} δ^{10/9}: 1e6 N/m².
        let per_both = 35_948e6 * length_m.powf(-1.0 / 9.0);
        Self {
            stiffness: per_both * 2.0_f64.powf(10.0 / 9.0) * contact_modulus_pa
                / STEEL_CONTACT_MODULUS_PA,
            curvature_per_m,
            contact_modulus_pa,
        }
    }

    /// Load per length \[N/m\] and its slope \[N/m²\] at an approach \[m\]; both zero when open.
    #[inline]
    #[must_use]
    pub fn line_load(&self, approach_m: f64) -> (f64, f64) {
        if approach_m <= 0.0 {
            return (0.0, 0.0);
        }
        let slope = self.stiffness * (approach_m.ln() / 9.0).exp();
        (slope * approach_m, 10.0 / 9.0 * slope)
    }

    /// Approach \[m\] at a load per length \[N/m\].
    #[must_use]
    pub fn approach_m(&self, line_load_n_per_m: f64) -> f64 {
        (line_load_n_per_m / self.stiffness).powf(0.9)
    }

    /// Energy per length \[J/m\] at a load per length and its approach: ∫ q dδ = (9/19) q δ.
    pub(crate) fn energy(line_load_n_per_m: f64, approach_m: f64) -> f64 {
        9.0 / 19.0 * line_load_n_per_m * approach_m.max(0.0)
    }

    /// Peak pressure of Hertz's line contact \[Pa\]: p₀ = √(q E*/(π ρ)).
    #[must_use]
    pub fn peak_pressure_pa(&self, line_load_n_per_m: f64) -> f64 {
        let square = line_load_n_per_m * self.contact_modulus_pa * self.curvature_per_m;
        (square / std::f64::consts::PI).sqrt()
    }

    /// Half width \[m\]: b = √(4 q ρ/(π E*)).
    #[must_use]
    pub fn half_width_m(&self, line_load_n_per_m: f64) -> f64 {
        let square = 4.0 * line_load_n_per_m / (self.contact_modulus_pa * self.curvature_per_m);
        (square / std::f64::consts::PI).sqrt()
    }
}
