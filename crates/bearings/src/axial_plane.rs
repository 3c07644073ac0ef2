//! The axial plane of a ball or roller, in which the cage holds it, and its points as the inner ring sees them.

use nalgebra::{Matrix3x2, Vector2, Vector3};

use crate::ring_pose::RingPose;

/// The plane through the bearing's axis at an element's angle: places in it are (r, z) \[m\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct AxialPlane {
    /// Radial unit vector.
    pub e_r: Vector3<f64>,
}

impl AxialPlane {
    /// A vector's part in the plane.
    #[inline]
    pub fn part(&self, v: &Vector3<f64>) -> Vector2<f64> {
        Vector2::new(self.e_r.dot(v), v.z)
    }

    /// The vectors of r and z.
    #[inline]
    pub fn vectors(&self) -> Matrix3x2<f64> {
        Matrix3x2::from_columns(&[self.e_r, Vector3::z()])
    }

    /// Its angle round the axis, from x towards y \[deg\].
    pub fn degrees(&self) -> f64 {
        self.e_r.y.atan2(self.e_r.x).to_degrees()
    }

    /// Point nearest to the plane of a circle about the ring's axis, `at` = (radius, height along it).
    pub fn nearest(&self, pose: &RingPose, at: (f64, f64)) -> Vector2<f64> {
        let a = &pose.axis;
        let e = (self.e_r - a * self.e_r.dot(a)).normalize();
        self.part(&(pose.centre_m + e * at.0 + a * at.1))
    }

    /// A place in the plane as the inner ring sees it.
    #[inline]
    pub fn seen_from_ring(&self, pose: &RingPose, place: &Vector2<f64>) -> FromRing {
        let a = &pose.axis;
        let w = self.e_r * place[0] + Vector3::z() * place[1] - pose.centre_m;
        let height = w.dot(a);
        let radial = w - a * height;
        let radius = radial.norm();
        let e = radial / radius;
        FromRing {
            w,
            height,
            radius,
            e,
            t: a.cross(&e),
        }
    }
}

/// A point in the cylindrical coordinates of the inner ring.
pub(crate) struct FromRing {
    /// From the ring's middle.
    pub w: Vector3<f64>,
    /// Along the ring's axis \[m\].
    pub height: f64,
    /// From the ring's axis \[m\].
    pub radius: f64,
    /// Radial and circumferential unit vectors of the ring at the point.
    pub e: Vector3<f64>,
    pub t: Vector3<f64>,
}
