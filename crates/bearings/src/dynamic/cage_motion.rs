//! How a cage moves in its bearing, for output: where its middle is, how fast it turns, how fast its middle goes round.

use gearmesh_dynamics::BodyMotion;
use gearmesh_dynamics::elements::Channel;
use nalgebra::{Matrix3, Vector3};

/// Number of the channels of a cage.
pub(super) const CAGE_MOTION: usize = 4;

/// Names, units and meaning.
pub(super) fn cage_motion_channels(cage: usize) -> [Channel; CAGE_MOTION] {
    let from = "of the cage's middle from the outer ring's, axes of the outer ring";
    [
        ("x_m", "m", format!("place along x {from}")),
        ("y_m", "m", format!("place along y {from}")),
        (
            "speed_ratio",
            "1",
            "speed of the cage over that of the inner ring, both against the outer ring; 0 where that stands".to_owned(),
        ),
        (
            "whirl_rad_per_s",
            "rad/s",
            "angular speed of the cage's middle about the outer ring's axis; 0 in the middle".to_owned(),
        ),
    ]
    .map(|(name, unit, what)| Channel::new(format!("cage_{cage}_{name}"), unit, what))
}

/// A frame that moves: middle, its velocity, axes (z that of the bearing), angular velocity about z \[rad/s\].
pub(super) struct Seen {
    pub middle: Vector3<f64>,
    pub velocity: Vector3<f64>,
    pub axes: Matrix3<f64>,
    pub spin_rad_per_s: f64,
}

/// The values: e and ė are place and velocity of the middle across the axis, whirl (e × ė)·a/|e|².
pub(super) fn cage_motion(
    outer: &Seen,
    inner_rad_per_s: f64,
    cage: &BodyMotion,
) -> [f64; CAGE_MOTION] {
    let axis: Vector3<f64> = outer.axes.column(2).into();
    let place = outer.axes.tr_mul(&(cage.position_m - outer.middle));
    let rate = outer.axes.tr_mul(&(cage.velocity_m_per_s - outer.velocity));
    let turning = (cage.rotation * cage.angular_velocity_rad_per_s).dot(&axis);
    let relative = inner_rad_per_s - outer.spin_rad_per_s;
    let square = place.x * place.x + place.y * place.y;
    let share = |above: f64, below: f64| if below == 0.0 { 0.0 } else { above / below };
    [
        place.x,
        place.y,
        share(turning - outer.spin_rad_per_s, relative),
        share(place.x * rate.y - place.y * rate.x, square),
    ]
}
