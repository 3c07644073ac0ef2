//! Coulomb friction between flanks with a static and a dynamic coefficient, regularised in the sliding velocity as in
//! ADAMS.
//!
//! ```text
//! T = −μ(v) F,   v: sliding velocity of gear 2 over gear 1 along w⊥
//! μ runs by STEP from −μ_s at −v_s to μ_s at v_s, then to μ_d at v_d; odd in v
//! ```
//!
//! The contact of tooth k₁ stands at P = σ r_b1 w⊥ + r_b1 ξ₁ w from gear 1's axis, so that v = k·(u̇, ω) and the load
//! is T k with
//!
//! ```text
//! k = (w⊥, (P − u) × w⊥),   ∂k: dω = w⊥·dd/L,   dw⊥ = −w dω,   dP = r_b1 ξ₁ w⊥ dω
//! ```
//!
//! where what falls to zero with the tilt is left out of ∂k.
//!
//! Flanks that slide along the teeth as well (bevel gears) have two tangents: with v_i = k_i·(u̇, ω) the load is −F Σ
//! w_i k_i, w = μ(|v|) v/|v|, and ∂w_i/∂v_j = μ′ e_i e_j + (μ/|v|)(δ_ij − e_i e_j), e = v/|v|.

use nalgebra::Vector3;

use crate::error::{DrivetrainError, not_negative, positive};
use crate::flank_kinematics::Tangent;
use crate::mesh_frame::MeshFrame;
use crate::pose::{Vector6, stacked};
use crate::slice_plane::{Matrix6, SlicePlane};
use crate::step::step;

/// Coefficients and transition speeds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Friction {
    static_coefficient: f64,
    dynamic_coefficient: f64,
    static_speed_m_per_s: f64,
    dynamic_speed_m_per_s: f64,
}

impl Friction {
    /// Static coefficient at its speed and dynamic coefficient from its speed on.
    ///
    /// # Errors
    /// [`DrivetrainError::Value`] if a coefficient is negative, the static one below the dynamic one, a speed not
    /// positive, or the dynamic speed not above the static one.
    pub fn new(
        [static_coefficient, dynamic_coefficient]: [f64; 2],
        [static_speed_m_per_s, dynamic_speed_m_per_s]: [f64; 2],
    ) -> Result<Self, DrivetrainError> {
        let owner = "tooth friction";
        not_negative(owner, "the dynamic coefficient", dynamic_coefficient)?;
        not_negative(owner, "the static coefficient", static_coefficient)?;
        positive(
            owner,
            "the static transition speed in m/s",
            static_speed_m_per_s,
        )?;
        positive(
            owner,
            "the dynamic transition speed in m/s",
            dynamic_speed_m_per_s,
        )?;
        DrivetrainError::require(
            owner,
            ("the static coefficient", static_coefficient),
            static_coefficient >= dynamic_coefficient,
            "at least the dynamic coefficient",
        )?;
        DrivetrainError::require(
            owner,
            ("the dynamic transition speed in m/s", dynamic_speed_m_per_s),
            dynamic_speed_m_per_s > static_speed_m_per_s,
            "above the static transition speed",
        )?;
        Ok(Self {
            static_coefficient,
            dynamic_coefficient,
            static_speed_m_per_s,
            dynamic_speed_m_per_s,
        })
    }

    /// μ(v) and dμ/dv \[s/m\].
    #[must_use]
    pub fn coefficient(&self, sliding_m_per_s: f64) -> (f64, f64) {
        let speed = sliding_m_per_s.abs();
        let (vs, vd) = (self.static_speed_m_per_s, self.dynamic_speed_m_per_s);
        let (mu_s, mu_d) = (self.static_coefficient, self.dynamic_coefficient);
        let (value, slope) = if speed <= vs {
            step(speed, [-vs, -mu_s], [vs, mu_s])
        } else {
            step(speed, [vs, mu_s], [vd, mu_d])
        };
        (value.copysign(sliding_m_per_s), slope)
    }
}

/// Friction on gear 2 for a normal force of one newton, along one or two tangents.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Drag {
    /// μ at the speed of sliding: signed along one tangent, positive in a plane.
    pub coefficient: f64,
    /// How many tangents there are.
    pub tangents: usize,
    /// Friction along the tangents.
    pub shares: [f64; 2],
    /// Its derivatives by the speeds along them \[s/m\].
    pub share_by_speed: [[f64; 2]; 2],
    /// k.
    pub directions: [Vector6; 2],
    /// Derivatives of the speeds by the increments of the pose; zero unless asked for, as those below.
    pub speeds_by_pose: [Vector6; 2],
    pub load: Vector6,
    pub by_position: Matrix6,
    pub by_velocity: Matrix6,
    pub dissipated_w: f64,
}

