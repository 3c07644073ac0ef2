//! Bushing: 6×6 stiffness and damping between two markers, for small relative rotations (rotation vector).
//!
//! ```text
//! e = (u − u₀, θ),  Q = exp(θ)          (f, μ) = −(k_u, T⁻¹(θ) k_θ) − C (u̇, ω),   (k_u, k_θ) = K e
//! ```
//!
//! T⁻¹(θ) makes the moment the gradient of ½ eᵀK e. Rotations must stay below half a turn; a bushing that is stiff or
//! loaded against large rotations has no physical meaning long before.

use nalgebra::{Matrix6, SMatrix, Vector3, Vector6};

use super::Power;
use super::marker_element::{Law, LawTangent, MarkerElement, PairLoad};
use crate::error::DynamicsError;
use crate::relative_motion::{MarkerPair, RelativeMotion};
use crate::rotation;

/// Parameters of a bushing; A axes, order x, y, z, rotations about x, y, z.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bushing {
    /// K, symmetric \[N/m, N/rad, N·m/rad\].
    pub stiffness: Matrix6<f64>,
    /// C, symmetric \[N·s/m, N·s/rad, N·m·s/rad\].
    pub damping: Matrix6<f64>,
    /// u₀: where B stands without force \[m\].
    pub free_displacement_m: Vector3<f64>,
}

impl Bushing {
    /// A bushing without coupling.
    #[must_use]
    pub fn diagonal(stiffness: [f64; 6], damping: [f64; 6]) -> Self {
        Self {
            stiffness: Matrix6::from_diagonal(&Vector6::from(stiffness)),
            damping: Matrix6::from_diagonal(&Vector6::from(damping)),
            free_displacement_m: Vector3::zeros(),
        }
    }

    /// The bushing between two markers.
    ///
    /// # Errors
    /// [`DynamicsError::Value`] if K or C is not symmetric, has a negative eigenvalue or is not finite.
    pub fn between(
        self,
        name: &str,
        pair: MarkerPair,
    ) -> Result<MarkerElement<Self>, DynamicsError> {
        for (what, lowest, matrix) in [
            (
                "asymmetry of the stiffness matrix",
                "lowest eigenvalue of the stiffness matrix",
                self.stiffness,
            ),
            (
                "asymmetry of the damping matrix",
                "lowest eigenvalue of the damping matrix",
                self.damping,
            ),
        ] {
            let owner = || format!("force element `{name}`");
            let asymmetry = (matrix - matrix.transpose()).norm();
            let scale = matrix.norm();
            let allowed = "zero: give a symmetric, finite matrix";
            let is_symmetric = asymmetry <= 1e-9 * scale;
            DynamicsError::require(owner(), (what, asymmetry), is_symmetric, allowed)?;
            // Scaled to a unit diagonal, because the units differ.
            let root = matrix
                .diagonal()
                .map(|d| if d > 0.0 { 1.0 / d.sqrt() } else { 1.0 });
            let scaled = Matrix6::from_diagonal(&root) * matrix * Matrix6::from_diagonal(&root);
            let least = scaled.symmetric_eigenvalues().min();
            let allowed = "zero or positive (scaled to a unit diagonal)";
            DynamicsError::require(owner(), (lowest, least), least >= -1e-9, allowed)?;
        }
        Ok(MarkerElement::new(name, pair, self))
    }

    /// e of the module page, and the vector θ.
    fn stretch(&self, motion: &RelativeMotion) -> (Vector6<f64>, Vector3<f64>) {
        let theta = rotation::log(&motion.quaternion());
        let u = motion.displacement_m - self.free_displacement_m;
        (
            Vector6::new(u[0], u[1], u[2], theta[0], theta[1], theta[2]),
            theta,
        )
    }
}

impl Law for Bushing {
    fn load(&self, motion: &RelativeMotion) -> (PairLoad, Power) {
        let (stretch, theta) = self.stretch(motion);
        let mut elastic = self.stiffness * stretch;
        let stored_j = 0.5 * stretch.dot(&elastic);
        let moment = rotation::tangent_inverse(&theta) * elastic.fixed_rows::<3>(3);
        elastic.fixed_rows_mut::<3>(3).copy_from(&moment);
        let rates = motion.rates();
        let viscous = self.damping * rates;
        let power = Power {
            stored_j,
            dissipated_w: rates.dot(&viscous),
            supplied_w: 0.0,
        };
        (-(elastic + viscous), power)
    }

    fn tangent(&self, motion: &RelativeMotion) -> LawTangent {
        let (stretch, theta) = self.stretch(motion);
        let elastic = self.stiffness * stretch;
        let moment = Vector3::new(elastic[3], elastic[4], elastic[5]);
        // φ is an increment in A axes: θ changes by T⁻¹(−θ) φ = T⁻ᵀ(θ) φ.
        let inverse = rotation::tangent_inverse(&theta);
        let by_phi = inverse.transpose();
        let mut strain = SMatrix::<f64, 6, 6>::identity();
        strain.fixed_view_mut::<3, 3>(3, 3).copy_from(&by_phi);
        let mut by_position = -strain.tr_mul(&(self.stiffness * strain));
        let curved = rotation::tangent_inverse_slope(&theta, &moment) * by_phi;
        let mut block = by_position.fixed_view_mut::<3, 3>(3, 3);
        block -= curved;
        LawTangent {
            by_position,
            by_velocity: -self.damping,
        }
    }
}
