//! A body: rigid, or with modal coordinates on top of its rigid motion.
//!
//! The body frame sits at the *reference point*, which need not be the centre of mass. A modal body is that of Craig
//! and Bampton with the reference point held: its modes vanish there, so joints and bearings act on the rigid frame and
//! only elements that know the mode shapes push on the modal coordinates.

use nalgebra::{DMatrix, Matrix3, UnitQuaternion, Vector3};

use crate::error::DynamicsError;

/// A body by its number in the system; [`GROUND`] is the world.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct BodyId(pub(crate) usize);

/// The world frame: does not move, has no degrees of freedom.
pub const GROUND: BodyId = BodyId(usize::MAX);

/// Mass properties, pose and speed at the start.
#[derive(Debug, Clone, PartialEq)]
pub struct Body {
    /// Name, used in every message.
    pub name: String,
    /// Mass \[kg\].
    pub mass_kg: f64,
    /// Centre of mass from the reference point, body axes \[m\].
    pub center_of_mass_m: Vector3<f64>,
    /// Inertia tensor about the **centre of mass**, body axes \[kg·m²\]; off-diagonal entries are −∫xy dm.
    pub inertia_kg_m2: Matrix3<f64>,
    /// Reference point in the world \[m\].
    pub position_m: Vector3<f64>,
    /// World from body axes.
    pub orientation: UnitQuaternion<f64>,
    /// Velocity of the reference point, world axes \[m/s\].
    pub velocity_m_per_s: Vector3<f64>,
    /// Angular velocity, **body** axes \[rad/s\].
    pub angular_velocity_rad_per_s: Vector3<f64>,
    /// Vibration modes, if the body has any.
    pub modes: Option<Modes>,
}

/// Vibration modes of a body with its reference point held, scaled to unit modal mass (ΦᵀMΦ = I).
#[derive(Debug, Clone, PartialEq)]
pub struct Modes {
    /// Angular frequencies ω \[rad/s\].
    pub angular_frequency_rad_per_s: Vec<f64>,
    /// Damping ratios ζ; the modal damping is 2ζω.
    pub damping_ratio: Vec<f64>,
    /// L = ΦᵀM R, shape modes × 6: coupling to the acceleration of the reference point along the body axes \[√kg\] and
    /// to the angular acceleration about them \[√kg·m\].
    pub coupling: DMatrix<f64>,
}

impl Body {
    /// A rigid body at the world's origin, at rest, its reference point in the centre of mass.
    #[must_use]
    pub fn rigid(name: &str, mass_kg: f64, principal_inertia_kg_m2: [f64; 3]) -> Self {
        Self {
            name: name.to_owned(),
            mass_kg,
            center_of_mass_m: Vector3::zeros(),
            inertia_kg_m2: Matrix3::from_diagonal(&Vector3::from(principal_inertia_kg_m2)),
            position_m: Vector3::zeros(),
            orientation: UnitQuaternion::identity(),
            velocity_m_per_s: Vector3::zeros(),
            angular_velocity_rad_per_s: Vector3::zeros(),
            modes: None,
        }
    }

    /// Number of modes.
    #[must_use]
    pub fn mode_count(&self) -> usize {
        self.modes
            .as_ref()
            .map_or(0, |modes| modes.angular_frequency_rad_per_s.len())
    }

    /// Inertia tensor about the reference point: J + m(cᵀc I − c cᵀ).
    #[must_use]
    pub fn inertia_about_reference_kg_m2(&self) -> Matrix3<f64> {
        let c = self.center_of_mass_m;
        self.inertia_kg_m2
            + self.mass_kg * (c.norm_squared() * Matrix3::identity() - c * c.transpose())
    }

    /// Checks everything that the equations of motion rely on.
    ///
    /// # Errors
    /// [`DynamicsError::Name`], [`DynamicsError::Value`], [`DynamicsError::Inertia`], [`DynamicsError::Shape`] or
    /// [`DynamicsError::ModalCoupling`].
    pub fn validate(&self) -> Result<(), DynamicsError> {
        if self.name.is_empty() {
            return Err(DynamicsError::Name {
                name: String::new(),
            });
        }
        let owner = || format!("body `{}`", self.name);
        DynamicsError::positive(owner(), "mass in kg", self.mass_kg)?;
        for (what, vector) in [
            ("centre of mass in m", self.center_of_mass_m),
            ("position in m", self.position_m),
            ("velocity in m/s", self.velocity_m_per_s),
            ("angular velocity in rad/s", self.angular_velocity_rad_per_s),
            ("orientation", self.orientation.imag()),
        ] {
            for found in vector.iter() {
                DynamicsError::require(owner(), (what, *found), found.is_finite(), "finite")?;
            }
        }
        self.validate_inertia()?;
        self.validate_modes()
    }

