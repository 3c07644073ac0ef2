//! Motion of gear 2 as seen in gear 1: all that a mesh depends on.

use gearmesh_geometry::BaseCircles;
use nalgebra::{Matrix3, SVector, Vector3};

/// Six numbers on the relative motion: translation, then rotation, both along gear 1's axes.
pub type Vector6 = SVector<f64, 6>;

/// Two vectors one above the other.
pub(crate) fn stacked(upper: Vector3<f64>, lower: Vector3<f64>) -> Vector6 {
    Vector6::new(upper[0], upper[1], upper[2], lower[0], lower[1], lower[2])
}

/// A vector on the rotation alone.
pub(crate) fn on_turn(lower: Vector3<f64>) -> Vector6 {
    stacked(Vector3::zeros(), lower)
}

/// Place and motion of gear 2's frame in gear 1's. Each frame has its z along the gear's axis, its origin at mid-face
/// and tooth 0 centred on +x; the two z point the same way.
///
/// Derivatives by "the increments" mean (δu, ϑ): u → u + δu and Q → exp(ϑ×) Q, both in gear 1's axes. They are the same
/// six directions as the rates (u̇, ω).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// u: gear 2's origin from gear 1's \[m\].
    pub displacement_m: Vector3<f64>,
    /// Q: gear 1 axes from gear 2 axes.
    pub rotation: Matrix3<f64>,
    /// u̇ \[m/s\].
    pub velocity_m_per_s: Vector3<f64>,
    /// ω of gear 2 against gear 1 \[rad/s\].
    pub angular_velocity_rad_per_s: Vector3<f64>,
}

impl Pose {
    /// At rest.
    #[must_use]
    pub fn at_rest(displacement_m: Vector3<f64>, rotation: Matrix3<f64>) -> Self {
        Self {
            displacement_m,
            rotation,
            velocity_m_per_s: Vector3::zeros(),
            angular_velocity_rad_per_s: Vector3::zeros(),
        }
    }

    /// Gear 2's axis as seen in gear 1.
    #[must_use]
    pub fn axis_2(&self) -> Vector3<f64> {
        self.rotation.column(2).into()
    }

    /// Angle \[rad\] between the two axes.
    #[must_use]
    pub fn misalignment_rad(&self) -> f64 {
        let b = self.axis_2();
        b[0].hypot(b[1]).atan2(b[2])
    }

    /// Whether that angle is within a limit below a right angle \[rad\].
    #[must_use]
    pub fn is_aligned(&self, limit_rad: f64) -> bool {
        let b = self.axis_2();
        b[2] > 0.0 && b[0] * b[0] + b[1] * b[1] <= (limit_rad.tan() * b[2]).powi(2)
    }

    /// Turn γ \[rad\] of gear 2 about its axis, without the tilt of that axis: Q = (shortest rotation that takes z to
    /// the axis) times a rotation by γ about z.
    #[must_use]
    pub fn spin_rad(&self) -> f64 {
        let q = &self.rotation;
        (q[(1, 0)] - q[(0, 1)]).atan2(q[(0, 0)] + q[(1, 1)])
    }

    /// ∂γ/∂ϑ = (e_z + b)/(1 + b_z), b the axis of gear 2.
    #[must_use]
    pub fn spin_gradient(&self) -> Vector3<f64> {
        let b = self.axis_2();
        (Vector3::z() + b) / (1.0 + b[2])
    }

    /// D \[m\]: how far gear 2's mid-face stands from gear 1's along the axes, at the pitch point; see mesh_frame.rs.
    #[must_use]
    pub fn face_displacement_m(&self, circles: BaseCircles) -> f64 {
        let b = self.axis_2();
        let along_m = self.spin_gradient().dot(&self.displacement_m);
        let shift_m = 0.5 * (b - Vector3::z()).dot(&self.displacement_m);
        along_m - circles.pitch_place() * shift_m
    }

    /// (u̇, ω).
    #[must_use]
    pub fn rates(&self) -> Vector6 {
        let (v, w) = (self.velocity_m_per_s, self.angular_velocity_rad_per_s);
        Vector6::new(v[0], v[1], v[2], w[0], w[1], w[2])
    }
}
