//! A row of balls between two grooves.

use nalgebra::Vector3;

use crate::axial_plane::AxialPlane;
use crate::ball_equilibrium::Ball;
use crate::element_load::ElementLoad;
use crate::element_place::ElementPlace;
use crate::error::BearingError;
use crate::faults::{RowFaults, Side};
use crate::operation::Operation;
use crate::point_contact::PointContact;
use crate::ring_load::RingLoad;
use crate::ring_pose::RingPose;

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

/// A row of balls.
#[derive(Debug, Clone, PartialEq)]
pub struct BallRow {
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
    /// Groove of the inner ring, in its frame.
    pub inner: Groove,
    /// Groove of the outer ring.
    pub outer: Groove,
    /// Contact angle without load, with the sign of the axial force that the inner ring can take \[rad\].
    pub free_angle_rad: f64,
    /// Angle of the first ball \[rad\].
    pub first_angle_rad: f64,
    /// What is wrong with it; none for a sound row.
    pub faults: Option<Box<RowFaults>>,
}

impl BallRow {
    /// Angle of a ball \[rad\].
    #[must_use]
    pub fn angle_rad(&self, ball: usize, operation: &Operation) -> f64 {
        operation.element_angle_rad(self.first_angle_rad, ball, self.balls)
    }

    /// The groove of a ring.
    #[must_use]
    pub fn groove(&self, side: Side) -> &Groove {
        match side {
            Side::Inner => &self.inner,
            Side::Outer => &self.outer,
        }
    }

    /// Whether a ball is there.
    #[must_use]
    pub fn has(&self, ball: usize) -> bool {
        !(self.faults.as_ref()).is_some_and(|faults| faults.is_missing(ball))
    }

    /// Diameter \[m\] and mass \[kg\] of a ball, which may be of another size than the others.
    #[must_use]
    pub fn ball_size(&self, ball: usize) -> (f64, f64) {
        let (diameter_m, mass_kg) = (self.ball_diameter_m, self.ball_mass_kg);
        match self.faults.as_ref().and_then(|faults| faults.size(ball)) {
            None => (diameter_m, mass_kg),
            Some(size) => (
                diameter_m + size.oversize_m,
                mass_kg * size.mass_ratio(diameter_m),
            ),
        }
    }

    /// Adds what the row does to the ring, and hands every ball's load to `each`. The search of each ball begins at
    /// its place, which it leaves where it ends.
    ///
    /// # Errors
    /// [`BearingError::NoBallEquilibrium`], [`BearingError::PulledOut`].
    pub(crate) fn add(
        &self,
        pose: &RingPose,
        operation: &Operation,
        places: &mut [ElementPlace],
        ring: &mut RingLoad,
        mut each: impl FnMut(ElementLoad),
    ) -> Result<(), BearingError> {
        let (step_sine, step_cosine) = (std::f64::consts::TAU / self.balls as f64).sin_cos();
        let (mut sine, mut cosine) = self.angle_rad(0, operation).sin_cos();
        for (number, place) in places.iter_mut().enumerate() {
            let e_r = Vector3::new(cosine, sine, 0.0);
            (sine, cosine) = (
                sine * step_cosine + cosine * step_sine,
                cosine * step_cosine - sine * step_sine,
            );
            if !self.has(number) {
                each(ElementLoad::absent(self.angle_rad(number, operation)));
                continue;
            }
            let faulty = self.faults.as_ref().map(|faults| {
                let angle = self.angle_rad(number, operation);
                let angles = (angle, angle - operation.inner_angle_rad);
                faults.grooves_under(self, number, angles)
            });
            let [outer, inner] = match &faulty {
                None => [&self.outer, &self.inner],
                Some([outer, inner]) => [outer, inner],
            };
            let ball = Ball {
                row: self,
                inner,
                outer,
                pose,
                operation,
                plane: AxialPlane { e_r },
                number,
            };
            each(ball.add(place, ring)?);
        }
        Ok(())
    }
}