    fn validate_inertia(&self) -> Result<(), DynamicsError> {
        let j = self.inertia_kg_m2;
        let fault = |what, principal_kg_m2| {
            Err(DynamicsError::Inertia {
                body: self.name.clone(),
                what,
                principal_kg_m2,
            })
        };
        if j.iter().any(|x| !x.is_finite()) {
            return fault("the inertia tensor is not finite", [f64::NAN; 3]);
        }
        if (j - j.transpose()).norm() > 1e-9 * j.norm() {
            return fault("the inertia tensor is not symmetric", [f64::NAN; 3]);
        }
        let mut principal: [f64; 3] = j.symmetric_eigenvalues().into();
        principal.sort_by(f64::total_cmp);
        if principal[0] <= 0.0 {
            return fault("a moment of inertia is zero or negative", principal);
        }
        // A flat body meets the bound with equality: leave room for the rounding of its file.
        if principal[2] > (principal[0] + principal[1]) * (1.0 + 1e-6) {
            return fault(
                "the inertia tensor breaks the triangle inequality",
                principal,
            );
        }
        Ok(())
    }

    fn validate_modes(&self) -> Result<(), DynamicsError> {
        let Some(modes) = &self.modes else {
            return Ok(());
        };
        let count = self.mode_count();
        for (what, found, expected) in [
            ("damping ratio", modes.damping_ratio.len(), count),
            ("coupling (rows)", modes.coupling.nrows(), count),
            ("coupling (columns)", modes.coupling.ncols(), 6),
        ] {
            if found != expected {
                return Err(DynamicsError::Shape {
                    owner: format!("modes of body `{}`", self.name),
                    what,
                    found,
                    expected,
                });
            }
        }
        let owner = || format!("body `{}`", self.name);
        for omega in &modes.angular_frequency_rad_per_s {
            DynamicsError::positive(owner(), "angular frequency of a mode in rad/s", *omega)?;
        }
        for zeta in &modes.damping_ratio {
            DynamicsError::not_negative(owner(), "damping ratio of a mode", *zeta)?;
        }
        if modes.coupling.iter().any(|x| !x.is_finite())
            || self.mass_matrix_in_body_axes().cholesky().is_none()
        {
            return Err(DynamicsError::ModalCoupling {
                body: self.name.clone(),
            });
        }
        Ok(())
    }

    /// Mass matrix for the undeformed body in body axes about the reference point, size 6 + modes.
    #[must_use]
    pub fn mass_matrix_in_body_axes(&self) -> DMatrix<f64> {
        let size = 6 + self.mode_count();
        let mut mass = DMatrix::identity(size, size);
        let offset = self.mass_kg * self.center_of_mass_m.cross_matrix();
        mass.fixed_view_mut::<3, 3>(0, 0)
            .copy_from(&(self.mass_kg * Matrix3::identity()));
        mass.fixed_view_mut::<3, 3>(0, 3).copy_from(&(-offset));
        mass.fixed_view_mut::<3, 3>(3, 0).copy_from(&offset);
        mass.fixed_view_mut::<3, 3>(3, 3)
            .copy_from(&self.inertia_about_reference_kg_m2());
        if let Some(modes) = &self.modes {
            mass.view_mut((6, 0), (size - 6, 6))
                .copy_from(&modes.coupling);
            mass.view_mut((0, 6), (6, size - 6))
                .copy_from(&modes.coupling.transpose());
        }
        mass
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn impossible_mass_properties_are_refused_with_their_numbers() {
        let message = |mass, inertia| {
            Body::rigid("disc", mass, inertia)
                .validate()
                .unwrap_err()
                .to_string()
        };
        assert!(message(-1.0, [1.0; 3]).contains("mass in kg is -1"));
        assert!(message(f64::NAN, [1.0; 3]).contains("disc"));
        assert!(message(1.0, [1.0, -2.0, 1.0]).contains("negative"));
        assert!(message(1.0, [1.0, 1.0, 2.1]).contains("triangle"));
        Body::rigid("lamina", 1.0, [1.0, 1.0, 2.0])
            .validate()
            .unwrap();
    }

    #[test]
    fn modes_heavier_than_the_body_are_refused() {
        let mut body = Body::rigid("rim", 1.0, [0.01; 3]);
        body.modes = Some(Modes {
            angular_frequency_rad_per_s: vec![100.0],
            damping_ratio: vec![0.0],
            coupling: DMatrix::from_row_slice(1, 6, &[0.9, 0.0, 0.0, 0.0, 0.0, 0.0]),
        });
        body.validate().unwrap();
        body.modes.as_mut().unwrap().coupling[0] = 1.1;
        assert!(matches!(
            body.validate(),
            Err(DynamicsError::ModalCoupling { .. })
        ));
        body.modes.as_mut().unwrap().damping_ratio.clear();
        assert!(matches!(body.validate(), Err(DynamicsError::Shape { .. })));
    }
}
