//! How high a ball's contact ellipse reaches up its groove, and where the groove's shoulder ends.
//!
//! The contact lies at the angle α on the groove's circle of the radius r = fD, its ellipse reaches a to each side, so
//! that its end towards the shoulder lies
//!
//! ```text
//! h = r (1 − cos(|α| + asin(a/r)))
//! ```
//!
//! above the groove's bottom. Beyond the shoulder the ellipse is cut off, and pressure rises at the edge (T. A. Harris,
//! *Rolling Bearing Analysis*: thrust load limit by override).

use std::f64::consts::FRAC_PI_2;

use crate::definition::{BallBearingKind, BallGeometry};

/// Height of the shoulders of today's deep-groove bearings over the ball's diameter, an assumption …
const USUAL_HEIGHT: f64 = 0.2;

/// … and by how much the higher shoulder of angular-contact bearings reaches beyond the free contact angle, another one
/// \[rad\].
const BEYOND_CONTACT_RAD: f64 = std::f64::consts::PI / 6.0;

impl BallGeometry {
    /// Heights of the shoulders above the bottoms of the inner and outer groove \[m\]: those stated, or else the
    /// estimate of 0.2 D, for angular-contact bearings of steep angles so much that the shoulder reaches 30° beyond the
    /// contact angle.
    #[must_use]
    pub fn shoulder_heights_m(&self) -> [f64; 2] {
        self.stated_shoulder_heights_m.unwrap_or_else(|| {
            let steep = match self.kind {
                // Washers are judged by nothing here: their grooves face along the axis.
                BallBearingKind::DeepGroove | BallBearingKind::Thrust => 0.0,
                BallBearingKind::AngularContact | BallBearingKind::FourPoint { .. } => {
                    0.5 * (1.0 - (self.free_angle_rad + BEYOND_CONTACT_RAD).cos())
                }
            };
            [USUAL_HEIGHT.max(steep) * self.ball_diameter_m; 2]
        })
    }

    /// How high contact ellipses reach above the bottoms of the inner and outer groove \[m\], given contact angles
    /// \[rad\] and half lengths \[m\]; 0 for one without load.
    #[must_use]
    pub fn ellipse_heights_m(&self, angles_rad: [f64; 2], half_lengths_m: [f64; 2]) -> [f64; 2] {
        let conformities = [self.inner_conformity, self.outer_conformity];
        std::array::from_fn(|side| {
            let half_m = half_lengths_m[side];
            if half_m <= 0.0 {
                return 0.0;
            }
            let radius_m = conformities[side] * self.ball_diameter_m;
            let end = angles_rad[side].abs() + (half_m / radius_m).min(1.0).asin();
            // Past a right angle there is no groove: it reaches at least as high as the circle's middle.
            radius_m * (1.0 - end.min(FRAC_PI_2).cos())
        })
    }
}
