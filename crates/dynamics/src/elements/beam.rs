//! Timoshenko beam between two markers, along z of both, as a bushing that turns with its first end.
//!
//! End B is seen from the frame of end A, so the element follows any rigid motion and spins freely; bending, shear,
//! torsion and stretch are small. Relative to A the beam is a cantilever, whose 6×6 stiffness at the tip is exact:
//!
//! ```text
//! [w ]   [L³/3EI + L/κGA   L²/2EI] [P]
//! [θ ] = [L²/2EI           L/EI  ] [M]       bending in x with rotation about y; in y with rotation about x, signs of θ, M turned
//! stretch EA/L,   torsion G I_t/L
//! ```
//!
//! The forces at A are in balance with those at B in the deformed position, so the 12×12 stiffness has the six rigid
//! motions as its null space. Mass is lumped in the bodies at the ends. Source: J. S. Przemieniecki, *Theory of Matrix
//! Structural Analysis*, 1968, section 5.6.

use nalgebra::{Matrix2, Matrix6, Vector3};

use super::bushing::Bushing;
use super::marker_element::MarkerElement;
use super::not_negative;
use crate::error::DynamicsError;
use crate::relative_motion::MarkerPair;

/// Section and material of a beam of constant section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BeamSection {
    /// E \[Pa\].
    pub youngs_modulus_pa: f64,
    /// G \[Pa\].
    pub shear_modulus_pa: f64,
    /// A \[m²\].
    pub area_m2: f64,
    /// ∫y² dA: bending in the y-z plane, about x \[m⁴\].
    pub second_moment_x_m4: f64,
    /// ∫x² dA: bending in the x-z plane, about y \[m⁴\].
    pub second_moment_y_m4: f64,
    /// I_t \[m⁴\].
    pub torsion_constant_m4: f64,
    /// κ: share of the area that carries shear; infinity leaves shear out (Euler-Bernoulli).
    pub shear_factor: f64,
    /// Damping matrix over stiffness matrix \[s\].
    pub damping_s: f64,
}

impl BeamSection {
    /// A round tube or bar (inner radius 0). κ after Cowper (J. Appl. Mech. 33, 1966): with m = r_i/r_o,
    /// κ = 6(1 + ν)(1 + m²)²/((7 + 6ν)(1 + m²)² + (20 + 12ν) m²).
    #[must_use]
    pub fn round(
        outer_radius_m: f64,
        inner_radius_m: f64,
        youngs_modulus_pa: f64,
        poisson_ratio: f64,
    ) -> Self {
        let (o, i) = (outer_radius_m, inner_radius_m);
        let second_moment = std::f64::consts::PI / 4.0 * (o.powi(4) - i.powi(4));
        let ratio = (i / o).powi(2);
        let nu = poisson_ratio;
        let sum = (1.0 + ratio).powi(2);
        Self {
            youngs_modulus_pa,
            shear_modulus_pa: youngs_modulus_pa / (2.0 * (1.0 + nu)),
            area_m2: std::f64::consts::PI * (o * o - i * i),
            second_moment_x_m4: second_moment,
            second_moment_y_m4: second_moment,
            torsion_constant_m4: 2.0 * second_moment,
            shear_factor: 6.0 * (1.0 + nu) * sum
                / ((7.0 + 6.0 * nu) * sum + (20.0 + 12.0 * nu) * ratio),
            damping_s: 0.0,
        }
    }

    /// The beam of a length between two markers; without load B lies at (0, 0, length) of A with parallel axes.
    ///
    /// # Errors
    /// [`DynamicsError::Value`] if a parameter is not positive.
    pub fn between(
        &self,
        name: &str,
        pair: MarkerPair,
        length_m: f64,
    ) -> Result<MarkerElement<Bushing>, DynamicsError> {
        for (what, found) in [
            ("Young's modulus in Pa", self.youngs_modulus_pa),
            ("shear modulus in Pa", self.shear_modulus_pa),
            ("area in m²", self.area_m2),
            ("second moment about x in m⁴", self.second_moment_x_m4),
            ("second moment about y in m⁴", self.second_moment_y_m4),
            ("torsion constant in m⁴", self.torsion_constant_m4),
            ("length in m", length_m),
            ("shear factor", self.shear_factor.min(1.0)),
        ] {
            DynamicsError::positive(format!("beam `{name}`"), what, found)?;
        }
        not_negative(name, "damping over stiffness in s", self.damping_s)?;
        let stiffness = self.tip_stiffness(length_m);
        Bushing {
            stiffness,
            damping: self.damping_s * stiffness,
            free_displacement_m: Vector3::new(0.0, 0.0, length_m),
        }
        .between(name, pair)
    }

    /// Stiffness at the tip of the cantilever of this section, order as in [`Bushing`].
    #[must_use]
    pub fn tip_stiffness(&self, length_m: f64) -> Matrix6<f64> {
        let l = length_m;
        let shear = l / (self.shear_factor * self.shear_modulus_pa * self.area_m2);
        let mut stiffness = Matrix6::zeros();
        // Transverse direction, the rotation that goes with it, and its sign.
        for (w, theta, second_moment, sign) in [
            (0, 4, self.second_moment_y_m4, 1.0),
            (1, 3, self.second_moment_x_m4, -1.0),
        ] {
            let ei = self.youngs_modulus_pa * second_moment;
            // Determinant of the compliance, positive: L⁴/12(EI)² + L/EI · L/κGA.
            let determinant = l.powi(4) / (12.0 * ei * ei) + l / ei * shear;
            let inverse = Matrix2::new(
                l / ei,
                -sign * l * l / (2.0 * ei),
                -sign * l * l / (2.0 * ei),
                l.powi(3) / (3.0 * ei) + shear,
            ) / determinant;
            stiffness[(w, w)] = inverse[(0, 0)];
            stiffness[(w, theta)] = inverse[(0, 1)];
            stiffness[(theta, w)] = inverse[(1, 0)];
            stiffness[(theta, theta)] = inverse[(1, 1)];
        }
        stiffness[(2, 2)] = self.youngs_modulus_pa * self.area_m2 / l;
        stiffness[(5, 5)] = self.shear_modulus_pa * self.torsion_constant_m4 / l;
        stiffness
    }
}
