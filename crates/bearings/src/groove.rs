//! A groove of a ring: half a torus that a ball touches.

use crate::point_contact::PointContact;

/// A groove.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Groove {
    /// R, radius of the circle of the groove's centres \[m\].
    pub centre_radius_m: f64,
    /// Its place along the ring's axis \[m\].
    pub centre_z_m: f64,
    /// r − D/2 \[m\].
    pub arm_m: f64,
    /// Contact with a ball.
    pub contact: PointContact,
    /// Direction (cosine, sine of a contact angle) in the middle of the half of the torus that is there.
    pub faces: (f64, f64),
}

impl Groove {
    /// Whether the half of the torus that is there has a contact at the angle with this cosine and sine.
    #[inline]
    pub(crate) fn reaches(&self, cosine: f64, sine: f64) -> bool {
        self.faces.0 * cosine + self.faces.1 * sine > 0.0
    }

    /// From the nearer rim, the end of the half of the torus that is there, to a ball's centre that lies (out, up) from
    /// the groove's centre: (out, up, distance) \[m\].
    #[inline]
    pub(crate) fn rim_to_centre(
        &self,
        (out, up): (f64, f64),
        ball_radius_m: f64,
    ) -> (f64, f64, f64) {
        let across = self.faces.0 * up - self.faces.1 * out;
        let end = (self.arm_m + ball_radius_m) * across.signum();
        let (out, up) = (out + self.faces.1 * end, up - self.faces.0 * end);
        (out, up, (out * out + up * up).sqrt().max(f64::MIN_POSITIVE))
    }
}
