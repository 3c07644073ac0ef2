//! A Hertzian line contact of one slice between two elastic bodies.

use super::local_law_error::{LocalLawError, require_positive};
use crate::hertz;
use std::f64::consts::PI;

/// Material and depth of one of the two bodies of a line contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactBody {
    /// Young's modulus \[Pa\].
    pub youngs_modulus_pa: f64,
    /// Poisson's ratio, 0 up to 0.5.
    pub poisson_ratio: f64,
    /// Depth below the contact to which the deflection is measured, along the normal \[m\].
    pub depth_m: f64,
}

impl ContactBody {
    /// Weber-Banaschek deflection `k q [ln(2h/a) − ν/(2(1−ν))]`, `k = 2(1−ν²)/(πE)` \[m\], under the line load `q`
    /// \[N/m\] spread as a Hertz pressure of half width `a` \[m\].
    pub fn weber_banaschek_m(&self, line_load_n_per_m: f64, half_width_m: f64) -> f64 {
        let nu = self.poisson_ratio;
        2.0 / PI
            * self.plane_strain_compliance()
            * line_load_n_per_m
            * ((2.0 * self.depth_m / half_width_m).ln() - nu / (2.0 * (1.0 - nu)))
    }

    /// `(1 − ν²)/E` \[1/Pa\].
    fn plane_strain_compliance(&self) -> f64 {
        (1.0 - self.poisson_ratio * self.poisson_ratio) / self.youngs_modulus_pa
    }
}

/// A Hertzian line contact of one slice.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineContact {
    /// Width of the slice along the contact line \[m\].
    pub width_m: f64,
    /// Relative radius of curvature, `1/ρ = 1/ρ₁ + 1/ρ₂` \[m\].
    pub relative_radius_m: f64,
    /// The two bodies.
    pub bodies: [ContactBody; 2],
}

impl LineContact {
    /// Hertz half width `a` \[m\] at the slice force `force_n` \[N\]: `a² = (4 q ρ/π) Σ (1 − ν²)/E`.
    pub fn half_width_m(&self, force_n: f64) -> f64 {
        self.half_width_factor() * force_n.max(0.0).sqrt()
    }

    /// α and β \[m/N\] of the law F (α − β ln F).
    pub(super) fn logarithm(&self) -> Result<(f64, f64), LocalLawError> {
        require_positive("slice width_m", self.width_m)?;
        require_positive("relative_radius_m", self.relative_radius_m)?;
        for body in &self.bodies {
            require_positive("youngs_modulus_pa", body.youngs_modulus_pa)?;
            require_positive("depth_m", body.depth_m)?;
            if !(0.0..=0.5).contains(&body.poisson_ratio) {
                return Err(LocalLawError::PoissonRatio {
                    found: body.poisson_ratio,
                });
            }
        }
        let factor = self.half_width_factor();
        let (mut alpha, mut beta) = (0.0, 0.0);
        for body in &self.bodies {
            let per_force = 2.0 * body.plane_strain_compliance() / (PI * self.width_m);
            let nu = body.poisson_ratio;
            alpha += per_force * ((2.0 * body.depth_m / factor).ln() - nu / (2.0 * (1.0 - nu)));
            beta += 0.5 * per_force;
        }
        Ok((alpha, beta))
    }

    /// Derivative of α \[m/N\] where the depth in one body grows by the share `depth_growth` of itself and the relative
    /// radius by `radius_growth`, both per unit of whatever moves the contact.
    pub fn alpha_rate(&self, body: usize, depth_growth: f64, radius_growth: f64) -> f64 {
        let per_force =
            |body: &ContactBody| 2.0 * body.plane_strain_compliance() / (PI * self.width_m);
        let both: f64 = self.bodies.iter().map(per_force).sum();
        per_force(&self.bodies[body]) * depth_growth - 0.5 * both * radius_growth
    }

    /// `c` of `a = c √F` \[m/√N\].
    pub(super) fn half_width_factor(&self) -> f64 {
        hertz::half_width_m(
            1.0 / self.width_m,
            self.relative_radius_m,
            self.plane_strain_compliance(),
        )
    }

    /// `1/E* = Σ (1 − ν²)/E` \[1/Pa\].
    pub(super) fn plane_strain_compliance(&self) -> f64 {
        self.bodies
            .iter()
            .map(ContactBody::plane_strain_compliance)
            .sum()
    }
}
