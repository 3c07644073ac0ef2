//! Coulomb friction between flanks with a static and a dynamic coefficient, regularised in the sliding velocity as in ADAMS.
//!
//! ```text
//! T = −μ(v) F,   v: sliding velocity of gear 2 over gear 1 along w⊥
//! μ runs by STEP from −μ_s at −v_s to μ_s at v_s, then to μ_d at v_d; odd in v
//! ```
//!
//! The contact of tooth k₁ stands at P = σ r_b1 w⊥ + r_b1 ξ₁ w from gear 1's axis, so that v = k·(u̇, ω) and the load is T k with
//!
//! ```text
//! k = (w⊥, (P − u) × w⊥),   ∂k: dω = w⊥·dd/L,   dw⊥ = −w dω,   dP = r_b1 ξ₁ w⊥ dω
//! ```

use nalgebra::Vector3;

use crate::error::{DrivetrainError, not_negative, positive};
use crate::pose::{Pose, Vector6};
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
    /// [`DrivetrainError::Value`] if a coefficient is negative, the static one below the dynamic one, a speed not positive, or the dynamic
    /// speed not above the static one.
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
        let out_of_order = |what, found, allowed| DrivetrainError::Value {
            owner,
            what,
            found,
            allowed,
        };
        if static_coefficient < dynamic_coefficient {
            return Err(out_of_order(
                "the static coefficient",
                static_coefficient,
                "at least the dynamic coefficient",
            ));
        }
        if dynamic_speed_m_per_s <= static_speed_m_per_s {
            return Err(out_of_order(
                "the dynamic transition speed in m/s",
                dynamic_speed_m_per_s,
                "above the static transition speed",
            ));
        }
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

/// Where two flanks of rigid gears touch and how they slide.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sliding {
    /// k: direction of the load of a unit friction force on gear 2.
    pub direction: Vector6,
    /// v \[m/s\].
    pub speed_m_per_s: f64,
}

impl Sliding {
    fn arm(
        plane: &SlicePlane,
        pose: &Pose,
        sigma: f64,
        (base_radius_1_m, roll_1_rad): (f64, f64),
    ) -> Vector3<f64> {
        base_radius_1_m * (sigma * plane.across + roll_1_rad * plane.normal)
            + Vector3::new(0.0, 0.0, plane.z_m)
            - pose.displacement_m
    }

    /// The sliding of a contact in a plane, on gear 1 at roll angle ξ₁; `sigma` is +1 for right flanks.
    #[must_use]
    pub fn new(plane: &SlicePlane, pose: &Pose, sigma: f64, on_gear_1: (f64, f64)) -> Self {
        let moment = Self::arm(plane, pose, sigma, on_gear_1).cross(&plane.across);
        let w = plane.across;
        let direction = Vector6::new(w[0], w[1], w[2], moment[0], moment[1], moment[2]);
        Self {
            direction,
            speed_m_per_s: direction.dot(&pose.rates()),
        }
    }

    /// ∂k/∂(u, ϑ), shape 6×6.
    #[must_use]
    pub fn direction_gradient(
        plane: &SlicePlane,
        pose: &Pose,
        sigma: f64,
        on_gear_1: (f64, f64),
    ) -> Matrix6 {
        let turned_by_shift = plane.across / plane.length_m;
        let turned_by_tilt = plane.z_m * pose.axis_2().cross(&turned_by_shift);
        let arm = Self::arm(plane, pose, sigma, on_gear_1);
        let moment = arm.cross(&plane.normal);
        let mut g = Matrix6::zeros();
        for (start, turned) in [(0, turned_by_shift), (3, turned_by_tilt)] {
            g.fixed_view_mut::<3, 3>(0, start)
                .copy_from(&(-plane.normal * turned.transpose()));
            g.fixed_view_mut::<3, 3>(3, start)
                .copy_from(&(-moment * turned.transpose()));
        }
        let mut lower = g.fixed_view_mut::<3, 3>(3, 0);
        lower += plane.across.cross_matrix();
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