impl Friction {
    /// Against the sliding along one tangent, or in the plane of two at right angles, with what vibration of the gears
    /// adds to the sliding along each \[m/s\].
    pub(crate) fn along(
        &self,
        tangents: &[Option<Tangent>; 2],
        vibration_m_per_s: impl Fn(usize) -> f64,
        rates: &Vector6,
    ) -> Drag {
        let count = tangents.iter().flatten().count();
        let mut speeds = [0.0; 2];
        let mut found = Drag {
            coefficient: 0.0,
            tangents: count,
            shares: [0.0; 2],
            share_by_speed: [[0.0; 2]; 2],
            directions: [Vector6::zeros(); 2],
            speeds_by_pose: [Vector6::zeros(); 2],
            load: Vector6::zeros(),
            by_position: Matrix6::zeros(),
            by_velocity: Matrix6::zeros(),
            dissipated_w: 0.0,
        };
        for (i, tangent) in tangents.iter().flatten().enumerate() {
            speeds[i] = tangent.direction.dot(rates) + vibration_m_per_s(i);
            found.directions[i] = tangent.direction;
            if let Some(change) = &tangent.change {
                found.speeds_by_pose[i] = change.tr_mul(rates);
            }
        }
        if count == 1 {
            let (mu, slope) = self.coefficient(speeds[0]);
            found.coefficient = mu;
            found.shares[0] = -mu;
            found.share_by_speed[0][0] = -slope;
        } else {
            self.in_plane(speeds, &mut found);
        }
        for (i, tangent) in tangents.iter().flatten().enumerate() {
            let (k, share) = (&tangent.direction, found.shares[i]);
            found.load += share * k;
            found.dissipated_w -= share * speeds[i];
            let Some(change) = &tangent.change else {
                continue;
            };
            found.by_position += share * change;
            for j in 0..count {
                let by_speed = found.share_by_speed[i][j] * k;
                found.by_position += by_speed * found.speeds_by_pose[j].transpose();
                found.by_velocity += by_speed * found.directions[j].transpose();
            }
        }
        found
    }

    /// Shares along two tangents and their derivatives.
    fn in_plane(&self, speeds: [f64; 2], found: &mut Drag) {
        let speed = speeds[0].hypot(speeds[1]);
        let (mu, slope) = self.coefficient(speed);
        // At rest the secant μ/v is the slope, and any direction will do.
        let (e, secant) = if speed > f64::MIN_POSITIVE {
            (speeds.map(|v| v / speed), mu / speed)
        } else {
            ([1.0, 0.0], slope)
        };
        found.coefficient = mu;
        found.shares = e.map(|e| -mu * e);
        found.share_by_speed = [0, 1].map(|i: usize| {
            [0, 1].map(|j: usize| {
                let own = f64::from(u8::from(i == j));
                -(slope * e[i] * e[j] + secant * (own - e[i] * e[j]))
            })
        });
    }
}

/// A contact in a slice plane.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SlidingAt<'a> {
    pub frame: &'a MeshFrame,
    pub plane: &'a SlicePlane,
    /// σ.
    pub sigma: f64,
    /// On gear 1, on whose flank the contact is taken.
    pub roll_rad: f64,
}

impl SlidingAt<'_> {
    /// P − u.
    fn arm(&self) -> Vector3<f64> {
        let (frame, plane) = (self.frame, self.plane);
        let along = self.sigma * plane.across + self.roll_rad * plane.normal;
        let [r1, _] = frame.circles.radii_m;
        plane.axis_heights_m[0] * Vector3::z() - frame.displacement_m + r1 * along
    }

    /// k: load of a unit friction force on gear 2.
    pub(crate) fn direction(&self) -> Vector6 {
        let w = self.plane.across;
        stacked(w, self.arm().cross(&w))
    }

    /// ∂k/∂(u, ϑ), shape 6×6.
    pub(crate) fn direction_gradient(&self) -> Matrix6 {
        let turn = self.plane.turn(self.frame);
        let moment = self.arm().cross(&self.plane.normal);
        let mut g = -stacked(self.plane.normal, moment) * turn.transpose();
        let mut lower = g.fixed_view_mut::<3, 3>(3, 0);
        lower += self.plane.across.cross_matrix();
        g
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    #[test]
    fn coefficient_is_odd_smooth_and_has_its_values() {
        let friction = Friction::new([0.3, 0.2], [1e-3, 1e-2]).unwrap();
        for (v, mu) in [(1e-3, 0.3), (1e-2, 0.2), (1.0, 0.2), (0.0, 0.0)] {
            assert!((friction.coefficient(v).0 - mu).abs() < 1e-15);
            assert!((friction.coefficient(-v).0 + mu).abs() < 1e-15);
        }
        for v in [-5e-3, -4e-4, 0.0, 3e-4, 7e-3] {
            let h = 1e-8;
            let change = friction.coefficient(v + h).0 - friction.coefficient(v - h).0;
            let slope = friction.coefficient(v).1;
            assert!((change / (2.0 * h) - slope).abs() < 1e-3 * 450.0, "{v}");
        }
    }

    #[test]
    fn coefficients_out_of_order_are_refused() {
        for (mu, v) in [
            ([0.1, 0.2], [1e-3, 1e-2]),
            ([0.3, 0.2], [1e-2, 1e-3]),
            ([0.3, -0.1], [1e-3, 1e-2]),
            ([0.3, 0.2], [0.0, 1e-2]),
        ] {
            assert!(Friction::new(mu, v).is_err(), "{mu:?} {v:?}");
        }
    }
}
