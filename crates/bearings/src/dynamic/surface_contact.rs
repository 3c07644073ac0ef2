//! Force between a ball and a surface, with all its derivatives in the surface's own frame.
//!
//! The surface is told by the approach δ(w) of a ball whose centre stands at w in the frame of the surface, by its gradient n (towards the surface)
//! and by its second derivatives N. With u the velocity of the ball's centre against that frame and σ its spin against it,
//!
//! ```text
//! δ̇ = n·u,   s = u − δ̇ n + (D/2) σ × n              slip
//! f = −F n − κ s,   m = (D/2) n × (−κ s)             on the ball, moment about its centre; F = F(δ, δ̇), κ = κ(F, |s|)
//! ```

use nalgebra::{Matrix3, Vector3};

use super::contact_damping::DampedLoad;
use super::traction::Slip;
use crate::ring_pose::cross;

/// Where a ball stands against a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Touch {
    /// δ \[m\].
    pub approach_m: f64,
    /// n = ∂δ/∂w.
    pub normal: Vector3<f64>,
    /// N = ∂n/∂w \[1/m\], symmetric.
    pub turning: Matrix3<f64>,
}

/// An elastic load: value, slope and energy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ElasticLoad {
    pub load_n: f64,
    pub slope_n_per_m: f64,
    pub stored_j: f64,
}

/// Motion of a ball against the frame of a surface, world axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Against {
    /// u \[m/s\].
    pub velocity: Vector3<f64>,
    /// σ \[rad/s\].
    pub spin: Vector3<f64>,
    /// D/2 \[m\].
    pub ball_radius_m: f64,
}

/// Derivatives of a vector by (w, u, σ).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ByMotion {
    pub place: Matrix3<f64>,
    pub velocity: Matrix3<f64>,
    pub spin: Matrix3<f64>,
}

impl ByMotion {
    pub const ZERO: Self = Self {
        place: Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        velocity: Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
        spin: Matrix3::new(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    };
}

/// Force and moment on a ball.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SurfaceForce {
    /// F \[N\], not negative.
    pub load_n: f64,
    pub force: Vector3<f64>,
    pub moment: Vector3<f64>,
    pub stored_j: f64,
    pub dissipated_w: f64,
    pub force_by: ByMotion,
    pub moment_by: ByMotion,
}

/// The force at a touch. `damped` gives F of the rate δ̇, `traction` κ of a load and a slip; none: no friction.
pub(crate) fn surface_force(
    touch: &Touch,
    damped: impl Fn(f64) -> DampedLoad,
    against: &Against,
    traction: Option<impl Fn(f64, f64) -> Slip>,
    tangents: bool,
) -> SurfaceForce {
    let (n, u) = (touch.normal, against.velocity);
    let rate = n.dot(&u);
    let damped = damped(rate);
    let load = damped.load_n;
    let mut found = SurfaceForce {
        load_n: load,
        force: -n * load,
        moment: Vector3::zeros(),
        stored_j: damped.stored_j,
        dissipated_w: (load - damped.elastic_n) * rate,
        force_by: ByMotion::ZERO,
        moment_by: ByMotion::ZERO,
    };
    // ∂F by w and by u.
    let rate_by_place = touch.turning * u;
    let load_by_place = n * damped.by_depth + rate_by_place * damped.by_rate;
    let load_by_velocity = n * damped.by_rate;
    if tangents {
        found.force_by.place = -n * load_by_place.transpose() - touch.turning * load;
        found.force_by.velocity = -n * load_by_velocity.transpose();
    }
    let Some(traction) = traction else {
        return found;
    };
    let arm = against.ball_radius_m;
    let slip = u - n * rate + against.spin.cross(&n) * arm;
    let law = traction(load, slip.norm());
    let drag = -slip * law.resistance;
    found.force += drag;
    found.moment = n.cross(&drag) * arm;
    found.dissipated_w += law.resistance * slip.norm_squared();
    if tangents {
        let slip_by = ByMotion {
            place: -n * rate_by_place.transpose() - touch.turning * rate
                + cross(&against.spin) * touch.turning * arm,
            velocity: Matrix3::identity() - n * n.transpose(),
            spin: cross(&n) * -arm,
        };
        let along = slip * law.by_half_square;
        let of = |by_slip: &Matrix3<f64>, load_by: &Vector3<f64>| {
            -by_slip * law.resistance
                - slip * (by_slip.tr_mul(&along) + load_by * law.by_load).transpose()
        };
        let drag_by = ByMotion {
            place: of(&slip_by.place, &load_by_place),
            velocity: of(&slip_by.velocity, &load_by_velocity),
            spin: of(&slip_by.spin, &Vector3::zeros()),
        };
        let lever = cross(&n) * arm;
        found.force_by.place += drag_by.place;
        found.force_by.velocity += drag_by.velocity;
        found.force_by.spin = drag_by.spin;
        found.moment_by = ByMotion {
            place: lever * drag_by.place - cross(&drag) * touch.turning * arm,
            velocity: lever * drag_by.velocity,
            spin: lever * drag_by.spin,
        };
    }
    found
}
