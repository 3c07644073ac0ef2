//! A row of balls between grooves of two arcs each: four-point contact bearings.
//!
//! Each ring's groove is made of two circular arcs whose centres stand (f − ½) D sin α aside of the middle plane, so
//! that a ball that just touches all four arcs does so at the angle α. Arcs end where they meet, in the middle plane.
//! docs/theory/rolling_bearings.md.

use crate::groove::Groove;
use crate::operation::Operation;

/// One arc of a ring's groove.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arc {
    /// The torus that it is a part of.
    pub groove: Groove,
    /// 1 where contact angles are positive, −1 where they are negative.
    pub side: f64,
    /// Sine of the contact angle at which the arc ends, in the sense of its side; below it the other arc is there.
    pub end_sine: f64,
}

impl Arc {
    /// Whether a contact at the angle with this cosine and sine lies on the arc.
    #[inline]
    pub(crate) fn reaches(&self, cosine: f64, sine: f64) -> bool {
        // Where both arcs are one (end at zero) a contact in the middle plane belongs to one of them.
        let along = self.side * sine;
        cosine > 0.0 && (along > self.end_sine || (along == self.end_sine && self.side > 0.0))
    }
}

/// A row of balls.
#[derive(Debug, Clone, PartialEq)]
pub struct FourPointRow {
    /// Number of balls.
    pub balls: usize,
    /// D \[m\].
    pub ball_diameter_m: f64,
    /// d_m/2 \[m\].
    pub pitch_radius_m: f64,
    /// Mass of a ball \[kg\].
    pub ball_mass_kg: f64,
    /// Plane of the balls' centres without load \[m\].
    pub middle_z_m: f64,
    /// Arcs of the inner ring, in its frame: of positive, then of negative contact angles.
    pub inner: [Arc; 2],
    /// Arcs of the outer ring.
    pub outer: [Arc; 2],
    /// α \[rad\].
    pub free_angle_rad: f64,
    /// Angle of the first ball \[rad\].
    pub first_angle_rad: f64,
}

impl FourPointRow {
    /// Angle of a ball \[rad\].
    #[must_use]
    pub fn angle_rad(&self, ball: usize, operation: &Operation) -> f64 {
        operation.element_angle_rad(self.first_angle_rad, ball, self.balls)
    }

    /// Speed of the cage \[rad/s\]: pure rolling at the angle α, (ω_i (1 − γ) + ω_o (1 + γ))/2, γ = D cos α/d_m.
    pub(crate) fn orbit_rad_per_s(&self, operation: &Operation) -> f64 {
        let gamma = 0.5 * self.ball_diameter_m * self.free_angle_rad.cos() / self.pitch_radius_m;
        0.5 * (operation.inner_rad_per_s * (1.0 - gamma)
            + operation.outer_rad_per_s * (1.0 + gamma))
    }
}
