//! Helical teeth in space: the sections of both gears at the contact in a slice plane, and their derivatives.
//!
//! The plane cuts the axes at z₁ and z₂ (mesh_frame.rs). A contact at r_b1 (σ w⊥ + ξ₁ w) from gear 1's axis lies on
//! gear 1 at the height z₁ − r_b1 (σ f·w⊥ + ξ₁ f·w), on gear 2 at z₂ − r_b2 (σ f·w⊥ + ξ₂ f·w). Its sections there have
//! turned by κ times that, κ = tan β_b/r_b with the sign of the hand, κ₂ r_b2 = −κ₁ r_b1. With ξ⁰ the roll angle
//! without twist, T = tan β_b, φ = f·w, ψ = f·w⊥,
//!
//! ```text
//! ξ₁ = (ξ₁⁰ − σ κ₁ z₁ + T ψ)/(1 − σ T φ),        ξ₂ = (ξ₂⁰ − σ κ₂ z₂ − T ψ)/(1 + σ T φ)
//! g = cos β_b (L − r_b1 ξ₁ − r_b2 ξ₂),           ∂φ = ½ (0, b × w) + ψ ∂ω,      ∂ψ = ½ (0, b × w⊥) − φ ∂ω
//! ```
//!
//! On parallel axes ∂g = (n, (P − u) × n) with n = cos β_b w + σ sin β_b e_z and P the point of contact: the wrench of
//! the flanks' normal.

use gearmesh_geometry::{BaseCircles, ToothGeometry};
use nalgebra::Vector3;

use crate::mesh_frame::{MeshFrame, turn_of_spin_gradient};
use crate::pose::{Vector6, on_turn};
use crate::slice_plane::{Matrix6, SlicePlane, ToothZero};

/// The helix of a pair; β_b is gear 1's, positive for a right hand. The gears have opposite hands, a ring and the gear
/// inside it equal ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct BaseHelix {
    pub cos: f64,
    pub tan: f64,
    /// κ of gear 1 and gear 2 \[rad/m\].
    pub twist_rad_per_m: [f64; 2],
    circles: BaseCircles,
}

/// Roll angles and gap of ideal flanks in a slice plane, with their derivatives.
#[derive(Debug, Clone, Copy)]
pub(crate) struct IdealFlanks {
    pub roll_rad: [f64; 2],
    pub roll_gradient: [Vector6; 2],
    /// Along the normal \[m\].
    pub gap_m: f64,
    pub gradient: Vector6,
}

impl BaseHelix {
    /// None for spur gears.
    pub(crate) fn new(gears: &[ToothGeometry; 2]) -> Option<Self> {
        if gears[0].helix_angle_rad == 0.0 {
            return None;
        }
        let angle = gears[0].base_helix_angle_rad();
        let twist = gears[0].twist_rad_per_m();
        let circles = BaseCircles::new(gears.each_ref());
        let [r1, r2] = circles.radii_m;
        Some(Self {
            cos: angle.cos(),
            tan: r1 * twist,
            twist_rad_per_m: [twist, -twist * r1 / r2],
            circles,
        })
    }

    /// Roll angles of tooth 0 of both gears in the section at gear 1's mid-face.
    pub(crate) fn mid_face_rolls_rad(
        &self,
        plane: &SlicePlane,
        zero: &ToothZero,
        sigma: f64,
    ) -> [f64; 2] {
        let [height_1, height_2] = plane.axis_heights_m;
        let [roll_1, roll_2] = zero.roll_rad;
        let turned_2 = sigma * self.twist_rad_per_m[1] * (height_2 - height_1);
        [roll_1, roll_2 - turned_2]
    }

