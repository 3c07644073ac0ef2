//! A root of one radius: the arc that touches both flanks of a tooth space and the root circle, as broaches have it.
//!
//! Its centre lies on the middle of the space at r_f − ρ of a ring, and the distance to the flank is ρ. The curve at
//! the distance ρ from an involute is an involute of the same base circle, turned by ρ/r_b; hence ρ of a space of half
//! angle ψ_s on the base circle solves
//!
//! ψ_s − ρ/r_b − inv α(r_f − ρ) = 0.
//!
//! The left side falls with ρ, for d(inv α)/dr = sin α/r_b, and there is one solution.

use std::f64::consts::FRAC_PI_2;

/// The arc on the right flank's side of the space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FullRound {
    /// Radius at which the arc's centre lies \[m\].
    pub centre_radius_m: f64,
    /// Radius ρ of the arc \[m\].
    pub radius_m: f64,
    /// Polar angle of the tooth space's centre \[rad\].
    pub space_angle_rad: f64,
}

impl FullRound {
    /// Point \[x, y\] \[m\] at an angle from the middle of the space \[rad\], seen from the arc's centre.
    pub fn point_m(&self, angle_rad: f64) -> [f64; 2] {
        let (s, c) = self.space_angle_rad.sin_cos();
        let (sin, cos) = (self.space_angle_rad + angle_rad).sin_cos();
        [
            self.centre_radius_m * c + self.radius_m * cos,
            self.centre_radius_m * s + self.radius_m * sin,
        ]
    }

    /// See [`super::Fillet::tangent_angle_rad`]; the tip of a ring's tooth points to the axis.
    pub fn tangent_angle_rad(&self, angle_rad: f64) -> f64 {
        FRAC_PI_2 - self.space_angle_rad - angle_rad
    }
}
