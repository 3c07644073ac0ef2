//! Spring and damper along the line between two points: f = −(k (L − L₀) + c L̇ + F₀) u/L on B.

use nalgebra::{Matrix3, SMatrix};

use super::marker_element::{Law, LawTangent, MarkerElement, PairLoad};
use super::{Power, not_negative};
use crate::error::DynamicsError;
use crate::relative_motion::{MarkerPair, RelativeMotion};

/// Parameters of the line spring.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SpringDamper {
    /// Stiffness k.
    pub stiffness_n_per_m: f64,
    /// Damping c.
    pub damping_n_s_per_m: f64,
    /// Length L₀ without force. With length 0 between the points the force has no direction: then it is zero.
    pub free_length_m: f64,
}

impl SpringDamper {
    /// The spring between the origins of two markers.
    ///
    /// # Errors
    /// [`DynamicsError::Value`] if a parameter is negative or not finite.
    pub fn between(
        self,
        name: &str,
        pair: MarkerPair,
    ) -> Result<MarkerElement<Self>, DynamicsError> {
        not_negative(name, "stiffness in N/m", self.stiffness_n_per_m)?;
        not_negative(name, "damping in N s/m", self.damping_n_s_per_m)?;
        not_negative(name, "free length in m", self.free_length_m)?;
        Ok(MarkerElement::new(name, pair, self))
    }
}

impl Law for SpringDamper {
    fn load(&self, motion: &RelativeMotion) -> (PairLoad, Power) {
        let length = motion.displacement_m.norm();
        let mut load = PairLoad::zeros();
        if length == 0.0 {
            let stored_j = 0.5 * self.stiffness_n_per_m * self.free_length_m.powi(2);
            return (
                load,
                Power {
                    stored_j,
                    ..Power::default()
                },
            );
        }
        let direction = motion.displacement_m / length;
        let rate = direction.dot(&motion.velocity_m_per_s);
        let stretch = length - self.free_length_m;
        let pull = self.stiffness_n_per_m * stretch + self.damping_n_s_per_m * rate;
        load.fixed_rows_mut::<3>(0).copy_from(&(-pull * direction));
        let power = Power {
            stored_j: 0.5 * self.stiffness_n_per_m * stretch * stretch,
            dissipated_w: self.damping_n_s_per_m * rate * rate,
            supplied_w: 0.0,
        };
        (load, power)
    }

    fn tangent(&self, motion: &RelativeMotion) -> LawTangent {
        let mut tangent = LawTangent {
            by_position: SMatrix::zeros(),
            by_velocity: SMatrix::zeros(),
        };
        let length = motion.displacement_m.norm();
        if length == 0.0 {
            return tangent;
        }
        let n = motion.displacement_m / length;
        let v = motion.velocity_m_per_s;
        let rate = n.dot(&v);
        let pull =
            self.stiffness_n_per_m * (length - self.free_length_m) + self.damping_n_s_per_m * rate;
        let along = n * n.transpose();
        let across = (Matrix3::identity() - along) / length;
        let by_u = -self.stiffness_n_per_m * along
            - self.damping_n_s_per_m * n * (v.transpose() * across)
            - pull * across;
        tangent
            .by_position
            .fixed_view_mut::<3, 3>(0, 0)
            .copy_from(&by_u);
        tangent
            .by_velocity
            .fixed_view_mut::<3, 3>(0, 0)
            .copy_from(&(-self.damping_n_s_per_m * along));
        tangent
    }
}
