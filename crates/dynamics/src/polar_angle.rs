//! The polar angle of a marker's place about another one's z axis, counted over any number of turns.
//!
//! ```text
//! β = atan2(u_y, u_x),      ∂β/∂u = (−u_y, u_x, 0)/ρ²,      ρ² = u_x² + u_y²
//! ```
//!
//! The turn is chosen next to the angle of the last accepted step, so a step must turn by less than half a revolution.

use std::f64::consts::TAU;

use nalgebra::{Matrix3, Vector3};

use crate::relative_motion::RelativeMotion;

/// The angle with the memory of its turns.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct PolarAngle {
    committed_rad: f64,
}

impl PolarAngle {
    /// Angle \[rad\] nearest to the committed one.
    pub(crate) fn value(&self, motion: &RelativeMotion) -> f64 {
        let u = &motion.displacement_m;
        let wrapped = u[1].atan2(u[0]);
        wrapped + TAU * ((self.committed_rad - wrapped) / TAU).round()
    }

    /// ∂β/∂u \[rad/m\].
    pub(crate) fn gradient(motion: &RelativeMotion) -> Vector3<f64> {
        let u = &motion.displacement_m;
        Vector3::new(-u[1], u[0], 0.0) / (u[0] * u[0] + u[1] * u[1])
    }

    /// ∂²β/∂u∂u \[rad/m²\].
    pub(crate) fn gradient_slope(motion: &RelativeMotion) -> Matrix3<f64> {
        let (x, y) = (motion.displacement_m[0], motion.displacement_m[1]);
        let (mixed, straight) = (y * y - x * x, 2.0 * x * y);
        Matrix3::new(straight, mixed, 0.0, mixed, -straight, 0.0, 0.0, 0.0, 0.0)
            / (x * x + y * y).powi(2)
    }

    /// Keeps the angle of an accepted step.
    pub(crate) fn commit(&mut self, motion: &RelativeMotion) {
        self.committed_rad = self.value(motion);
    }

    /// The angle of the last accepted step \[rad\].
    pub(crate) fn committed_rad(&self) -> f64 {
        self.committed_rad
    }

    /// Goes on from a stored angle.
    pub(crate) fn restore(&mut self, committed_rad: f64) {
        self.committed_rad = committed_rad;
    }

    /// Begins within half a turn of zero.
    pub(crate) fn begin(&mut self, motion: &RelativeMotion) {
        self.committed_rad = 0.0;
        self.commit(motion);
    }
}
