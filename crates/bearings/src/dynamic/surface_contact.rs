//! Force between a ball and a surface, with all its derivatives in the surface's own frame.
//!
//! The surface is given by the approach δ(w) of a ball whose centre stands at w in the frame of the surface, by its
//! gradient n (towards the surface) and by its second derivatives N. With u the velocity of the ball's centre against
//! that frame and σ its spin against it,
//!
//! ```text
//! δ̇ = n·u,   s = u − δ̇ n + (D/2) σ × n              slip
//! f = −F n − κ s,   m = (D/2) n × (−κ s)             on the ball, moment about its centre; F = F(δ, δ̇), κ = κ(F, |s|)
//! ```

use nalgebra::{Matrix3, Vector3};

use super::contact_damping::DampedLoad;
use super::traction::Slip;

/// Where a ball stands against a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Touch {
    /// δ \[m\].
    pub approach_m: f64,
    /// n = ∂δ/∂w.
    pub normal: Vector3<f64>,
    /// N = ∂n/∂w \[1/m\], symmetric.
    pub turning: Matrix3<f64>,
    /// How the approach depends on the ball's rotation; none for a sphere.
    pub by_turn: Option<ByTurn>,
}

/// Derivatives of an approach by the rotation φ of the ball.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ByTurn {
    /// τ \[m\].
    pub first: Vector3<f64>,
    /// ∂n/∂φ.
    pub place: Matrix3<f64>,
    /// ∂τ/∂φ \[m\].
    pub turn: Matrix3<f64>,
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
    /// Derivatives of force and moment by φ.
    pub by_turn: Option<[Matrix3<f64>; 2]>,
}

impl SurfaceForce {
    pub const NONE: Self = Self {
        load_n: 0.0,
        force: Vector3::new(0.0, 0.0, 0.0),
        moment: Vector3::new(0.0, 0.0, 0.0),
        stored_j: 0.0,
        dissipated_w: 0.0,
        force_by: ByMotion::ZERO,
        moment_by: ByMotion::ZERO,
        by_turn: None,
    };
}

/// Sets the force at a touch. `damped` gives F of the rate δ̇, `traction` κ of a load and a slip; none: no friction.
/// Without `tangents` the derivatives in `found` keep what they were: with all of them it is large, and moving it took
/// an eighth of a run.
#[inline]
pub(crate) fn surface_force(
    touch: &Touch,
    damped: impl Fn(f64) -> DampedLoad,
    against: &Against,
    traction: Option<impl Fn(f64, f64) -> Slip>,
    tangents: bool,
    found: &mut SurfaceForce,
) {
    let (n, u) = (touch.normal, against.velocity);
    let across = n.dot(&u);
    let by_turn = touch.by_turn.as_ref();
    let rate = across + by_turn.map_or(0.0, |by| by.first.dot(&against.spin));
    let damped = damped(rate);
    let load = damped.load_n;
    found.load_n = load;
    found.force = -n * load;
    found.moment = by_turn.map_or_else(Vector3::zeros, |by| by.first * -load);
    found.stored_j = damped.stored_j;
    found.dissipated_w = (load - damped.elastic_n) * rate;
    // ∂F by w and by u.
    let mut rate_by_place = touch.turning * u;
    if let Some(by) = by_turn {
        rate_by_place += by.place * against.spin;
    }
    let load_by = LoadBy {
        place: n * damped.by_depth + rate_by_place * damped.by_rate,
        velocity: n * damped.by_rate,
    };
    if tangents {
        found.force_by = ByMotion {
            place: -n * load_by.place.transpose() - touch.turning * load,
            velocity: -n * load_by.velocity.transpose(),
            spin: Matrix3::zeros(),
        };
        found.moment_by = ByMotion::ZERO;
        found.by_turn = None;
    }
    let mut drag = None;
    if let Some(traction) = traction {
        let arm = against.ball_radius_m;
        let square = n.norm_squared();
        let slip = u - n * (across / square) + against.spin.cross(&n) * arm;
        let law = traction(load, slip.norm());
        let force = -slip * law.resistance;
        found.force += force;
        found.moment += n.cross(&force) * arm;
        found.dissipated_w += law.resistance * slip.norm_squared();
        if tangents {
            let here = Drag {
                slip,
                law,
                force,
                arm,
                by_normal: n * (n * (2.0 * across / square) - u).transpose() / square
                    - Matrix3::identity() * (across / square)
                    + against.spin.cross_matrix() * arm,
            };
            here.add(touch, &load_by, found);
            drag = Some(here);
        }
    }
    if let (true, Some(by)) = (tangents, by_turn) {
        let rate_by_turn = by.place.tr_mul(&u) + by.turn.tr_mul(&against.spin);
        let by_turn = by.first * damped.by_depth + rate_by_turn * damped.by_rate;
        let by_spin = by.first * damped.by_rate;
        add_turn(
            touch,
            by,
            (load, &load_by),
            (&by_turn, &by_spin),
            &drag,
            found,
        );
    }
}

