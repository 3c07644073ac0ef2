//! Where the inner ring stands against the outer one.

use gearmesh_dynamics::{BodyMotion, Marker, RelativeMotion};
use nalgebra::{Vector3, Vector5};

/// Centre and axis of the inner ring, in the frame of the outer ring: z is its axis, the origin its middle.
///
/// A ring is a surface of revolution: its turning about its own axis has no effect, so that five numbers say it all.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RingPose {
    /// u, displacement of the ring's middle \[m\].
    pub centre_m: Vector3<f64>,
    /// a, unit vector along the ring's axis.
    pub axis: Vector3<f64>,
}

impl Default for RingPose {
    fn default() -> Self {
        Self {
            centre_m: Vector3::zeros(),
            axis: Vector3::z(),
        }
    }
}

impl From<&RelativeMotion> for RingPose {
    /// Of marker B on the inner ring in the frame of marker A on the outer one.
    fn from(motion: &RelativeMotion) -> Self {
        Self {
            centre_m: motion.displacement_m,
            axis: motion.rotation.column(2).into(),
        }
    }
}

/// Speed of a ring about its own axis, z of a marker on its body \[rad/s\].
pub(crate) fn spin_rad_per_s(body: &BodyMotion, marker: &Marker) -> f64 {
    let axis = marker.orientation() * Vector3::z();
    body.angular_velocity_rad_per_s.dot(&axis)
}

impl RingPose {
    /// From the five coordinates x, y, z \[m\], θx, θy \[rad\]: the axis is e_z turned by the rotation vector (θx,
    /// θy, 0).
    #[must_use]
    pub fn from_five(q: &Vector5<f64>) -> Self {
        let angle = q[3].hypot(q[4]);
        let share = if angle > 0.0 {
            angle.sin() / angle
        } else {
            1.0
        };
        Self {
            centre_m: Vector3::new(q[0], q[1], q[2]),
            axis: Vector3::new(q[4] * share, -q[3] * share, angle.cos()),
        }
    }

    /// The five coordinates, the reverse of [`Self::from_five`].
    #[must_use]
    pub fn to_five(&self) -> Vector5<f64> {
        let sine = self.axis.x.hypot(self.axis.y);
        let share = if sine > 0.0 {
            sine.atan2(self.axis.z) / sine
        } else {
            1.0
        };
        let u = &self.centre_m;
        Vector5::new(u.x, u.y, u.z, -self.axis.y * share, self.axis.x * share)
    }

    /// Moved by (δx, δy, δz \[m\], δφx, δφy \[rad\]), the last two a rotation about the fixed axes x and y.
    #[must_use]
    pub fn moved(&self, step: &Vector5<f64>) -> Self {
        let turn = Vector3::new(step[3], step[4], 0.0);
        let angle = turn.norm();
        let axis = if angle > 0.0 {
            let n = turn / angle;
            let a = &self.axis;
            a * angle.cos() + n.cross(a) * angle.sin() + n * (n.dot(a) * (1.0 - angle.cos()))
        } else {
            self.axis
        };
        Self {
            centre_m: self.centre_m + Vector3::new(step[0], step[1], step[2]),
            axis: axis.normalize(),
        }
    }
}
