//! An end of a force element on a body with modes, at a place that moves with them: a frame of its own, carried by the
//! body.
//!
//! ```text
//! a = p + β_u η,   θ = β_θ η,   E = exp(θ)         place and turn of the frame in the body
//! X = x + R a,   Ṽ = v + R(Ω × a + β_u η̇),   Q = R E,   Ω̃ = Eᵀ Ω + T(θ) β_θ η̇
//! δ(X, ψ̃) = G δ(x, ψ, η),      G = [ 1  −R a×  R β_u ;  0  Eᵀ  T β_θ ]
//! ```
//!
//! The element sees a body with these motions; forces on it act on the carrier by Gᵀ, their tangents by Gᵀ K G and the
//! change of Gᵀ at a constant force. In derivatives of T(θ) it is taken as 1 − ½ θ×: θ is the small turn of an elastic
//! body, and forces are exact.

use nalgebra::{DMatrix, DVector, Matrix3, SVector, Vector3};

use crate::rotation::{self, skew};
use crate::state::BodyMotion;

/// A frame on a body with modes that moves with them.
#[derive(Debug, Clone, PartialEq)]
pub struct MovingEnd {
    /// Its origin on the body at rest, body axes \[m\].
    pub place_m: Vector3<f64>,
    /// Displacement and turn of the frame, body axes, per modal coordinate: 6 × modes \[m/(√kg·m), rad/(√kg·m)\].
    pub shapes: DMatrix<f64>,
}

/// The frame at a motion of its body.
pub(crate) struct MovedEnd {
    pub motion: BodyMotion,
    /// G, 6 × (6 + modes).
    pub jacobian: DMatrix<f64>,
    /// How its velocities change with the carrier's increments at constant velocities.
    pub rate_jacobian: DMatrix<f64>,
    rotation: Matrix3<f64>,
    turn: Matrix3<f64>,
    tangent: Matrix3<f64>,
    arm_m: Vector3<f64>,
}

impl MovingEnd {
    /// Where the frame is and how it moves.
    pub(crate) fn moved(&self, body: &BodyMotion, eta: &[f64], rates: &[f64]) -> MovedEnd {
        let modal = |values: &[f64]| {
            let value = |i: usize| values.get(i).copied().unwrap_or_default();
            DVector::from_fn(self.shapes.ncols(), |i, _| value(i))
        };
        let (eta, rates) = (modal(eta), modal(rates));
        let three = |all: &DVector<f64>, first: usize| -> Vector3<f64> {
            all.fixed_rows::<3>(first).into_owned()
        };
        let (moved, moving) = (&self.shapes * eta, &self.shapes * rates);
        let arm_m = self.place_m + three(&moved, 0);
        let theta = three(&moved, 3);
        let quaternion = rotation::exp(&theta);
        let turn = *quaternion.to_rotation_matrix().matrix();
        let tangent = rotation::tangent(&theta);
        let omega = body.angular_velocity_rad_per_s;
        let slip = omega.cross(&arm_m) + three(&moving, 0);
        let spin = turn.tr_mul(&omega);
        let (by_u, by_theta) = (self.shapes.rows(0, 3), self.shapes.rows(3, 3));
        let r = body.rotation;
        let modes = self.shapes.ncols();
        let mut jacobian = DMatrix::zeros(6, 6 + modes);
        let mut rate_jacobian = DMatrix::zeros(6, 6 + modes);
        let blocks = [
            ((0, 0), Matrix3::identity()),
            ((0, 3), -r * skew(&arm_m)),
            ((3, 3), turn.transpose()),
        ];
        for (at, block) in blocks {
            jacobian.view_mut(at, (3, 3)).copy_from(&block);
        }
        jacobian.view_mut((0, 6), (3, modes)).copy_from(&(r * by_u));
        let turning = tangent * by_theta;
        jacobian.view_mut((3, 6), (3, modes)).copy_from(&turning);
        let by_turn = -r * skew(&slip);
        rate_jacobian.view_mut((0, 3), (3, 3)).copy_from(&by_turn);
        let by_eta = r * skew(&omega) * by_u;
        rate_jacobian
            .view_mut((0, 6), (3, modes))
            .copy_from(&by_eta);
        let by_eta = skew(&spin) * turning + 0.5 * skew(&three(&moving, 3)) * by_theta;
        rate_jacobian
            .view_mut((3, 6), (3, modes))
            .copy_from(&by_eta);
        MovedEnd {
            motion: BodyMotion {
                position_m: body.position_m + r * arm_m,
                orientation: body.orientation * quaternion,
                rotation: r * turn,
                velocity_m_per_s: body.velocity_m_per_s + r * slip,
                angular_velocity_rad_per_s: spin + tangent * three(&moving, 3),
            },
            jacobian,
            rate_jacobian,
            rotation: r,
            turn,
            tangent,
            arm_m,
        }
    }

    /// ∂(Gᵀ f)/∂(carrier's increments) at a constant force f (world axes) and moment (the frame's axes).
    pub(crate) fn geometric_tangent(&self, at: &MovedEnd, force: &SVector<f64, 6>) -> DMatrix<f64> {
        let f = skew(&at.rotation.tr_mul(&force.fixed_rows::<3>(0)));
        let moment = skew(&force.fixed_rows::<3>(3).into_owned());
        let (by_u, by_theta) = (self.shapes.rows(0, 3), self.shapes.rows(3, 3));
        let modes = self.shapes.ncols();
        let mut tangent = DMatrix::zeros(6 + modes, 6 + modes);
        let own = skew(&at.arm_m) * f;
        tangent.view_mut((3, 3), (3, 3)).copy_from(&own);
        let by_eta = -f * by_u - at.turn * moment * (at.tangent * by_theta);
        tangent.view_mut((3, 6), (3, modes)).copy_from(&by_eta);
        let by_turn = by_u.tr_mul(&f);
        tangent.view_mut((6, 3), (modes, 3)).copy_from(&by_turn);
        let curved = -0.5 * by_theta.tr_mul(&(moment * by_theta));
        tangent.view_mut((6, 6), (modes, modes)).copy_from(&curved);
        tangent
    }
}