/// ∂F by w and u.
struct LoadBy {
    place: Vector3<f64>,
    velocity: Vector3<f64>,
}

/// Friction at a touch.
struct Drag {
    slip: Vector3<f64>,
    law: Slip,
    force: Vector3<f64>,
    arm: f64,
    /// ∂s/∂n.
    by_normal: Matrix3<f64>,
}

impl Drag {
    /// How the friction follows the slip and the load.
    fn follow(&self, by_slip: &Matrix3<f64>, load_by: &Vector3<f64>) -> Matrix3<f64> {
        let along = self.slip * self.law.by_half_square;
        -by_slip * self.law.resistance
            - self.slip * (by_slip.tr_mul(&along) + load_by * self.law.by_load).transpose()
    }

    fn add(&self, touch: &Touch, load_by: &LoadBy, found: &mut SurfaceForce) {
        let n = touch.normal;
        let slip_by = ByMotion {
            place: self.by_normal * touch.turning,
            velocity: Matrix3::identity() - n * n.transpose() / n.norm_squared(),
            spin: n.cross_matrix() * -self.arm,
        };
        let drag_by = ByMotion {
            place: self.follow(&slip_by.place, &load_by.place),
            velocity: self.follow(&slip_by.velocity, &load_by.velocity),
            spin: self.follow(&slip_by.spin, &Vector3::zeros()),
        };
        let lever = n.cross_matrix() * self.arm;
        found.force_by.place += drag_by.place;
        found.force_by.velocity += drag_by.velocity;
        found.force_by.spin = drag_by.spin;
        found.moment_by = ByMotion {
            place: lever * drag_by.place - self.force.cross_matrix() * touch.turning * self.arm,
            velocity: lever * drag_by.velocity,
            spin: lever * drag_by.spin,
        };
    }
}

/// Derivatives that a ball has whose approach depends on its rotation; `load_by_own` are those of F by φ and by the
/// spin.
fn add_turn(
    touch: &Touch,
    by: &ByTurn,
    (load, load_by): (f64, &LoadBy),
    (load_by_turn, load_by_spin): (&Vector3<f64>, &Vector3<f64>),
    drag: &Option<Drag>,
    found: &mut SurfaceForce,
) {
    let n = touch.normal;
    let mut force = -n * load_by_turn.transpose() - by.place * load;
    let mut moment = -by.first * load_by_turn.transpose() - by.turn * load;
    found.force_by.spin -= n * load_by_spin.transpose();
    found.moment_by.place -= by.first * load_by.place.transpose() + by.place.transpose() * load;
    found.moment_by.velocity -= by.first * load_by.velocity.transpose();
    found.moment_by.spin -= by.first * load_by_spin.transpose();
    if let Some(drag) = drag {
        let lever = n.cross_matrix() * drag.arm;
        let by_turn = drag.follow(&(drag.by_normal * by.place), load_by_turn);
        force += by_turn;
        moment += lever * by_turn - drag.force.cross_matrix() * by.place * drag.arm;
        // The load follows the spin, too.
        let by_spin = drag.slip * (load_by_spin * -drag.law.by_load).transpose();
        found.force_by.spin += by_spin;
        found.moment_by.spin += lever * by_spin;
    }
    found.by_turn = Some([force, moment]);
}