    /// The sections of two flanks whose roll angles without twist are `plain_rad`, and their gap. With `common` at a
    /// contact there, r_b1 ξ₁ − r_b2 ξ₂ \[m\], wherever these flanks touch: on tilted axes the gap changes from one
    /// pair of teeth to the next by 2 sin β_b f·w p_b, and what stands for all of them takes it at one place. Its roll
    /// angles are then those of X = ξ (1 ∓ σ T φ), which teeth a pitch apart share but for their pitch.
    pub(crate) fn flanks(
        &self,
        (frame, plane): (&MeshFrame, &SlicePlane),
        zero: &ToothZero,
        (plain_rad, sigma): ([f64; 2], f64),
        common: Option<f64>,
    ) -> IdealFlanks {
        let [r1, r2] = self.circles.radii_m;
        let [phi, psi] = plane.tilt;
        let turn = plane.turn(frame);
        let half = 0.5 * frame.axis_2;
        let phi_gradient = on_turn(half.cross(&plane.normal)) + psi * turn;
        let psi_gradient = on_turn(half.cross(&plane.across)) - phi * turn;
        let half_along = 0.5 * frame.displacement_along_gradient;
        let height_gradient = [
            plane.plane_gradient + half_along,
            plane.plane_gradient - half_along,
        ];
        let (mut roll_rad, mut roll_gradient) = ([0.0; 2], [Vector6::zeros(); 2]);
        // What 1/(1 ∓ σ T φ) makes of a roll angle, and its change with φ.
        let mut stretch = [(1.0, 0.0); 2];
        for (gear, sense) in [(0, 1.0), (1, -1.0)] {
            let twist = sigma * self.twist_rad_per_m[gear];
            let tan = sense * self.tan;
            roll_rad[gear] = plain_rad[gear] - twist * plane.axis_heights_m[gear] + tan * psi;
            roll_gradient[gear] =
                zero.roll_gradient[gear] - twist * height_gradient[gear] + tan * psi_gradient;
            let factor = 1.0 / (1.0 - sigma * tan * phi);
            stretch[gear] = (factor, sigma * tan * factor * factor);
        }
        let length_gradient =
            zero.gradient + r1 * zero.roll_gradient[0] + r2 * zero.roll_gradient[1];
        // r ξ of both flanks, in what follows to stretch.
        let mut arcs = [r1 * roll_rad[0], r2 * roll_rad[1]];
        let mut arc_gradients = [r1 * roll_gradient[0], r2 * roll_gradient[1]];
        if let Some(difference_m) = common {
            let half_sum = 0.5 * (arcs[0] + arcs[1]);
            let sum_gradient = 0.5 * (arc_gradients[0] + arc_gradients[1]);
            arcs = [half_sum + 0.5 * difference_m, half_sum - 0.5 * difference_m];
            arc_gradients = [sum_gradient; 2];
        }
        let (mut gap_m, mut gradient) = (plane.length_m, length_gradient);
        for gear in 0..2 {
            let (factor, by_phi) = stretch[gear];
            gap_m -= factor * arcs[gear];
            gradient -= factor * arc_gradients[gear] + by_phi * arcs[gear] * phi_gradient;
            if common.is_none() {
                roll_gradient[gear] =
                    factor * roll_gradient[gear] + by_phi * roll_rad[gear] * phi_gradient;
                roll_rad[gear] *= factor;
            }
        }
        IdealFlanks {
            roll_rad,
            roll_gradient,
            gap_m: self.cos * gap_m,
            gradient: self.cos * gradient,
        }
    }

    /// Second derivative of the gap along the normal, with the same omissions as [`SlicePlane::transverse_curvature`].
    pub(crate) fn curvature(
        &self,
        (frame, plane): (&MeshFrame, &SlicePlane),
        zero: &ToothZero,
        (roll_rad, sigma): ([f64; 2], f64),
        transverse: Matrix6,
    ) -> Matrix6 {
        let [r1, r2] = self.circles.radii_m;
        let (b, tan) = (frame.axis_2, self.tan);
        let turn = plane.turn(frame);
        let by_normal = on_turn(0.5 * b.cross(&plane.normal));
        let by_across = on_turn(0.5 * b.cross(&plane.across));
        let symmetric = |x: &Vector6, y: &Vector6| x * y.transpose() + y * x.transpose();
        let half_block = |v: &Vector3<f64>| {
            let mut h = Matrix6::zeros();
            h.fixed_view_mut::<3, 3>(3, 3)
                .copy_from(&(0.5 * b * v.transpose()));
            h
        };
        // ∂²D′.
        let mut along = Matrix6::zeros();
        let spin = turn_of_spin_gradient();
        along.fixed_view_mut::<3, 3>(0, 3).copy_from(&spin);
        along.fixed_view_mut::<3, 3>(3, 0).copy_from(&(-spin));
        let u_across = frame.displacement_m - frame.displacement_along_m * b;
        along += half_block(&u_across);
        // ∂²ψ and ∂²φ.
        let of_psi = half_block(&plane.across) - symmetric(&by_normal, &turn);
        let of_phi = half_block(&plane.normal) + symmetric(&by_across, &turn);
        let twist = sigma * tan;
        let difference = r1 * roll_rad[0] - r2 * roll_rad[1];
        let sum = r1 * roll_rad[0] + r2 * roll_rad[1];
        // ∂(r_b1 ξ₁ − r_b2 ξ₂): the sum of both heights changes by twice that of the plane.
        let changes = r1 * zero.roll_gradient[0]
            - r2 * zero.roll_gradient[1]
            - 2.0 * twist * plane.plane_gradient
            + (r1 + r2) * tan * by_across;
        let own = twist * along
            - (r1 - r2) * tan * of_psi
            - twist * (difference * of_phi + symmetric(&by_normal, &changes))
            - 2.0 * tan * tan * sum * by_normal * by_normal.transpose();
        self.cos * (transverse + own)
    }
}
