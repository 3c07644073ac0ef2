//! Torsion spring and damper about z of marker A, over any number of turns: τ = −(k (a − a₀) + c ȧ), μ = τ j on B.
//!
//! a is the angle of `relative_angle.rs`, j its gradient, so that the torque does the work −k(a − a₀) da even where the
//! axes are not aligned.

use nalgebra::SMatrix;

use super::marker_element::{Law, LawTangent, MarkerElement, PairLoad};
use super::{Power, not_negative};
use crate::error::DynamicsError;
use crate::relative_angle::RelativeAngle;
use crate::relative_motion::{MarkerPair, RelativeMotion};

/// Parameters of the torsion spring.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct TorsionSpring {
    /// Stiffness k.
    pub stiffness_nm_per_rad: f64,
    /// Damping c.
    pub damping_nm_s_per_rad: f64,
    /// Angle a₀ without torque.
    pub free_angle_rad: f64,
    angle: RelativeAngle,
}

impl TorsionSpring {
    /// Stiffness and damping, free at angle 0.
    #[must_use]
    pub fn new(stiffness_nm_per_rad: f64, damping_nm_s_per_rad: f64) -> Self {
        Self {
            stiffness_nm_per_rad,
            damping_nm_s_per_rad,
            ..Self::default()
        }
    }

    /// The spring between two markers.
    ///
    /// # Errors
    /// [`DynamicsError::Value`] if a parameter is negative or not finite.
    pub fn between(
        self,
        name: &str,
        pair: MarkerPair,
    ) -> Result<MarkerElement<Self>, DynamicsError> {
        not_negative(name, "stiffness in N m/rad", self.stiffness_nm_per_rad)?;
        not_negative(name, "damping in N m s/rad", self.damping_nm_s_per_rad)?;
        not_negative(name, "free angle in rad", self.free_angle_rad.abs())?;
        Ok(MarkerElement::new(name, pair, self))
    }

    /// Stretch and its rate.
    fn stretch(&self, motion: &RelativeMotion) -> (f64, f64) {
        let rate = RelativeAngle::gradient(motion).dot(&motion.angular_velocity_rad_per_s);
        (self.angle.value(motion) - self.free_angle_rad, rate)
    }
}

impl Law for TorsionSpring {
    fn load(&self, motion: &RelativeMotion) -> (PairLoad, Power) {
        let (stretch, rate) = self.stretch(motion);
        let torque = -(self.stiffness_nm_per_rad * stretch + self.damping_nm_s_per_rad * rate);
        let mut load = PairLoad::zeros();
        load.fixed_rows_mut::<3>(3)
            .copy_from(&(torque * RelativeAngle::gradient(motion)));
        let power = Power {
            stored_j: 0.5 * self.stiffness_nm_per_rad * stretch * stretch,
            dissipated_w: self.damping_nm_s_per_rad * rate * rate,
            supplied_w: 0.0,
        };
        (load, power)
    }

    fn tangent(&self, motion: &RelativeMotion) -> LawTangent {
        let (stretch, rate) = self.stretch(motion);
        let (k, c) = (self.stiffness_nm_per_rad, self.damping_nm_s_per_rad);
        let j = RelativeAngle::gradient(motion);
        let slope = RelativeAngle::gradient_slope(motion);
        let torque = -(k * stretch + c * rate);
        let torque_slope =
            -k * j.transpose() - c * motion.angular_velocity_rad_per_s.transpose() * slope;
        let mut tangent = LawTangent {
            by_position: SMatrix::zeros(),
            by_velocity: SMatrix::zeros(),
        };
        tangent
            .by_position
            .fixed_view_mut::<3, 3>(3, 3)
            .copy_from(&(j * torque_slope + torque * slope));
        tangent
            .by_velocity
            .fixed_view_mut::<3, 3>(3, 3)
            .copy_from(&(-c * j * j.transpose()));
        tangent
    }

    fn has_state(&self) -> bool {
        true
    }

    fn begin(&mut self, motion: &RelativeMotion) {
        self.angle.begin(motion);
    }

    fn commit(&mut self, motion: &RelativeMotion) {
        self.angle.commit(motion);
    }

    fn save(&self, out: &mut Vec<f64>) {
        out.push(self.angle.committed_rad());
    }

    fn restore(&mut self, numbers: &[f64]) {
        self.angle.restore(numbers[0]);
    }
}
