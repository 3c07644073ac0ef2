//! The angle that a marker has turned about another one's z axis, counted over any number of turns.
//!
//! With c the x axis of B seen in A, a = atan2(c_y, c_x). Its derivative by a rotation φ of B against A (A axes) is
//! jᵀφ,
//!
//! ```text
//! j = (−c_z c_x/ρ², −c_z c_y/ρ², 1),   ρ² = c_x² + c_y²
//! ```
//!
//! The turn is chosen next to the angle of the last accepted step, so a step must turn by less than half a revolution.

use std::f64::consts::{PI, TAU};

use nalgebra::{Matrix3, Vector3};

use crate::relative_motion::RelativeMotion;
use crate::rotation::skew;

/// The angle with the memory of its turns.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RelativeAngle {
    committed_rad: f64,
}

impl RelativeAngle {
    /// Angle \[rad\] nearest to the committed one.
    #[must_use]
    pub fn value(&self, motion: &RelativeMotion) -> f64 {
        let wrapped = motion.rotation[(1, 0)].atan2(motion.rotation[(0, 0)]);
        wrapped + TAU * ((self.committed_rad - wrapped) / TAU).round()
    }

    /// j of the module page.
    #[must_use]
    pub fn gradient(motion: &RelativeMotion) -> Vector3<f64> {
        let c = motion.rotation.column(0);
        let square = c[0] * c[0] + c[1] * c[1];
        Vector3::new(-c[2] * c[0] / square, -c[2] * c[1] / square, 1.0)
    }

    /// ∂j/∂φ, shape 3×3.
    #[must_use]
    pub fn gradient_slope(motion: &RelativeMotion) -> Matrix3<f64> {
        let c: Vector3<f64> = motion.rotation.column(0).into();
        // dc = φ × c
        let turned = -skew(&c);
        let inverse = 1.0 / (c[0] * c[0] + c[1] * c[1]);
        let inverse_slope =
            -2.0 * inverse * inverse * (c[0] * turned.row(0) + c[1] * turned.row(1));
        let mut slope = Matrix3::zeros();
        for i in 0..2 {
            let row = -inverse * (turned.row(2) * c[i] + c[2] * turned.row(i))
                - c[2] * c[i] * inverse_slope;
            slope.row_mut(i).copy_from(&row);
        }
        slope
    }

    /// Keeps the angle of an accepted step.
    pub fn commit(&mut self, motion: &RelativeMotion) {
        self.committed_rad = self.value(motion);
    }

    /// The angle of the last accepted step \[rad\]: what a checkpoint stores.
    #[must_use]
    pub fn committed_rad(&self) -> f64 {
        self.committed_rad
    }

    /// Goes on from a stored angle.
    pub fn restore(&mut self, committed_rad: f64) {
        self.committed_rad = committed_rad;
    }

    /// Begins within half a turn of zero, whatever was counted before.
    pub fn begin(&mut self, motion: &RelativeMotion) {
        self.committed_rad = 0.0;
        self.commit(motion);
        // Exactly half a turn may come out with either sign; take the positive one.
        if (self.committed_rad + PI).abs() < 1e-12 {
            self.committed_rad = PI;
        }
    }
}
