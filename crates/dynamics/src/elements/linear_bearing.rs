//! Linear bearing: radial, axial and tilting stiffness and damping; spins freely about its axis.
//!
//! A sits in the housing, B on the shaft, z is the axis. With c the z axis of B seen in A, the tilt about x and y is
//! (−c_y, c_x),
//!
//! ```text
//! f = −(k_r u_x + c_r u̇_x, k_r u_y + c_r u̇_y, k_a u_z + c_a u̇_z)
//! μ = −k_t c_z (−c_y, c_x, 0) − c_t (ω − (ω·c) c)
//! ```
//!
//! (ω − (ω·c) c = c × ċ is the rate of the tilt: a shaft that turns about its own tilted axis is not braked) (an axial
//! support that carries one way has k_a = 0 on the other side of u_z = 0; its damping acts both ways), which is the
//! gradient of ½ k_r(u_x² + u_y²) + ½ k_a u_z² + ½ k_t(c_x² + c_y²) and the same for every angle of B.

use nalgebra::{SMatrix, Vector3};

use super::marker_element::{Law, LawTangent, MarkerElement, PairLoad};
use super::{Power, not_negative};
use crate::error::DynamicsError;
use crate::relative_motion::{MarkerPair, RelativeMotion};
use crate::rotation::skew;

/// Which displacements of the shaft along z the bearing resists.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum AxialSupport {
    /// Both ways.
    #[default]
    Both,
    /// Towards +z only: it carries forces on the shaft along +z.
    Positive,
    /// Towards −z only.
    Negative,
}

/// Parameters of a linear bearing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LinearBearing {
    /// k_r
    pub radial_stiffness_n_per_m: f64,
    /// k_a
    pub axial_stiffness_n_per_m: f64,
    /// k_t
    pub tilt_stiffness_nm_per_rad: f64,
    /// c_r
    pub radial_damping_n_s_per_m: f64,
    /// c_a
    pub axial_damping_n_s_per_m: f64,
    /// c_t
    pub tilt_damping_nm_s_per_rad: f64,
    /// Where k_a acts.
    pub axial_support: AxialSupport,
}

impl LinearBearing {
    /// The bearing between housing (A) and shaft (B).
    ///
    /// # Errors
    /// [`DynamicsError::Value`] if a parameter is negative or not finite.
    pub fn between(
        self,
        name: &str,
        pair: MarkerPair,
    ) -> Result<MarkerElement<Self>, DynamicsError> {
        for (what, value) in [
            ("radial stiffness in N/m", self.radial_stiffness_n_per_m),
            ("axial stiffness in N/m", self.axial_stiffness_n_per_m),
            ("tilt stiffness in N m/rad", self.tilt_stiffness_nm_per_rad),
            ("radial damping in N s/m", self.radial_damping_n_s_per_m),
            ("axial damping in N s/m", self.axial_damping_n_s_per_m),
            ("tilt damping in N m s/rad", self.tilt_damping_nm_s_per_rad),
        ] {
            not_negative(name, what, value)?;
        }
        Ok(MarkerElement::new(name, pair, self))
    }

    /// Stiffness along the axes, at a displacement.
    fn stiffness(&self, u_z_m: f64) -> Vector3<f64> {
        let carries = match self.axial_support {
            AxialSupport::Both => true,
            AxialSupport::Positive => u_z_m > 0.0,
            AxialSupport::Negative => u_z_m < 0.0,
        };
        Vector3::new(
            self.radial_stiffness_n_per_m,
            self.radial_stiffness_n_per_m,
            if carries {
                self.axial_stiffness_n_per_m
            } else {
                0.0
            },
        )
    }

    fn damping(&self) -> Vector3<f64> {
        Vector3::new(
            self.radial_damping_n_s_per_m,
            self.radial_damping_n_s_per_m,
            self.axial_damping_n_s_per_m,
        )
    }
}

impl Law for LinearBearing {
    fn load(&self, motion: &RelativeMotion) -> (PairLoad, Power) {
        let (u, v) = (motion.displacement_m, motion.velocity_m_per_s);
        let c = motion.rotation.column(2);
        let w = motion.tilt_rate_rad_per_s();
        let tilt = Vector3::new(-c[1], c[0], 0.0);
        let elastic = self.stiffness(u[2]).component_mul(&u);
        let viscous = self.damping().component_mul(&v);
        let (k, d) = (
            self.tilt_stiffness_nm_per_rad,
            self.tilt_damping_nm_s_per_rad,
        );
        let mut load = PairLoad::zeros();
        load.fixed_rows_mut::<3>(0).copy_from(&-(elastic + viscous));
        load.fixed_rows_mut::<3>(3)
            .copy_from(&(-(k * c[2] * tilt + d * w)));
        let power = Power {
            stored_j: 0.5 * u.dot(&elastic) + 0.5 * k * tilt.norm_squared(),
            dissipated_w: v.dot(&viscous) + d * w.norm_squared(),
            supplied_w: 0.0,
        };
        (load, power)
    }

    /// z along the shaft; x and y do not turn with it.
    fn axes(&self) -> &'static str {
        "shaft_"
    }

    fn tangent(&self, motion: &RelativeMotion) -> LawTangent {
        let c: Vector3<f64> = motion.rotation.column(2).into();
        // dc = φ × c
        let turned = -skew(&c);
        let k = self.tilt_stiffness_nm_per_rad;
        let mut tangent = LawTangent {
            by_position: SMatrix::zeros(),
            by_velocity: SMatrix::zeros(),
        };
        let stiffness = self.stiffness(motion.displacement_m[2]);
        for axis in 0..3 {
            tangent.by_position[(axis, axis)] = -stiffness[axis];
            tangent.by_velocity[(axis, axis)] = -self.damping()[axis];
            tangent.by_position[(3, 3 + axis)] =
                k * (turned[(2, axis)] * c[1] + c[2] * turned[(1, axis)]);
            tangent.by_position[(4, 3 + axis)] =
                -k * (turned[(2, axis)] * c[0] + c[2] * turned[(0, axis)]);
        }
        let viscous = self.tilt_damping_nm_s_per_rad * motion.tilt_rate_by_velocity();
        let turned = self.tilt_damping_nm_s_per_rad * motion.tilt_rate_by_rotation();
        let mut corner = tangent.by_velocity.fixed_view_mut::<3, 3>(3, 3);
        corner -= viscous;
        let mut corner = tangent.by_position.fixed_view_mut::<3, 3>(3, 3);
        corner -= turned;
        tangent
    }
}
