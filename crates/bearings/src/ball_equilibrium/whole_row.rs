//! Load and stiffness of a whole row of balls on the inner ring.

use nalgebra::Vector3;

use super::Ball;
use crate::axial_plane::AxialPlane;
use crate::ball_row::BallRow;
use crate::element_load::ElementLoad;
use crate::element_search::ElementPlace;
use crate::error::BearingError;
use crate::operation::Operation;
use crate::ring_load::RingLoad;
use crate::ring_pose::RingPose;

impl BallRow {
    /// Adds the row's load and stiffness to the ring's, and hands the load of every ball to `each`. The search for a
    /// ball begins at its place, and writes there where it ends.
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
                faults.grooves_under([&self.outer, &self.inner], number, angles)
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
