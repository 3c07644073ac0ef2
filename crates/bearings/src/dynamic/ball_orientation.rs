//! How a ball with a spall stands: its orientation, kept for such balls alone.
//!
//! The coordinates of a ball's turning are the integral of its spin; their increment ψ since the last accepted step
//! turns the ball from where it was then,
//!
//! ```text
//! q = exp(ψ) q₀,   δφ = Tᵀ(ψ) δψ          world axes, T of gearmesh_dynamics::rotation
//! ```

use gearmesh_dynamics::rotation;
use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

/// Numbers of one orientation in a saved state.
pub(crate) const SAVED: usize = 7;

/// A ball that has an orientation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BallOrientation {
    /// Number of the ball among all of the bearing.
    pub ball: usize,
    /// c in the axes of the ball.
    middle: Vector3<f64>,
    /// q₀.
    kept: UnitQuaternion<f64>,
    /// The coordinates then.
    turned: Vector3<f64>,
}

impl BallOrientation {
    pub fn new(ball: usize, middle: Vector3<f64>) -> Self {
        Self {
            ball,
            middle,
            kept: UnitQuaternion::identity(),
            turned: Vector3::zeros(),
        }
    }

    /// Begins with the axes of the ball along these of the world.
    pub fn begin(&mut self, axes: &Matrix3<f64>, turned: Vector3<f64>) {
        self.kept = UnitQuaternion::from_matrix(axes);
        self.turned = turned;
    }

    /// c in the world, and Tᵀ.
    pub fn at(&self, turned: &Vector3<f64>) -> (Vector3<f64>, Matrix3<f64>) {
        let step = turned - self.turned;
        let now = rotation::exp(&step) * self.kept;
        (now * self.middle, rotation::tangent(&step).transpose())
    }

    /// A step is accepted.
    pub fn commit(&mut self, turned: Vector3<f64>) {
        let now = rotation::exp(&(turned - self.turned)) * self.kept;
        self.kept = UnitQuaternion::new_normalize(now.into_inner());
        self.turned = turned;
    }

    pub fn save(&self, out: &mut Vec<f64>) {
        let q = self.kept.coords;
        out.extend([q.x, q.y, q.z, q.w]);
        out.extend(self.turned.iter());
    }

    pub fn restore(&mut self, numbers: &[f64]) {
        if let [x, y, z, w, a, b, c] = *numbers {
            self.kept = UnitQuaternion::new_unchecked(Quaternion::new(w, x, y, z));
            self.turned = Vector3::new(a, b, c);
        }
    }
}
