//! Helical teeth in space: the height of gear 2's sections in gear 1, which turns gear 1's tooth, and its derivatives.
//!
//! Slices are numbered on gear 2: the slice z of it stands at z along its axis b. Seen from gear 2's axis its contact point lies at −m, in
//! gear 1 therefore at the height z₁, where the tooth of gear 1 has turned by κ₁ z₁:
//!
//! ```text
//! m  = r_b2 (σ w⊥ + ξ₂ w),      z₁ = u_z + z b_z + b·m,      κ = tan β_b/r_b,    κ₂ r_b2 = −κ₁ r_b1 = −tan β_b
//! ∂z₁/∂(u, ϑ) = (e_z, z b × e_z + b × m − σ r_b2 (b·w) t) + r_b2 ξ₂ (b·w⊥) ∂ω,      ∂ω = (w⊥, z b × w⊥)/L
//! ```
//!
//! On parallel axes the gap along the normal, cos β_b times the transverse one, then has the gradient (n, (P − u) × n) with
//! n = cos β_b w + σ sin β_b e_z and P the point of contact: the wrench of the flanks' normal.

use gearmesh_geometry::ToothGeometry;
use nalgebra::{Matrix3, Vector3};

use crate::pose::{Pose, Vector6};
use crate::slice_plane::{Matrix6, SlicePlane, stacked};

/// The helix of a pair; β_b is gear 1's, positive for a right hand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BaseHelix {
    pub sin: f64,
    pub cos: f64,
    pub tan: f64,
    /// κ of gear 1 and gear 2 \[rad/m\].
    pub twist_rad_per_m: [f64; 2],
    base_radius_2_m: f64,
}

/// z₁ \[m\] and ∂z₁/∂(increments of the pose).
pub(crate) struct Height {
    pub z_m: f64,
    pub gradient: Vector6,
}

impl BaseHelix {
    /// None for spur gears. The gears have opposite hands.
    pub(crate) fn new(gears: &[ToothGeometry; 2]) -> Option<Self> {
        if gears[0].helix_angle_rad == 0.0 {
            return None;
        }
        let angle = gears[0].base_helix_angle_rad();
        let twist = gears[0].twist_rad_per_m();
        let [r1, r2] = [0, 1].map(|i: usize| gears[i].base_radius_m);
        Some(Self {
            sin: angle.sin(),
            cos: angle.cos(),
            tan: r1 * twist,
            twist_rad_per_m: [twist, -twist * r1 / r2],
            base_radius_2_m: r2,
        })
    }

    /// m \[m\].
    fn arm(&self, plane: &SlicePlane, sigma: f64, roll_2_rad: f64) -> Vector3<f64> {
        self.base_radius_2_m * (sigma * plane.across + roll_2_rad * plane.normal)
    }

    /// ∂ω: turn of the line of action.
    fn turn(plane: &SlicePlane, axis: &Vector3<f64>) -> Vector6 {
        let along = plane.across / plane.length_m;
        stacked(along, plane.z_m * axis.cross(&along))
    }

    /// Height in gear 1 of the contact in the slice plane of gear 2, which has its roll angle there.
    pub(crate) fn height(
        &self,
        plane: &SlicePlane,
        pose: &Pose,
        sigma: f64,
        roll_2_rad: f64,
    ) -> Height {
        let axis = pose.axis_2();
        let arm = self.arm(plane, sigma, roll_2_rad);
        let tilted = self.base_radius_2_m * roll_2_rad * axis.dot(&plane.across);
        let moment = plane.z_m * axis.cross(&Vector3::z()) + axis.cross(&arm)
            - sigma * self.base_radius_2_m * axis.dot(&plane.normal) * pose.spin_gradient();
        Height {
            z_m: pose.displacement_m[2] + plane.z_m * axis[2] + axis.dot(&arm),
            gradient: stacked(Vector3::z(), moment) + tilted * Self::turn(plane, &axis),
        }
    }

    /// Second derivative of z₁; what falls to zero with the tilt of the axes is left out.
    pub(crate) fn height_curvature(
        &self,
        plane: &SlicePlane,
        pose: &Pose,
        sigma: f64,
        roll_2_rad: f64,
    ) -> Matrix6 {
        let axis = pose.axis_2();
        let from_origin = plane.z_m * Vector3::z() + self.arm(plane, sigma, roll_2_rad);
        let by_turn: Matrix3<f64> = from_origin.cross_matrix() * axis.cross_matrix();
        let mut h = Matrix6::zeros();
        h.fixed_view_mut::<3, 3>(3, 3).copy_from(&by_turn);
        let none = Vector3::zeros();
        let r2 = self.base_radius_2_m;
        let turn = Self::turn(plane, &axis);
        let across = r2 * roll_2_rad * stacked(none, axis.cross(&plane.across));
        let normal = sigma * r2 * stacked(none, axis.cross(&plane.normal));
        let spin = stacked(none, pose.spin_gradient());
        h += across * turn.transpose() + turn * across.transpose();
        h -= normal * spin.transpose() + spin * normal.transpose();
        h
    }
}
