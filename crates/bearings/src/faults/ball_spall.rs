//! Material lost from a round patch of a ball.
//!
//! With c the patch's middle on the ball (a unit vector that turns with it), n from the ball's centre to the contact
//! and u = n·c,
//!
//! ```text
//! h(u) = d' S(chord),   chord = (D/2) √(2 − 2u),   d' = min(d, L²/(8R)),   R = max(R_L, R_W)                (19)
//! ```
//!
//! for a patch of the diameter L. It depends on how the ball stands, so that this ball alone keeps an orientation.

use nalgebra::Vector3;

use super::race_spall::curvatures_per_m;
use super::smooth_edge::{SmoothEdge, entry_m, reached_m};
use crate::groove::Groove;

/// A spall on a ball.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BallSpall {
    /// Place along the track at the start: 0 faces the outer race, a quarter of a turn later the way on, half a turn
    /// the inner race \[rad\].
    pub angle_rad: f64,
    /// Place beside the track, towards +z of the ring \[rad\].
    pub beside_rad: f64,
    /// L, diameter of the patch \[m\].
    pub diameter_m: f64,
    /// d \[m\].
    pub depth_m: f64,
}

impl BallSpall {
    /// c in the axes of the ball at the start, which are the radial direction, the way on, and z.
    #[must_use]
    pub fn direction(&self) -> Vector3<f64> {
        let (sine, cosine) = self.angle_rad.sin_cos();
        let (up, level) = self.beside_rad.sin_cos();
        Vector3::new(cosine * level, sine * level, up)
    }

    pub(crate) fn on(&self, groove: &Groove, ball_diameter_m: f64) -> PlacedPatch {
        let [along, across] = curvatures_per_m(groove, ball_diameter_m);
        let reached = reached_m(self.depth_m, self.diameter_m, along.min(across));
        PlacedPatch {
            ball_radius_m: 0.5 * ball_diameter_m,
            reached_m: reached,
            edge: SmoothEdge {
                half_m: 0.5 * self.diameter_m,
                entry_m: entry_m(reached, along.min(across)),
            },
        }
    }
}

/// The patch of a ball against one of the races.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PlacedPatch {
    ball_radius_m: f64,
    /// d' \[m\].
    pub reached_m: f64,
    edge: SmoothEdge,
}

impl PlacedPatch {
    /// h and its derivatives by u; none beside the patch.
    pub fn depth(&self, u: f64) -> Option<[f64; 3]> {
        let radius = self.ball_radius_m;
        let square = 2.0 - 2.0 * u;
        let chord = radius * square.max(0.0).sqrt();
        if chord >= self.edge.half_m {
            return None;
        }
        let [share, slope, bend] = self.edge.share(chord);
        let d = self.reached_m;
        // chord² = (D/2)² (2 − 2u): chord' = −(D/2)²/chord, chord'' = −(D/2)⁴/chord³.
        if chord < 1e-6 * self.edge.half_m {
            // In the middle the floor is flat to the second order, whatever the edges are.
            return Some([d * share, 0.0, 0.0]);
        }
        let first = -radius * radius / chord;
        let second = -first * first / chord;
        Some([
            d * share,
            d * slope * first,
            d * (bend * first * first + slope * second),
        ])
    }
}
