//! Linear isotropic elasticity: moduli, stress from strain, von Mises stress.
//!
//! Strain and stress vectors are ordered xx, yy, zz, xy, yz, xz; the shear strains are engineering strains
//! (γ = 2 ε). Tension is positive.

use crate::error::FeError;

/// An isotropic linear elastic material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Material {
    young_pa: f64,
    poisson: f64,
}

/// Lamé's parameters: σ = λ tr(ε) I + 2 μ ε.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LameParameters {
    /// First parameter λ = E ν / ((1 + ν)(1 − 2 ν)) (Pa).
    pub lambda_pa: f64,
    /// Shear modulus μ = E / (2 (1 + ν)) (Pa).
    pub mu_pa: f64,
}

impl Material {
    /// A material from Young's modulus (Pa) and Poisson's ratio.
    ///
    /// # Errors
    /// [`FeError::YoungOutOfRange`] unless 0 < E < ∞; [`FeError::PoissonOutOfRange`] unless −1 < ν < 0.5, the
    /// range in which the elasticity matrix is positive definite.
    pub fn new(young_pa: f64, poisson: f64) -> Result<Self, FeError> {
        if !(young_pa > 0.0 && young_pa.is_finite()) {
            return Err(FeError::YoungOutOfRange { young_pa });
        }
        if !(poisson > -1.0 && poisson < 0.5) {
            return Err(FeError::PoissonOutOfRange { poisson });
        }
        Ok(Self { young_pa, poisson })
    }

    /// Young's modulus E (Pa).
    pub fn young_pa(&self) -> f64 {
        self.young_pa
    }

    /// Poisson's ratio ν.
    pub fn poisson(&self) -> f64 {
        self.poisson
    }

    /// Lamé's parameters λ and μ.
    pub fn lame(&self) -> LameParameters {
        let (e, nu) = (self.young_pa, self.poisson);
        LameParameters {
            lambda_pa: e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)),
            mu_pa: e / (2.0 * (1.0 + nu)),
        }
    }

    /// Elasticity matrix D (6x6, Pa): stress = D strain with engineering shear.
    pub fn elasticity(&self) -> [[f64; 6]; 6] {
        let LameParameters { lambda_pa, mu_pa } = self.lame();
        let mut d = [[0.0; 6]; 6];
        for (i, row) in d.iter_mut().enumerate() {
            if i < 3 {
                row[..3].fill(lambda_pa);
                row[i] += 2.0 * mu_pa;
            } else {
                row[i] = mu_pa;
            }
        }
        d
    }

    /// Stress (Pa) from strain, both ordered xx, yy, zz, xy, yz, xz; engineering shear strain.
    pub fn stress(&self, strain: &[f64; 6]) -> [f64; 6] {
        let LameParameters { lambda_pa, mu_pa } = self.lame();
        let pressure_part = lambda_pa * (strain[0] + strain[1] + strain[2]);
        std::array::from_fn(|i| {
            if i < 3 {
                pressure_part + 2.0 * mu_pa * strain[i]
            } else {
                mu_pa * strain[i]
            }
        })
    }
}

/// Von Mises equivalent stress (Pa) of a stress vector xx, yy, zz, xy, yz, xz:
/// σ_v² = ½[(σx−σy)² + (σy−σz)² + (σz−σx)²] + 3 (τxy² + τyz² + τxz²).
pub fn von_mises(stress: &[f64; 6]) -> f64 {
    let [x, y, z, xy, yz, xz] = *stress;
    let normal = 0.5 * ((x - y).powi(2) + (y - z).powi(2) + (z - x).powi(2));
    (normal + 3.0 * (xy * xy + yz * yz + xz * xz)).sqrt()
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn uniaxial_stress_gives_young_and_poisson() {
        let steel = Material::new(210e9, 0.3).unwrap();
        let stress = steel.stress(&[1e-3, -0.3e-3, -0.3e-3, 0.0, 0.0, 0.0]);
        assert!((stress[0] - 210e6).abs() < 1e-6 * 210e6);
        assert!(stress[1].abs() < 1.0 && stress[2].abs() < 1.0);
        assert!((von_mises(&stress) - 210e6).abs() < 1e-6 * 210e6);
    }

    #[test]
    fn stress_agrees_with_the_elasticity_matrix() {
        let m = Material::new(70e9, 0.33).unwrap();
        let strain = [1e-3, 2e-3, -0.5e-3, 0.7e-3, -0.2e-3, 0.4e-3];
        let d = m.elasticity();
        for (row, stress) in d.iter().zip(m.stress(&strain)) {
            let product: f64 = row.iter().zip(strain).map(|(a, b)| a * b).sum();
            assert!((product - stress).abs() < 1e-6);
        }
    }

    #[test]
    fn pure_shear_is_sqrt_three() {
        let stress = [0.0, 0.0, 0.0, 0.0, 5e6, 0.0];
        assert!((von_mises(&stress) - 5e6 * 3.0_f64.sqrt()).abs() < 1e-3);
    }

    #[test]
    fn values_outside_the_range_are_refused() {
        assert!(matches!(
            Material::new(-1.0, 0.3),
            Err(FeError::YoungOutOfRange { .. })
        ));
        assert!(matches!(
            Material::new(f64::NAN, 0.3),
            Err(FeError::YoungOutOfRange { .. })
        ));
        assert!(matches!(
            Material::new(1.0, 0.5),
            Err(FeError::PoissonOutOfRange { .. })
        ));
        assert!(matches!(
            Material::new(1.0, f64::NAN),
            Err(FeError::PoissonOutOfRange { .. })
        ));
    }
}
