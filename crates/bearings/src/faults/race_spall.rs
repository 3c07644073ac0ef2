//! Material lost from a patch of a race.
//!
//! With ψ the ball's angle in the ring's own axes, α its contact angle, ρ the radius on which the contact runs round
//! the axis and r that of the groove,
//!
//! ```text
//! h(ψ, α) = d' S_L(ρ (ψ − ψ₀)) S_W(r (α − α₀)),   d' = min(d, L²/(8R_L), W²/(8R_W))                       (17)
//! ```
//!
//! is what the approach of ball and race lacks there; S of `smooth_edge.rs`. Between its rims a rigid ball sinks no
//! deeper than d'.

use std::f64::consts::{PI, TAU};

use super::smooth_edge::{SmoothEdge, entry_m, reached_m};
use crate::groove::Groove;

/// A spall on a race.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RaceSpall {
    /// ψ₀, its middle round the axis, from the ring's x towards its y \[rad\].
    pub angle_rad: f64,
    /// α₀, its middle across the groove as a contact angle; none: the contact angle without load \[rad\].
    pub contact_angle_rad: Option<f64>,
    /// L, along the way of the balls \[m\].
    pub length_m: f64,
    /// W, across the groove; none: all of the groove \[m\].
    pub width_m: Option<f64>,
    /// d \[m\].
    pub depth_m: f64,
}

/// A depth over the angles of a race, with its derivatives.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Depth {
    /// h \[m\].
    pub depth_m: f64,
    /// ∂h/∂ψ, ∂h/∂α.
    pub by: [f64; 2],
    /// ∂²h/∂ψ², ∂²h/∂ψ∂α, ∂²h/∂α².
    pub by_two: [f64; 3],
}

impl Depth {
    pub fn add(&mut self, other: &Self) {
        self.depth_m += other.depth_m;
        for (a, b) in self.by.iter_mut().zip(other.by) {
            *a += b;
        }
        for (a, b) in self.by_two.iter_mut().zip(other.by_two) {
            *a += b;
        }
    }
}

/// A spall on the race of a row, ready to be evaluated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PlacedSpall {
    angle_rad: f64,
    contact_angle_rad: f64,
    /// ρ \[m\].
    radius_m: f64,
    /// r \[m\].
    groove_m: f64,
    /// d' \[m\].
    pub reached_m: f64,
    along: SmoothEdge,
    /// None where it takes all of the groove.
    across: Option<SmoothEdge>,
}

/// Sums of the curvatures of ball and groove along the way of the balls and across it \[1/m\].
pub(crate) fn curvatures_per_m(groove: &Groove, ball_diameter_m: f64) -> [f64; 2] {
    let ball = 2.0 / ball_diameter_m;
    let across = ball - 1.0 / (groove.arm_m + 0.5 * ball_diameter_m);
    [groove.contact.curvature_sum_per_m - across, across]
}

impl RaceSpall {
    pub(crate) fn on(
        &self,
        groove: &Groove,
        ball_diameter_m: f64,
        (free_angle_rad, pitch_radius_m): (f64, f64),
    ) -> PlacedSpall {
        let [along, across] = curvatures_per_m(groove, ball_diameter_m);
        let mut reached = reached_m(self.depth_m, self.length_m, along);
        if let Some(width) = self.width_m {
            reached = reached_m(reached, width, across);
        }
        let contact_angle_rad = self.contact_angle_rad.unwrap_or(free_angle_rad);
        // The inner groove's surface lies inwards of its centre, the outer one's outwards.
        let outwards = (pitch_radius_m - groove.centre_radius_m).signum();
        let groove_m = groove.arm_m + 0.5 * ball_diameter_m;
        PlacedSpall {
            angle_rad: self.angle_rad,
            contact_angle_rad,
            radius_m: groove.centre_radius_m + outwards * groove_m * contact_angle_rad.cos(),
            groove_m,
            reached_m: reached,
            along: SmoothEdge {
                half_m: 0.5 * self.length_m,
                entry_m: entry_m(reached, along),
            },
            across: self.width_m.map(|width| SmoothEdge {
                half_m: 0.5 * width,
                entry_m: entry_m(reached, across),
            }),
        }
    }
}

/// An angle between −π and π.
fn wrapped(angle_rad: f64) -> f64 {
    (angle_rad + PI).rem_euclid(TAU) - PI
}

impl PlacedSpall {
    /// What is lost under a ball at ψ with the contact angle α; none beside the spall.
    pub fn depth(&self, psi: f64, alpha: f64) -> Option<Depth> {
        let along = wrapped(psi - self.angle_rad) * self.radius_m;
        if along.abs() >= self.along.half_m {
            return None;
        }
        let s = self.along.share(along);
        let t = self.across.map_or([1.0, 0.0, 0.0], |edge| {
            edge.share(wrapped(alpha - self.contact_angle_rad) * self.groove_m)
        });
        let (d, rho, r) = (self.reached_m, self.radius_m, self.groove_m);
        Some(Depth {
            depth_m: d * s[0] * t[0],
            by: [d * rho * s[1] * t[0], d * r * s[0] * t[1]],
            by_two: [
                d * rho * rho * s[2] * t[0],
                d * rho * r * s[1] * t[1],
                d * r * r * s[0] * t[2],
            ],
        })
    }

    /// What is lost in the middle of its width under a ball at ψ \[m\].
    pub fn middle_depth_m(&self, psi: f64) -> f64 {
        let along = wrapped(psi - self.angle_rad) * self.radius_m;
        self.reached_m * self.along.share(along)[0]
    }
}
